//! A region of the canvas, drawn on a small map or given in numbers.

use eframe::egui::accesskit::Role;
use eframe::egui::{
    Color32, CornerRadius, DragValue, Pos2, Rect, Sense, Stroke, StrokeKind, Ui, WidgetInfo, vec2,
};
use maulstick_types::Region;
use maulstick_ui_kit::units::Units;

/// The longer side of the map, points.
const MAP: f32 = 120.0;
/// The smallest side of a part that is drawn, m.
const LEAST_M: f64 = 1e-3;

/// The middle of a surface of this size, m.
#[must_use]
pub(super) fn middle(size_m: [f64; 2]) -> Region {
    Region {
        corner_m: size_m.map(|side| tidy(0.25 * side)),
        size_m: size_m.map(|side| tidy(0.5 * side)),
    }
}

/// Tenths of a millimetre.
fn tidy(m: f64) -> f64 {
    (m * 1e4).round() * 1e-4
}

/// Shows a part of a surface of this size, m, and how it was changed.
pub(super) fn show(ui: &mut Ui, region: &mut Region, size_m: [f64; 2], units: Units) {
    let (unit_m, sign) = units.large();
    ui.horizontal(|ui| {
        map(ui, region, size_m);
        ui.vertical(|ui| {
            let [x, y] = &mut region.corner_m;
            let [width, height] = &mut region.size_m;
            for (word, hover, m) in [
                (tr!("Left"), tr!("From the left edge of the canvas"), x),
                (tr!("Bottom"), tr!("From the lower edge of the canvas"), y),
                (tr!("Width"), tr!("Width of the part"), width),
                (tr!("Height"), tr!("Height of the part"), height),
            ] {
                ui.horizontal(|ui| {
                    let mut shown = *m / unit_m;
                    let number = DragValue::new(&mut shown)
                        .suffix(format!(" {sign}"))
                        .speed(0.1)
                        .max_decimals(2)
                        .update_while_editing(false);
                    let number = ui.add_sized([74.0, ui.spacing().interact_size.y], number);
                    if number.changed() {
                        *m = tidy(shown * unit_m);
                    }
                    let label = ui.label(word);
                    number.labelled_by(label.id).on_hover_text(hover);
                });
            }
        });
    });
}

/// The map: a drag over it draws that part again.
fn map(ui: &mut Ui, region: &mut Region, size_m: [f64; 2]) {
    let scale = f64::from(MAP) / size_m[0].max(size_m[1]).max(1e-6);
    let size = vec2((size_m[0] * scale) as f32, (size_m[1] * scale) as f32);
    let (place, response) = ui.allocate_exact_size(size.max(vec2(8.0, 8.0)), Sense::drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, tr!("Map of the canvas")));
    let start = ui.input(|input| input.pointer.press_origin());
    if let (true, Some(from), Some(to)) =
        (response.dragged(), start, response.interact_pointer_pos())
        && let Some(drawn) = between(place, size_m, from, to)
    {
        *region = drawn;
    }
    let painter = ui.painter_at(place);
    let square = CornerRadius::ZERO;
    painter.rect_filled(place, square, Color32::from_gray(216));
    let part = on_map(place, size_m, region);
    let ink = Color32::from_rgb(30, 96, 170);
    painter.rect_filled(part, square, ink.gamma_multiply(0.35));
    painter.rect_stroke(part, square, Stroke::new(1.5, ink), StrokeKind::Inside);
    response.on_hover_text(tr!("Drag over the part of the canvas that is meant"));
}

/// The region between two points of the map; `None` if it is too narrow.
fn between(place: Rect, size_m: [f64; 2], from: Pos2, to: Pos2) -> Option<Region> {
    let share = |at: Pos2| {
        let x = f64::from((at.x - place.left()) / place.width());
        let y = f64::from((place.bottom() - at.y) / place.height());
        [x.clamp(0.0, 1.0), y.clamp(0.0, 1.0)]
    };
    let (from, to) = (share(from), share(to));
    let side = |axis: usize| {
        let [low, high] = [from[axis].min(to[axis]), from[axis].max(to[axis])];
        let low_m = tidy(low * size_m[axis]);
        (low_m, tidy(high * size_m[axis] - low_m))
    };
    let ([x, width], [y, height]) = (<[f64; 2]>::from(side(0)), <[f64; 2]>::from(side(1)));
    (width >= LEAST_M && height >= LEAST_M).then_some(Region {
        corner_m: [x, y],
        size_m: [width, height],
    })
}

fn on_map(place: Rect, size_m: [f64; 2], region: &Region) -> Rect {
    let at = |x: f64, y: f64| {
        let share = [x / size_m[0], y / size_m[1]].map(|v| v as f32);
        place.left_bottom() + vec2(share[0] * place.width(), -share[1] * place.height())
    };
    let ([x, y], [width, height]) = (region.corner_m, region.size_m);
    Rect::from_two_pos(at(x, y), at(x + width, y + height))
}

#[cfg(test)]
mod tests {
    use eframe::egui::pos2;

    use super::*;

    #[test]
    fn a_drag_over_the_map_is_the_part_of_the_canvas() {
        let (place, size_m) = (
            Rect::from_min_size(pos2(10.0, 10.0), vec2(120.0, 90.0)),
            [0.4, 0.3],
        );
        let (from, to) = (pos2(40.0, 70.0), pos2(100.0, 40.0));
        let region = between(place, size_m, from, to).expect("wide enough");
        // A point of the map is a third of a centimetre; the lower edge of the map is at 100 points.
        assert!((region.corner_m[0] - 0.1).abs() < 1e-6, "{region}");
        assert!((region.corner_m[1] - 0.1).abs() < 1e-6, "{region}");
        assert!((region.size_m[0] - 0.2).abs() < 1e-6 && (region.size_m[1] - 0.1).abs() < 1e-6);
        let back = on_map(place, size_m, &region);
        let drawn = Rect::from_two_pos(from, to);
        assert!((back.min - drawn.min).length() < 0.1 && (back.max - drawn.max).length() < 0.1);
        let mirrored = Rect::from_two_pos(pos2(40.0, 40.0), pos2(100.0, 10.0));
        assert!(
            (back.min - mirrored.min).length() > 1.0,
            "a fault would pass"
        );
        assert_eq!(between(place, size_m, from, from), None);
        let beyond = between(place, size_m, pos2(-9.0, 500.0), pos2(999.0, -9.0));
        let whole = Region {
            corner_m: [0.0; 2],
            size_m,
        };
        assert_eq!(beyond, Some(whole));
    }
}
