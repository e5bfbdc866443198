//! The line at the lower edge: name of the painting, and whether it is saved. It opens a menu of all file
//! actions, for painters who do not know the keys. Before it stands the mark of a recording in progress.

use std::path::Path;

use eframe::egui::containers::menu::MenuButton;
use eframe::egui::{Area, Button, Context, Frame, Id, Margin, Order, RichText, TextWrapMode, Ui};

use crate::app::{rack, sides};
use crate::dialogs::paths;
use crate::input::keymap::Keymap;
use crate::input::keys::{Action, BINDINGS};
use crate::sessions::recording_mark;
use crate::widgets::context::PanelContext;

/// Unsaved time from which it is shown, ns.
const LATE_NS: u64 = 2_000_000_000;
/// Entries of the menu.
const OFFERS: [Action; 6] = [
    Action::New,
    Action::Open,
    Action::Save,
    Action::SaveAs,
    Action::Export,
    Action::Reference,
];

/// The line; empty where nothing is known of the painting.
fn words(context: &Context, work: &PanelContext<'_>) -> String {
    let Some(node) = &work.rig.paint else {
        return String::new();
    };
    let status = &node.status;
    if status.path.is_empty() {
        return match status.blank {
            true => tr!("New painting").to_owned(),
            false => match work.preferences.keys.written(context, Action::Save) {
                key if key.is_empty() => tr!("In no file").to_owned(),
                key => tr!("In no file · {key} keeps it", key),
            },
        };
    }
    let since = work.rig.now_ns.saturating_sub(status.committed_ns);
    let state = match (status.fault.is_empty(), status.all_committed) {
        (false, _) => tr!("not saved"),
        (true, false) if since > LATE_NS => tr!("saving …"),
        _ => tr!("saved"),
    };
    if !work.rig.is_sketch() {
        let name = paths::name(Path::new(&status.path));
        return format!("{name} · {state}");
    }
    match work.preferences.keys.written(context, Action::Save) {
        _ if status.blank => tr!("New sketch").to_owned(),
        key if key.is_empty() => tr!("Sketch · {state}", state),
        key => tr!("Sketch · {state} · {key} names it", state, key),
    }
}

/// Shows the line; what was chosen under it.
pub(crate) fn show(context: &Context, work: &mut PanelContext<'_>) -> Option<Action> {
    let words = words(context, work);
    if words.is_empty() && work.rig.recording.is_none() {
        return None;
    }
    let side = sides::rack_side(work.preferences);
    let (_, corner, inward) = side.anchors();
    let aside = rack::WIDTH + 8.0 + sides::column_at(work.preferences, side);
    let mut chosen = None;
    Area::new(Id::unique("saved"))
        .order(Order::Middle)
        .anchor(corner, [inward * aside, -4.0])
        .accessible_name(tr!("Painting"))
        .show(context, |ui| {
            ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
            let back = ui.visuals().window_fill.gamma_multiply(0.8);
            let frame = Frame::NONE.fill(back).corner_radius(4.0);
            frame.inner_margin(Margin::symmetric(4, 0)).show(ui, |ui| {
                ui.horizontal(|ui| {
                    recording_mark::show(ui, work);
                    if !words.is_empty() {
                        chosen = menu(ui, &words, &work.preferences.keys);
                    }
                });
            });
        });
    chosen
}

/// The line with its menu; what was chosen there.
fn menu(ui: &mut Ui, words: &str, keymap: &Keymap) -> Option<Action> {
    let mut chosen = None;
    let button = Button::new(RichText::new(words).small())
        .frame_when_inactive(false)
        .small();
    MenuButton::from_button(button).ui(ui, |ui| {
        for act in OFFERS {
            let Some(binding) = BINDINGS.iter().find(|known| known.act == act) else {
                continue;
            };
            let keys = keymap.written(ui.ctx(), act);
            let offer = Button::new(binding.words).shortcut_text(keys);
            if ui.add(offer).clicked() {
                chosen = Some(act);
            }
        }
    });
    chosen
}
