//! Placement of the palette, beside the canvas or slid over it, and the rounded corners of its board.

use glam::{DVec2, DVec3};
use maulstick_num::geometry::{Rigid, shortest_arc};
use maulstick_types::Pose;
use maulstick_types::scene::{PALETTE, Surface, Well, WellKind};

/// Height of the palette's face over the desk at rest, m: a brush may be wiped on the board's edge.
pub const BOARD_M: f64 = 4e-3;
/// Gap between the palette at rest and the canvas, m.
pub const GAP_M: f64 = 0.01;
/// Height of the palette's face above the canvas that it is slid over, m: its board is 4 mm thick, and there is paint
/// under it.
const OVER_M: f64 = 0.01;
/// Tolerance of equal poses, m and components of a quaternion.
const POSE_TOLERANCE: f64 = 1e-9;
/// Radius of the board's corners on the side of the wells, and on the other, shares of its width.
const ROUNDED: [f64; 2] = [0.14, 0.48];

/// The side of the canvas on which the palette rests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// The left, for a brush in the right hand.
    #[default]
    Left,
    /// The right, for a brush in the left hand.
    Right,
}

/// Width and height of a surface in its own lengths, m.
#[must_use]
pub fn size_m(surface: &Surface) -> DVec2 {
    let [across, up] = surface.cells.map(f64::from);
    DVec2::new(across, up) * surface.cell_m
}

/// The palette beside the canvas at its initial place, in the middle of the desk.
#[must_use]
pub fn beside(canvas: &Surface, palette: &Surface, side: Side) -> Pose {
    let (wide, own) = (size_m(canvas).x, size_m(palette) * palette.zoom);
    let left = match side {
        Side::Left => -0.5 * wide - GAP_M - own.x,
        Side::Right => 0.5 * wide + GAP_M,
    };
    Pose {
        position_m: [left, -0.5 * own.y, BOARD_M],
        ..Pose::IDENTITY
    }
}

/// The palette in the middle of the desk, over the canvas whatever its placement.
#[must_use]
pub fn over(canvas: &Surface, palette: &Surface) -> Pose {
    let plane = Rigid::from(&canvas.pose);
    let normal = plane.vector(DVec3::Z);
    let under = DVec3::Z * (normal.dot(plane.translation) / normal.z.max(0.1));
    let tilt = shortest_arc(DVec3::Z, normal);
    let middle = (0.5 * size_m(palette) * palette.zoom).extend(0.0);
    Rigid {
        rotation: tilt,
        translation: under + normal * OVER_M - tilt * middle,
    }
    .to_pose()
}

/// True if two poses differ by rounding alone.
#[must_use]
pub fn is_same(a: &Pose, b: &Pose) -> bool {
    let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < POSE_TOLERANCE);
    near(&a.position_m, &b.position_m) && near(&a.orientation, &b.orientation)
}

/// Radii of a surface's corners in its own lengths, m: lower left, lower right, upper left, upper right.
/// A canvas has none.
#[must_use]
pub fn corner_radii(surface: &Surface) -> [f64; 4] {
    if surface.id != PALETTE {
        return [0.0; 4];
    }
    let size = size_m(surface);
    let [near, far] = ROUNDED.map(|share| share * size.x.min(size.y));
    match side_of_wells(surface) {
        Side::Left => [near, far, near, far],
        Side::Right => [far, near, far, near],
    }
}

/// The side with most of the paints.
fn side_of_wells(palette: &Surface) -> Side {
    let middle = 0.5 * size_m(palette).x;
    let paints = palette.wells.iter().filter(|well| is_paint(well));
    let lean: f64 = paints.map(|well| well.center_m[0] - middle).sum();
    if lean > 0.0 { Side::Right } else { Side::Left }
}

fn is_paint(well: &Well) -> bool {
    matches!(well.kind, WellKind::Paint { .. })
}

/// True if a point, in the surface's own lengths, is on it and within its rounded corners.
#[must_use]
pub fn is_on(size: DVec2, radii: [f64; 4], at: DVec2) -> bool {
    if at.cmplt(DVec2::ZERO).any() || at.cmpge(size).any() {
        return false;
    }
    let (right, upper) = (at.x > 0.5 * size.x, at.y > 0.5 * size.y);
    let radius = radii[usize::from(right) + 2 * usize::from(upper)];
    let from_corner = at.min(size - at);
    let into = DVec2::splat(radius) - from_corner;
    into.cmple(DVec2::ZERO).any() || into.length_squared() <= radius * radius
}

