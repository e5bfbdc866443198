//! K and S of all paints at one wavelength.
//!
//! Baxter 2004, § 7.6: for each opaque sample ΣK·c − Q·ΣS·c = 0 with Q = (1−R)²/2R, the S of one
//! white being 1 and no K or S below 0, is a quadratic program. Two things are done to it. Its rows
//! are weighted so that an error of the reading counts the same in a dark and in a light sample: a row
//! is worth |d reading/dQ| / ΣS·c, and since that holds S, the program is solved some times over.
//! From there Gauss and Newton's method continues in ln K and ln S, a bounded program a step, with the
//! reading itself as the model: this is exact where Q is not linear in the noise of R, and takes
//! drawdowns in, whose reflectance is no ratio of K and S.
//!
//! Unknowns that readings do not determine are drawn to a paint like the measured ones: ln K and ln S have the
//! standard deviation [`PRIOR_SD`] about them. Where readings speak, that has no weight.
//!
//! Drawdowns have a length. κ = u·ΣK·c·d, with d in units of 1/S of the paint files' white, so that
//! u is the S of this white as a share of that one's; u is an unknown where there are drawdowns.

use maulstick_num::{exp, ln};

use crate::layer::{Slopes, film_over, opaque};
use crate::normal::NormalEquations;
use crate::program::{Bound, minimise};
use crate::surface::Surface;

/// Standard deviation of ln K and ln S of an unknown paint about the prior.
pub const PRIOR_SD: f64 = 1.5;
/// The same for the S per metre of an unknown white.
pub const UNIT_SD: f64 = 0.5;
/// Programmes of eq. 7.7 in turn.
const REWEIGHTINGS: usize = 4;
/// Greatest number of Gauss-Newton steps.
const STEPS: usize = 60;
/// Greatest factor on K and S in one step.
const LARGEST_FACTOR: f64 = 4.0;

/// K and S of each paint, relative to the white's S, and that S.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknowns {
    /// K.
    pub k: Vec<f64>,
    /// S.
    pub s: Vec<f64>,
    /// The white's S as a share of [`maulstick_optics::paints::WHITE_S_PER_M`].
    pub unit: f64,
}

/// A reading.
#[derive(Clone, Debug, PartialEq)]
pub struct Observation<'a> {
    /// Shares of the paints.
    pub shares: &'a [f64],
    /// d·[`maulstick_optics::paints::WHITE_S_PER_M`] and the ground's internal reflectance; `None` for an opaque
    /// sample.
    pub film: Option<(f64, f64)>,
    /// Reading of the instrument.
    pub reading: f64,
    /// Squared ratio of the other samples' deviation to this one's: 1, or less for a
    /// sample that stands out.
    pub trust: f64,
}

/// All inputs at a wavelength.
#[derive(Clone, Debug, PartialEq)]
pub struct Wavelength<'a> {
    /// The readings.
    pub observations: Vec<Observation<'a>>,
    /// Prior of K, S and unit.
    pub prior: Unknowns,
    /// Place of the reference white.
    pub white: usize,
    /// The samples' surface.
    pub surface: Surface,
    /// Standard deviation of a reading.
    pub noise: f64,
}

impl Unknowns {
    /// ΣK·c and ΣS·c.
    #[must_use]
    pub fn mixed(&self, shares: &[f64]) -> (f64, f64) {
        let sum = |values: &[f64]| values.iter().zip(shares).map(|(v, c)| v * c).sum();
        (sum(&self.k), sum(&self.s))
    }

    /// K, S and unit times e to these powers, in this order.
    #[must_use]
    pub fn moved(&self, by: &[f64]) -> Self {
        let n = self.k.len();
        let moved = |values: &[f64], by: &[f64]| {
            let pairs = values.iter().zip(by);
            pairs.map(|(value, by)| value * exp(*by)).collect()
        };
        Self {
            k: moved(&self.k, &by[..n]),
            s: moved(&self.s, &by[n..2 * n]),
            unit: self.unit * exp(by[2 * n]),
        }
    }
}

