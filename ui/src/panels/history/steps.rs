//! The last steps: undo and redo, and a list to go back or forth to any of them by a click.

use eframe::egui::{
    Align2, Button, CornerRadius, FontId, Rect, Response, Role, ScrollArea, Sense, Ui, WidgetInfo,
    pos2, vec2,
};
use maulstick_painting::edits::{GoTo, Redo, Undo};
use maulstick_types::paint::HistoryStep;
use maulstick_ui_kit::language;

use maulstick_client::thumbnails::Pictured;

use super::{Textures, paint_picture};
use crate::input::keys::Action;
use crate::widgets::context::{PanelContext, ask};

/// Width and height of the picture of a step, points.
const PICTURE: [f32; 2] = [40.0, 32.0];
/// Height of the list at most, points.
const HEIGHT: f32 = 250.0;
/// Gap between a row's edge, its picture and its words, points.
const GAP: f32 = 4.0;

/// A row of the list.
struct Row {
    /// Its step; 0 is the beginning.
    id: u64,
    words: String,
    done: bool,
}

/// The rows: the steps of a status, and the beginning where the list reaches back to it.
fn rows(work: &PanelContext<'_>) -> Vec<Row> {
    let Some(paint) = &work.rig.live.paint else {
        return Vec::new();
    };
    let row = |step: &HistoryStep| Row {
        id: step.id,
        words: language::capitalized(&language::step(&step.what)),
        done: step.done,
    };
    let mut rows: Vec<Row> = paint.status.history.iter().map(row).collect();
    let done = rows.iter().filter(|row| row.done).count();
    if !rows.is_empty() && done == paint.status.undo as usize {
        rows.push(Row {
            id: 0,
            words: tr!("Beginning").to_owned(),
            done: true,
        });
    }
    rows
}

/// Subjects of the rows that have pictures.
pub(super) fn pictured(work: &PanelContext<'_>) -> Vec<Pictured> {
    let rows = rows(work).into_iter();
    rows.map(|row| Pictured::Step(row.id)).collect()
}

/// Undo and redo, how many steps there are, and the list.
pub(super) fn show(ui: &mut Ui, work: &mut PanelContext<'_>, textures: &mut Textures) {
    let status = work.rig.live.paint.as_ref().map(|paint| &paint.status);
    let (undo, redo) = status.map_or((0, 0), |status| (status.undo, status.redo));
    ui.horizontal(|ui| {
        let step = |ui: &mut Ui, word: &str, count: u32, hover: &str| {
            let button = ui.add_enabled(count > 0, Button::new(format!("{word} ({count})")));
            button.on_hover_text(hover).clicked()
        };
        let keys = &work.preferences.keys;
        let back = keys.hint(ui.ctx(), tr!("The newest step back"), &[Action::Undo]);
        let again = keys.hint(ui.ctx(), tr!("What was undone, again"), &[Action::Redo]);
        if step(ui, tr!("Undo"), undo, &back) {
            ask(work, Ok(Undo { brush: None }));
        }
        if step(ui, tr!("Redo"), redo, &again) {
            ask(work, Ok(Redo { brush: None }));
        }
    });
    let rows = rows(work);
    let now = rows.iter().position(|row| row.done);
    let list = ScrollArea::vertical().id_salt("steps").max_height(HEIGHT);
    list.show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 1.0;
        for (at, row) in rows.iter().enumerate() {
            let place = now.map(|now| at.cmp(&now));
            let said = match place {
                Some(std::cmp::Ordering::Equal) => tr!("Now: {step}", step = row.words),
                Some(std::cmp::Ordering::Greater) => tr!("Back to: {step}", step = row.words),
                _ => tr!("Forward to: {step}", step = row.words),
            };
            let is_now = place == Some(std::cmp::Ordering::Equal);
            let shown = ui.push_id(row.id, |ui| {
                line(ui, row, is_now, &said, |ui, place| {
                    paint_picture(ui, place, work, textures, &Pictured::Step(row.id));
                })
            });
            if shown.inner.on_hover_text(&said).clicked() && !is_now {
                ask(work, Ok(GoTo { step: row.id }));
            }
        }
    });
}

/// A row, which screen readers call `said`.
fn line(
    ui: &mut Ui,
    row: &Row,
    is_now: bool,
    said: &str,
    picture: impl FnOnce(&Ui, Rect),
) -> Response {
    let size = vec2(ui.available_width(), PICTURE[1] + GAP);
    let (place, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, is_now, said));
    if !ui.is_rect_visible(place) {
        return response;
    }
    let visuals = ui.style().interact_selectable(&response, is_now);
    if is_now || response.hovered() || response.has_focus() {
        let corners = CornerRadius::same(3);
        ui.painter()
            .rect_filled(place, corners, visuals.weak_bg_fill);
        if response.has_focus() {
            let edge = ui.visuals().selection.stroke;
            let inside = eframe::egui::StrokeKind::Inside;
            ui.painter().rect_stroke(place, corners, edge, inside);
        }
    }
    let left = pos2(place.left() + GAP, place.center().y - 0.5 * PICTURE[1]);
    let seen = Rect::from_min_size(left, PICTURE.into());
    picture(ui, seen);
    let colour = if row.done {
        visuals.text_color()
    } else {
        ui.visuals().weak_text_color()
    };
    let width = place.right() - seen.right() - 3.0 * GAP;
    let font = FontId::proportional(13.0);
    let mut words =
        eframe::egui::text::LayoutJob::simple_singleline(row.words.clone(), font, colour);
    words.wrap = eframe::egui::text::TextWrapping::truncate_at_width(width);
    let words = ui.painter().layout_job(words);
    let at = Align2::LEFT_CENTER.anchor_size(
        pos2(seen.right() + 2.0 * GAP, place.center().y),
        words.size(),
    );
    ui.painter().galley(at.min, words, colour);
    response
}
