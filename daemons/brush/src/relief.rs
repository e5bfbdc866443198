//! Relief around a brush for the hand: the paint's, told by the paint node, and the edges of canvas and palette.

use glam::DVec3;
use maulstick_brush::desk::{Desk, Plane};
use maulstick_types::brush::BrushRelief;
use maulstick_types::haptics::{HeightPatch, height_bytes, heights_um};
use maulstick_types::scene::CANVAS;

/// Side of a cell on the desk until the paint node has sent one, m.
const CELL_M: f64 = 1e-3;
/// Beyond its edge the canvas is felt to end by this, m of the desk; its plane goes on there for the brush.
const CANVAS_EDGE_M: f64 = 1e-3;
/// A tip that is higher over its surface feels no relief soon, m.
const FAR_M: f64 = 0.03;
/// Planes that are steeper to each other have no height over each other.
const LEAST_COSINE: f64 = 0.5;
/// Cells along a side.
const SIDE: i64 = HeightPatch::SIDE as i64;

/// The patch around a `tip`, m of the desk, over the plane that it is above; `paint` is the newest relief of any surface.
#[must_use]
pub fn height_patch(
    desk: &Desk,
    plane: &Plane,
    tip: DVec3,
    paint: Option<&BrushRelief>,
) -> HeightPatch {
    let place = plane.to_desk.inverse().point(tip);
    let paint = paint.filter(|paint| paint.surface == plane.id);
    let cell_m = paint.map_or(CELL_M, |paint| paint.cell_m * plane.zoom);
    let is_far = !place.is_finite() || place.z > FAR_M || !(2.5e-4..=2.5e-2).contains(&cell_m);
    if is_far {
        return HeightPatch::flat();
    }
    let first = [place.x, place.y].map(|at| (at / cell_m).floor() as i64 - SIDE / 2);
    let paint = paint.map(|paint| Told::of(paint, plane.zoom));
    let paint = paint.filter(|told| told.is_near(first));
    let cells = (0..SIDE).flat_map(|j| (0..SIDE).map(move |i| [first[0] + i, first[1] + j]));
    let heights = cells.map(|cell| {
        let [x, y] = cell.map(|k| (k as f64 + 0.5) * cell_m);
        let edges = edge_m(desk, plane, plane.to_desk.point(DVec3::new(x, y, 0.0)));
        let own = paint.as_ref().map_or(0.0, |told| told.height_um(cell));
        let most = f64::from(HeightPatch::MOST_UM);
        (edges * 1e6 + own).round().clamp(-most, most) as i16
    });
    let heights: Vec<i16> = heights.collect();
    if heights.iter().all(|height| *height == 0) {
        return HeightPatch::flat();
    }
    let corner = DVec3::new(first[0] as f64, first[1] as f64, 0.0) * cell_m;
    HeightPatch {
        corner_m: plane.to_desk.point(corner).to_array(),
        along: plane.to_desk.vector(DVec3::X).to_array(),
        cell_m,
        heights_um: height_bytes(heights),
    }
}

/// Height over `plane` of the highest surface at a point of it, m of the desk.
fn edge_m(desk: &Desk, plane: &Plane, point: DVec3) -> f64 {
    let normal = plane.normal();
    let heights = desk.planes().iter().filter_map(|other| {
        let under = other.half_space();
        let cosine = under.normal.dot(normal);
        let height = match other.id == plane.id {
            true => 0.0,
            false if cosine < LEAST_COSINE => return None,
            false => -under.gap(point) / cosine,
        };
        match other.holds(point) {
            true => Some(height),
            false if other.id == CANVAS => Some(height - CANVAS_EDGE_M),
            false => None,
        }
    });
    let most = f64::from(HeightPatch::MOST_UM) * 1e-6;
    heights.fold(-most, f64::max)
}

/// The paint node's heights, in lengths of the desk.
struct Told {
    first: [i64; 2],
    side: i64,
    heights_um: Vec<f64>,
}

impl Told {
    fn of(paint: &BrushRelief, zoom: f64) -> Self {
        let heights = heights_um(&paint.heights_um);
        Self {
            first: paint.first.map(i64::from),
            side: i64::from(paint.side),
            heights_um: heights.map(|um| f64::from(um) * zoom).collect(),
        }
    }

    /// True if a patch from this cell on has more of it than its edge.
    fn is_near(&self, first: [i64; 2]) -> bool {
        (0..2).all(|i| {
            let off = first[i] - self.first[i];
            (-SIDE / 2..self.side - SIDE / 2).contains(&off)
        })
    }

    /// Height of a cell; beyond the edge the outermost go on.
    fn height_um(&self, cell: [i64; 2]) -> f64 {
        let [x, y] = [0, 1].map(|i| (cell[i] - self.first[i]).clamp(0, self.side - 1));
        self.heights_um[(y * self.side + x) as usize]
    }
}

#[cfg(test)]
mod tests {
    use maulstick_haptics::Contact;
    use maulstick_painting::PaintingSetup;
    use maulstick_types::haptics::{ContactModel, ForceLaw};
    use maulstick_types::scene::{PALETTE, Scene};

    use super::*;

    fn desk() -> (Scene, Desk) {
        let scene = PaintingSetup::default().scene();
        let desk = Desk::of(&scene);
        (scene, desk)
    }

    fn plane(desk: &Desk, id: u32) -> Plane {
        *desk.plane(id).expect("a plane")
    }

    fn heights(patch: &HeightPatch) -> Vec<i16> {
        heights_um(&patch.heights_um).collect()
    }

