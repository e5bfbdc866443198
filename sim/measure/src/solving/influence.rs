//! Influence of each sample: the fit with one left out.
//!
//! Least squares bend to a wrong row, most where there are few others, so that its own residual is small and those of
//! its neighbours are large. The criterion is the fall of the sum of squares when a row is left out (Cook 1977,
//! *Detection of influential observation in linear regression*; the likelihood-ratio test of a row whose mean is
//! shifted). A row is suspect where that fall, per reading, is many times the residual variance without it. The worst
//! is removed, and the rest are tested again.
//!
//! Candidates are found by the fall that the linearised fit predicts, r²/(1 − h), and tested by separate fits at some
//! wavelengths: a mistake in shares or thickness shows at all of them.

use maulstick_num::ln;

use crate::determined::effective_unknowns;
use crate::wavelength::{Unknowns, Wavelength, gradient};

/// A row is suspect whose fall per reading is more than this squared times the variance of the others.
const SUSPECT: f64 = 5.0;
/// The variance is taken to be no less than that of readings with this standard deviation: smaller
/// mistakes are not seen in a painting.
const LEAST_SD: f64 = 1e-3;
/// Wavelengths at which rows are left out.
const WAVELENGTHS: usize = 16;
/// Rows that are tried by a fit without them.
const TRIED: usize = 40;
/// Most rows that are accused, and most as a share of all.
const MOST_SUSPECTS: usize = 5;
const MOST_SHARE: f64 = 0.1;
/// Greatest number of Gauss-Newton steps.
const STEPS: usize = 20;
/// Greatest factor on K and S in one step.
const LARGEST_FACTOR: f64 = 2.0;

/// A row that is inconsistent with the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Suspect {
    /// Index among the samples.
    pub sample: usize,
    /// Ratio of the other samples' residuals, root mean square, with it and without it.
    pub gain: f64,
}

