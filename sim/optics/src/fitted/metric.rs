//! The metric of ΔE₀₀ in XYZ, for small errors at a colour.

use crate::colour::{delta_e_2000, lab};

/// A symmetric matrix M with ΔE₀₀² ≈ eᵀ·M·e for a small error e in XYZ.
#[derive(Clone, Copy, Debug)]
pub(super) struct Metric(pub(super) [[f64; 3]; 3]);

impl Metric {
    /// √(eᵀ·M·e).
    pub(super) fn length(&self, e: [f64; 3]) -> f64 {
        let row = |i: usize| (0..3).map(|j| self.0[i][j] * e[j]).sum::<f64>();
        (0..3).map(|i| e[i] * row(i)).sum::<f64>().max(0.0).sqrt()
    }
}

/// The metric at `xyz` under a light of white `white`, by central differences of ΔE₀₀².
pub(super) fn of_delta_e(xyz: [f64; 3], white: [f64; 3]) -> Metric {
    let here = lab(xyz, white);
    let step = xyz.map(|v| (2e-4 * v).max(1e-6));
    let square = |along: [f64; 3]| {
        let both = [1.0, -1.0].map(|sign| {
            let there = [0, 1, 2].map(|i| xyz[i] + sign * along[i] * step[i]);
            let far = delta_e_2000(here, lab(there, white));
            far * far
        });
        0.5 * (both[0] + both[1])
    };
    let axis = |i: usize| [0, 1, 2].map(|j| if i == j { 1.0 } else { 0.0 });
    let diagonal = [0, 1, 2].map(|i| square(axis(i)));
    let mut m = [[0.0; 3]; 3];
    for i in 0..3 {
        m[i][i] = diagonal[i] / (step[i] * step[i]);
        for j in 0..i {
            let (a, b) = (axis(i), axis(j));
            let mixed = square([0, 1, 2].map(|c| a[c] + b[c])) - diagonal[i] - diagonal[j];
            m[i][j] = mixed / (2.0 * step[i] * step[j]);
            m[j][i] = m[i][j];
        }
    }
    Metric(m)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_errors_have_the_length_of_their_colour_difference() {
        let white = [0.9504, 1.0, 1.0888];
        for xyz in [
            [0.2, 0.21, 0.23],
            [0.03, 0.02, 0.15],
            [0.7, 0.75, 0.1],
            [0.005, 0.005, 0.006],
        ] {
            let metric = of_delta_e(xyz, white);
            for e in [[1.0, 0.0, 0.0], [0.3, -0.5, 0.7], [-0.2, 0.1, -0.9]] {
                let e = [0, 1, 2].map(|i| 1e-3 * e[i] * xyz[i]);
                let there = [0, 1, 2].map(|i| xyz[i] + e[i]);
                let exact = delta_e_2000(lab(xyz, white), lab(there, white));
                let got = metric.length(e);
                println!("{got:.6} for {exact:.6}");
                assert!((got - exact).abs() < 0.02 * exact, "{xyz:?} {e:?}");
            }
        }
    }
}