    /// Height that a servo finds below a place of the desk, m over the plane.
    fn felt(patch: &HeightPatch, plane: &Plane, at: DVec3) -> f64 {
        let law = ForceLaw::Rigid {
            stiffness_n_m: 100.0,
        };
        let contact = Contact::new(&ContactModel {
            plane_point_m: plane.to_desk.point(DVec3::ZERO).to_array(),
            plane_normal: plane.normal().to_array(),
            relief: patch.clone(),
            ..ContactModel::bare(law, 0.025)
        });
        let contact = contact.expect("a servo takes it");
        let handle = maulstick_haptics::contact::HandleState {
            position: at + DVec3::Z * 0.025,
            orientation: glam::DQuat::IDENTITY,
            velocity: DVec3::ZERO,
        };
        let depth = contact.evaluate(&handle, 1e9).depth_m;
        depth + (at - plane.to_desk.point(DVec3::ZERO)).dot(plane.normal())
    }

    #[test]
    fn in_the_middle_of_a_bare_canvas_nothing_is_felt_and_nothing_from_afar() {
        let (_, desk) = desk();
        let canvas = plane(&desk, CANVAS);
        assert!(height_patch(&desk, &canvas, DVec3::ZERO, None).is_flat());
        let edge = canvas.to_desk.point(DVec3::ZERO);
        assert!(height_patch(&desk, &canvas, edge + DVec3::Z * 0.04, None).is_flat());
        assert!(height_patch(&desk, &canvas, DVec3::NAN, None).is_flat());
    }

    #[test]
    fn the_canvas_ends_at_its_edge_and_the_palettes_board_stands_beside_it() {
        let (_, desk) = desk();
        let (canvas, palette) = (plane(&desk, CANVAS), plane(&desk, PALETTE));
        let corner = canvas.to_desk.point(DVec3::ZERO);
        let edge = corner + DVec3::Y * 0.1;
        let patch = height_patch(&desk, &canvas, edge, None);
        let [inside, outside] = [6e-3, -6e-3].map(|x| felt(&patch, &canvas, edge + DVec3::X * x));
        assert!(
            inside.abs() < 1e-4 && (outside + 1e-3).abs() < 1e-4,
            "{inside} {outside}"
        );
        // The board's edge on the canvas's side, from both.
        let far = DVec3::new(palette.size_m[0], 0.5 * palette.size_m[1], 0.0) * palette.zoom;
        let rim = palette.to_desk.point(far);
        let seen = |plane: &Plane| {
            let patch = height_patch(&desk, plane, rim, None);
            [-7e-3, 7e-3].map(|x| felt(&patch, plane, rim + DVec3::X * x))
        };
        let [on, beside] = seen(&palette);
        assert!(on.abs() < 3e-4 && beside < -3e-3, "{on} {beside}");
        let [up, down] = seen(&canvas);
        assert!(
            up - down > 2.5e-3,
            "{up} {down}: a wall to who comes from the canvas"
        );
    }

    fn told(surface: u32, first: [i32; 2], height_um: impl Fn(i32, i32) -> i16) -> BrushRelief {
        let cells = (0..24).flat_map(|j| (0..24).map(move |i| (i, j)));
        BrushRelief {
            surface,
            cell_m: 1e-3,
            side: 24,
            first,
            heights_um: height_bytes(cells.map(|(i, j)| height_um(i + first[0], j + first[1]))),
        }
    }

    #[test]
    fn the_paints_relief_lies_where_it_was_painted_however_the_canvas_is_turned() {
        let (mut scene, _) = desk();
        let ridge = told(CANVAS, [88, 88], |i, _| {
            if (98..102).contains(&i) { 300 } else { 0 }
        });
        for (turn, zoom) in [(0.0, 1.0), (0.3, 1.0), (0.4, 2.0)] {
            let rotation = maulstick_num::geometry::rotation(DVec3::Z, turn);
            scene.surfaces[0].pose.orientation = rotation.to_array();
            scene.surfaces[0].zoom = zoom;
            let desk = Desk::of(&scene);
            let canvas = plane(&desk, CANVAS);
            let on_desk = |x: f64, y: f64| canvas.to_desk.point(DVec3::new(x, y, 0.0) * zoom);
            let patch = height_patch(&desk, &canvas, on_desk(0.1, 0.1), Some(&ridge));
            let [on, off] = [0.1, 0.105].map(|x| felt(&patch, &canvas, on_desk(x, 0.1)) / zoom);
            assert!(
                on > 1.5e-4 && off < 0.5 * on,
                "{on} {off} at {turn}, {zoom}"
            );
        }
    }

    #[test]
    fn relief_of_another_surface_or_from_far_away_is_not_felt() {
        let (_, desk) = desk();
        let canvas = plane(&desk, CANVAS);
        let at = canvas.to_desk.point(DVec3::new(0.1, 0.1, 0.0));
        let high = |surface, first| told(surface, first, |_, _| 300);
        let of = |relief: &BrushRelief| height_patch(&desk, &canvas, at, Some(relief));
        assert_eq!(heights(&of(&high(CANVAS, [88, 88]))), [300; 256]);
        assert!(of(&high(PALETTE, [88, 88])).is_flat());
        assert!(of(&high(CANVAS, [188, 88])).is_flat());
        // A part of it is known: its edge goes on.
        assert_eq!(heights(&of(&high(CANVAS, [95, 88]))), [300; 256]);
        let most = told(CANVAS, [88, 88], |_, _| i16::MAX);
        assert_eq!(heights(&of(&most)), [5000; 256]);
    }
}
