//! Paint within the head: paint inside a strip rises to its surface as the film there is used up, the film's excess
//! over its fill goes inside, and inside it creeps along the strip.
//!
//! This happens in every strip, even in one that is the lowest of no cell at the moment, because their number depends
//! on the cell size.

use maulstick_num::select::larger;
use maulstick_num::wide;

use maulstick_model::brush::load::{PaintOnBrush, film_share};
use maulstick_model::brush::traits::{BrushTraits, TEXELS_PER_STRIP};
use maulstick_model::interface::Step;

/// Counts a step and moves paint within the strips.
pub fn flow(step: &mut Step<'_>) {
    step.load.count_step();
    let (films, paints) = step.load.parts_mut();
    let mut paints: Vec<PaintOnBrush<'_>> = paints.collect();
    let thinner = paints.iter().position(|p| Some(p.slot) == step.thinner);
    let capacity = step.head.capacity();
    flow_in_strips(films, &mut paints, thinner, capacity, &step.traits);
}

wide! {
    fn flow_in_strips(
        films: &mut [u32],
        paints: &mut [PaintOnBrush<'_>],
        thinner: Option<usize>,
        capacity: &[f32],
        traits: &BrushTraits,
    ) {
        let strips = films.as_chunks_mut::<TEXELS_PER_STRIP>().0.iter_mut().zip(capacity);
        for (strip, (film, capacity)) in strips.enumerate() {
            let inside = all_inside(strip, paints);
            let thin = thinner.map_or(0.0, |thinner| {
                let there = film.iter().chain(&inside).map(|count| f64::from(*count)).sum();
                thinner_in(strip, &paints[thinner], there)
            });
            let full = traits.film_full * f64::from(*capacity) * film_share(thin);
            if is_at_rest(film, &inside, full, traits) {
                continue;
            }
            let shares = Shares::of(film, &inside, full, traits);
            *film = [0; TEXELS_PER_STRIP];
            for paint in &mut *paints {
                move_paint(strip, paint, &shares);
                let counts = film.iter_mut().zip(of_strip(strip, paint.film));
                counts.for_each(|(sum, count)| *sum += *count);
            }
        }
    }
}

/// The texels of a strip.
#[inline(always)]
fn of_strip(strip: usize, plane: &[u32]) -> &[u32; TEXELS_PER_STRIP] {
    &plane.as_chunks().0[strip]
}

/// Sum of all paints inside a strip.
#[inline(always)]
fn all_inside(strip: usize, paints: &[PaintOnBrush<'_>]) -> [u32; TEXELS_PER_STRIP] {
    let mut all = [0; TEXELS_PER_STRIP];
    for paint in paints {
        let inside = of_strip(strip, paint.inside);
        all.iter_mut()
            .zip(inside)
            .for_each(|(sum, count)| *sum += *count);
    }
    all
}

/// Share of thinner in the `all` that a strip carries.
#[inline(always)]
fn thinner_in(strip: usize, thinner: &PaintOnBrush<'_>, all: f64) -> f64 {
    let planes = [&*thinner.film, &*thinner.inside].into_iter();
    let counts = planes.flat_map(|plane| of_strip(strip, plane));
    let thin: f64 = counts.map(|count| f64::from(*count)).sum();
    if all > 0.0 { thin / all } else { 0.0 }
}

/// True if no quantum would move, as in most strips of a brush.
#[inline(always)]
fn is_at_rest(
    film: &[u32; TEXELS_PER_STRIP],
    inside: &[u32; TEXELS_PER_STRIP],
    full: f64,
    traits: &BrushTraits,
) -> bool {
    let (mut off, mut falls) = (0, 0);
    for count in film {
        off = off.max(count.abs_diff(full as u32));
    }
    for k in 1..TEXELS_PER_STRIP {
        falls = falls.max(inside[k].abs_diff(inside[k - 1]));
    }
    traits.refill * (f64::from(off) + 1.0) < 1.0 && traits.creep * f64::from(falls) < 1.0
}

/// Shares of the paint inside a strip that go to the film, to the next texel and to the one before, and of the film
/// that go inside.
#[derive(Clone, Copy, Debug, Default)]
struct Shares {
    out: [f64; TEXELS_PER_STRIP],
    onward: [f64; TEXELS_PER_STRIP],
    back: [f64; TEXELS_PER_STRIP],
    inward: [f64; TEXELS_PER_STRIP],
}

impl Shares {
    #[inline(always)]
    fn of(
        film: &[u32; TEXELS_PER_STRIP],
        inside: &[u32; TEXELS_PER_STRIP],
        full: f64,
        traits: &BrushTraits,
    ) -> Self {
        let mut shares = Self::default();
        let (film, inside) = (film.map(f64::from), inside.map(f64::from));
        // Reciprocals of the counts; an empty one gives nothing, whatever its share.
        let by = inside.map(|count| 1.0 / larger(count, 1.0));
        for k in 0..TEXELS_PER_STRIP {
            let missing = full - film[k];
            let lacks = larger(missing, 0.0) * by[k];
            shares.out[k] = traits.refill * if lacks < 1.0 { lacks } else { 1.0 };
            shares.inward[k] = traits.refill * larger(-missing, 0.0) / larger(film[k], 1.0);
        }
        for k in 0..TEXELS_PER_STRIP - 1 {
            let fall = traits.creep * (inside[k] - inside[k + 1]);
            shares.onward[k] = larger(fall, 0.0) * by[k];
            shares.back[k + 1] = larger(-fall, 0.0) * by[k + 1];
        }
        // On coarse cells a step is long: outflow beyond the stock stays.
        for k in 0..TEXELS_PER_STRIP {
            let leaves = shares.out[k] + shares.onward[k] + shares.back[k];
            let stays = 1.0 / larger(leaves, 1.0);
            shares.out[k] *= stays;
            shares.onward[k] *= stays;
            shares.back[k] *= stays;
        }
        shares
    }
}

/// A share of a count, truncated.
#[inline(always)]
pub(super) fn part(count: u32, share: f64) -> u32 {
    // The low bits of a number from 2⁵² on are its integer part, and unlike a cast they are read four at a time.
    const WHOLE: f64 = 4_503_599_627_370_496.0;
    ((f64::from(count) * share).floor() + WHOLE).to_bits() as u32
}

/// Moves one paint within a strip.
#[inline(always)]
fn move_paint(strip: usize, paint: &mut PaintOnBrush<'_>, shares: &Shares) {
    let film: &mut [u32; TEXELS_PER_STRIP] = &mut paint.film.as_chunks_mut().0[strip];
    let inside: &mut [u32; TEXELS_PER_STRIP] = &mut paint.inside.as_chunks_mut().0[strip];
    let before = *inside;
    // Nothing flows over the end of a strip.
    let mut onward = [0; TEXELS_PER_STRIP + 1];
    let mut back = [0; TEXELS_PER_STRIP + 1];
    for k in 0..TEXELS_PER_STRIP {
        onward[k + 1] = part(before[k], shares.onward[k]);
        back[k] = part(before[k], shares.back[k]);
    }
    for k in 0..TEXELS_PER_STRIP {
        let rises = part(before[k], shares.out[k]);
        let sinks = part(film[k], shares.inward[k]);
        film[k] = film[k] + rises - sinks;
        inside[k] = before[k] - rises - onward[k + 1] - back[k] + sinks + onward[k] + back[k + 1];
    }
}

#[cfg(test)]
mod tests {
    use maulstick_brush::BrushFile;

    use super::*;

    /// Exactly the strips without any movement are skipped: one quantum more moves.
    #[test]
    fn only_strips_at_rest_are_left_out() {
        let file = BrushFile::library("round").expect("round");
        let traits = BrushTraits::of(&file, 2.5e-4, 1.0);
        let full = 1_000_000.5;
        let moves = |film: &[u32; TEXELS_PER_STRIP], inside: &[u32; TEXELS_PER_STRIP]| {
            let shares = Shares::of(film, inside, full, &traits);
            (0..TEXELS_PER_STRIP).any(|k| {
                let leaves = [shares.out[k], shares.onward[k], shares.back[k]];
                let leaves = leaves.into_iter().any(|share| part(inside[k], share) > 0);
                leaves || part(film[k], shares.inward[k]) > 0
            })
        };
        let mut seen = [0; 2];
        for off in -40_i32..=40 {
            let (mut film, mut inside) = (
                [1_000_000_u32; TEXELS_PER_STRIP],
                [200_000; TEXELS_PER_STRIP],
            );
            let place = (off + 40) as usize % TEXELS_PER_STRIP;
            film[place] = film[place].saturating_add_signed(off);
            for falls in [false, true] {
                if falls {
                    (film, inside[place]) = ([1_000_000; TEXELS_PER_STRIP], film[place] - 800_000);
                }
                let (rests, moves) = (
                    is_at_rest(&film, &inside, full, &traits),
                    moves(&film, &inside),
                );
                assert!(!rests || !moves, "{off}: at rest, but paint would move");
                seen[usize::from(rests)] += 1;
                assert!(rests || moves || off.abs() < 15, "{off}: nothing moves");
            }
        }
        assert!(seen.iter().all(|seen| *seen > 20), "{seen:?}");
    }
}
