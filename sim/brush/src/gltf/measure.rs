//! Width, thickness and their profiles, measured from a mesh.

use glam::DVec3;

use crate::file::sections::Outline;
use crate::subdivide::{Mesh, subdivide};

/// Number of places along the head at which it is measured, both ends included.
const PLACES: usize = 9;
/// Threshold between outlines: the corners of a cut through a rectangle are at 2 times the square of its half widths,
/// an ellipse is at 1 all around.
const CORNERED: f64 = 1.5;

/// Measurements of a mesh.
pub(super) struct Measured {
    /// Width and thickness of the subdivided surface, which paints, mm: twice its greatest distance from the middle
    /// along x and y.
    pub(super) across_mm: [f64; 2],
    /// Place along the head and half the width there as a share of the greatest, along x and y, of the control mesh:
    /// subdivision would draw in its ends.
    pub(super) profiles: [Vec<[f64; 2]>; 2],
    /// Outline of its widest cut, with or without corners.
    pub(super) outline: Outline,
}

/// Measures the part of a mesh from z = 0 down to −`length_mm`; `None` if the mesh is elsewhere.
pub(super) fn measure(
    vertices: &[DVec3],
    faces: &[Vec<usize>],
    levels: usize,
    length_mm: f64,
) -> Option<Measured> {
    let cuts: Vec<Vec<DVec3>> = (0..PLACES)
        .map(|i| cut(vertices, faces, -length_mm * place(i)))
        .collect();
    let halves = filled(cuts.iter().map(|points| half(points)).collect())?;
    let below = |points: &[DVec3]| half(&below(points)).unwrap_or([0.0; 2]);
    let [x, y] = [0, 1].map(|axis| {
        let widest = halves.iter().map(|half| half[axis]);
        let widest = widest.fold(below(vertices)[axis], f64::max);
        let share = |(i, half): (usize, &[f64; 2])| [place(i), half[axis] / widest];
        let profile = halves.iter().enumerate().map(share).collect::<Vec<_>>();
        (widest > 0.0).then_some((widest, profile))
    });
    let ((width, wide), (thickness, thick)) = (x?, y.unwrap_or((0.0, Vec::new())));
    let mesh = Mesh {
        vertices: vertices.len(),
        faces: faces.to_vec(),
    };
    let fine: Vec<DVec3> = subdivide(&mesh, levels)
        .stencils
        .iter()
        .map(|stencil| stencil.iter().map(|(v, share)| vertices[*v] * *share).sum())
        .collect();
    let fine = below(&fine);
    let smooth = |axis: usize, control: f64| {
        if fine[axis] > 0.0 {
            2.0 * fine[axis]
        } else {
            2.0 * control
        }
    };
    Some(Measured {
        across_mm: [smooth(0, width), smooth(1, thickness)],
        profiles: [wide, thick],
        outline: outline(&cuts),
    })
}

fn place(i: usize) -> f64 {
    i as f64 / (PLACES - 1) as f64
}

/// Intersections of the faces' sides with the plane of a height.
fn cut(vertices: &[DVec3], faces: &[Vec<usize>], z: f64) -> Vec<DVec3> {
    let sides = faces
        .iter()
        .flat_map(|face| (0..face.len()).map(|i| (face[i], face[(i + 1) % face.len()])));
    sides
        .map(|(a, b)| (vertices[a], vertices[b]))
        .filter(|(a, b)| a.z.min(b.z) <= z + NEAR_MM && a.z.max(b.z) >= z - NEAR_MM)
        .flat_map(|(a, b)| {
            if (b.z - a.z).abs() > NEAR_MM {
                let at = a.lerp(b, ((z - a.z) / (b.z - a.z)).clamp(0.0, 1.0));
                [at, at]
            } else {
                [a, b]
            }
        })
        .collect()
}

/// Tolerance of equal heights, mm: single precision a hand's breadth from the origin.
const NEAR_MM: f64 = 1e-5;

fn below(points: &[DVec3]) -> Vec<DVec3> {
    points.iter().filter(|p| p.z <= NEAR_MM).copied().collect()
}

/// The greatest distances from the middle along x and y.
fn half(points: &[DVec3]) -> Option<[f64; 2]> {
    let greatest = points.iter().map(|p| p.abs()).reduce(DVec3::max)?;
    Some([greatest.x, greatest.y])
}

