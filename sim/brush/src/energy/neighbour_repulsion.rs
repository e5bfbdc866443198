//! Repulsion between the spines of a head.

use glam::{DMat3, DVec3};

use super::outer;

/// Energy by which a joint repels a neighbouring spine's joint that comes nearer than at rest: E = k/(8D²)·max(0, D²
/// − r²)², with r the distance and D the distance at rest. Its force at r → D is k·(D − r). It has no pole and never
/// attracts, so a head may splay but not collapse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repulsion {
    /// E, J.
    pub value: f64,
    /// dE/dx: along the vector from the neighbour, N.
    pub force: DVec3,
    /// d²E/dx², N/m.
    pub hessian: DMat3,
}

/// Evaluates [`Repulsion`] for stiffness `k` (N/m), the vector `x` from the neighbour to the joint (m) and the
/// distance at rest (m); `None` beyond that distance.
#[must_use]
pub fn neighbour_repulsion(k: f64, x: DVec3, at_rest: f64) -> Option<Repulsion> {
    let square = at_rest * at_rest;
    let lacking = square - x.length_squared();
    (lacking > 0.0).then(|| {
        let scale = k / (2.0 * square);
        Repulsion {
            value: 0.25 * scale * lacking * lacking,
            force: x * (-scale * lacking),
            hessian: outer(x, x) * (2.0 * scale)
                - DMat3::from_diagonal(DVec3::splat(scale * lacking)),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_pushes_apart_only_and_its_derivatives_agree() {
        let (k, rest) = (3.0, 2e-3);
        assert_eq!(neighbour_repulsion(k, DVec3::X * 2.1e-3, rest), None);
        let near = neighbour_repulsion(k, DVec3::X * 1.9e-3, rest).expect("near");
        assert!(
            (near.force.x + k * 1e-4).abs() < 0.08 * k * 1e-4,
            "about k·(D − r)"
        );
        for x in [DVec3::new(1e-3, -5e-4, 2e-4), DVec3::new(1e-9, 0.0, 0.0)] {
            let f = |x: DVec3| neighbour_repulsion(k, x, rest).expect("near");
            let got = f(x);
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let h = 1e-7;
                let numeric = (f(x + axis * h).value - f(x - axis * h).value) / (2.0 * h);
                assert!((numeric - got.force.dot(axis)).abs() < 1e-8);
                assert!((numeric - 1.01 * got.force.dot(axis) - 1e-7).abs() > 1e-8);
                let numeric = (f(x + axis * h).force - f(x - axis * h).force) / (2.0 * h);
                assert!((numeric - got.hessian * axis).length() < 1e-5);
            }
        }
    }
}
