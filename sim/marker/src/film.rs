//! The film that a marker leaves: in each cell a share of what it lacks to its most, as far as the cell is covered, of
//! the mixture that the whole tip holds.

use maulstick_canvas::quantum::{Counts, QUANTUM_M, SLOTS};
use maulstick_model::brush::load::BrushLoad;
use maulstick_model::footprint::Footprint;
use maulstick_model::interface::Step;

/// Thickness of the film at most, m.
pub const FILM_M: f64 = 30e-6;
/// Factor on shares: reduced so that rounding never gives more than there is.
const SAFE: f64 = 1.0 - 1.0 / 1_099_511_627_776.0;

/// Room for a step.
#[derive(Debug, Default)]
pub(crate) struct Film {
    /// Quanta that each contact lacks.
    wants: Vec<f64>,
    /// Quanta of all paints on its cell.
    lying: Vec<f32>,
    cells: Vec<u32>,
}

impl Film {
    /// Lays the film of a step; by slot, what came onto the cells.
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
            let lacks = (most - lying).max(0.0) * contact.cover;
            f64::from(lacks.floor())
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

    /// Draws what was given out of the tip: from all of it alike.
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
            // What rounding leaves over comes from the first texels that have it.
            for texel in film.iter_mut().chain(inside) {
                left -= take(texel, left.min(u64::from(*texel)));
            }
        }
        load.count_films();
    }
}

/// Takes quanta that are there, and returns how many.
fn take(texel: &mut u32, count: u64) -> u64 {
    *texel -= count as u32;
    count
}
