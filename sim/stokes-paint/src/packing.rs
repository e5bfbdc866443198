//! Paint of a column without voids: paint that cannot be compressed fills what room there is under it, and none is fuller than
//! full. What is under an overhang stays empty.

use crate::voxels::Voxels;

/// Fill from which on a voxel is paint with voids in it, and not air under paint.
const VOIDS: f32 = 0.5;

impl Voxels {
    /// Packs each column: as mixtures, what a voxel has too much of goes to the one above, and what it lacks comes from there.
    pub fn pack(&mut self) {
        let up = self.volume.grid.stride(2);
        let whole = self.layers.capacity;
        for column in 0..self.area.cells() {
            let bottom = self.bottom(column);
            let layers = self.volume.grid.cells[2] - usize::from(self.lowest[column]);
            let mut room = self.lowest_room(column);
            for voxel in (0..layers - 1).map(|layer| bottom + layer * up) {
                let (total, above) = (self.total(voxel), self.total(voxel + up));
                if total > room {
                    self.shift([voxel, voxel + up], total - room);
                } else if above > 0 && total as f32 >= VOIDS * room as f32 {
                    self.shift([voxel + up, voxel], above.min(room - total));
                }
                room = whole;
            }
        }
    }

    /// Quanta that fill the lowest voxel of a column, with what is open below it.
    #[must_use]
    pub fn lowest_room(&self, column: usize) -> u32 {
        let open = f32::from(self.lowest[column]) + 1.0 - self.floor_of(column);
        (open * self.layers.capacity as f32) as u32
    }

    /// Moves so many quanta, which must be there, from one voxel to another, as the mixture that they are.
    pub(crate) fn shift(&mut self, [from, to]: [usize; 2], quanta: u32) {
        let total = u64::from(self.total(from).max(1));
        let mut left = quanta;
        let paints = self.volume.paints.iter_mut();
        paints.for_each(|paint| {
            let goes = (u64::from(paint[from]) * u64::from(quanta) / total) as u32;
            paint[from] -= goes;
            paint[to] += goes;
            left -= goes;
        });
        for paint in &mut self.volume.paints {
            let goes = left.min(paint[from]);
            paint[from] -= goes;
            paint[to] += goes;
            left -= goes;
        }
    }

    /// Puts paint of the lowest voxel of each column into what is open below it, where it lies as it flows.
    pub fn sink(&mut self) {
        let up = self.volume.grid.stride(2);
        for column in 0..self.area.cells() {
            let open = f32::from(self.lowest[column]) - self.floor_of(column);
            if open > 0.0 {
                let bottom = self.bottom(column);
                let sinks = (open * self.layers.capacity as f32) as u32;
                self.shift([bottom, bottom - up], sinks.min(self.total(bottom)));
            }
        }
    }

    /// Lifts what is below the lowest voxel of its column into that.
    pub fn lift(&mut self) {
        let up = self.volume.grid.stride(2);
        for column in 0..self.area.cells() {
            let bottom = self.bottom(column);
            for below in 1..=usize::from(self.lowest[column]) {
                for paint in &mut self.volume.paints {
                    paint[bottom] += std::mem::take(&mut paint[bottom - below * up]);
                }
            }
        }
    }
}