/// The rows that do not go with the others, the worst first.
#[must_use]
pub fn suspects(spectrum: &[(f64, Wavelength<'_>)], found: &[Unknowns]) -> Vec<Suspect> {
    let stride = spectrum.len().div_ceil(WAVELENGTHS).max(1);
    let mut fits: Vec<LeaveOneOut<'_>> = spectrum
        .iter()
        .zip(found)
        .skip(stride / 2)
        .step_by(stride)
        .map(|((_, one), at)| LeaveOneOut::of(one, at))
        .collect();
    let samples = fits.first().map_or(0, |fit| fit.one.observations.len());
    let most = MOST_SUSPECTS.min((MOST_SHARE * samples as f64).ceil() as usize);
    let mut suspects = Vec::new();
    while suspects.len() < most {
        let Some(worst) = worst(&fits, samples) else {
            break;
        };
        suspects.push(worst);
        for fit in &mut fits {
            fit.leave_out(worst.sample);
        }
    }
    suspects
}

/// The row without which the others fit best, if it is suspect.
fn worst(fits: &[LeaveOneOut<'_>], samples: usize) -> Option<Suspect> {
    let mut foretold: Vec<(usize, f64)> = (0..samples)
        .map(|i| (i, fits.iter().map(|fit| fit.foretold[i]).sum()))
        .collect();
    foretold.sort_by(|a, b| b.1.total_cmp(&a.1));
    let all: f64 = fits.iter().map(|fit| fit.squares).sum();
    let tried = foretold.iter().take(TRIED).map(|(sample, _)| {
        let without: f64 = fits.iter().map(|fit| fit.without(*sample).1).sum();
        (*sample, without)
    });
    let (sample, without) = tried.min_by(|a, b| a.1.total_cmp(&b.1))?;
    // One row less.
    let freedom: f64 = fits.iter().map(|fit| fit.freedom - 1.0).sum();
    if freedom < 0.5 * fits.len() as f64 {
        return None;
    }
    let variance = (without / freedom).max(LEAST_SD * LEAST_SD);
    let fall = (all - without) / fits.len() as f64;
    (fall > SUSPECT * SUSPECT * variance).then(|| Suspect {
        sample,
        gain: (all / freedom / variance).sqrt(),
    })
}

/// Least squares at a wavelength with all rows weighted equally, and without single rows.
struct LeaveOneOut<'a> {
    one: Wavelength<'a>,
    at: Unknowns,
    /// Sum of squares of the readings.
    squares: f64,
    /// By how much it falls without each row, to first order.
    foretold: Vec<f64>,
    /// Readings less the unknowns that they determine.
    freedom: f64,
}

impl<'a> LeaveOneOut<'a> {
    fn of(one: &Wavelength<'a>, at: &Unknowns) -> Self {
        let mut one = one.clone();
        // A wrong row makes the noise look large, and the prior too weighty.
        one.noise = LEAST_SD;
        one.observations.iter_mut().for_each(|row| row.trust = 1.0);
        Self::settled(one, at.clone())
    }

    fn settled(one: Wavelength<'a>, start: Unknowns) -> Self {
        let (at, squares) = least_squares(&one, start);
        let rows: f64 = one.observations.iter().map(|row| row.trust).sum();
        let freedom = rows - effective_unknowns(&one, &at).unwrap_or(rows);
        let free = one.free();
        let size = free.len();
        let covariance = one.linearised(&at).inverse(&free);
        let foretold = one.observations.iter().map(|row| {
            let Some(covariance) = &covariance else {
                return 0.0;
            };
            let (slopes, value) = gradient(row, &at, &one.surface);
            let spread: f64 = slopes
                .iter()
                .flat_map(|(i, a)| {
                    slopes
                        .iter()
                        .map(move |(j, b)| a * b * covariance[i * size + j])
                })
                .sum();
            let leverage = row.trust * spread / (one.noise * one.noise);
            let off = value - row.reading;
            row.trust * off * off / (1.0 - leverage).max(1e-6)
        });
        let foretold = foretold.collect();
        Self {
            one,
            at,
            squares,
            foretold,
            freedom,
        }
    }

    /// The fit without a row.
    fn without(&self, sample: usize) -> (Unknowns, f64) {
        let mut one = self.one.clone();
        one.observations[sample].trust = 0.0;
        least_squares(&one, self.at.clone())
    }

    fn leave_out(&mut self, sample: usize) {
        let mut one = self.one.clone();
        one.observations[sample].trust = 0.0;
        *self = Self::settled(one, self.at.clone());
    }
}

/// Gauss and Newton's method from a nearby start; the sum of squared residuals of the readings.
fn least_squares(one: &Wavelength<'_>, mut at: Unknowns) -> (Unknowns, f64) {
    let free = one.free();
    let mut cost = one.cost(&at);
    let mut reach = ln(LARGEST_FACTOR);
    for _ in 0..STEPS {
        let equations = one.linearised(&at);
        let Some(covariance) = equations.inverse(&free) else {
            break;
        };
        let step: Vec<f64> = covariance
            .chunks_exact(equations.size)
            .map(|row| {
                -row.iter()
                    .zip(&equations.vector)
                    .map(|(p, q)| p * q)
                    .sum::<f64>()
            })
            .collect();
        let far = step.iter().fold(0.0f64, |far, by| far.max(by.abs()));
        let share = (reach / far).min(1.0);
        let step: Vec<f64> = step.iter().map(|by| by * share).collect();
        let there = at.moved(&step);
        let cost_there = one.cost(&there);
        if cost_there <= cost {
            let settled = cost - cost_there <= 1e-6 * cost;
            (at, cost) = (there, cost_there);
            if settled {
                break;
            }
        } else {
            reach = 0.25 * reach.min(far);
        }
    }
    let squares = one.observations.iter().map(|row| {
        let off = row.model(&at, &one.surface).value - row.reading;
        row.trust * off * off
    });
    let squares = squares.sum();
    (at, squares)
}
