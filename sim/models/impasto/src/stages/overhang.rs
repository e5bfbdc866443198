//! Paint that is pushed over the border of the surface: it hangs on the edge and is wiped off.

use maulstick_canvas::quantum::{Counts, SLOTS};
use maulstick_model::footprint::Footprint;
use maulstick_model::footprint::contact::Contact;
use maulstick_model::interface::Step;

use super::velocity::{follows, squish, thinner_of};

/// Share of a cell's loose paint that goes over the border in a step.
fn over(contact: &Contact, wet: f32, step: &Step<'_>) -> f32 {
    let width = step.window.width();
    let at = [contact.cell as usize % width, contact.cell as usize / width];
    let (limit, borders) = (step.window.limit(), step.window.borders());
    let traits = &step.traits;
    let outward = |axis: usize| {
        let [low, high] = borders[axis];
        let is_low = low && at[axis] == 0;
        match (is_low, high && at[axis] + 1 == limit[axis]) {
            (false, false) => None,
            (true, _) => Some(-contact.moved[axis]),
            _ => Some(contact.moved[axis]),
        }
    };
    let mut share = 0.0;
    for moved in [outward(0), outward(1)].into_iter().flatten() {
        let thinner = thinner_of(contact, wet, step);
        let height = contact.depth / contact.fraction.max(1e-6);
        let pushed = follows(traits.follows, thinner) * contact.cover * contact.fraction * moved;
        let pressed = squish(height, thinner) * contact.depth * contact.cover;
        share += (pushed + traits.parts as f32 * pressed).clamp(0.0, 1.0);
    }
    share.min(1.0)
}

/// Cells from which paint goes over the border, with its share.
#[derive(Clone, Debug, Default)]
pub(crate) struct Overhang(Vec<(usize, f32)>);

impl Overhang {
    /// Finds the cells, before paint moves.
    pub(crate) fn find(&mut self, footprint: &Footprint, step: &Step<'_>) {
        self.0.clear();
        if !step.handling.push || !step.window.borders().as_flattened().contains(&true) {
            return;
        }
        let contacts = footprint.contacts.iter().zip(&footprint.wet);
        let shares =
            contacts.map(|(contact, wet)| (contact.cell as usize, over(contact, *wet, step)));
        self.0.extend(shares.filter(|(_, share)| *share > 0.0));
    }

    /// Weighs what of it is loose, before the exchange.
    pub(crate) fn weigh(&mut self, step: &Step<'_>) {
        for (cell, share) in &mut self.0 {
            let total = step.window.total(*cell);
            *share *= (total - step.stain).max(0.0) / total.max(1.0);
        }
    }

    /// Wipes it off, and counts it.
    pub(crate) fn wipe(&self, step: &mut Step<'_>) -> Counts {
        let mut wiped = [0; SLOTS];
        if self.0.is_empty() {
            return wiped;
        }
        for (slot, plane) in step.window.planes_mut() {
            for (cell, share) in &self.0 {
                let count = (plane[*cell] * share).floor();
                plane[*cell] -= count;
                wiped[slot] += count as u64;
            }
        }
        wiped
    }
}
