//! Footprint of a head: the cells that it touches, with the touching strip and its depth.
//!
//! Strips are ribbons that turn their flat side to the surface (Baxter 2004, § 3.5.2). In each cell the deepest one
//! counts. It touches where it, with the film of paint that it carries, reaches the top of the surface there: tooth,
//! dry relief and wet paint. All lengths are in cells.

mod band;
pub mod contact;
mod draw_skin;
pub mod drawn;
pub mod lying;
mod piece;
mod rasterizer;
pub mod ribbons;

use maulstick_canvas::window::{Area, Window};
use maulstick_num::fork_join::{Balance, threads};

use band::Band;
use contact::Contact;
use lying::Lying;
use ribbons::Ribbons;

use crate::interface::{Step, StepReport};

/// Smaller footprints run on one core: fork-join would cost more than it saves.
const PARALLEL_MIN_CELLS: usize = 400;
/// Number of cells that justify another core: a stage of a step takes some microseconds for them, several times the
/// cost of handing them over.
const CELLS_PER_SHARE: usize = 1000;

/// Number of shares for a stage over `cells` cells, up to the [threads].
#[must_use]
pub fn shares_of(cells: usize) -> usize {
    match cells {
        0..PARALLEL_MIN_CELLS => 1,
        _ => threads().min((cells / CELLS_PER_SHARE).max(2)),
    }
}

/// The footprint of one step.
#[derive(Clone, Debug, Default)]
pub struct Footprint {
    /// The cells in contact, row after row.
    pub contacts: Vec<Contact>,
    /// The cells of the window on which the head is drawn.
    pub grid: Area,
    /// The contacts and one cell more to each side, as far as the surface goes: where paint may move.
    pub around: Area,
    /// Wet quanta of all paints on each contact, before the step.
    pub wet: Vec<f32>,
    /// The same on the cells of the grid, and afterwards on those around.
    lying: Lying,
    /// One for each core, in order of their rows.
    bands: Vec<Band>,
    ribbons: Ribbons,
    balance: Balance,
}

impl Footprint {
    /// Computes the contacts of the head after the step's motion.
    pub fn find(&mut self, step: &mut Step<'_>) {
        self.contacts.clear();
        let traits = step.traits;
        let sink = traits.sink * step.sweep.to.press;
        self.grid = step.window.area(step.bounds.0, step.bounds.1);
        if self.grid.is_empty() {
            return;
        }
        // From the cells around the brush alone: the rest of the window must not matter.
        let top = self.lying.weigh(self.grid, step);
        // The pressed head may lie below its solved height by the depth of the ride.
        let low = top + sink + step.window.ride_below();
        // Strips are drawn in the coordinates of the surface.
        let origin = step.window.origin();
        let offset = [0, 1].map(|i| (origin[i] + self.grid.from[i] as i64) as f32);
        let (grid, lying, height) = (self.grid, &self.lying.quanta[..], self.grid.size[1]);
        let step = &*step;
        self.ribbons.lay(step, grid, offset, low);
        let ribbons = &self.ribbons;
        let find = |band: &mut Band, rows| {
            band.begin(grid, offset, rows);
            band.draw_head(step, ribbons, low);
            band.touch(step, ribbons, lying, sink);
        };
        let rows = self.balance.cut(height, shares_of(grid.cells()));
        let bands = self.bands.len().max(rows.len());
        self.bands.resize_with(bands, Band::default);
        self.bands.iter_mut().for_each(Band::clear);
        let mut shares: Vec<_> = self.bands.iter_mut().zip(rows).collect();
        self.balance
            .each(&mut shares, |(band, rows)| find(band, rows.clone()));
        self.gather(step.window);
    }

    /// Greatest number of wet quanta on a cell of the grid, before the step.
    #[must_use]
    pub fn fullest(&self) -> f32 {
        let lying = self.lying.quanta.iter().copied();
        lying.fold(0.0, f32::max)
    }

    /// Records the height of paint behind the brush.
    pub fn note_left(&mut self, step: &mut Step<'_>) {
        self.lying.weigh(self.around, step);
    }

    /// Gathers the contacts of the bands, and indexes the cells around them.
    fn gather(&mut self, window: &Window) {
        self.contacts.clear();
        self.wet.clear();
        self.around = Area::default();
        if self.bands.iter().all(|band| band.contacts.is_empty()) {
            return;
        }
        let (from, to) = self.bands.iter().fold(Band::NOWHERE, |(from, to), band| {
            let (low, high) = band.reach;
            let outer = |i: usize| (low[i].min(from[i]), high[i].max(to[i]));
            let ((left, right), (bottom, top)) = (outer(0), outer(1));
            ([left, bottom], [right, top])
        });
        let limit = window.limit();
        let from = [0, 1].map(|i| (self.grid.from[i] + from[i]).saturating_sub(1));
        let size = [0, 1].map(|i| (self.grid.from[i] + to[i] + 1).min(limit[i]) - from[i]);
        self.around = Area { from, size };
        let inset = [0, 1].map(|i| self.grid.from[i] as i64 - from[i] as i64);
        let (width, row) = (self.grid.size[0] as u32, size[0] as i64);
        for band in &self.bands {
            self.wet.extend_from_slice(&band.wet);
            self.contacts.extend(band.contacts.iter().map(|contact| {
                let (x, y) = (contact.local % width, contact.local / width);
                let place = (i64::from(y) + inset[1]) * row + i64::from(x) + inset[0];
                Contact {
                    local: place as u32,
                    ..*contact
                }
            }));
        }
    }

    /// Amount of wet paint under the brush before the step.
    #[must_use]
    pub fn report(&self, step: &Step<'_>) -> StepReport {
        let wet = self.wet.iter().map(|quanta| *quanta as u64);
        let thinner = step.thinner.and_then(|slot| step.window.plane(slot));
        let thinner = thinner.map_or(0, |plane| {
            let cells = self.contacts.iter().map(|contact| contact.cell as usize);
            cells.map(|cell| plane[cell] as u64).sum()
        });
        StepReport {
            footprint_cells: self.contacts.len() as u64,
            wet: wet.sum(),
            thinner,
            ..StepReport::default()
        }
    }

    /// The cells of the window that the step may have changed: from, up to but not with.
    #[must_use]
    pub fn reached(&self) -> ([usize; 2], [usize; 2]) {
        let Area { from, size } = self.around;
        (from, [from[0] + size[0], from[1] + size[1]])
    }
}