/// The wells of a board of `size` m mirrored from one side to the other.
#[must_use]
pub fn mirrored(wells: &[Well], size: DVec2) -> Vec<Well> {
    let mirror = |well: &Well| Well {
        center_m: [size.x - well.center_m[0], well.center_m[1]],
        ..well.clone()
    };
    wells.iter().map(mirror).collect()
}

/// True if the palette is nearer to its place over the canvas than to the one beside it.
#[must_use]
pub fn is_out(canvas: &Surface, palette: &Surface, side: Side) -> bool {
    let at = |pose: &Pose| DVec3::from_array(pose.position_m);
    let now = at(&palette.pose);
    let far = |pose: Pose| now.distance(at(&pose));
    far(over(canvas, palette)) < far(beside(canvas, palette, side))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surface(id: u32, cells: [u32; 2]) -> Surface {
        Surface {
            id,
            pose: Pose::IDENTITY,
            zoom: 1.0,
            cells,
            cell_m: 2.5e-4,
            ground: "gesso".into(),
            tooth: "linen".into(),
            tooth_seed: 1,
            wells: Vec::new(),
            stain_m: 3e-6,
            piles_last: false,
            model: "impasto".into(),
        }
    }

    fn middle(palette: &Surface, pose: &Pose) -> DVec3 {
        let middle = 0.5 * size_m(palette) * palette.zoom;
        Rigid::from(pose).point(middle.extend(0.0))
    }

    #[test]
    fn the_palette_rests_on_either_side_and_slides_to_the_middle_of_the_desk() {
        let (mut canvas, palette) = (surface(0, [1024, 1024]), surface(PALETTE, [512, 1024]));
        canvas.pose.position_m = [-0.128, -0.128, 0.0];
        let left = beside(&canvas, &palette, Side::Left);
        let right = beside(&canvas, &palette, Side::Right);
        assert_eq!(left.position_m, [-0.266, -0.128, BOARD_M]);
        assert_eq!(right.position_m, [0.138, -0.128, BOARD_M]);
        // However the canvas is moved, it comes to where the painter looks, over the canvas.
        for (zoom, tilt, off) in [(1.0, 0.0, 0.0), (3.0, 0.0, 0.2), (1.0, 0.6, 0.0)] {
            canvas.zoom = zoom;
            canvas.pose.position_m[0] += off;
            canvas.pose.orientation = maulstick_num::geometry::rotation(DVec3::X, tilt).to_array();
            let out = over(&canvas, &palette);
            let at = middle(&palette, &out);
            let plane = Rigid::from(&canvas.pose);
            let above = plane.inverse().point(at).z;
            assert!((above - OVER_M).abs() < 1e-12, "{above}");
            assert!(at.truncate().length() < 0.01, "{at}");
            assert!(is_out(
                &canvas,
                &Surface {
                    pose: out,
                    ..palette.clone()
                },
                Side::Left
            ));
        }
        let resting = Surface {
            pose: left,
            ..palette
        };
        assert!(!is_out(&canvas, &resting, Side::Left), "a fault would pass");
    }

    #[test]
    fn a_rounded_board_ends_at_its_corners() {
        let size = DVec2::new(0.128, 0.256);
        let radii = [0.06, 0.018, 0.06, 0.018];
        for (at, on) in [
            ([0.064, 0.128], true),
            ([0.001, 0.128], true),
            ([0.001, 0.001], false),
            ([0.001, 0.255], false),
            ([0.03, 0.03], true),
            ([0.127, 0.255], false),
            ([0.122, 0.25], true),
            ([0.129, 0.1], false),
            ([0.1, -0.001], false),
        ] {
            assert_eq!(is_on(size, radii, DVec2::from_array(at)), on, "{at:?}");
        }
        assert!(
            is_on(size, [0.0; 4], DVec2::new(0.001, 0.001)),
            "a canvas is not rounded"
        );
    }

    #[test]
    fn mirrored_wells_lie_on_the_other_side_and_so_do_the_narrow_corners() {
        let mut palette = surface(PALETTE, [512, 1024]);
        let paint = maulstick_types::Mixture::pure("Bone Black");
        palette.wells = vec![Well {
            center_m: [0.1145, 0.05],
            radius_m: 0.009,
            kind: WellKind::Paint { mixture: paint },
        }];
        let radii = corner_radii(&palette);
        assert!(radii[1] < radii[0], "{radii:?}");
        palette.wells = mirrored(&palette.wells, size_m(&palette));
        assert!((palette.wells[0].center_m[0] - 0.0135).abs() < 1e-12);
        let [a, b, c, d] = corner_radii(&palette);
        assert_eq!([b, a, d, c], radii);
        assert_eq!(corner_radii(&surface(0, [512, 512])), [0.0; 4]);
    }
}
