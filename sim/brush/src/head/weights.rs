//! The weights of strips among spines (Baxter 2004, eq. 3.17-3.20).

use glam::DVec2;

use crate::qp::DualSolver;

/// The point of the convex hull of `points` that is nearest to `p`.
#[must_use]
pub fn nearest_in_hull(points: &[DVec2], p: DVec2) -> DVec2 {
    let hull = hull(points);
    let inside = hull.len() > 2
        && (0..hull.len()).all(|i| {
            let (a, b) = (hull[i], hull[(i + 1) % hull.len()]);
            (b - a).perp_dot(p - a) >= 0.0
        });
    if inside {
        return p;
    }
    let on_edge = |i: usize| {
        let (a, b) = (hull[i], hull[(i + 1) % hull.len()]);
        let along = b - a;
        let square = along.length_squared();
        let t = if square > 0.0 {
            ((p - a).dot(along) / square).clamp(0.0, 1.0)
        } else {
            0.0
        };
        a + along * t
    };
    (0..hull.len())
        .map(on_edge)
        .min_by(|a, b| {
            (*a - p)
                .length_squared()
                .total_cmp(&(*b - p).length_squared())
        })
        .unwrap_or(p)
}

/// The corners of the convex hull, counterclockwise (Andrew 1979).
fn hull(points: &[DVec2]) -> Vec<DVec2> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    sorted.dedup();
    let chain = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut side: Vec<DVec2> = Vec::new();
        for p in points {
            while let [.., a, b] = side[..]
                && (b - a).perp_dot(p - a) <= 1e-12 * (b - a).length() * (p - a).length()
            {
                side.pop();
            }
            side.push(p);
        }
        side.pop();
        side
    };
    let mut lower = chain(&mut sorted.iter().copied());
    lower.extend(chain(&mut sorted.iter().rev().copied()));
    if lower.is_empty() {
        lower.extend(sorted.first());
    }
    lower
}

/// The weights of a root within the hull of the spines' (eq. 3.17-3.20): of all weights that reproduce its position,
/// those that favour near spines most.
#[must_use]
pub fn weights_of(roots: &[DVec2], root: DVec2) -> Vec<f64> {
    /// Penalty for an error in the sum or the position, by the squared size of the head; the error is added to the
    /// target until it vanishes (augmented Lagrangian, Hestenes 1969).
    const PRICE: f64 = 1e3;
    const ROUNDS: usize = 6;
    let m = roots.len();
    let size = roots
        .iter()
        .map(|other| other.length_squared())
        .fold(1e-18, f64::max);
    let place = |p: DVec2| [1.0, p.x / size.sqrt(), p.y / size.sqrt()];
    let rows: Vec<[f64; 3]> = roots.iter().map(|other| place(*other)).collect();
    let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let mut g = Vec::with_capacity(m * m);
    for (i, a) in rows.iter().enumerate() {
        for (j, b) in rows.iter().enumerate() {
            let near = (root - roots[i]).length_squared() / size;
            let own = if i == j { 2.0 * near } else { 0.0 };
            g.push(own + PRICE * dot(a, b));
        }
    }
    let goal = place(root);
    let mut wanted = goal;
    let mut weights = vec![1.0 / m as f64; m];
    let mut solver = DualSolver::default();
    for _ in 0..ROUNDS {
        let r: Vec<f64> = rows.iter().map(|row| PRICE * dot(row, &wanted)).collect();
        solver.solve(&g, &r, 1e-12, &mut weights);
        for (axis, wanted) in wanted.iter_mut().enumerate() {
            let got: f64 = rows
                .iter()
                .zip(&weights)
                .map(|(row, w)| row[axis] * w)
                .sum();
            *wanted += goal[axis] - got;
        }
    }
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|weight| weight / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring() -> Vec<DVec2> {
        std::iter::once(DVec2::ZERO)
            .chain((0..6).map(|i| {
                let (s, c) = maulstick_num::sin_cos(f64::from(i) * std::f64::consts::PI / 3.0);
                DVec2::new(c, s) * 3e-3
            }))
            .collect()
    }

    #[test]
    fn weights_are_convex_and_place_their_root() {
        let roots = ring();
        for i in 0..200 {
            let (s, c) = maulstick_num::sin_cos(f64::from(i) * 0.7);
            let root = DVec2::new(c, s) * (2.5e-3 * f64::from(i) / 200.0);
            let weights = weights_of(&roots, root);
            let sum: f64 = weights.iter().sum();
            let place: DVec2 = roots.iter().zip(&weights).map(|(p, w)| *p * *w).sum();
            assert!((sum - 1.0).abs() < 1e-12 && weights.iter().all(|w| *w >= 0.0));
            assert!((place - root).length() < 1e-8, "{root} {place}");
            assert!(
                (place - root * 1.001).length() > 1e-8 || i < 5,
                "a fault would pass"
            );
        }
        for (i, root) in roots.iter().enumerate() {
            assert!(
                weights_of(&roots, *root)[i] > 1.0 - 1e-6,
                "a root on a spine's"
            );
        }
    }

    #[test]
    fn a_root_outside_the_hull_goes_to_its_nearest_point() {
        let roots = ring();
        let far = DVec2::new(10e-3, 0.0);
        assert!((nearest_in_hull(&roots, far) - roots[1]).length() < 1e-15);
        let inside = DVec2::new(1e-3, 1e-3);
        assert_eq!(nearest_in_hull(&roots, inside), inside);
        let row = [DVec2::new(-1.0, 0.0), DVec2::ZERO, DVec2::new(1.0, 0.0)];
        let beside = nearest_in_hull(&row, DVec2::new(0.3, 0.5));
        assert!((beside - DVec2::new(0.3, 0.0)).length() < 1e-12);
        let place = |w: Vec<f64>| -> DVec2 { row.iter().zip(w).map(|(p, w)| *p * w).sum() };
        assert!((place(weights_of(&row, beside)) - beside).length() < 1e-8);
        assert_eq!(nearest_in_hull(&[DVec2::ONE], far), DVec2::ONE);
    }
}
