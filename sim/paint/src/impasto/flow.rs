//! Paint within the head: what is inside a strip comes to its surface as the film there is used up,
//! what the film takes up beyond its fill goes inside, and inside it creeps along the strip.

use super::footprint::Footprint;
use crate::load::{ALONG, BrushLoad, film_share};
use crate::model::{BrushTraits, Step};
use crate::quantum::SLOTS;

/// Moves paint within the strips that touch, every few steps for as many.
pub fn flow(footprint: &Footprint, step: &mut Step<'_>) {
    if !step.load.is_due(BrushTraits::FLOW_STEPS) {
        return;
    }
    let mut touched = vec![false; step.head.strips()];
    for contact in &footprint.contacts {
        touched[contact.texel as usize / ALONG] = true;
    }
    for (strip, _) in touched.iter().enumerate().filter(|(_, touched)| **touched) {
        let capacity = f64::from(step.head.capacity()[strip]);
        let thin = film_share(thinner_in(strip, step.load, step.thinner));
        let film_full = step.traits.film_full * capacity * thin;
        flow_in_strip(strip, step.load, film_full, &step.traits);
    }
    step.load.count_films();
}

/// Share of thinner in what a strip carries.
fn thinner_in(strip: usize, load: &BrushLoad, thinner: Option<usize>) -> f64 {
    let Some(slot) = thinner.filter(|slot| load.has(*slot)) else {
        return 0.0;
    };
    let there = totals(strip, load);
    let all: f64 = there.film.iter().chain(&there.inside).sum();
    let run = strip * ALONG..(strip + 1) * ALONG;
    let planes = [load.film_of(slot), load.inside(slot)];
    let counts = planes
        .into_iter()
        .flatten()
        .flat_map(|plane| &plane[run.clone()]);
    let thin: f64 = counts.map(|count| f64::from(*count)).sum();
    if all > 0.0 { thin / all } else { 0.0 }
}

/// Counts of all paints by texel of one strip.
#[derive(Clone, Copy, Debug, Default)]
struct Totals {
    film: [f64; ALONG],
    inside: [f64; ALONG],
}

fn totals(strip: usize, load: &BrushLoad) -> Totals {
    let mut totals = Totals::default();
    for slot in 0..SLOTS {
        let (Some(film), Some(inside)) = (load.film_of(slot), load.inside(slot)) else {
            continue;
        };
        for k in 0..ALONG {
            totals.film[k] += f64::from(film[strip * ALONG + k]);
            totals.inside[k] += f64::from(inside[strip * ALONG + k]);
        }
    }
    totals
}

fn flow_in_strip(strip: usize, load: &mut BrushLoad, film_full: f64, traits: &BrushTraits) {
    let there = totals(strip, load);
    // Shares of what is inside that go to the film, of the film that go inside, and of what is
    // inside that go to the next texel and to the one before.
    let mut out = [0.0; ALONG];
    let mut inward = [0.0; ALONG];
    let mut onward = [0.0; ALONG];
    let mut back = [0.0; ALONG];
    for k in 0..ALONG {
        let missing = film_full - there.film[k];
        if missing > 0.0 && there.inside[k] > 0.0 {
            out[k] = (traits.refill * missing / there.inside[k]).min(traits.refill);
        } else if missing < 0.0 {
            inward[k] = traits.refill * -missing / there.film[k];
        }
        if k + 1 < ALONG {
            let fall = traits.creep * (there.inside[k] - there.inside[k + 1]);
            if fall > 0.0 {
                onward[k] = fall / there.inside[k];
            } else if fall < 0.0 {
                back[k + 1] = -fall / there.inside[k + 1];
            }
        }
    }
    // On coarse cells a step is a long way: what would leave beyond what is there stays.
    for k in 0..ALONG {
        let leaves = out[k] + onward[k] + back[k];
        if leaves > 1.0 {
            for share in [&mut out[k], &mut onward[k], &mut back[k]] {
                *share /= leaves;
            }
        }
    }
    for slot in 0..SLOTS {
        let Some((film, inside)) = load.planes_mut(slot) else {
            continue;
        };
        let run = strip * ALONG..(strip + 1) * ALONG;
        let (film, inside) = (&mut film[run.clone()], &mut inside[run]);
        let before: [u32; ALONG] = std::array::from_fn(|k| inside[k]);
        for k in 0..ALONG {
            let taken = |share: f64| (f64::from(before[k]) * share) as u32;
            let (rises, goes_on, goes_back) = (taken(out[k]), taken(onward[k]), taken(back[k]));
            let sinks = (f64::from(film[k]) * inward[k]) as u32;
            film[k] = film[k] + rises - sinks;
            inside[k] = inside[k] + sinks - rises - goes_on - goes_back;
            if goes_on > 0 {
                inside[k + 1] += goes_on;
            }
            if goes_back > 0 {
                inside[k - 1] += goes_back;
            }
        }
    }
}
