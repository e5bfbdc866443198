//! Choice of a colour: a strip of hues, and a square of saturation to the right and brightness upward. Both follow the
//! pointer, and the arrow keys.

use eframe::egui::ecolor::Hsva;
use eframe::egui::{
    Color32, Mesh, Pos2, Rect, Role, Sense, Shape, Stroke, StrokeKind, Ui, Vec2, WidgetInfo, pos2,
    vec2,
};
use maulstick_ui_kit::arrow_keys::arrow_steps;

/// Size of the square, points.
const SQUARE: Vec2 = vec2(240.0, 110.0);
/// Height of the strip, points.
const STRIP: f32 = 18.0;
/// Fields of either that are drawn across and down; colours between their corners are interpolated.
const FIELDS: [usize; 2] = [24, 12];
/// Change by one press of an arrow key, as a share of the whole.
const STEP: f32 = 0.02;

/// Shows both; true if the colour was changed.
pub(super) fn show(ui: &mut Ui, colour: &mut Hsva) -> bool {
    let before = *colour;
    let hue = colour.h;
    let place = field(
        ui,
        SQUARE,
        tr!("Saturation and brightness. Arrow keys change them"),
        pos2(colour.s, 1.0 - colour.v),
        |at| Hsva::new(hue, at.x, 1.0 - at.y, 1.0),
    );
    if let Some(at) = place {
        (colour.s, colour.v) = (at.x, 1.0 - at.y);
    }
    let place = field(
        ui,
        vec2(SQUARE.x, STRIP),
        tr!("Hue. Arrow keys change it"),
        pos2(colour.h, 0.5),
        |at| Hsva::new(at.x, 1.0, 1.0, 1.0),
    );
    if let Some(at) = place {
        // The last hue is the first one again.
        colour.h = at.x.min(0.999);
    }
    *colour != before
}

/// A field of colours with a mark at a point, 0 to 1 each way from the upper left corner; returns the point where the
/// mark was put.
fn field(
    ui: &mut Ui,
    size: Vec2,
    name: &str,
    mark: Pos2,
    of: impl Fn(Pos2) -> Hsva,
) -> Option<Pos2> {
    let (area, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Slider, true, name));
    if ui.is_rect_visible(area) {
        let painter = ui.painter_at(area);
        painter.add(Shape::mesh(mesh(area, &of)));
        let at = area.min + mark.to_vec2() * area.size();
        for (radius, width, colour) in [(6.0, 3.0, Color32::BLACK), (6.0, 1.5, Color32::WHITE)] {
            painter.circle_stroke(at, radius, Stroke::new(width, colour));
        }
        if response.has_focus() {
            let stroke = ui.visuals().selection.stroke;
            painter.rect_stroke(area, 0.0, stroke, StrokeKind::Inside);
        }
    }
    let pointer = response.interact_pointer_pos();
    let by_pointer = pointer.map(|pointer| ((pointer - area.min) / area.size()).to_pos2());
    let step = arrow_steps(ui, &response);
    let by_keys = (step != Vec2::ZERO).then(|| mark + STEP * step);
    by_pointer
        .or(by_keys)
        .map(|at| at.clamp(Pos2::ZERO, pos2(1.0, 1.0)))
}

fn mesh(area: Rect, of: impl Fn(Pos2) -> Hsva) -> Mesh {
    let [across, down] = FIELDS;
    let mut mesh = Mesh::default();
    for row in 0..=down {
        for column in 0..=across {
            let at = pos2(column as f32 / across as f32, row as f32 / down as f32);
            mesh.colored_vertex(area.min + at.to_vec2() * area.size(), of(at).into());
        }
    }
    let corner = |column: usize, row: usize| (row * (across + 1) + column) as u32;
    for row in 0..down {
        for column in 0..across {
            let [a, b] = [corner(column, row), corner(column + 1, row)];
            let [c, d] = [corner(column, row + 1), corner(column + 1, row + 1)];
            mesh.add_triangle(a, b, c);
            mesh.add_triangle(b, d, c);
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable as _;

    use eframe::egui::Key;

    use super::*;

    const SQUARE_NAME: &str = "Saturation and brightness. Arrow keys change them";
    const HUE_NAME: &str = "Hue. Arrow keys change it";

    #[test]
    fn a_colour_is_chosen_by_the_pointer_alone_and_by_keys_alone() {
        let show = |ui: &mut Ui, colour: &mut Hsva| {
            show(ui, colour);
        };
        let start = Hsva::new(0.1, 0.2, 0.3, 1.0);
        let mut harness = Harness::new_ui_state(show, start);
        harness.run();
        let area = harness.get_by_label(SQUARE_NAME).rect();
        let at = area.min + vec2(0.75, 0.25) * area.size();
        harness.hover_at(at);
        harness.step();
        harness.drag_at(at);
        harness.step();
        harness.drop_at(at);
        harness.run();
        let chosen = *harness.state();
        assert!((chosen.s - 0.75).abs() < 0.01 && (chosen.v - 0.75).abs() < 0.01);
        assert_eq!(chosen.h, start.h);
        harness.get_by_label(HUE_NAME).focus();
        harness.run();
        for _ in 0..3 {
            harness.key_press(Key::ArrowRight);
            harness.run();
        }
        assert!((harness.state().h - 0.16).abs() < 1e-4);
        for _ in 0..100 {
            harness.key_press(Key::ArrowRight);
            harness.step();
        }
        assert!(harness.state().h < 1.0);
        assert_eq!((harness.state().s, harness.state().v), (chosen.s, chosen.v));
    }
}
