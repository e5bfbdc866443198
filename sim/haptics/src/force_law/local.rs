//! A force linearised about a pose: f₀ + (∂f/∂x)·(x − x₀).
//!
//! Only the symmetric positive part of the derivative is kept: the rest would drive the hand in circles, and give
//! energy with each turn. Its principal stiffnesses are bounded one by one.

use glam::{DMat3, DVec3};
use maulstick_types::Pose;

/// The linearised force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Local {
    at: DVec3,
    force: DVec3,
    /// Principal stiffnesses, N/m, not negative, and their directions.
    stiffness: DVec3,
    directions: DMat3,
}

impl Local {
    /// The force `force_n` at `pose` and its derivative by position, row by row, N/m.
    ///
    /// # Errors
    /// The value that is not finite.
    pub fn new(
        pose: &Pose,
        force_n: [f64; 3],
        derivative_n_m: [[f64; 3]; 3],
    ) -> Result<Self, &'static str> {
        let force = DVec3::from_array(force_n);
        let derivative = DMat3::from_cols_array_2d(&derivative_n_m);
        if !(pose.is_valid() && force.is_finite() && derivative.is_finite()) {
            return Err("the local force is not finite");
        }
        let symmetric = (derivative + derivative.transpose()) * -0.5;
        let (stiffness, directions) = principal(symmetric);
        if !(stiffness.is_finite() && directions.is_finite()) {
            return Err("the local stiffness is beyond all numbers");
        }
        Ok(Self {
            at: DVec3::from_array(pose.position_m),
            force,
            stiffness: stiffness.max(DVec3::ZERO),
            directions,
        })
    }

    /// The force at `position`, N; no principal stiffness exceeds `max_stiffness`, N/m.
    #[must_use]
    pub fn force(&self, position: DVec3, max_stiffness: f64) -> DVec3 {
        let along = self.directions.transpose() * (position - self.at);
        let stiffness = self.stiffness.min(DVec3::splat(max_stiffness));
        self.force - self.directions * (stiffness * along)
    }

    /// Stiffness along a unit vector, N/m.
    #[must_use]
    pub fn stiffness_along(&self, unit: DVec3, max_stiffness: f64) -> f64 {
        let along = self.directions.transpose() * unit;
        let stiffness = self.stiffness.min(DVec3::splat(max_stiffness));
        (stiffness * along * along).element_sum()
    }
}

/// Eigenvalues of a symmetric matrix and its eigenvectors as columns, by Jacobi's rotations.
fn principal(mut m: DMat3) -> (DVec3, DMat3) {
    const SWEEPS: usize = 12;
    let mut vectors = DMat3::IDENTITY;
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let off = m.col(p)[q];
            if off == 0.0 {
                continue;
            }
            let theta = (m.col(q)[q] - m.col(p)[p]) / (2.0 * off);
            let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            let mut turn = DMat3::IDENTITY;
            turn.col_mut(p)[p] = c;
            turn.col_mut(q)[q] = c;
            turn.col_mut(q)[p] = s;
            turn.col_mut(p)[q] = -s;
            m = turn.transpose() * m * turn;
            vectors *= turn;
        }
    }
    (DVec3::new(m.col(0)[0], m.col(1)[1], m.col(2)[2]), vectors)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn local(derivative: [[f64; 3]; 3]) -> Local {
        Local::new(&Pose::IDENTITY, [0.0; 3], derivative).expect("a local force")
    }

    #[test]
    fn it_is_the_force_and_its_derivative_within_the_bound() {
        let derivative = [
            [-200.0, 30.0, 0.0],
            [30.0, -150.0, 10.0],
            [0.0, 10.0, -90.0],
        ];
        let force = Local::new(&Pose::IDENTITY, [0.1, 0.2, 0.3], derivative).expect("a force");
        let x = DVec3::new(1e-3, -2e-3, 3e-3);
        let expected = DVec3::new(0.1, 0.2, 0.3) + DMat3::from_cols_array_2d(&derivative) * x;
        assert!((force.force(x, 1e9) - expected).length() < 1e-12);
        assert!((force.stiffness_along(DVec3::Z, 1e9) - 90.0).abs() < 1e-9);
        assert!(force.stiffness_along(DVec3::X, 100.0) <= 100.0 + 1e-9);
    }

    proptest! {
        /// A closed path gains no energy, and away from the pose the force pushes back.
        #[test]
        fn no_derivative_gives_energy(
            rows in prop::array::uniform3(prop::array::uniform3(-500.0..500.0f64)),
            way in prop::array::uniform3(-0.01..0.01f64),
        ) {
            let force = local(rows);
            let x = DVec3::from_array(way);
            prop_assert!(force.force(x, 300.0).dot(x) <= 1e-12);
            prop_assert!(force.force(x, 300.0).length() <= 300.0 * x.length() * (1.0 + 1e-9));
            let mut given = 0.0;
            let corners = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::X].map(|c| c * 0.01);
            for pair in corners.windows(2) {
                let middle = (pair[0] + pair[1]) * 0.5;
                given += force.force(middle, 1e9).dot(pair[1] - pair[0]);
            }
            prop_assert!(given.abs() < 1e-12, "{given} J");
        }
    }

    /// The seeded fault: with its curl the derivative would give energy.
    #[test]
    fn a_derivative_with_curl_would_give_energy() {
        let curl = DMat3::from_cols_array_2d(&[[0.0, 100.0, 0.0], [-100.0, 0.0, 0.0], [0.0; 3]]);
        let corners = [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y, DVec3::X].map(|c| c * 0.01);
        let given = corners.windows(2).map(|pair| {
            let middle = (pair[0] + pair[1]) * 0.5;
            (curl * middle).dot(pair[1] - pair[0])
        });
        assert!(given.sum::<f64>().abs() > 1e-3);
    }
}
