//! Undoes the changes that an exporter makes to a mesh: vertices split at seams, quadrilaterals cut in two.

use std::collections::BTreeMap;

use glam::DVec3;

/// Distance of vertices to be merged, as a share of the mesh's size.
const WELD_DISTANCE_SHARE: f64 = 1e-6;
/// Cosine of the angle, 30°, up to which two triangles of a quadrilateral face the same direction.
const FLAT: f64 = 0.866;
/// Least quality of a quadrilateral: 1 − |cos| of its most skewed corner, here about 32°.
const SQUARE: f64 = 0.15;

/// For each vertex, the first one at the same place.
pub(super) fn same(positions: &[DVec3]) -> Vec<usize> {
    let low = positions.iter().copied().reduce(DVec3::min);
    let high = positions.iter().copied().reduce(DVec3::max);
    let size = match (low, high) {
        (Some(low), Some(high)) => (high - low).length(),
        _ => 0.0,
    };
    let near = (WELD_DISTANCE_SHARE * size).max(f64::MIN_POSITIVE);
    let mut cells: BTreeMap<[i64; 3], Vec<usize>> = BTreeMap::new();
    let mut firsts = Vec::with_capacity(positions.len());
    for (number, at) in positions.iter().enumerate() {
        // Cells of that size: what is nearer lies in this one or in one beside it.
        let cell = (*at / near).floor().to_array().map(|v| v as i64);
        let beside = (0..27i64).map(|i| {
            let step = [i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1];
            std::array::from_fn::<i64, 3, _>(|axis| cell[axis].saturating_add(step[axis]))
        });
        let found = beside
            .filter_map(|cell| cells.get(&cell))
            .flatten()
            .find(|other| (positions[**other] - *at).length() <= near)
            .copied();
        firsts.push(found.unwrap_or(number));
        if found.is_none() {
            cells.entry(cell).or_default().push(number);
        }
    }
    firsts
}

/// Faces in which successive triangles that make a good quadrilateral are joined: the pairing with the greatest sum
/// of qualities.
pub(super) fn quads(positions: &[DVec3], triangles: &[[usize; 3]]) -> Vec<Vec<usize>> {
    let pairs: Vec<Option<(f64, [usize; 4])>> = (0..triangles.len())
        .map(|i| {
            let next = triangles.get(i + 1)?;
            let quad = joined(&triangles[i], next)?;
            quality(positions, &triangles[i], next, &quad).map(|quality| (quality, quad))
        })
        .collect();
    // Greatest sum of qualities from each triangle to the last.
    let mut best = vec![0.0; triangles.len() + 2];
    let pays = |best: &[f64], i: usize| {
        let paired = pairs[i].map(|(quality, quad)| (quality + best[i + 2], quad));
        paired.filter(|(sum, _)| *sum > best[i + 1])
    };
    for i in (0..triangles.len()).rev() {
        best[i] = pays(&best, i).map_or(best[i + 1], |(sum, _)| sum);
    }
    let mut faces = Vec::new();
    let mut i = 0;
    while i < triangles.len() {
        match pays(&best, i) {
            Some((_, quad)) => {
                faces.push(quad.to_vec());
                i += 2;
            }
            None => {
                faces.push(triangles[i].to_vec());
                i += 1;
            }
        }
    }
    faces
}

/// The quadrilateral of two triangles with a common side.
fn joined(one: &[usize; 3], other: &[usize; 3]) -> Option<[usize; 4]> {
    let turned = |t: &[usize; 3], i: usize| [t[i], t[(i + 1) % 3], t[(i + 2) % 3]];
    let mut sides = (0..9).map(|i| (turned(one, i / 3), turned(other, i % 3)));
    let ([a, b, c], [.., d]) = sides.find(|([a, b, _], [c, d, _])| a == d && b == c)?;
    Some([b, c, a, d])
}

