//! Paint between bristles: it seeps from a fuller film to a thinner one beside it, from strip to strip and along each
//! strip.
//!
//! Only the amount that evens the films out goes over, with the mixture of the fuller one: so the whole head feeds the
//! bristles that touch, and adjacent colours stay distinct. Between strips the yield stress holds a difference, so that
//! a fuller bristle paints its streak to the end; along a strip a thin film clings, so that paint that a clean brush
//! takes up stays near its tips, and the tips of a brush that is painted out starve.

use maulstick_num::select::larger;
use maulstick_num::wide;

use maulstick_model::brush::load::PaintOnBrush;
use maulstick_model::brush::traits::{BrushTraits, TEXELS_PER_STRIP};
use maulstick_model::interface::Step;

use super::bristle_flow::part;

/// Evens films out: between strips of either order in turn, and along them.
pub fn seep(step: &mut Step<'_>) {
    let steps = step.load.steps();
    let seep = step.traits.seep;
    let holds = BrushTraits::HOLDS * step.traits.film_full;
    let (films, paints) = step.load.parts_mut();
    let mut paints: Vec<PaintOnBrush<'_>> = paints.collect();
    let order = &step.head.beside()[(steps % 2) as usize];
    let first = (steps / 2 % 2) as usize;
    between_strips(films, &mut paints, &order[first..], seep.beside, holds);
    along_strips(films, &mut paints, [seep.along, seep.clings], steps);
}

wide! {
    fn between_strips(
        films: &mut [u32],
        paints: &mut [PaintOnBrush<'_>],
        order: &[u32],
        share: f64,
        holds: f64,
    ) {
        for pair in order.as_chunks::<2>().0 {
            let pair = pair.map(|strip| strip as usize);
            let [one, other] = of_strips(films, pair);
            let (mut on, mut back, mut goes) = ([0.0; TEXELS_PER_STRIP], [0.0; TEXELS_PER_STRIP], 0.0);
            for k in 0..TEXELS_PER_STRIP {
                let fall = f64::from(one[k]) - f64::from(other[k]);
                on[k] = given(share, fall - holds, one[k]);
                back[k] = given(share, -fall - holds, other[k]);
                goes = larger(goes, on[k] + back[k]);
            }
            if goes == 0.0 {
                continue;
            }
            let mut sums = [[0; TEXELS_PER_STRIP]; 2];
            for paint in &mut *paints {
                let [mut one, mut other] = of_strips(paint.film, pair);
                for k in 0..TEXELS_PER_STRIP {
                    let (on, back) = (part(one[k], on[k]), part(other[k], back[k]));
                    one[k] = one[k] - on + back;
                    other[k] = other[k] + on - back;
                    sums[0][k] += one[k];
                    sums[1][k] += other[k];
                }
                put(paint.film, pair, [one, other]);
            }
            put(films, pair, sums);
        }
    }
}

/// The texels of two strips.
#[inline(always)]
fn of_strips(plane: &[u32], pair: [usize; 2]) -> [[u32; TEXELS_PER_STRIP]; 2] {
    pair.map(|strip| plane.as_chunks().0[strip])
}

#[inline(always)]
fn put(plane: &mut [u32], pair: [usize; 2], texels: [[u32; TEXELS_PER_STRIP]; 2]) {
    for (strip, texels) in pair.into_iter().zip(texels) {
        plane.as_chunks_mut().0[strip] = texels;
    }
}

wide! {
    fn along_strips(
        films: &mut [u32],
        paints: &mut [PaintOnBrush<'_>],
        seep: [f64; 2],
        steps: u64,
    ) {
        let [share, clings] = seep;
        let strips = films.as_chunks_mut::<TEXELS_PER_STRIP>().0.iter_mut().enumerate();
        for (strip, films) in strips {
            // Pairs start in turn at the first and at the second texel.
            let first = (steps as usize + strip) % 2;
            // For each texel but the last, the flow between it and the next; in every second pair.
            let (mut on, mut back, mut falls) = ([0.0; TEXELS_PER_STRIP], [0.0; TEXELS_PER_STRIP], 0.0);
            for k in 0..TEXELS_PER_STRIP - 1 {
                let own = if k % 2 == first { share } else { 0.0 };
                let [own_film, next] = [films[k], films[k + 1]].map(|film| larger(f64::from(film), clings));
                let fall = own_film - next;
                on[k] = given(own, fall, films[k]);
                back[k] = given(own, -fall, films[k + 1]);
                falls = larger(falls, own * fall.abs());
            }
            // No quantum would move.
            if falls < 2.0 {
                continue;
            }
            *films = [0; TEXELS_PER_STRIP];
            for paint in &mut *paints {
                let film = &mut paint.film.as_chunks_mut::<TEXELS_PER_STRIP>().0[strip];
                let before = *film;
                let (mut leaves, mut comes) = ([0; TEXELS_PER_STRIP], [0; TEXELS_PER_STRIP]);
                for k in 0..TEXELS_PER_STRIP - 1 {
                    leaves[k] = part(before[k], on[k]);
                    comes[k] = part(before[k + 1], back[k]);
                }
                for k in 0..TEXELS_PER_STRIP - 1 {
                    film[k] = film[k] - leaves[k] + comes[k];
                }
                for k in 1..TEXELS_PER_STRIP {
                    film[k] = film[k] + leaves[k - 1] - comes[k - 1];
                }
                films.iter_mut().zip(film).for_each(|(sum, count)| *sum += *count);
            }
        }
    }
}

/// The share of a film that seeps, where it is fuller by `fall` quanta than its neighbour.
#[inline(always)]
fn given(share: f64, fall: f64, film: u32) -> f64 {
    0.5 * share * larger(fall, 0.0) / larger(f64::from(film), 1.0)
}
