//! White under another light: von Kries' scaling in the space of a cone matrix.

use super::matrix::{Matrix, apply, inverse, product};

/// CAT16's cone matrix (Li et al. 2017, *Comprehensive color solutions: CAM16, CAT16*).
const CAT16: Matrix = [
    [0.401_288, 0.650_173, -0.051_461],
    [-0.250_268, 1.204_414, 0.045_854],
    [-0.002_079, 0.048_952, 0.953_127],
];

/// Bradford's (ICC.1:2022, annex E), which profiles are made with.
const BRADFORD: Matrix = [
    [0.8951, 0.2664, -0.1614],
    [-0.7502, 1.7135, 0.0367],
    [0.0389, -0.0685, 1.0296],
];

/// White of the connection space of ICC profiles, XYZ (ICC.1:2022, § 7.2.16).
pub const D50: [f64; 3] = [0.9642, 1.0, 0.8249];

fn scaled(cones: &Matrix, from: [f64; 3], to: [f64; 3]) -> Matrix {
    let (from, to) = (apply(cones, from), apply(cones, to));
    let scaled: Matrix = std::array::from_fn(|i| cones[i].map(|value| value * to[i] / from[i]));
    product(&inverse(cones), &scaled)
}

/// XYZ under a white to the XYZ that looks like it under another: CAT16, complete.
#[must_use]
pub fn adaptation(from_white: [f64; 3], to_white: [f64; 3]) -> Matrix {
    scaled(&CAT16, from_white, to_white)
}

/// [`adaptation`] by Bradford's matrix.
#[must_use]
pub fn bradford(from_white: [f64; 3], to_white: [f64; 3]) -> Matrix {
    scaled(&BRADFORD, from_white, to_white)
}
