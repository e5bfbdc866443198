//! Command bar in a lower corner: menu of all commands, undo, redo, help, and the brush's load.

use eframe::egui::containers::menu::MenuButton;
use eframe::egui::{
    Area, Button, Context, Frame, Id, Margin, Order, Response, Role, TextWrapMode, Ui, WidgetInfo,
};
use maulstick_ui_kit::language::translated;

use crate::app::sides;
use crate::input::keymap::Keymap;
use crate::input::keys::{Action, BINDINGS, Binding};
use crate::widgets::brush_gauge;
use crate::widgets::context::PanelContext;

/// Entries of the menu, by subject.
const GROUPS: [(&str, &[Action]); 4] = [
    (
        tr_noop!("Painting"),
        &[
            Action::New,
            Action::Open,
            Action::Save,
            Action::SaveAs,
            Action::Export,
            Action::Record,
            Action::Play,
            Action::Motions,
            Action::Undo,
            Action::Redo,
            Action::Dry,
            Action::Quit,
        ],
    ),
    (
        tr_noop!("Brush"),
        &[
            Action::NextBrush,
            Action::LoadFrom,
            Action::Clean,
            Action::Scrape,
            Action::Colour,
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
        tr_noop!("View"),
        &[
            Action::Palette,
            Action::Panels,
            Action::Reference,
            Action::ChooseTracing,
            Action::Tracing,
            Action::Fit,
            Action::Hundred,
            Action::Mirror,
            Action::FullScreen,
            Action::Alone,
            Action::Focus,
        ],
    ),
    (
        tr_noop!("Help"),
        &[
            Action::Tutorial,
            Action::Keys,
            Action::Settings,
            Action::ForceOff,
            Action::About,
        ],
    ),
];

/// Distance from the window's edges, points.
const MARGIN: f32 = 6.0;

#[must_use]
pub(crate) fn id() -> Id {
    Id::unique("bar")
}

/// Shows the bar; the action that was chosen.
pub(super) fn show(context: &Context, work: &PanelContext<'_>) -> Option<Action> {
    let side = sides::rack_side(work.preferences).other();
    let (_, corner, inward) = side.anchors();
    let aside = MARGIN + sides::column_at(work.preferences, side);
    let mut chosen = None;
    Area::new(id())
        .order(Order::Middle)
        .anchor(corner, [inward * aside, -MARGIN])
        .accessible_name(tr!("Commands"))
        .show(context, |ui| {
            ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
            let back = ui.visuals().window_fill.gamma_multiply(0.8);
            let frame = Frame::NONE.fill(back).corner_radius(6.0);
            frame.inner_margin(Margin::same(3)).show(ui, |ui| {
                ui.horizontal(|ui| {
                    ui.spacing_mut().item_spacing.x = 2.0;
                    chosen = menu(ui, work);
                    for (word, action) in [
                        (tr!("Undo"), Action::Undo),
                        (tr!("Redo"), Action::Redo),
                        ("?", Action::Keys),
                    ] {
                        let button = ui.add(Button::new(word).min_size([26.0, 24.0].into()));
                        if described(button, action, &work.preferences.keys).clicked() {
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
fn menu(ui: &mut Ui, work: &PanelContext<'_>) -> Option<Action> {
    let mut chosen = None;
    let button = Button::new(tr!("Menu")).min_size([26.0, 24.0].into());
    let (shown, _) = MenuButton::from_button(button).ui(ui, |ui| {
        for (title, actions) in GROUPS {
            ui.menu_button(translated(title), |ui| {
                for action in actions {
                    if let Some(binding) = binding(*action) {
                        let keys = work.preferences.keys.written(ui.ctx(), *action);
                        let words = match (action, &work.rig.recording) {
                            (Action::Record, Some(_)) => tr!("Stop recording"),
                            _ => translated(binding.words),
                        };
                        let entry = Button::new(words).shortcut_text(keys);
                        if ui.add(entry).clicked() {
                            chosen = Some(*action);
                            ui.close();
                        }
                    }
                }
            });
        }
    });
    shown.widget_info(|| WidgetInfo::labeled(Role::Button, true, tr!("Menu")));
    shown.on_hover_text(tr!("All commands"));
    chosen
}

/// Describes a button by its action, for screen readers and on hover.
fn described(button: Response, action: Action, keymap: &Keymap) -> Response {
    let Some(binding) = binding(action) else {
        return button;
    };
    button.widget_info(|| WidgetInfo::labeled(Role::Button, true, translated(binding.words)));
    let hint = keymap.hint(&button.ctx, translated(binding.words), &[action]);
    button.on_hover_text(hint)
}

fn binding(action: Action) -> Option<&'static Binding> {
    BINDINGS.iter().find(|known| known.act == action)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_menu_has_every_command_once() {
        let offered: Vec<Action> = GROUPS.iter().flat_map(|(_, acts)| acts.to_vec()).collect();
        // Size and zoom are drags.
        let is_drag = |act: Action| matches!(act, Action::Size | Action::Zoom);
        for binding in BINDINGS.iter().filter(|binding| !is_drag(binding.act)) {
            let times = offered.iter().filter(|act| **act == binding.act).count();
            assert_eq!(times, 1, "{}", binding.words);
        }
    }
}
