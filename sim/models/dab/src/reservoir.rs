//! The reservoir of a brush (Baxter 2004, fig. 4.2): it refills the surface layer where that is low, in whole deep
//! units of 32 surface units, and takes up its excess. Paint higher up on a bristle runs down to where it is used, as
//! from a reservoir.

use maulstick_canvas::quantum::QUANTA_PER_UNIT;
use maulstick_model::brush::load::{BrushLoad, PaintOnBrush};
use maulstick_model::brush::traits::{BrushTraits, TEXELS_PER_STRIP};

use crate::dither::{Dither, whole};
use crate::volume::{RESERVOIR_UNIT, UNIT};

/// Quanta from a texel's reservoir to its surface, or back where negative.
///
/// `surface` and `inside` are the quanta of both, `full` those of a full brush, `deep` a deep unit.
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

/// Quanta, in whole deep units, that run down a bristle from one texel's surface to the next one's, which holds less.
#[must_use]
pub fn runs([upper, lower]: [f64; 2], deep: f64, (rate, threshold): (f64, f32)) -> f64 {
    let even = 0.5 * (upper - lower).max(0.0);
    (f64::from(whole((rate * even / deep) as f32, threshold)) * deep).min(upper)
}

/// Moves a share of all paints from one place of a texel to another; the share is the same in each slot.
fn share_out(from: &mut u32, to: &mut u32, share: f64) {
    let goes = (f64::from(*from) * share) as u32;
    (*from, *to) = (*from - goes, to.saturating_add(goes));
}

/// Refilling of a brush's surface along a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refill {
    /// Quanta of a deep unit of a texel.
    pub deep: f64,
    /// Quanta of a full brush on the surface and inside of a texel.
    pub full: [f64; 2],
    /// Share of the deficit that is refilled.
    pub rate: f64,
}

impl Refill {
    /// Refilling of a brush with these traits along a path of `cells`.
    #[must_use]
    pub fn of(traits: &BrushTraits, cells: f32) -> Self {
        let units = QUANTA_PER_UNIT * f64::from(traits.film_units_per_quantum);
        let steps = f64::from(cells / traits.step_cells);
        let kept = (1.0 - traits.refill).max(1e-9);
        Self {
            deep: f64::from(RESERVOIR_UNIT * UNIT) / units,
            full: [traits.film_full, traits.inside_full],
            rate: 1.0 - maulstick_num::powf(kept, steps),
        }
    }
}

/// Moves paint between the reservoirs and the surfaces of these strips, and down the strips, rounded by the thresholds
/// of the step. The load's films must be [counted](BrushLoad::count_films) afterwards.
pub fn refill(
    load: &mut BrushLoad,
    refill: &Refill,
    strips: impl IntoIterator<Item = usize>,
    dither: Dither,
) {
    let (_, paints) = load.parts_mut();
    let mut paints: Vec<_> = paints.collect();
    for strip in strips {
        let first = strip * TEXELS_PER_STRIP;
        let mut on: [[f64; 2]; TEXELS_PER_STRIP] =
            std::array::from_fn(|place| held(&paints, first + place));
        let thresholds: [[f32; TEXELS_PER_STRIP]; 2] =
            [0, 1].map(|row| dither.along([first as i64, row]));
        // From the point up, so that paint runs down by one texel a step.
        for place in (0..TEXELS_PER_STRIP).rev() {
            let texel = first + place;
            let [surface, inside] = on[place];
            let chance = (refill.rate, thresholds[0][place]);
            let flow = flows(on[place], refill.full, refill.deep, chance);
            if flow != 0.0 {
                for paint in &mut paints {
                    let (film, inside_of) = (&mut paint.film[texel], &mut paint.inside[texel]);
                    if flow > 0.0 {
                        share_out(inside_of, film, flow / inside);
                    } else {
                        share_out(film, inside_of, -flow / surface);
                    }
                }
                on[place] = held(&paints, texel);
            }
            if place == 0 {
                continue;
            }
            let both = [on[place - 1][0], on[place][0]];
            let flow = runs(both, refill.deep, (refill.rate, thresholds[1][place]));
            if flow > 0.0 {
                for paint in &mut paints {
                    let (above, below) = paint.film.split_at_mut(texel);
                    share_out(&mut above[texel - 1], &mut below[0], flow / both[0]);
                }
                for place in [place - 1, place] {
                    on[place] = held(&paints, first + place);
                }
            }
        }
    }
}

/// Quanta of all paints on the surface and inside of a texel.
fn held(paints: &[PaintOnBrush<'_>], texel: usize) -> [f64; 2] {
    let both = paints.iter().fold([0; 2], |[film, inside], paint| {
        [
            film + u64::from(paint.film[texel]),
            inside + u64::from(paint.inside[texel]),
        ]
    });
    both.map(|quanta| quanta as f64)
}
