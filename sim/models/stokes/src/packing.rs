//! Paint of a column without voids: paint that cannot be compressed fills what room there is under it, and none is fuller than
//! full. What is under an overhang stays empty, if it is higher than a voxel: surface tension closes narrow gaps.

use crate::voxels::Voxels;

/// Fill below which a voxel is air.
const AIR: f32 = 0.5;

impl Voxels {
    /// Packs each column: as mixtures, what a voxel has too much of goes to the one above, and what it lacks comes from there.
    pub fn pack(&mut self) {
        let up = self.volume.grid.stride(2);
        let whole = self.layers.capacity;
        for column in 0..self.area.cells() {
            let bottom = self.bottom(column);
            let layers = self.volume.grid.cells[2] - usize::from(self.lowest[column]);
            // The voxel that is being filled.
            let (mut under, mut room) = (0, self.lowest_room(column));
            for layer in 1..layers {
                let [mut to, from] = [under, layer].map(|layer| bottom + layer * up);
                let excess = self.total(to).saturating_sub(room);
                self.shift([to, to + up], excess);
                let mut left = self.total(from);
                let is_air = (self.total(to) as f32) < AIR * room as f32;
                if left > 0 && layer - under + usize::from(is_air) > 2 {
                    (under, room) = (layer, whole);
                    continue;
                }
                while under < layer && left > 0 {
                    let goes = left.min(room - self.total(to));
                    self.shift([from, to], goes);
                    left -= goes;
                    if self.total(to) == room {
                        (under, to, room) = (under + 1, to + up, whole);
                    }
                }
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
        if quanta == 0 {
            return;
        }
        let total = u64::from(self.total(from));
        let mut left = quanta;
        for paint in &mut self.volume.paints {
            let goes = (u64::from(paint[from]) * u64::from(quanta) / total) as u32;
            paint[from] -= goes;
            paint[to] += goes;
            left -= goes;
        }
        // What rounding has left of them.
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