/// 1 − |cos| of the most skewed corner, if the quadrilateral is convex and nearly flat.
fn quality(
    positions: &[DVec3],
    one: &[usize; 3],
    other: &[usize; 3],
    quad: &[usize; 4],
) -> Option<f64> {
    let normal = |t: &[usize; 3]| {
        let [a, b, c] = t.map(|i| positions[i]);
        (b - a).cross(c - a).normalize_or_zero()
    };
    let (one, other) = (normal(one), normal(other));
    if one.dot(other) < FLAT {
        return None;
    }
    let up = one + other;
    let at = quad.map(|i| positions[i]);
    let corner = |i: usize| {
        let to = (at[(i + 1) % 4] - at[i]).normalize_or_zero();
        let from = (at[i] - at[(i + 3) % 4]).normalize_or_zero();
        if from.cross(to).dot(up) > 0.0 {
            1.0 - from.dot(to).abs()
        } else {
            0.0
        }
    };
    let worst = (0..4).map(corner).fold(1.0, f64::min);
    (worst > SQUARE).then_some(worst)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of `n` × `m` squares whose middle stands out, each cut along its diagonal.
    fn grid(n: usize, m: usize) -> (Vec<DVec3>, Vec<[usize; 3]>) {
        let at = |i: usize| {
            let (x, y) = ((i % (n + 1)) as f64, (i / (n + 1)) as f64);
            DVec3::new(x, y + 0.1 * x, 0.1 * (x - 0.5 * n as f64).abs())
        };
        let mut triangles = Vec::new();
        for j in 0..m {
            for i in 0..n {
                let a = j * (n + 1) + i;
                let (b, c, d) = (a + 1, a + n + 2, a + n + 1);
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        ((0..(n + 1) * (m + 1)).map(at).collect(), triangles)
    }

    fn sorted(face: &[usize]) -> Vec<usize> {
        let mut face = face.to_vec();
        face.sort_unstable();
        face
    }

    #[test]
    fn a_cut_grid_is_whole_again() {
        let (positions, triangles) = grid(4, 3);
        let faces = quads(&positions, &triangles);
        let whole: Vec<Vec<usize>> = triangles
            .chunks(2)
            .map(|pair| {
                let mut face = sorted(&pair.concat());
                face.dedup();
                face
            })
            .collect();
        assert_eq!(faces.iter().map(|f| sorted(f)).collect::<Vec<_>>(), whole);
    }

    #[test]
    fn a_triangle_ahead_does_not_shift_the_pairs() {
        let (mut positions, triangles) = grid(3, 1);
        positions.push(DVec3::new(0.0, -1.0, 0.15));
        let mut shifted = vec![[1, 0, positions.len() - 1]];
        shifted.extend(&triangles);
        // With the first triangle of the grid it would make a quadrilateral, but a skewed one.
        assert_eq!(quads(&positions, &shifted[..2]).len(), 1);
        let faces = quads(&positions, &shifted);
        assert_eq!(faces.len(), 4);
        assert_eq!(faces[1..].to_vec(), quads(&positions, &triangles));
    }

    #[test]
    fn folds_and_fans_stay_triangles() {
        let fold = [
            DVec3::ZERO,
            DVec3::X,
            DVec3::new(1.0, 1.0, 0.0),
            DVec3::new(0.0, 0.0, 1.0),
        ];
        assert_eq!(quads(&fold, &[[0, 1, 2], [0, 2, 3]]).len(), 2);
        let rim = |i: f64| {
            let (s, c) = maulstick_num::sin_cos(0.5 * i);
            DVec3::new(c, s, -0.2)
        };
        let fan = [DVec3::ZERO, rim(0.0), rim(1.0), rim(2.0)];
        assert_eq!(quads(&fan, &[[0, 1, 2], [0, 2, 3]]).len(), 2);
        let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let whole = quads(&square, &[[0, 1, 2], [0, 2, 3]]);
        assert_eq!(whole, [[0, 1, 2, 3]]);
    }

    #[test]
    fn a_quadrilateral_looks_where_its_triangles_look() {
        let (positions, triangles) = grid(2, 2);
        for face in quads(&positions, &triangles) {
            let at = |i: usize| positions[face[i]];
            assert!((at(2) - at(0)).cross(at(3) - at(1)).z > 0.0, "{face:?}");
        }
    }

    #[test]
    fn what_a_seam_split_is_one() {
        let seam = [
            DVec3::ZERO,
            DVec3::X,
            DVec3::new(1e-8, -1e-8, 0.0),
            DVec3::new(1.0, 0.0, 1e-4),
            DVec3::X,
        ];
        assert_eq!(same(&seam), [0, 1, 0, 3, 1]);
        assert_eq!(same(&[DVec3::ONE, DVec3::ONE]), [0, 0]);
    }
}
