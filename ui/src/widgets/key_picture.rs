//! A small picture of what the most used keys do: a cap with its sign, and below it a word.

use eframe::egui::{
    Align2, Color32, FontId, Painter, Rect, Response, Role, Sense, Stroke, StrokeKind, Ui,
    WidgetInfo, pos2, vec2,
};
use maulstick_ui_kit::language::translated;

use crate::input::keymap::Keymap;
use crate::input::keys::Action;

/// Size of a key with its word, points.
const CELL: [f32; 2] = [92.0, 46.0];
/// Height of a cap, points.
const CAP: f32 = 24.0;
/// Room at either side of a sign on its cap, points.
const ASIDE: f32 = 7.0;

/// Meaning of a pressed key.
#[derive(Clone, Copy, Debug)]
enum Means {
    /// The mouse is dragged.
    Drag,
    /// Its wheel is turned.
    Wheel,
    Key(Action),
}

/// The keys of the first minute, and what they do.
const SHOWN: [(Means, &str); 12] = [
    (Means::Drag, tr_noop!("paint")),
    (Means::Key(Action::Palette), tr_noop!("palette")),
    (Means::Key(Action::NextBrush), tr_noop!("next brush")),
    (Means::Key(Action::Smaller), tr_noop!("smaller")),
    (Means::Key(Action::Larger), tr_noop!("larger")),
    (Means::Key(Action::Clean), tr_noop!("clean brush")),
    (Means::Key(Action::LoadFrom), tr_noop!("take colour")),
    (Means::Key(Action::Dry), tr_noop!("dry")),
    (Means::Key(Action::Undo), tr_noop!("undo")),
    (Means::Wheel, tr_noop!("zoom")),
    (Means::Key(Action::Panels), tr_noop!("panels")),
    (Means::Key(Action::Keys), tr_noop!("all keys")),
];

/// Shows it in rows of at most `width` points, in `colour`.
pub(crate) fn show(ui: &mut Ui, keymap: &Keymap, width: f32, colour: Color32) -> Response {
    let keys: Vec<(Means, String, &str)> = SHOWN
        .iter()
        .map(|(means, word)| {
            let sign = match means {
                Means::Key(act) => keymap.written(ui.ctx(), *act),
                Means::Drag | Means::Wheel => String::new(),
            };
            (*means, sign, translated(word))
        })
        .filter(|(means, sign, _)| !matches!(means, Means::Key(_)) || !sign.is_empty())
        .collect();
    let columns = ((width / CELL[0]) as usize).clamp(1, keys.len().max(1));
    let rows = keys.len().div_ceil(columns);
    let size = vec2(CELL[0] * columns as f32, CELL[1] * rows as f32);
    let (area, response) = ui.allocate_exact_size(size, Sense::hover());
    response.widget_info(|| {
        let said = keys.iter().map(|(_, sign, word)| format!("{sign} {word}"));
        let said: Vec<String> = said.collect();
        WidgetInfo::labeled(Role::Image, true, said.join(", "))
    });
    for (place, (means, sign, word)) in keys.iter().enumerate() {
        let (row, column) = (place / columns, place % columns);
        let corner = area.min + vec2(column as f32 * CELL[0], row as f32 * CELL[1]);
        let cell = Rect::from_min_size(corner, CELL.into());
        draw(ui.painter(), cell, (*means, sign, word), colour);
    }
    response
}

fn draw(painter: &Painter, cell: Rect, (means, sign, word): (Means, &str, &str), colour: Color32) {
    let line = Stroke::new(1.2, colour);
    let middle = pos2(cell.center().x, cell.top() + 0.5 * CAP + 2.0);
    match means {
        Means::Key(_) => {
            let text = painter.layout_no_wrap(sign.to_owned(), FontId::monospace(12.0), colour);
            let width = (text.size().x + 2.0 * ASIDE).max(CAP);
            let cap = Rect::from_center_size(middle, vec2(width, CAP));
            painter.rect_stroke(cap, 5.0, line, StrokeKind::Inside);
            // The front of the cap.
            let front = cap.bottom() - 4.0;
            let dim = Stroke::new(1.0, colour.gamma_multiply(0.5));
            painter.hline(cap.x_range().shrink(4.0), front, dim);
            painter.galley(middle - 0.5 * text.size() - vec2(0.0, 1.0), text, colour);
        }
        Means::Drag | Means::Wheel => mouse(painter, middle, means, colour),
    }
    let below = pos2(cell.center().x, cell.top() + CAP + 5.0);
    let font = FontId::proportional(11.0);
    painter.text(below, Align2::CENTER_TOP, word, font, colour);
}

/// A mouse: its left button filled for a drag, its wheel for the wheel.
fn mouse(painter: &Painter, middle: eframe::egui::Pos2, means: Means, colour: Color32) {
    let line = Stroke::new(1.2, colour);
    let body = Rect::from_center_size(middle, vec2(16.0, CAP));
    painter.rect_stroke(body, 8.0, line, StrokeKind::Inside);
    let wheel = Rect::from_center_size(middle - vec2(0.0, 6.0), vec2(3.0, 6.0));
    match means {
        Means::Wheel => {
            painter.rect_filled(wheel.expand(1.0), 2.0, colour);
            for up in [-1.0, 1.0] {
                let tip = middle + vec2(15.0, 5.0 * up);
                let foot = [vec2(-3.0, -4.0 * up), vec2(3.0, -4.0 * up)];
                painter.line(vec![tip + foot[0], tip, tip + foot[1]], line);
            }
        }
        Means::Drag | Means::Key(_) => {
            let mut left = body.shrink(3.0);
            left.max = pos2(middle.x - 1.0, middle.y - 1.0);
            painter.rect_filled(left, 3.0, colour);
            let from = middle + vec2(12.0, 4.0);
            painter.arrow(from, vec2(15.0, -6.0), line);
        }
    }
}
