//! A sampling rule fitted to paints and light: the few wavelengths, and their weights in XYZ, which reproduce the
//! colours of all 101 samples for films and mixtures of these paints.
//!
//! Baxter's rule (2004, § 7.7) is made for any smooth reflectance. But the reflectances of a palette
//! are few and known, so here wavelengths and weights minimise the squared colour difference
//! Σ_m e_mᵀ·M_m·e_m over mixtures and films of the palette ([`training`]). e_m is the error in XYZ of
//! the m-th one, and M_m the metric of ΔE₀₀ at its colour ([`metric`]).
//!
//! Wavelengths are found by exchange, one at a time ([`select`]), weights by least squares under two conditions
//! ([`weights`]): white is exact, and no weight is negative. Then XYZ of any reflectance from 0 to 1 lies from 0 to
//! white, without clamping. That costs nothing: over 5,000 mixtures the mean ΔE₀₀ of sixteen samples is .07, the same
//! as with weights of either sign.

mod metric;
mod normal;
mod select;
mod training;
mod weights;

use std::collections::VecDeque;
use std::sync::{Mutex, PoisonError};

use metric::Metric;
use normal::Normal;
use select::{exchange, spread};
use weights::non_negative;

use crate::cie::{Illuminant, Observer};
use crate::paints::Paint;
use crate::rule::SamplingRule;
use crate::spectrum::{SAMPLES, Spectrum, wavelength};

/// Rounds of weighing the worst samples more, so that none stands out.
const ROUNDS: usize = 3;
/// A sample this many times as wrong as the mean counts √2 times as much in the next round.
const OUTLIER_RATIO: f64 = 3.0;

/// A reflectance of the palette: its exact colour, and the metric of errors there.
struct Target {
    reflectance: [f64; SAMPLES],
    xyz: [f64; 3],
    metric: Metric,
    weight: f64,
}

/// A cached fit, with its inputs.
struct Done {
    n: usize,
    observer: Observer,
    light: Illuminant,
    paints: Vec<Paint>,
    rule: SamplingRule,
}

/// Rules that are remembered: a painter goes back and forth between a few lights.
const REMEMBERED: usize = 8;

impl SamplingRule {
    /// `n` wavelengths and weights fitted to `paints` under `light`: exact for white, weights of 0 or more, the least
    /// ΔE₀₀ from all 101 samples over mixtures and films of the paints. Without paints it is [`gauss`](Self::gauss).
    #[must_use]
    pub fn fitted(n: usize, observer: Observer, light: &Illuminant, paints: &[Paint]) -> Self {
        if paints.is_empty() {
            return Self::gauss(n, observer, light);
        }
        fit_once(n, observer, light, paints)
    }
}

/// [`fit`], cached by its inputs.
fn fit_once(n: usize, observer: Observer, light: &Illuminant, paints: &[Paint]) -> SamplingRule {
    static MEMORY: Mutex<VecDeque<Done>> = Mutex::new(VecDeque::new());
    let mut memory = MEMORY.lock().unwrap_or_else(PoisonError::into_inner);
    let same = |done: &&Done| {
        (done.n, done.observer) == (n, observer) && done.light == *light && done.paints == paints
    };
    if let Some(done) = memory.iter().find(same) {
        return done.rule.clone();
    }
    let rule = fit(n, observer, light, paints);
    if memory.len() >= REMEMBERED {
        memory.pop_front();
    }
    let (light, paints) = (light.clone(), paints.to_vec());
    memory.push_back(Done {
        n,
        observer,
        light,
        paints,
        rule: rule.clone(),
    });
    rule
}

/// The rule of `n` wavelengths for `paints` under `light`.
#[must_use]
fn fit(n: usize, observer: Observer, light: &Illuminant, paints: &[Paint]) -> SamplingRule {
    let white = light.xyz(observer, &Spectrum::flat(1.0));
    let full = SamplingRule::reference(observer, light);
    let mut targets: Vec<Target> = training::reflectances(paints)
        .into_iter()
        .map(|reflectance| {
            let xyz = full.xyz(&reflectance);
            let metric = metric::of_delta_e(xyz, white);
            Target {
                reflectance,
                xyz,
                metric,
                weight: 1.0,
            }
        })
        .collect();
    let every: Vec<usize> = (0..SAMPLES).collect();
    let mut chosen = spread(&full, n);
    exchange(&Normal::new(&targets, white, &every), &mut chosen);
    for _ in 0..ROUNDS {
        let normal = Normal::new(&targets, white, &chosen);
        let rule = rule(&chosen, &non_negative(&normal, &chosen));
        weigh(&mut targets, &rule, &chosen);
    }
    let normal = Normal::new(&targets, white, &every);
    exchange(&normal, &mut chosen);
    rule(&chosen, &non_negative(&normal, &chosen))
}

fn rule(chosen: &[usize], weights: &[[f64; 3]]) -> SamplingRule {
    SamplingRule {
        wavelengths_nm: chosen.iter().map(|i| wavelength(*i)).collect(),
        weights: weights.to_vec(),
    }
}

/// Increases the weight of targets with above-average errors.
fn weigh(targets: &mut [Target], rule: &SamplingRule, chosen: &[usize]) {
    let errors: Vec<f64> = targets
        .iter()
        .map(|target| {
            let seen: Vec<f64> = chosen.iter().map(|i| target.reflectance[*i]).collect();
            let got = rule.xyz(&seen);
            target
                .metric
                .length([0, 1, 2].map(|c| got[c] - target.xyz[c]))
        })
        .collect();
    let mean = errors.iter().sum::<f64>() / errors.len().max(1) as f64;
    let limit = OUTLIER_RATIO * mean.max(1e-12);
    for (target, error) in targets.iter_mut().zip(&errors) {
        let off = error / limit;
        target.weight *= (1.0 + off * off).sqrt();
    }
    let sum: f64 = targets.iter().map(|target| target.weight).sum();
    let scale = targets.len() as f64 / sum;
    targets.iter_mut().for_each(|target| target.weight *= scale);
}
