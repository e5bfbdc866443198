//! The reservoir of a brush (Baxter 2004, fig. 4.2): it fills the surface layer again where that is low, in whole deep
//! units of 32 of the surface, and takes up what the surface has too much. Paint higher up on a bristle runs down to where
//! it is used, as from a reservoir.

use maulstick_canvas::quantum::QUANTA_PER_UNIT;
use maulstick_model::brush::load::PaintOnBrush;
use maulstick_model::brush::traits::TEXELS_PER_STRIP;
use maulstick_model::interface::Step;

use crate::dither::{Dither, whole};
use crate::volume::{DEEP, UNIT};

/// Quanta that go from a texel's reservoir to its surface, or back where negative.
///
/// `surface` and `inside` are what both hold, `full` is what they hold on a full brush, `deep` a deep unit.
#[must_use]
pub fn flows(
    [surface, inside]: [f64; 2],
    full: [f64; 2],
    deep: f64,
    (rate, threshold): (f64, f32),
) -> f64 {
    let units = |quanta: f64| f64::from(whole((rate * quanta / deep) as f32, threshold)) * deep;
    match full[0] - surface {
        lack if lack > 0.0 => units(lack).min(inside),
        lack => -units(-lack).min((full[1] - inside).max(0.0)).min(surface),
    }
}

/// Quanta that run down a bristle from one texel's surface to the next one's, which holds less, in deep units.
#[must_use]
pub fn runs([upper, lower]: [f64; 2], deep: f64, (rate, threshold): (f64, f32)) -> f64 {
    let even = 0.5 * (upper - lower).max(0.0);
    (f64::from(whole((rate * even / deep) as f32, threshold)) * deep).min(upper)
}

/// A paint moved from one place of a texel to another, by slot the same share of each.
fn share_out(from: &mut u32, to: &mut u32, share: f64) {
    let goes = (f64::from(*from) * share) as u32;
    (*from, *to) = (*from - goes, to.saturating_add(goes));
}

/// Moves paint between the reservoirs and the surfaces of the strips of these texels, and down the strips, as chance has
/// it in the step of these thresholds.
pub fn refill(step: &mut Step<'_>, texels: impl Iterator<Item = u32>, dither: Dither) {
    let traits = &step.traits;
    let deep =
        f64::from(DEEP * UNIT) / (QUANTA_PER_UNIT * f64::from(traits.film_units_per_quantum));
    // The rate is that of two steps.
    let rate = 1.0 - (1.0 - traits.refill).max(0.0).sqrt();
    let full = [traits.film_full, traits.inside_full];
    let mut strips: Vec<usize> = texels
        .map(|texel| texel as usize / TEXELS_PER_STRIP)
        .collect();
    strips.sort_unstable();
    strips.dedup();
    let (films, paints) = step.load.parts_mut();
    let mut paints: Vec<_> = paints.collect();
    for strip in strips {
        let first = strip * TEXELS_PER_STRIP;
        let on = |paints: &[PaintOnBrush<'_>], texel: usize| {
            let sum = |of: fn(&PaintOnBrush<'_>, usize) -> u32| -> f64 {
                paints.iter().map(|paint| f64::from(of(paint, texel))).sum()
            };
            [
                sum(|paint, at| paint.film[at]),
                sum(|paint, at| paint.inside[at]),
            ]
        };
        // From the point up: what runs down in one step goes a texel far.
        for texel in (first..first + TEXELS_PER_STRIP).rev() {
            let threshold = |row| dither.at([texel as i64, row]);
            let [surface, inside] = on(&paints, texel);
            let flow = flows([surface, inside], full, deep, (rate, threshold(0)));
            for paint in &mut paints {
                let (film, inside_of) = (&mut paint.film[texel], &mut paint.inside[texel]);
                if flow > 0.0 {
                    share_out(inside_of, film, flow / inside);
                } else if flow < 0.0 {
                    share_out(film, inside_of, -flow / surface);
                }
            }
            if texel > first {
                let [lower, _] = on(&paints, texel);
                let [upper, _] = on(&paints, texel - 1);
                let flow = runs([upper, lower], deep, (rate, threshold(1)));
                for paint in &mut paints {
                    let (above, below) = paint.film.split_at_mut(texel);
                    if flow > 0.0 {
                        share_out(&mut above[texel - 1], &mut below[0], flow / upper);
                    }
                }
            }
        }
        for texel in first..first + TEXELS_PER_STRIP {
            films[texel] = paints.iter().map(|paint| paint.film[texel]).sum();
        }
    }
}