impl Observation<'_> {
    /// The reading that `unknowns` give, with its slopes.
    #[must_use]
    pub fn model(&self, unknowns: &Unknowns, surface: &Surface) -> Slopes {
        let (k, s) = unknowns.mixed(self.shares);
        let inner = match self.film {
            None => opaque(k, s),
            Some((length, ground)) => {
                let d = length * unknowns.unit;
                film_over(k * d, s * d, ground)
            }
        };
        let (value, slope) = surface.reading(inner.value);
        Slopes {
            value,
            by_ln_k: slope * inner.by_ln_k,
            by_ln_s: slope * inner.by_ln_s,
        }
    }
}

impl Wavelength<'_> {
    fn paints(&self) -> usize {
        self.prior.k.len()
    }

    /// 1/standard deviation of a reading.
    fn precision(&self, one: &Observation<'_>) -> f64 {
        one.trust.sqrt() / self.noise
    }

    fn has_films(&self) -> bool {
        self.observations.iter().any(|one| one.film.is_some())
    }

    /// Mask of the unknowns among ln K, ln S and ln u.
    #[must_use]
    pub fn free(&self) -> Vec<bool> {
        let n = self.paints();
        let mut free = vec![true; 2 * n + 1];
        free[n + self.white] = false;
        free[2 * n] = self.has_films();
        free
    }

    /// The program of eq. 7.7, solved and reweighted several times.
    ///
    /// Unknowns are K and S as multiples of the prior.
    #[must_use]
    pub fn start(&self) -> Unknowns {
        let n = self.paints();
        let mut bounds = vec![Bound::Above(0.0); 2 * n];
        bounds[n + self.white] = Bound::Fixed(1.0 / self.prior.s[self.white]);
        let mut found = self.prior.clone();
        found.s[self.white] = 1.0;
        for _ in 0..REWEIGHTINGS {
            let mut equations = NormalEquations::new(2 * n);
            for one in self.observations.iter().filter(|one| one.film.is_none()) {
                let r = self.surface.internal(one.reading).clamp(1e-3, 0.9999);
                let q = (1.0 - r) * (1.0 - r) / (2.0 * r);
                let by_q = 2.0 * r * r / (1.0 - r * r) * self.surface.reading(r).1;
                let (_, s) = found.mixed(one.shares);
                let weight = by_q * self.precision(one) / s;
                let mut row = Vec::new();
                for (j, share) in one.shares.iter().enumerate().filter(|(_, c)| **c > 0.0) {
                    row.push((j, weight * share * self.prior.k[j]));
                    row.push((n + j, -weight * q * share * self.prior.s[j]));
                }
                equations.add(&row, 0.0);
            }
            for i in 0..2 * n {
                equations.add(&[(i, 1.0 / PRIOR_SD)], 1.0 / PRIOR_SD);
            }
            let Some(x) = minimise(&equations, &bounds) else {
                break;
            };
            // A value of 0 could not come back in logarithms.
            for j in 0..n {
                found.k[j] = self.prior.k[j] * x[j].max(1e-4);
                found.s[j] = self.prior.s[j] * x[n + j].max(1e-3);
            }
            found.s[self.white] = 1.0;
        }
        found
    }

    /// Iterates from `found` to the least squares of readings and prior.
    #[must_use]
    pub fn refine(&self, mut found: Unknowns) -> Unknowns {
        let free = self.free();
        let mut cost = self.cost(&found);
        let mut reach = ln(LARGEST_FACTOR);
        for _ in 0..STEPS {
            let bounds: Vec<Bound> = free
                .iter()
                .map(|free| {
                    if *free {
                        Bound::Between(-reach, reach)
                    } else {
                        Bound::Fixed(0.0)
                    }
                })
                .collect();
            let Some(step) = minimise(&self.linearised(&found), &bounds) else {
                return found;
            };
            let there = found.moved(&step);
            let cost_there = self.cost(&there);
            let far = step.iter().fold(0.0f64, |far, by| far.max(by.abs()));
            if cost_there <= cost {
                (found, cost) = (there, cost_there);
                reach = (2.0 * reach).min(ln(LARGEST_FACTOR));
            } else {
                reach = 0.25 * far;
            }
            if far < 1e-8 || reach < 1e-9 {
                break;
            }
        }
        found
    }

    /// The sum of squares that [`refine`](Self::refine) makes least.
    #[must_use]
    pub fn cost(&self, at: &Unknowns) -> f64 {
        let readings = self.observations.iter().map(|one| {
            let off = one.model(at, &self.surface).value - one.reading;
            let off = off * self.precision(one);
            off * off
        });
        let prior = self.prior_rows(at).into_iter().map(|(_, weight, off)| {
            let off = weight * off;
            off * off
        });
        readings.sum::<f64>() + prior.sum::<f64>()
    }

    /// Normal equations in steps of ln K, ln S and ln u; P⁻¹ is the covariance.
    #[must_use]
    pub fn linearised(&self, at: &Unknowns) -> NormalEquations {
        let mut equations = NormalEquations::new(2 * self.paints() + 1);
        for one in &self.observations {
            let (row, value) = gradient(one, at, &self.surface);
            let weight = self.precision(one);
            let row: Vec<(usize, f64)> = row.into_iter().map(|(i, a)| (i, a * weight)).collect();
            equations.add(&row, (one.reading - value) * weight);
        }
        for (i, weight, off) in self.prior_rows(at) {
            equations.add(&[(i, weight)], -weight * off);
        }
        equations
    }

    /// Rows of the prior: (index, weight, ln of the ratio to the prior).
    fn prior_rows(&self, at: &Unknowns) -> Vec<(usize, f64, f64)> {
        let n = self.paints();
        let mut rows = Vec::new();
        for j in 0..n {
            rows.push((j, 1.0 / PRIOR_SD, ln(at.k[j] / self.prior.k[j])));
            if j != self.white {
                rows.push((n + j, 1.0 / PRIOR_SD, ln(at.s[j] / self.prior.s[j])));
            }
        }
        if self.has_films() {
            rows.push((2 * n, 1.0 / UNIT_SD, ln(at.unit / self.prior.unit)));
        }
        rows
    }
}

