//! Look of the window: the size of its text, and its theme.

use std::ops::RangeInclusive;

use eframe::egui::{Context, ThemePreference};
use serde::{Deserialize, Serialize};

/// Factors on the size of texts and controls that the window offers.
pub(crate) const TEXT_SIZES: RangeInclusive<f32> = 0.5..=3.0;

/// Theme of panels and dialogs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Theme {
    /// As the system has it.
    #[default]
    System,
    /// Light text on dark ground.
    Dark,
    /// Dark text on light ground.
    Light,
}

impl Theme {
    /// All themes, as a painter reads them.
    pub(crate) const WORDS: [(Self, &'static str); 3] = [
        (Self::System, tr_noop!("As the system")),
        (Self::Dark, tr_noop!("Dark")),
        (Self::Light, tr_noop!("theme|Light")),
    ];
}

impl From<Theme> for ThemePreference {
    fn from(theme: Theme) -> Self {
        match theme {
            Theme::System => Self::System,
            Theme::Dark => Self::Dark,
            Theme::Light => Self::Light,
        }
    }
}

/// Keeps window and preferences at the same look.
#[derive(Debug, Default)]
pub(crate) struct Look {
    theme: Option<Theme>,
}

impl Look {
    /// Gives a new window this look; later the theme follows, and the text size is taken from the window, for keys of egui
    /// change it too.
    pub(crate) fn follow(&mut self, context: &Context, theme: Theme, text_size: &mut f32) {
        match self.theme {
            None => context.set_zoom_factor(*text_size),
            Some(_) => *text_size = (100.0 * context.zoom_factor()).round() / 100.0,
        }
        if self.theme.replace(theme) != Some(theme) {
            context.set_theme(theme);
        }
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::{self, Key, Modifiers};
    use egui_kittest::Harness;

    use super::*;

    #[test]
    fn the_text_size_is_given_to_the_window_and_kept_as_its_keys_change_it() {
        let show = |ui: &mut egui::Ui, (look, text_size, theme): &mut (Look, f32, Theme)| {
            look.follow(ui.ctx(), *theme, text_size);
        };
        let state = (Look::default(), 1.3, Theme::Light);
        let mut harness = Harness::builder().build_ui_state(show, state);
        harness.run_steps(3);
        assert_eq!(harness.ctx.zoom_factor(), 1.3);
        assert!(!harness.ctx.global_style().visuals.dark_mode);
        harness.key_press_modifiers(Modifiers::COMMAND, Key::Minus);
        harness.run_steps(3);
        assert_eq!(harness.state().1, 1.2);
        harness.state_mut().2 = Theme::Dark;
        harness.run_steps(3);
        assert!(harness.ctx.global_style().visuals.dark_mode);
    }
}