/// Values for places that the mesh does not reach: those of the place before, or after.
fn filled(halves: Vec<Option<[f64; 2]>>) -> Option<Vec<[f64; 2]>> {
    let mut last = halves.iter().flatten().next().copied()?;
    let fill = |half: Option<[f64; 2]>| {
        last = half.unwrap_or(last);
        last
    };
    Some(halves.into_iter().map(fill).collect())
}

fn outline(cuts: &[Vec<DVec3>]) -> Outline {
    let wide = |points: &&Vec<DVec3>| half(points).map_or(0.0, |half| half[0]);
    let widest = cuts.iter().max_by(|a, b| wide(a).total_cmp(&wide(b)));
    let corner = widest.and_then(|points| {
        let [x, y] = half(points)?.map(|v| v.max(f64::MIN_POSITIVE));
        let out = |p: &DVec3| (p.x / x) * (p.x / x) + (p.y / y) * (p.y / y);
        points.iter().map(out).reduce(f64::max)
    });
    if corner.is_some_and(|corner| corner > CORNERED) {
        Outline::Flat
    } else {
        Outline::Round
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tube of rings: height, and half the width and thickness there.
    fn tube(around: usize, turn: f64, rings: &[[f64; 3]]) -> (Vec<DVec3>, Vec<Vec<usize>>) {
        let mut vertices = Vec::new();
        for [z, x, y] in rings {
            for i in 0..around {
                let angle = 2.0 * std::f64::consts::PI * (i as f64 + turn) / around as f64;
                let (s, c) = maulstick_num::sin_cos(angle);
                vertices.push(DVec3::new(x * c, y * s, *z));
            }
        }
        let quad = |i: usize| {
            let (ring, i) = (i / around * around, i % around);
            let next = (i + 1) % around;
            vec![
                ring + next,
                ring + i,
                ring + around + i,
                ring + around + next,
            ]
        };
        let faces = (0..around * (rings.len() - 1)).map(quad).collect();
        (vertices, faces)
    }

    #[test]
    fn a_cone_is_measured_at_nine_places() {
        let (vertices, faces) = tube(16, 0.0, &[[0.0, 5.0, 2.0], [-20.0, 1.0, 2.0]]);
        let measured = measure(&vertices, &faces, 0, 20.0).expect("a head");
        let [wide, thick] = &measured.profiles;
        assert_eq!((wide.len(), measured.outline), (9, Outline::Round));
        for (i, [place, share]) in wide.iter().enumerate() {
            let expected = 1.0 - 0.8 * i as f64 / 8.0;
            assert!((share - expected).abs() < 1e-12, "{place}: {share}");
            assert!((share - expected * 0.99).abs() > 1e-4, "a fault would pass");
        }
        assert!(thick.iter().all(|[_, share]| (share - 1.0).abs() < 1e-12));
        assert_eq!(measured.across_mm, [10.0, 4.0]);
    }

    #[test]
    fn it_is_as_wide_as_its_subdivided_surface() {
        let rings = [0.0, -5.0, -10.0, -15.0, -20.0].map(|z| [z, 5.0, 5.0]);
        let (vertices, faces) = tube(12, 0.0, &rings);
        let [width, _] = measure(&vertices, &faces, 2, 20.0)
            .expect("a head")
            .across_mm;
        // A cubic B-spline through twelve points of a circle runs within it by (2 + cos 30°)/3.
        assert!((width / 10.0 - 0.9553).abs() < 5e-3, "{width}");
    }

    #[test]
    fn a_box_is_flat_and_what_is_in_the_ferrule_does_not_count() {
        let rings = [[3.0, 90.0, 80.0], [0.0, 8.0, 2.0], [-20.0, 8.0, 1.0]];
        let (vertices, faces) = tube(4, 0.5, &rings);
        let measured = measure(&vertices, &faces, 0, 20.0).expect("a head");
        let side = 0.5f64.sqrt();
        assert!((measured.across_mm[0] - 16.0 * side).abs() < 1e-9);
        assert_eq!(measured.outline, Outline::Flat);
        let above: Vec<DVec3> = vertices.iter().map(|at| *at + DVec3::Z * 21.0).collect();
        assert!(measure(&above, &faces, 0, 20.0).is_none());
    }
}
