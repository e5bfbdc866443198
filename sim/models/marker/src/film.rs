//! The film of a marker: each covered cell is filled up towards [`FILM_M`], in proportion to its cover, with the
//! mixture of the whole tip. In the brush mode `marker` a step deposits at most flow · travel.

use maulstick_canvas::quantum::{Counts, QUANTA_PER_UNIT, QUANTUM_M, SLOTS};
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::footprint::Footprint;
use maulstick_model::interface::{Step, Transfer};

/// Largest thickness of the film, m.
pub const FILM_M: f64 = 30e-6;
/// Factor on shares, 1 − 2⁻⁴⁰: rounding then never gives more paint than the tip holds.
const SAFE: f64 = 1.0 - 1.0 / 1_099_511_627_776.0;

/// Scratch buffers of a step.
#[derive(Debug, Default)]
pub(crate) struct Film {
    /// Quanta that each contact's cell lacks.
    wants: Vec<f64>,
    /// Quanta of all paints on its cell.
    lying: Vec<f32>,
    /// Cell of each contact.
    cells: Vec<u32>,
}

impl Film {
    /// Deposits the film of a step and returns the quanta deposited, by slot.
    pub(crate) fn lay(&mut self, footprint: &Footprint, step: &mut Step<'_>) -> Counts {
        let held = step.load.counts();
        let total: u64 = held.iter().sum();
        self.cells.clear();
        self.cells
            .extend(footprint.contacts.iter().map(|contact| contact.cell));
        step.window.totals(&self.cells, &mut self.lying);
        let most = ((FILM_M / QUANTUM_M) as f32).min(step.handling.most);
        let contacts = footprint.contacts.iter().zip(&self.lying);
        let wants = contacts.map(|(contact, lying)| {
            let lacks = (most - lying).max(0.0);
            let flows = match step.handling.transfer {
                Transfer::Marker { flow } => {
                    flow * QUANTA_PER_UNIT as f32 * contact.travel(&step.traits)
                }
                _ => f32::INFINITY,
            };
            f64::from((lacks.min(flows) * contact.cover).floor())
        });
        self.wants.clear();
        self.wants.extend(wants);
        let wanted: f64 = self.wants.iter().sum();
        let mut given = [0; SLOTS];
        if total == 0 || wanted == 0.0 {
            return given;
        }
        let granted = (total as f64 / wanted).min(1.0);
        for (slot, held) in held.iter().enumerate().filter(|(_, held)| **held > 0) {
            let share = *held as f64 / total as f64 * granted * SAFE;
            let plane = step.window.plane_mut(slot);
            for (cell, wants) in self.cells.iter().zip(&self.wants) {
                let gives = (wants * share).floor();
                plane[*cell as usize] += gives as f32;
                given[slot] += gives as u64;
            }
        }
        given
    }

    /// Removes the deposited paint from the tip, the same share from each texel.
    pub(crate) fn draw(&self, given: &Counts, load: &mut BrushLoad) {
        let held = load.counts();
        for slot in 0..SLOTS {
            let Some((film, inside)) = load.planes_mut(slot) else {
                continue;
            };
            let mut left = given[slot];
            let share = left as f64 / held[slot].max(1) as f64;
            for texel in film.iter_mut().chain(&mut *inside) {
                let alike = (f64::from(*texel) * share) as u64;
                left -= take(texel, alike.min(left));
            }
            // The rounding remainder comes from the first texels that have it.
            for texel in film.iter_mut().chain(inside) {
                left -= take(texel, left.min(u64::from(*texel)));
            }
        }
        load.count_films();
    }
}

/// Takes `count` quanta, which must be there, from a texel, and returns `count`.
fn take(texel: &mut u32, count: u64) -> u64 {
    *texel -= count as u32;
    count
}
