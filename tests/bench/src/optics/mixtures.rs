//! Mixtures that no rule was fitted to.

use maulstick_optics::spectrum::SAMPLES;
use maulstick_optics::{Paint, Spectrum, km};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng as _, SeedableRng as _};

/// Seed of the mixtures, which no test and no fit uses.
const SEED: u64 = 0x6f_7074_6963;
/// Most paints of a mixture.
const PARTS: usize = 4;
/// Thinnest and thickest film, m.
const FILMS_M: [f64; 2] = [5e-6, 2e-4];

/// Uniform in 0..1.
fn unit(random: &mut Pcg64) -> f64 {
    (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

/// Some of the paints with shares that sum to 1, uniform over the simplex (Dirichlet with all
/// parameters 1).
fn mixture<'a>(random: &mut Pcg64, paints: &'a [Paint]) -> Vec<(&'a Paint, f64)> {
    let parts = 1 + (PARTS as f64 * unit(random)) as usize;
    let mut left: Vec<&Paint> = paints.iter().collect();
    let mut drawn: Vec<(&Paint, f64)> = Vec::with_capacity(parts);
    while drawn.len() < parts && !left.is_empty() {
        let paint = left.swap_remove((unit(random) * left.len() as f64) as usize);
        drawn.push((paint, -maulstick_num::ln(1.0 - unit(random))));
    }
    let sum: f64 = drawn.iter().map(|(_, draw)| draw).sum();
    drawn.iter_mut().for_each(|(_, draw)| *draw /= sum);
    drawn
}

/// Internal reflectances of `count` mixtures: half of them masstones, half films over white or black.
pub(crate) fn held_out(paints: &[Paint], count: usize) -> Vec<Spectrum> {
    let mut random = Pcg64::seed_from_u64(SEED);
    let one = |number| {
        let parts = mixture(&mut random, paints);
        let thickness_m = FILMS_M[0] + (FILMS_M[1] - FILMS_M[0]) * unit(&mut random);
        let ground = if unit(&mut random) < 0.5 { 0.0 } else { 1.0 };
        Spectrum(std::array::from_fn::<f64, SAMPLES, _>(|i| {
            let sum = |of: fn(&Paint) -> &Spectrum| -> f64 {
                parts
                    .iter()
                    .map(|(paint, share)| share * of(paint).0[i])
                    .sum()
            };
            let (k, s) = (sum(|paint| &paint.k), sum(|paint| &paint.s));
            if number % 2 == 0 {
                km::opaque(k, s)
            } else {
                km::over(km::film(k * thickness_m, s * thickness_m), ground)
            }
        }))
    };
    (0..count).map(one).collect()
}
