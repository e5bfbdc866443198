//! Paint between bristles: where a film has become thinner than the one beside it, paint seeps over,
//! from strip to strip and along each strip.
//!
//! Only what evens the films out goes over, with the mixture of the fuller one: so the whole head feeds
//! the bristles that touch, and two colours beside each other stay two. Between strips the yield stress holds
//! a difference, so that a bristle that took up more paints its streak to the end.

use maulstick_num::wide;

use crate::load::{ALONG, PaintOnBrush};
use crate::model::{BrushTraits, Step};

/// Evens films out, every few steps for as many; in turn along strips and between those of either order.
pub fn seep(step: &mut Step<'_>) {
    let steps = step.load.steps();
    if !steps.is_multiple_of(BrushTraits::FLOW_STEPS) {
        return;
    }
    let turn = steps / BrushTraits::FLOW_STEPS;
    let seep = step.traits.seep;
    let holds = BrushTraits::HOLDS * step.traits.film_full;
    let (films, paints) = step.load.parts_mut();
    let mut paints: Vec<PaintOnBrush<'_>> = paints.collect();
    let order = &step.head.beside()[(turn % 2) as usize];
    let first = (turn / 2 % 2) as usize;
    between_strips(films, &mut paints, &order[first..], seep.beside, holds);
    along_strips(films, &mut paints, first, seep.along);
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
            let [one, other] = pair.map(|strip| strip as usize * ALONG);
            let mut shares = [[0.0; ALONG]; 2];
            for k in 0..ALONG {
                let fall = f64::from(films[one + k]) - f64::from(films[other + k]);
                shares[0][k] = given(share, fall - holds, films[one + k]);
                shares[1][k] = given(share, -fall - holds, films[other + k]);
            }
            for paint in &mut *paints {
                for k in 0..ALONG {
                    let (a, b) = (one + k, other + k);
                    exchange(films, paint.film, [a, b], [shares[0][k], shares[1][k]]);
                }
            }
        }
    }
}

wide! {
    fn along_strips(
        films: &mut [u32],
        paints: &mut [PaintOnBrush<'_>],
        first: usize,
        share: f64,
    ) {
        for start in (0..films.len()).step_by(ALONG) {
            for k in (first..ALONG - 1).step_by(2) {
                let (a, b) = (start + k, start + k + 1);
                let fall = f64::from(films[a]) - f64::from(films[b]);
                let shares = [given(share, fall, films[a]), given(share, -fall, films[b])];
                for paint in &mut *paints {
                    exchange(films, paint.film, [a, b], shares);
                }
            }
        }
    }
}

/// The share of a film that goes over, where it is fuller by `fall` quanta than the one beside it.
#[inline(always)]
fn given(share: f64, fall: f64, film: u32) -> f64 {
    let goes = 0.5 * share * fall;
    if goes > 0.0 {
        goes / f64::from(film)
    } else {
        0.0
    }
}

/// One paint of two films: of each so much of it goes to the other.
#[inline(always)]
fn exchange(films: &mut [u32], film: &mut [u32], [a, b]: [usize; 2], shares: [f64; 2]) {
    let on = (f64::from(film[a]) * shares[0]) as u32;
    let back = (f64::from(film[b]) * shares[1]) as u32;
    film[a] = film[a] - on + back;
    film[b] = film[b] + on - back;
    films[a] = films[a] - on + back;
    films[b] = films[b] + on - back;
}
