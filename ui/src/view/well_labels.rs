//! Names of the paints beside their wells: all while the palette is out, otherwise that of the well under the
//! brush.

use eframe::egui::{Align2, Color32, FontId, Painter, vec2};
use glam::{DVec2, DVec3};
use maulstick_num::geometry::Rigid;
use maulstick_types::scene::{Surface, Well, WellKind};

use crate::view::camera::View;

/// Size of the letters, points.
const SIZE: f32 = 11.0;
/// From a well to its name, points.
const GAP: f32 = 6.0;

/// Names that are shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shown {
    All,
    /// The name of the well under a point of the desk, m.
    Under(DVec3),
}

/// Name of a well.
#[must_use]
pub(crate) fn name(well: &Well) -> String {
    match &well.kind {
        WellKind::Cleaner => tr!("Cleaner").to_owned(),
        WellKind::Medium => tr!("Medium").to_owned(),
        WellKind::Paint { mixture } => match &mixture.parts[..] {
            [only] => only.paint.clone(),
            _ => mixture.to_string(),
        },
    }
}

/// The wells of a palette whose names are shown.
#[must_use]
pub(crate) fn named(palette: &Surface, shown: Shown) -> Vec<&Well> {
    let under = |well: &&Well| match shown {
        Shown::All => true,
        Shown::Under(at) => {
            let at = Rigid::from(&palette.pose).inverse().point(at) / palette.zoom;
            at.truncate().distance(DVec2::from_array(well.center_m)) < well.radius_m
        }
    };
    palette.wells.iter().filter(under).collect()
}

/// True if another well is where the name would be.
fn crowded(palette: &Surface, well: &Well, inward: f64) -> bool {
    palette.wells.iter().any(|other| {
        let [x, y] = [0, 1].map(|i| other.center_m[i] - well.center_m[i]);
        let reach = 4.0 * (well.radius_m + other.radius_m);
        y.abs() < other.radius_m && (f64::MIN_POSITIVE..reach).contains(&(inward * x))
    })
}

/// Draws the names, on the side of the wells toward the middle of the board.
pub(crate) fn draw(painter: &Painter, view: &View, palette: &Surface, shown: Shown) {
    let pose = Rigid::from(&palette.pose);
    let half = 0.5 * f64::from(palette.cells[0]) * palette.cell_m;
    for well in named(palette, shown) {
        let [x, y] = well.center_m;
        let (inward, align) = if x > half {
            (-1.0, Align2::RIGHT_CENTER)
        } else {
            (1.0, Align2::LEFT_CENTER)
        };
        // Next to another well the name goes over its own.
        let (align, edge, gap) = if crowded(palette, well, inward) {
            (
                Align2::CENTER_BOTTOM,
                [x, y + well.radius_m],
                vec2(0.0, -0.3),
            )
        } else {
            (
                align,
                [x + inward * well.radius_m, y],
                vec2(inward as f32, 0.0),
            )
        };
        let edge = DVec3::new(edge[0], edge[1], 0.0) * palette.zoom;
        let at = view.to_window(pose.point(edge)) + GAP * gap;
        let font = FontId::proportional(SIZE);
        let words = name(well);
        // Letters lie on any paint: a dark rim keeps them legible.
        for rim in [
            vec2(1.0, 0.0),
            vec2(-1.0, 0.0),
            vec2(0.0, 1.0),
            vec2(0.0, -1.0),
        ] {
            painter.text(
                at + rim,
                align,
                &words,
                font.clone(),
                Color32::from_black_alpha(150),
            );
        }
        painter.text(at, align, words, font, Color32::from_gray(245));
    }
}

#[cfg(test)]
mod tests {
    use maulstick_painting::PaintingSetup;

    use super::*;

    #[test]
    fn the_name_under_the_brush_is_that_of_its_well() {
        let scene = PaintingSetup::default().scene();
        let palette = &scene.surfaces[1];
        let names = |shown| {
            named(palette, shown)
                .into_iter()
                .map(name)
                .collect::<Vec<_>>()
        };
        let all = names(Shown::All);
        assert_eq!(all.len(), 12);
        assert_eq!(
            [0, 10, 11].map(|at| all[at].as_str()),
            ["Titanium White", "Cleaner", "Medium"]
        );
        let [x, y] = palette.wells[5].center_m;
        let at = Rigid::from(&palette.pose).point(DVec3::new(x, y, 0.0));
        assert_eq!(names(Shown::Under(at)), ["Ultramarine Blue"]);
        assert!(names(Shown::Under(at + DVec3::X * 0.02)).is_empty());
    }
}
