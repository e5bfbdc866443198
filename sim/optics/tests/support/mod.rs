//! Mixtures that no rule was fitted to.

use maulstick_optics::{Paint, Spectrum, km};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng as _, SeedableRng as _};

/// `count` mixtures of one to four of `paints` with Dirichlet shares, in turn opaque, and films of 5
/// to 200 µm over black or white; internal reflectances.
pub(crate) fn held_out(paints: &[Paint], count: usize, seed: u64) -> Vec<Spectrum> {
    let mut random = Pcg64::seed_from_u64(seed);
    let mut unit = move || (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    let mut all = Vec::with_capacity(count);
    for number in 0..count {
        let parts = 1 + (4.0 * unit()) as usize;
        let mut mixed: Vec<(usize, f64)> = Vec::new();
        while mixed.len() < parts {
            let paint = (unit() * paints.len() as f64) as usize;
            if mixed.iter().all(|(other, _)| *other != paint) {
                mixed.push((paint, -maulstick_num::ln(1.0 - unit())));
            }
        }
        let sum: f64 = mixed.iter().map(|(_, draw)| draw).sum();
        let total = |of: &dyn Fn(&Paint) -> f64| -> f64 {
            let parts = mixed.iter();
            parts
                .map(|(paint, draw)| draw / sum * of(&paints[*paint]))
                .sum()
        };
        let thickness_m = 5e-6 + 195e-6 * unit();
        let ground = if unit() < 0.5 { 0.0 } else { 1.0 };
        all.push(Spectrum(std::array::from_fn(|i| {
            let (k, s) = (total(&|paint| paint.k.0[i]), total(&|paint| paint.s.0[i]));
            if number % 2 == 0 {
                km::opaque(k, s)
            } else {
                km::over(km::film(k * thickness_m, s * thickness_m), ground)
            }
        })));
    }
    all
}