/// The reading's derivatives by ln K, ln S and ln u, and the reading.
#[must_use]
pub fn gradient(
    one: &Observation<'_>,
    at: &Unknowns,
    surface: &Surface,
) -> (Vec<(usize, f64)>, f64) {
    let n = at.k.len();
    let model = one.model(at, surface);
    let (k, s) = at.mixed(one.shares);
    let mut row = Vec::new();
    for (j, share) in one.shares.iter().enumerate().filter(|(_, c)| **c > 0.0) {
        row.push((j, model.by_ln_k * at.k[j] * share / k));
        row.push((n + j, model.by_ln_s * at.s[j] * share / s));
    }
    if one.film.is_some() {
        row.push((2 * n, model.by_ln_k + model.by_ln_s));
    }
    (row, model.value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gradient_agrees_with_central_differences() {
        let at = Unknowns {
            k: vec![2e-3, 0.4, 1.1],
            s: vec![1.0, 0.07, 0.2],
            unit: 0.8,
        };
        let shares = [0.3, 0.0, 0.7];
        for film in [None, Some((3.0, 0.6))] {
            let one = Observation {
                shares: &shares,
                film,
                reading: 0.0,
                trust: 1.0,
            };
            let surface = Surface::default();
            let mut dense = [0.0; 7];
            for (i, slope) in gradient(&one, &at, &surface).0 {
                dense[i] = slope;
            }
            for i in 0..7 {
                let value = |by: f64| {
                    let mut step = [0.0; 7];
                    step[i] = by;
                    one.model(&at.moved(&step), &surface).value
                };
                let difference = (value(1e-5) - value(-1e-5)) / 2e-5;
                assert!(
                    (difference - dense[i]).abs() < 1e-8,
                    "{i}: {difference} {}",
                    dense[i]
                );
            }
        }
    }
}
