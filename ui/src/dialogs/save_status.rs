//! The line at the lower edge: name of the painting, and whether it is saved. It opens a menu of all file actions, for
//! painters without the keys. The mark of a recording in progress stands before it.

use std::path::Path;

use eframe::egui::containers::menu::MenuButton;
use eframe::egui::{
    Area, Button, Context, Frame, Id, Margin, Order, Rect, RichText, TextWrapMode, Ui,
};
use maulstick_ui_kit::language::translated;

use crate::app::overlay::bar;
use crate::app::sides;
use crate::dialogs::paths;
use crate::input::keymap::Keymap;
use crate::input::keys::{Action, BINDINGS};
use crate::sessions::recording_mark;
use crate::widgets::context::PanelContext;

/// Unsaved time from which it is shown, ns.
const LATE_NS: u64 = 2_000_000_000;
/// Space around the line, points.
const MARGIN: f32 = 8.0;
/// Width below which the line stands over the bar instead of beside it, points.
const LEAST_WIDTH: f32 = 120.0;
/// Entries of the menu.
const OFFERS: [Action; 6] = [
    Action::New,
    Action::Open,
    Action::Save,
    Action::SaveAs,
    Action::Export,
    Action::Reference,
];

/// The line; empty while the painting is unknown.
fn words(context: &Context, work: &PanelContext<'_>) -> String {
    let Some(node) = &work.rig.live.paint else {
        return String::new();
    };
    let status = &node.status;
    if status.path.is_empty() {
        return if status.blank {
            tr!("New painting").to_owned()
        } else {
            match work.preferences.keys.written(context, Action::Save) {
                key if key.is_empty() => tr!("In no file").to_owned(),
                key => tr!("In no file · {key} keeps it", key),
            }
        };
    }
    let since = work.rig.live.now_ns.saturating_sub(status.committed_ns);
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

/// Shows the line; returns the choice from its menu.
pub(crate) fn show(context: &Context, work: &mut PanelContext<'_>) -> Option<Action> {
    let words = words(context, work);
    if words.is_empty() && work.rig.recording.is_none() {
        return None;
    }
    let side = sides::rack_side(work.preferences);
    let (_, corner, inward) = side.anchors();
    let beside = sides::rack_at(work.preferences, side) + sides::column_at(work.preferences, side);
    let aside = beside + MARGIN;
    let bar = context.memory(|memory| memory.area_rect(bar::id()));
    let (width, above) = room(context.content_rect(), bar, aside);
    let mut chosen = None;
    Area::new(Id::unique("saved"))
        .order(Order::Middle)
        .anchor(corner, [inward * aside, -above])
        .accessible_name(tr!("Painting"))
        .show(context, |ui| {
            ui.set_max_width(width);
            ui.style_mut().wrap_mode = Some(TextWrapMode::Truncate);
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

/// Greatest width of the line and its height over the window's edge, points: beside the bar, or over it where there is
/// no room; `aside` is its distance from its side of the window.
fn room(window: Rect, bar: Option<Rect>, aside: f32) -> (f32, f32) {
    let least_above = 4.0;
    let whole = window.width() - aside - 3.0 * MARGIN;
    let Some(bar) = bar else {
        return (whole.max(LEAST_WIDTH), least_above);
    };
    let nearer = (bar.left() - window.left()).min(window.right() - bar.right());
    let free = whole - bar.width() - nearer;
    if free >= LEAST_WIDTH {
        (free, least_above)
    } else {
        (
            whole.max(LEAST_WIDTH),
            window.bottom() - bar.top() + least_above,
        )
    }
}

/// The line with its menu; returns the choice.
fn menu(ui: &mut Ui, words: &str, keymap: &Keymap) -> Option<Action> {
    let mut chosen = None;
    let button = Button::new(RichText::new(words).small())
        .frame_when_inactive(false)
        .small();
    let (shown, _) = MenuButton::from_button(button).ui(ui, |ui| {
        for act in OFFERS {
            let Some(binding) = BINDINGS.iter().find(|known| known.act == act) else {
                continue;
            };
            let keys = keymap.written(ui.ctx(), act);
            let offer = Button::new(translated(binding.words)).shortcut_text(keys);
            if ui.add(offer).clicked() {
                chosen = Some(act);
            }
        }
    });
    shown.on_hover_text(words);
    chosen
}

#[cfg(test)]
mod tests {
    use eframe::egui::{Pos2, pos2};

    use super::*;

    #[test]
    fn a_long_name_ends_before_the_bar_and_stands_over_it_where_there_is_no_room() {
        let bar = |left: f32| Rect::from_min_max(pos2(left, 560.0), pos2(left + 300.0, 594.0));
        for (width, left, aside, is_beside) in [
            (1280.0, 6.0, 80.0, true),
            (1280.0, 974.0, 80.0, true),
            (800.0, 6.0, 442.0, false),
            (500.0, 6.0, 80.0, false),
        ] {
            let window = Rect::from_min_max(Pos2::ZERO, pos2(width, 600.0));
            let (most, above) = room(window, Some(bar(left)), aside);
            assert!(most >= LEAST_WIDTH && most < width - aside);
            let line = if left < 0.5 * width {
                width - aside - most..width - aside
            } else {
                aside..aside + most
            };
            let free = line.end <= left || line.start >= left + 300.0;
            assert_eq!(free, is_beside, "{line:?}");
            assert_eq!(600.0 - above < 560.0, !is_beside, "{above}");
        }
    }
}
