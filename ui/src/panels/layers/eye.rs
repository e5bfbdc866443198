//! Visibility switch of a layer: an eye, struck out while the layer is hidden.

use eframe::egui::{Pos2, Response, Sense, Shape, Stroke, Ui, vec2};

/// Half the width and half the height of the eye, and the radius of its iris, points.
const HALF: [f32; 2] = [7.5, 4.5];
const IRIS: f32 = 2.4;

/// Shows the eye; it can be clicked.
pub(super) fn show(ui: &mut Ui, is_open: bool) -> Response {
    let side = ui.spacing().interact_size.y;
    let (place, response) = ui.allocate_exact_size(vec2(side, side), Sense::click());
    let visuals = ui.style().interact(&response);
    let colour = if is_open || response.hovered() {
        visuals.fg_stroke.color
    } else {
        ui.visuals().weak_text_color()
    };
    let stroke = Stroke::new(1.4, colour);
    let middle = place.center();
    let lid = |up: f32| -> Vec<Pos2> {
        let point = |i: i32| {
            let x = i as f32 / 8.0;
            middle + vec2(HALF[0] * x, up * HALF[1] * (1.0 - x * x))
        };
        (-8..=8).map(point).collect()
    };
    let painter = ui.painter();
    if response.has_focus() {
        painter.circle_stroke(middle, 0.5 * side, ui.visuals().selection.stroke);
    }
    painter.add(Shape::line(lid(-1.0), stroke));
    painter.add(Shape::line(lid(1.0), stroke));
    if is_open {
        painter.circle_filled(middle, IRIS, colour);
    } else {
        let corner = vec2(HALF[0], HALF[1]);
        painter.line_segment([middle - corner, middle + corner], stroke);
    }
    response
}
