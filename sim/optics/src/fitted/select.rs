//! Which wavelengths: exchange of one after the other for a better one.
//!
//! White enters as one more reflectance of great weight, so that what a wavelength adds follows from
//! bordering a Cholesky factor: with A = L·Lᵀ of the others and z = L⁻¹·b, a wavelength with the
//! columns B and the block D lowers the sum of squares by rᵀ·(D − YᵀY)⁻¹·r, Y = L⁻¹·B,
//! r = b − Yᵀ·z.

use super::weights::{Factor, Normal};
use crate::colour::solve3;
use crate::rule::SamplingRule;
use crate::spectrum::SAMPLES;

/// Weight of white, in mean diagonals of the normal matrix.
const WHITE: f64 = 1e3;
/// Rounds over all wavelengths; it settles after four to eight.
const SWEEPS: usize = 24;

/// `n` wavelengths such that each stands for the same share of X + Y + Z, to begin with.
pub(super) fn spread(full: &SamplingRule, n: usize) -> Vec<usize> {
    let power: Vec<f64> = full.weights.iter().map(|w| w.iter().sum::<f64>()).collect();
    let total: f64 = power.iter().sum();
    let mut chosen: Vec<usize> = Vec::with_capacity(n);
    let (mut below, mut at) = (0.0, 0);
    for k in 0..n {
        let aim = total * (k as f64 + 0.5) / n as f64;
        while at + 1 < SAMPLES && below + power[at] < aim {
            below += power[at];
            at += 1;
        }
        let least = chosen.last().map_or(0, |last| last + 1);
        chosen.push(at.max(least).min(SAMPLES - (n - k)));
    }
    chosen
}

/// Exchanges wavelengths until no single exchange lowers the sum of squares.
pub(super) fn exchange(normal: &Normal, chosen: &mut Vec<usize>) {
    for _ in 0..SWEEPS {
        let mut settled = true;
        for place in 0..chosen.len() {
            let others: Vec<usize> = chosen
                .iter()
                .enumerate()
                .filter(|(i, _)| *i != place)
                .map(|(_, p)| *p)
                .collect();
            let border = Border::new(normal, &others);
            let now = border.gain(normal, chosen[place]);
            let best = (0..SAMPLES)
                .filter(|p| !others.contains(p))
                .map(|p| (border.gain(normal, p), p))
                .max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
            if let Some((gain, p)) = best
                && gain > now * (1.0 + 1e-12)
            {
                chosen[place] = p;
                settled = false;
            }
        }
        if settled {
            break;
        }
    }
    chosen.sort_unstable();
}

/// The factor of all wavelengths but one.
struct Border {
    unknowns: Vec<usize>,
    factor: Factor,
    z: Vec<f64>,
    white: f64,
}

impl Border {
    fn new(normal: &Normal, others: &[usize]) -> Self {
        let unknowns: Vec<usize> = others
            .iter()
            .flat_map(|p| [3 * p, 3 * p + 1, 3 * p + 2])
            .collect();
        let white = WHITE * normal.scale();
        let mut factor = Factor::default();
        for n in 0..unknowns.len() {
            let row: Vec<f64> = unknowns[..=n]
                .iter()
                .map(|q| entry(normal, white, unknowns[n], *q))
                .collect();
            factor.grow(&row);
        }
        let pull: Vec<f64> = unknowns.iter().map(|p| pull(normal, white, *p)).collect();
        let z = factor.forward(&pull);
        Self {
            unknowns,
            factor,
            z,
            white,
        }
    }

    /// By how much wavelength `p` lowers the sum of squares.
    fn gain(&self, normal: &Normal, p: usize) -> f64 {
        let columns = [0, 1, 2].map(|c| {
            let column: Vec<f64> = self
                .unknowns
                .iter()
                .map(|q| entry(normal, self.white, *q, 3 * p + c))
                .collect();
            self.factor.forward(&column)
        });
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let block = [0, 1, 2].map(|i| {
            [0, 1, 2].map(|j: usize| {
                entry(normal, self.white, 3 * p + i, 3 * p + j) - dot(&columns[i], &columns[j])
            })
        });
        let r = [0, 1, 2].map(|c| pull(normal, self.white, 3 * p + c) - dot(&columns[c], &self.z));
        let x = solve3(&block, r);
        (0..3).map(|c| r[c] * x[c]).sum()
    }
}

fn entry(normal: &Normal, white: f64, p: usize, q: usize) -> f64 {
    normal.a(p, q) + if p % 3 == q % 3 { white } else { 0.0 }
}

fn pull(normal: &Normal, white: f64, p: usize) -> f64 {
    normal.b(p) + white * normal.white[p % 3]
}
