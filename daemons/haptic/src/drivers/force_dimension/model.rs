//! Limits of the models, by the vendor's number of their type.
//!
//! Largest forces are those that CHAI3D's driver takes for safe. Stiffness is bounded by our clock, which is that of the
//! other arms, and not by the motors: CHAI3D drives an omega with 5000 N/m at 4 kHz.

/// Its own viscous friction, N·s/m, is published by nobody: the least of devices of its kind.
pub const DAMPING_N_S_M: f64 = 0.1;

/// Limits of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Model {
    /// Largest force, N.
    pub force_n: f64,
    /// Force that its warm motors bear, N.
    pub continuous_n: f64,
    /// Largest stiffness, N/m.
    pub stiffness_n_m: f64,
}

const OMEGA: Model = Model {
    force_n: 12.0,
    continuous_n: 12.0,
    stiffness_n_m: 1000.0,
};
const LARGE: Model = Model {
    force_n: 20.0,
    continuous_n: 20.0,
    ..OMEGA
};
const FALCON: Model = Model {
    force_n: 8.0,
    continuous_n: 8.0,
    ..OMEGA
};

impl Model {
    /// The model of a type; one that is not known is as weak as the weakest.
    #[must_use]
    pub fn of(system_type: i32) -> Self {
        match system_type {
            // omega.3, omega.6 and omega.7 of either hand.
            33..=37 => OMEGA,
            // delta.3; sigma.7 and lambda.7 of either hand.
            63 | 104 | 105 | 108 | 109 => LARGE,
            _ => FALCON,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_model_that_is_not_known_gets_no_more_than_any_that_is() {
        let other = Model::of(-7);
        for system_type in [33, 34, 37, 60, 63, 104, 109] {
            let known = Model::of(system_type);
            assert!(other.force_n <= known.force_n && other.continuous_n <= known.continuous_n);
            assert!(other.stiffness_n_m <= known.stiffness_n_m);
        }
    }
}
