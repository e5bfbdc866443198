//! Command bar in a lower corner: menu of all commands, undo, redo, help, and what the brush carries.

use eframe::egui::containers::menu::MenuButton;
use eframe::egui::{
    Align2, Area, Button, Context, Frame, Id, Margin, Order, Response, Role, TextWrapMode, Ui,
    WidgetInfo,
};

use crate::app::brush_gauge;
use crate::input::keys::{self, Action, BINDINGS};
use crate::widgets::context::PanelContext;

/// Entries of the menu, by what they concern.
const GROUPS: [(&str, &[Action]); 4] = [
    (
        "Painting",
        &[
            Action::New,
            Action::Open,
            Action::Save,
            Action::SaveAs,
            Action::Export,
            Action::Undo,
            Action::Redo,
            Action::Dry,
        ],
    ),
    (
        "Brush",
        &[
            Action::NextBrush,
            Action::LoadFrom,
            Action::Scrape,
            Action::Larger,
            Action::Smaller,
            Action::Follow,
            Action::TurnLeft,
            Action::TurnRight,
            Action::Harder,
            Action::Lighter,
        ],
    ),
    (
        "View",
        &[
            Action::Palette,
            Action::Panels,
            Action::Reference,
            Action::ChooseTracing,
            Action::Tracing,
            Action::Fit,
            Action::Hundred,
            Action::FullScreen,
            Action::Alone,
            Action::Focus,
        ],
    ),
    ("Help", &[Action::Keys, Action::ForceOff]),
];

/// Distance from the window's edges, points.
const MARGIN: f32 = 6.0;

/// Shows the bar; the action that was chosen.
pub(super) fn show(context: &Context, work: &PanelContext<'_>) -> Option<Action> {
    let (corner, inward) = match work.preferences.left_handed {
        false => (Align2::LEFT_BOTTOM, 1.0),
        true => (Align2::RIGHT_BOTTOM, -1.0),
    };
    let mut chosen = None;
    Area::new(Id::unique("bar"))
        .order(Order::Middle)
        .anchor(corner, [inward * MARGIN, -MARGIN])
        .accessible_name("Commands")
        .show(context, |ui| {
            ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
            let back = ui.visuals().window_fill.gamma_multiply(0.8);
            let frame = Frame::NONE.fill(back).corner_radius(6.0);
            frame.inner_margin(Margin::same(3)).show(ui, |ui| {
                ui.horizontal(|ui| {
                    ui.spacing_mut().item_spacing.x = 2.0;
                    chosen = menu(ui);
                    for (word, action) in [
                        ("Undo", Action::Undo),
                        ("Redo", Action::Redo),
                        ("?", Action::Keys),
                    ] {
                        let button = ui.add(Button::new(word).min_size([26.0, 24.0].into()));
                        if described(button, action).clicked() {
                            chosen = Some(action);
                        }
                    }
                    brush_gauge::show(ui, work);
                });
            });
        });
    chosen
}

/// The button of the menu; the action that was chosen in it.
fn menu(ui: &mut Ui) -> Option<Action> {
    let mut chosen = None;
    let button = Button::new("Menu").min_size([26.0, 24.0].into());
    let (shown, _) = MenuButton::from_button(button).ui(ui, |ui| {
        for (title, actions) in GROUPS {
            ui.menu_button(title, |ui| {
                for action in actions {
                    if let Some(binding) = binding(*action) {
                        let keys = keys::written(ui.ctx(), &binding.shortcut);
                        let entry = Button::new(binding.words).shortcut_text(keys);
                        if ui.add(entry).clicked() {
                            chosen = Some(*action);
                            ui.close();
                        }
                    }
                }
            });
        }
    });
    shown.widget_info(|| WidgetInfo::labeled(Role::Button, true, "Menu"));
    shown.on_hover_text("All commands");
    chosen
}

/// Describes a button by its action, for screen readers and on hover.
fn described(button: Response, action: Action) -> Response {
    let Some(binding) = binding(action) else {
        return button;
    };
    button.widget_info(|| WidgetInfo::labeled(Role::Button, true, binding.words));
    let keys = keys::written(&button.ctx, &binding.shortcut);
    button.on_hover_text(format!("{}  {keys}", binding.words))
}

fn binding(action: Action) -> Option<&'static keys::Binding> {
    BINDINGS.iter().find(|known| known.act == action)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_menu_has_every_command_once() {
        let offered: Vec<Action> = GROUPS.iter().flat_map(|(_, acts)| acts.to_vec()).collect();
        for binding in &BINDINGS {
            let times = offered.iter().filter(|act| **act == binding.act).count();
            assert_eq!(times, 1, "{}", binding.words);
        }
    }
}
