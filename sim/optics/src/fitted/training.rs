//! Reflectances for fitting a rule: masstones, tints, films and mixtures of the paints.

use maulstick_num::ln;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng as _, SeedableRng as _};

use crate::km::{film, opaque, over};
use crate::paints::Paint;
use crate::spectrum::SAMPLES;
use crate::surface::SurfaceCorrection;

/// Number of random mixtures.
const MIXTURES: usize = 1200;
/// Seed of the mixtures.
const SEED: u64 = 0x6d61_756c;
/// Most paints of a mixture.
const PARTS: usize = 4;
/// Thinnest and thickest film, m.
const FILMS_M: [f64; 2] = [5e-6, 2e-4];

/// K and S of a mixture.
struct Mixed {
    k: [f64; SAMPLES],
    s: [f64; SAMPLES],
}

impl Mixed {
    fn of(parts: &[(&Paint, f64)]) -> Self {
        let sum = |pick: &dyn Fn(&Paint, usize) -> f64| {
            std::array::from_fn(|i| {
                parts
                    .iter()
                    .map(|(paint, share)| share * pick(paint, i))
                    .sum()
            })
        };
        Self {
            k: sum(&|paint, i| paint.k.0[i]),
            s: sum(&|paint, i| paint.s.0[i]),
        }
    }

    fn opaque(&self) -> [f64; SAMPLES] {
        std::array::from_fn(|i| opaque(self.k[i], self.s[i]))
    }

    fn film(&self, thickness_m: f64, ground: f64) -> [f64; SAMPLES] {
        std::array::from_fn(|i| {
            over(
                film(self.k[i] * thickness_m, self.s[i] * thickness_m),
                ground,
            )
        })
    }
}

/// Uniform in 0..1.
fn unit(random: &mut Pcg64) -> f64 {
    (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

/// Shares that sum to 1, uniform over the simplex (Dirichlet with all parameters 1).
fn shares(random: &mut Pcg64, count: usize) -> Vec<f64> {
    let draws: Vec<f64> = (0..count).map(|_| -ln(1.0 - unit(random))).collect();
    let sum: f64 = draws.iter().sum::<f64>().max(1e-300);
    draws.iter().map(|draw| draw / sum).collect()
}

/// `count` random mixtures of one to four of `paints`, half of them opaque and half as films over
/// black or white; internal reflectances.
pub(super) fn mixtures(paints: &[Paint], count: usize, seed: u64) -> Vec<[f64; SAMPLES]> {
    if paints.is_empty() {
        return Vec::new();
    }
    let mut random = Pcg64::seed_from_u64(seed);
    let mut draw = |bound: usize| (unit(&mut random) * bound as f64) as usize;
    let mut drawn = Vec::with_capacity(count);
    for _ in 0..count {
        let parts = 1 + draw(PARTS.min(paints.len()));
        let mut chosen: Vec<usize> = Vec::with_capacity(parts);
        while chosen.len() < parts {
            let paint = draw(paints.len());
            if !chosen.contains(&paint) {
                chosen.push(paint);
            }
        }
        drawn.push(chosen);
    }
    drawn
        .iter()
        .map(|chosen| {
            let shares = shares(&mut random, chosen.len());
            let parts: Vec<(&Paint, f64)> =
                chosen.iter().map(|i| &paints[*i]).zip(shares).collect();
            let mixed = Mixed::of(&parts);
            if unit(&mut random) < 0.5 {
                return mixed.opaque();
            }
            let thickness_m = FILMS_M[0] + unit(&mut random) * (FILMS_M[1] - FILMS_M[0]);
            mixed.film(thickness_m, if unit(&mut random) < 0.5 { 0.0 } else { 1.0 })
        })
        .collect()
}

/// Each paint alone: its masstone, its tints with the strongest scatterer, its films.
fn alone(paints: &[Paint]) -> Vec<[f64; SAMPLES]> {
    let brightness = |paint: &Paint| paint.s.0.iter().sum::<f64>();
    let white = paints
        .iter()
        .max_by(|a, b| brightness(a).total_cmp(&brightness(b)));
    let mut all = Vec::new();
    for paint in paints {
        for share in [1.0, 0.5, 0.1, 0.02] {
            let parts = white.map(|white| [(paint, share), (white, 1.0 - share)]);
            all.extend(parts.map(|parts| Mixed::of(&parts).opaque()));
        }
        let pure = Mixed::of(&[(paint, 1.0)]);
        for thickness_m in [5e-6, 2e-5, 8e-5, 2e-4] {
            all.extend([0.0, 1.0].map(|ground| pure.film(thickness_m, ground)));
        }
    }
    all
}

/// All that a rule should show well: internal reflectances, and the same through the surface.
pub(super) fn reflectances(paints: &[Paint]) -> Vec<[f64; SAMPLES]> {
    let surface = SurfaceCorrection::default();
    let mut all = alone(paints);
    all.extend(mixtures(paints, MIXTURES, SEED));
    let seen: Vec<_> = all.iter().map(|r| r.map(|r| surface.measured(r))).collect();
    all.extend(seen);
    all
}
