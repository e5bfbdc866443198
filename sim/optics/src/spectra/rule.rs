//! Wavelengths of a painting, and conversion of their reflectances to XYZ.

use crate::cie::{Illuminant, Observer};
use crate::quadrature::Recurrence;
use crate::spectrum::{SAMPLES, Spectrum, wavelength};

/// Wavelengths and weights: XYZ = Σ weight_i · R(λ_i), Y = 1 for the perfect diffuser.
#[derive(Clone, Debug, PartialEq)]
pub struct SamplingRule {
    /// λ_i, nm.
    pub wavelengths_nm: Vec<f64>,
    /// Weights of X, Y and Z at each wavelength.
    pub weights: Vec<[f64; 3]>,
}

impl SamplingRule {
    /// Gaussian quadrature with the weight (x̄ + ȳ + z̄)·H (Baxter 2004, § 7.7), scaled a channel
    /// so that R = 1 gives the exact white; the plain rule is off by up to 5.6 % in Z.
    #[must_use]
    pub fn gauss(n: usize, observer: Observer, light: &Illuminant) -> Self {
        let points: Vec<f64> = (0..SAMPLES).map(wavelength).collect();
        let density = |nm: f64, power: f64| observer.at(nm).iter().sum::<f64>() * power;
        let measure: Vec<f64> = points
            .iter()
            .zip(&light.power.0)
            .map(|(nm, power)| density(*nm, *power))
            .collect();
        let rule = Recurrence::of_measure(&points, &measure, n).gauss();
        let white = light.xyz(observer, &Spectrum::flat(1.0));
        let mut weights: Vec<[f64; 3]> = rule
            .nodes
            .iter()
            .zip(&rule.weights)
            .map(|(nm, weight)| {
                let response = observer.at(*nm);
                let sum: f64 = response.iter().sum();
                response.map(|value| weight * value / sum)
            })
            .collect();
        for channel in 0..3 {
            let sum: f64 = weights.iter().map(|weight| weight[channel]).sum();
            weights
                .iter_mut()
                .for_each(|weight| weight[channel] *= white[channel] / sum);
        }
        Self {
            wavelengths_nm: rule.nodes,
            weights,
        }
    }

    /// All 101 samples.
    #[must_use]
    pub fn reference(observer: Observer, light: &Illuminant) -> Self {
        let wavelengths_nm: Vec<f64> = (0..SAMPLES).map(wavelength).collect();
        let white: f64 = wavelengths_nm
            .iter()
            .zip(&light.power.0)
            .map(|(nm, power)| observer.at(*nm)[1] * power)
            .sum();
        let weights = wavelengths_nm
            .iter()
            .zip(&light.power.0)
            .map(|(nm, power)| observer.at(*nm).map(|value| value * power / white))
            .collect();
        Self {
            wavelengths_nm,
            weights,
        }
    }

    /// Number of wavelengths.
    #[must_use]
    pub fn len(&self) -> usize {
        self.wavelengths_nm.len()
    }

    /// True if there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.wavelengths_nm.is_empty()
    }

    /// XYZ of the reflectances at the rule's wavelengths.
    #[must_use]
    pub fn xyz(&self, reflectances: &[f64]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (weight, r) in self.weights.iter().zip(reflectances) {
            for (total, w) in sum.iter_mut().zip(weight) {
                *total += w * r;
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_exact_under_every_light() {
        for name in crate::cie::ILLUMINANTS {
            let light = Illuminant::named(name).expect("known");
            let rule = SamplingRule::gauss(8, Observer::Cie1931, &light);
            let exact = light.xyz(Observer::Cie1931, &Spectrum::flat(1.0));
            for (got, want) in rule.xyz(&[1.0; 8]).iter().zip(exact) {
                assert!((got - want).abs() < 1e-12, "{name}");
            }
            assert!(
                rule.wavelengths_nm
                    .iter()
                    .all(|nm| (380.0..780.0).contains(nm))
            );
        }
    }

    #[test]
    fn the_reference_is_the_sum_over_all_samples() {
        let light = Illuminant::d65();
        let ramp = Spectrum::from_fn(|nm| (nm - 380.0) / 400.0);
        let rule = SamplingRule::reference(Observer::Cie1964, &light);
        let want = light.xyz(Observer::Cie1964, &ramp);
        for (got, want) in rule.xyz(&ramp.0).iter().zip(want) {
            assert!((got - want).abs() < 1e-12);
        }
    }
}
