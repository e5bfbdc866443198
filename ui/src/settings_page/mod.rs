//! Dialog of settings: text size, language, theme, units, keys. A change takes effect at once.
//!
//! | module | holds |
//! | --- | --- |
//! | `key_rows` | the keys, and their changes |

mod key_rows;

use eframe::egui::{
    Align, Button, Context, Frame, Id, Layout, Margin, Modal, RichText, Role, Ui, WidgetInfo,
    gui_zoom,
};
use maulstick_ui_kit::language;
use maulstick_ui_kit::language::translated;
use maulstick_ui_kit::rows::cell;
use maulstick_ui_kit::units::Units;

use key_rows::KeyRows;

use crate::settings::look::{TEXT_SIZES, Theme};
use crate::widgets::context::PanelContext;

/// Width of the dialog, points.
const WIDTH: f32 = 460.0;
/// Space around it in a small window, points.
const AROUND: f32 = 48.0;
/// Width of a setting's name, and space between two settings, points.
const NAME: f32 = 84.0;
const BETWEEN: f32 = 4.0;
/// Height of what is around the list of keys below the settings, and of the window around the dialog, points.
const FOOT: f32 = 160.0;

/// The dialog; closed at first.
#[derive(Debug, Default)]
pub(crate) struct SettingsPage {
    shown: Option<KeyRows>,
}

impl SettingsPage {
    pub(crate) fn open(&mut self) {
        self.shown = Some(KeyRows::default());
    }

    /// True while it has the keyboard.
    #[must_use]
    pub(crate) fn is_open(&self) -> bool {
        self.shown.is_some()
    }

    /// Shows it, if it is open.
    pub(crate) fn show(&mut self, context: &Context, work: &mut PanelContext<'_>) {
        let Some(rows) = &mut self.shown else {
            return;
        };
        rows.take_key(context, &mut work.preferences.keys);
        let frame = Frame::window(&context.global_style()).inner_margin(Margin::same(16));
        let modal = Modal::new(Id::unique("settings"))
            .frame(frame)
            .show(context, |ui| {
                let window = context.content_rect().size();
                ui.set_width(WIDTH.min(window.x - AROUND));
                ui.heading(RichText::new(tr!("Settings")).strong());
                ui.add_space(8.0);
                look(ui, work);
                ui.add_space(6.0);
                ui.separator();
                let height = window.y - ui.min_rect().height() - FOOT;
                rows.show(ui, height, &mut work.preferences.keys);
                ui.add_space(8.0);
                let layout = Layout::right_to_left(Align::Center);
                let close = Button::new(tr!("Close")).min_size([80.0, 28.0].into());
                ui.with_layout(layout, |ui| ui.add(close)).inner
            });
        if modal.inner.clicked() || modal.should_close() {
            self.shown = None;
            return;
        }
        // A dialog without the keyboard could not be left by it.
        if context.memory(|memory| memory.focused().is_none()) {
            modal.inner.request_focus();
        }
    }
}

/// Text size, language, theme and units.
fn look(ui: &mut Ui, work: &mut PanelContext<'_>) {
    let preferences = &mut *work.preferences;
    setting(ui, tr!("Text size"), text_size);
    setting(ui, tr!("Language"), |ui| {
        language_choice(ui, &mut preferences.window.language);
    });
    setting(ui, tr!("Theme"), |ui| {
        for (theme, words) in Theme::WORDS {
            ui.selectable_value(&mut preferences.window.theme, theme, translated(words));
        }
    });
    setting(ui, tr!("Lengths"), |ui| {
        for (units, words) in Units::WORDS {
            ui.selectable_value(&mut preferences.window.units, units, translated(words));
        }
    });
}

/// A setting: its name, beside it the choices, in as many lines as they need.
fn setting(ui: &mut Ui, name: &str, choices: impl FnOnce(&mut Ui)) {
    ui.horizontal_top(|ui| {
        cell(ui, NAME, |ui| ui.label(name));
        ui.horizontal_wrapped(choices);
    });
    ui.add_space(BETWEEN);
}

/// The languages by their own names; the window speaks the chosen one at once.
fn language_choice(ui: &mut Ui, chosen: &mut Option<String>) {
    let english = (language::ENGLISH, "English");
    let others = language::all().iter();
    let names = std::iter::once(english).chain(others.map(|(code, other)| (*code, &*other.name)));
    let system = tr!("As the system");
    let mut is_changed = ui.selectable_value(chosen, None, system).clicked();
    for (code, name) in names {
        let own = Some(code.to_owned());
        is_changed |= ui.selectable_value(chosen, own, name).clicked();
    }
    if is_changed {
        language::choose(chosen.as_deref());
        ui.ctx().request_repaint();
    }
}

fn text_size(ui: &mut Ui) {
    let now = ui.ctx().zoom_factor();
    let button = |ui: &mut Ui, sign: &str, name: &str, can: bool| {
        let button = Button::new(sign).min_size([26.0, 0.0].into());
        let shown = ui.add_enabled(can, button).on_hover_text(name);
        shown.widget_info(|| WidgetInfo::labeled(Role::Button, can, name));
        shown.clicked()
    };
    if button(ui, "−", tr!("Smaller text"), now > *TEXT_SIZES.start()) {
        gui_zoom::zoom_out(ui.ctx());
    }
    ui.label(format!("{:.0} %", 100.0 * now));
    if button(ui, "+", tr!("Larger text"), now < *TEXT_SIZES.end()) {
        gui_zoom::zoom_in(ui.ctx());
    }
    ui.weak(tr!("also by Ctrl + and −"));
}

#[cfg(test)]
mod tests;
