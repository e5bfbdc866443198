//! Determinacy: tests whether the readings suffice for each paint.
//!
//! The inverse of the normal equations is the covariance of ln K, ln S and of the unit. The painter cares about the
//! colour of mixtures, not about K or S: a paint is well determined where its masstone, and its tints 1:1 and 1:10 with
//! the white, are predicted within a small error.

use crate::measurements::Measurements;
use crate::warning::Warning;
use crate::wavelength::{Observation, PRIOR_SD, Unknowns, Wavelength, gradient};

/// Shares of a paint in the mixtures with the white by which it is judged.
const TRIALS: [f64; 3] = [1.0, 0.5, 1.0 / 11.0];
/// A standard deviation of a trial's reading, root mean square over the spectrum, that is too much.
const RMS_MAX: f64 = 0.02;

/// The number of unknowns determined by the readings rather than the prior: the trace of the hat matrix. `None` where
/// the equations are singular.
#[must_use]
pub fn effective_unknowns(one: &Wavelength<'_>, at: &Unknowns) -> Option<f64> {
    let free = one.free();
    let covariance = one.linearised(at).inverse(&free)?;
    let size = free.len();
    let known = |i: usize| 1.0 - covariance[i * size + i] / (PRIOR_SD * PRIOR_SD);
    Some((0..size - 1).filter(|i| free[*i]).map(known).sum())
}

/// 1/variance of ln u from readings alone; 0 where there are no drawdowns.
#[must_use]
pub fn unit_information(one: &Wavelength<'_>, at: &Unknowns) -> f64 {
    let free = one.free();
    let last = free.len() - 1;
    if !free[last] {
        return 0.0;
    }
    let variance = one
        .linearised(at)
        .inverse(&free)
        .map_or(f64::INFINITY, |covariance| {
            covariance[last * free.len() + last]
        });
    (1.0 / variance - 1.0 / (crate::wavelength::UNIT_SD * crate::wavelength::UNIT_SD)).max(0.0)
}

/// A warning for each paint that is ill-determined.
#[must_use]
pub fn warnings(
    measured: &Measurements,
    spectrum: &[(f64, Wavelength<'_>)],
    found: &[Unknowns],
) -> Vec<Warning> {
    let paints = measured.paints.len();
    // Sum of variances, and the worst deviation with its wavelength, a paint and trial.
    let mut sums = vec![[0.0f64; TRIALS.len()]; paints];
    let mut worst = vec![(0.0f64, 0.0f64); paints];
    let mut white = 0;
    for ((nm, one), at) in spectrum.iter().zip(found) {
        white = one.white;
        let free = one.free();
        let covariance = one.linearised(at).inverse(&free);
        for j in 0..paints {
            for (sum, share) in sums[j].iter_mut().zip(TRIALS) {
                let mut shares = vec![0.0; paints];
                shares[white] += 1.0 - share;
                shares[j] += share;
                let deviation = deviation(&shares, one, at, covariance.as_deref());
                *sum += deviation * deviation;
                if deviation > worst[j].0 {
                    worst[j] = (deviation, *nm);
                }
            }
        }
    }
    let white = &measured.paints[white];
    let mut warnings = Vec::new();
    for (j, name) in measured.paints.iter().enumerate() {
        let mean = |sum: &f64| (sum / spectrum.len() as f64).sqrt();
        let rms = sums[j].iter().map(mean).fold(0.0, f64::max);
        if rms > RMS_MAX {
            let (most, nm) = worst[j];
            warnings.push(Warning::Indeterminate {
                paint: name.clone(),
                white: white.clone(),
                rms,
                most,
                nm,
            });
        }
    }
    warnings
}

/// Standard deviation of the reading of an opaque mixture, at most 1.
fn deviation(
    shares: &[f64],
    one: &Wavelength<'_>,
    at: &Unknowns,
    covariance: Option<&[f64]>,
) -> f64 {
    let Some(covariance) = covariance else {
        return 1.0;
    };
    let size = 2 * shares.len() + 1;
    let trial = Observation {
        shares,
        film: None,
        reading: 0.0,
        trust: 1.0,
    };
    let (row, _) = gradient(&trial, at, &one.surface);
    let mut variance = 0.0;
    for (i, a) in &row {
        for (j, b) in &row {
            variance += a * covariance[i * size + j] * b;
        }
    }
    variance.max(0.0).sqrt().min(1.0)
}
