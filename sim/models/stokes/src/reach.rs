//! Paint within a brush's reach: the exchange of paint leaves deeper paint alone.

use maulstick_canvas::quantum::QUANTA_PER_UNIT;
use maulstick_canvas::window::Window;
use maulstick_model::footprint::Footprint;
use maulstick_model::interface::Step;
use maulstick_model::transfer::SKIN;

use crate::voxels::Voxels;

/// Quanta of each paint within each contact's reach, contact by contact.
#[derive(Clone, Debug, Default)]
pub struct Reach {
    quanta: Vec<u32>,
}

impl Reach {
    /// Leaves on the contacts' cells of the window only the paint within reach: down to the bristles, and at least as
    /// deep as films are swapped.
    pub fn uncover(&mut self, voxels: &Voxels, footprint: &mut Footprint, step: &mut Step<'_>) {
        let paints = voxels.slots.len();
        self.quanta.clear();
        self.quanta.resize(footprint.contacts.len() * paints, 0);
        let per_cell = 1.0 / step.traits.cells_per_quantum;
        let film = SKIN * QUANTA_PER_UNIT as f32;
        let width = step.window.width();
        let contacts = footprint
            .contacts
            .iter_mut()
            .zip(self.quanta.chunks_exact_mut(paints.max(1)));
        for (contact, quanta) in contacts {
            let column = voxels.column_of(contact.cell as usize, width);
            let depth = contact.depth * per_cell;
            voxels.reach(column, depth.max(film), quanta);
            let all: u32 = quanta.iter().sum();
            contact.fraction = if all > 0 {
                (depth / all as f32).min(1.0)
            } else {
                0.0
            };
        }
        self.put(voxels, footprint, step.window);
    }

    /// Leaves all paint on the contacts' cells.
    pub fn uncover_all(&mut self, voxels: &Voxels, footprint: &Footprint, step: &mut Step<'_>) {
        let paints = voxels.slots.len();
        self.quanta.clear();
        self.quanta.resize(footprint.contacts.len() * paints, 0);
        let contacts = footprint
            .contacts
            .iter()
            .zip(self.quanta.chunks_exact_mut(paints.max(1)));
        for (contact, quanta) in contacts {
            let column = voxels.column_of(contact.cell as usize, step.window.width());
            voxels.reach(column, f32::INFINITY, quanta);
        }
        self.put(voxels, footprint, step.window);
    }

    fn put(&self, voxels: &Voxels, footprint: &Footprint, window: &mut Window) {
        for (paint, slot) in voxels.slots.iter().enumerate() {
            let plane = window.plane_mut(*slot);
            let reached = self.quanta.iter().skip(paint).step_by(voxels.slots.len());
            for (contact, quanta) in footprint.contacts.iter().zip(reached) {
                plane[contact.cell as usize] = *quanta as f32;
            }
        }
    }

    /// Applies the changes of the exchange on the contacts' cells: losses come from the reached paint, gains lie on
    /// top.
    pub fn cover(&self, voxels: &mut Voxels, footprint: &Footprint, window: &Window) {
        let paints = voxels.slots.len();
        for paint in 0..paints {
            let Some(plane) = window.plane(voxels.slots[paint]) else {
                continue;
            };
            let reached = self.quanta.iter().skip(paint).step_by(paints);
            for (contact, reached) in footprint.contacts.iter().zip(reached) {
                let cell = contact.cell as usize;
                let column = voxels.column_of(cell, window.width());
                let now = plane[cell] as u32;
                if now > *reached {
                    voxels.lay(column, paint, now - reached);
                } else if now < *reached {
                    voxels.take(column, paint, reached - now);
                }
            }
        }
    }
}
