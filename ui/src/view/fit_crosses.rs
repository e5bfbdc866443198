//! Crosses at the corners of the desk's usual canvas, while a device is fitted to it: on a pen display they are what the
//! nib is to touch.

use eframe::egui::{Color32, Painter, Stroke, vec2};
use glam::DVec3;
use maulstick_device::corner_calibration::Corner;
use maulstick_types::scene::Surface;

use crate::view::camera::View;

/// Half of a cross, points.
const ARM: f32 = 14.0;
/// The corner that is asked for.
const ASKED: Color32 = Color32::from_rgb(240, 120, 30);
const OTHER: Color32 = Color32::from_gray(150);

/// Position of a corner on the desk, m, for a canvas that lies as it does in the beginning.
#[must_use]
fn place(canvas: &Surface, corner: Corner) -> DVec3 {
    let [x, y] = canvas
        .cells
        .map(|cells| 0.5 * f64::from(cells) * canvas.cell_m);
    match corner {
        Corner::LowerLeft => DVec3::new(-x, -y, 0.0),
        Corner::LowerRight => DVec3::new(x, -y, 0.0),
        Corner::UpperLeft => DVec3::new(-x, y, 0.0),
    }
}

/// Draws them, that of the corner that is asked for in a colour of its own.
pub(crate) fn draw(painter: &Painter, view: &View, canvas: &Surface, asked: Option<Corner>) {
    for corner in Corner::ALL {
        let at = view.to_window(place(canvas, corner));
        let colour = if asked == Some(corner) { ASKED } else { OTHER };
        // On any ground: a dark rim below.
        for stroke in [
            Stroke::new(5.0, Color32::from_black_alpha(130)),
            Stroke::new(2.0, colour),
        ] {
            for arm in [vec2(ARM, 0.0), vec2(0.0, ARM)] {
                painter.line_segment([at - arm, at + arm], stroke);
            }
            painter.circle_stroke(at, 0.5 * ARM, stroke);
        }
    }
}

#[cfg(test)]
mod tests {
    use maulstick_painting::PaintingSetup;

    use super::*;

    #[test]
    fn they_lie_where_the_fit_takes_the_corners_to_be() {
        let scene = PaintingSetup::default().scene();
        let canvas = &scene.surfaces[0];
        let size = canvas.cells.map(|cells| f64::from(cells) * canvas.cell_m);
        let [left, right, upper] = Corner::ALL.map(|corner| place(canvas, corner));
        assert!((right.x - left.x - size[0]).abs() < 1e-12 && left.y == right.y);
        assert!((upper.y - left.y - size[1]).abs() < 1e-12 && left.x == upper.x);
        assert!((right + upper).length() < 1e-12, "about the desk's origin");
    }
}
