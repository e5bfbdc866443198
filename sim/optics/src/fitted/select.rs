//! Selection of wavelengths, by exchange of one after the other for a better one.
//!
//! White enters as one more reflectance of great weight, so that the gain of a wavelength follows from bordering a
//! Cholesky factor: with A = L·Lᵀ of the others and z = L⁻¹·b, a wavelength with the columns B and the block D lowers
//! the sum of squares by rᵀ·(D − YᵀY)⁻¹·r, Y = L⁻¹·B, r = b − Yᵀ·z.

use super::normal::Normal;
use super::weights::Factor;
use crate::colour::solve3;
use crate::rule::SamplingRule;
use crate::spectrum::SAMPLES;

/// Weight of white, in mean diagonals of the normal matrix.
const WHITE: f64 = 1e3;
/// Rounds over all wavelengths; it settles after four to eight.
const SWEEPS: usize = 24;

/// Wavelengths whose columns are solved for together: their sums stay in registers.
const RUN: usize = 6;

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
pub(super) fn exchange(normal: &Normal, chosen: &mut [usize]) {
    for _ in 0..SWEEPS {
        let mut settled = true;
        for place in 0..chosen.len() {
            let others: Vec<usize> = chosen
                .iter()
                .enumerate()
                .filter(|(i, _)| *i != place)
                .map(|(_, p)| *p)
                .collect();
            let gains = Border::new(normal, &others).gains(normal);
            let now = gains[chosen[place]];
            let best = (0..SAMPLES)
                .filter(|p| !others.contains(p))
                .map(|p| (gains[p], p))
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

    /// By how much each wavelength lowers the sum of squares.
    fn gains(&self, normal: &Normal) -> Vec<f64> {
        let (rows, z) = (&self.factor.rows, &self.z);
        // D − YᵀY and r of each wavelength.
        let mut left = vec![([[0.0; 3]; 3], [0.0; 3]); SAMPLES];
        for (at, left) in left.chunks_mut(RUN).enumerate() {
            let from = 3 * RUN * at;
            let width = 3 * left.len();
            let mut y: Vec<[f64; 3 * RUN]> = Vec::with_capacity(rows.len());
            for (row, unknown) in rows.iter().zip(&self.unknowns) {
                let mut sum = [0.0; 3 * RUN];
                for (l, y) in row.iter().zip(&y) {
                    sum.iter_mut().zip(y).for_each(|(sum, y)| *sum += l * y);
                }
                let mut new = [0.0; 3 * RUN];
                let b = &normal.row(*unknown)[from..from + width];
                for (i, (new, b)) in new.iter_mut().zip(b).enumerate() {
                    let white = if i % 3 == unknown % 3 {
                        self.white
                    } else {
                        0.0
                    };
                    *new = (b + white - sum[i]) / row[y.len()];
                }
                y.push(new);
            }
            for (n, (block, r)) in left.iter_mut().enumerate() {
                for i in 0..3 {
                    let own = 3 * n + i;
                    for j in 0..3 {
                        let dot: f64 = y.iter().map(|y| y[own] * y[3 * n + j]).sum();
                        block[i][j] = entry(normal, self.white, from + own, from + 3 * n + j) - dot;
                    }
                    let dot: f64 = y.iter().zip(z).map(|(y, z)| y[own] * z).sum();
                    r[i] = pull(normal, self.white, from + own) - dot;
                }
            }
        }
        let gain = |(block, r): &([[f64; 3]; 3], [f64; 3])| {
            let x = solve3(block, *r);
            (0..3).map(|c| r[c] * x[c]).sum()
        };
        left.iter().map(gain).collect()
    }
}

fn entry(normal: &Normal, white: f64, p: usize, q: usize) -> f64 {
    normal.a(p, q) + if p % 3 == q % 3 { white } else { 0.0 }
}

fn pull(normal: &Normal, white: f64, p: usize) -> f64 {
    normal.b(p) + white * normal.white[p % 3]
}
