//! Paint of a column without voids: paint is incompressible and fills the room under it, and no voxel is overfull. A
//! gap under an overhang stays empty if it is higher than a voxel: surface tension closes narrow gaps.

use crate::voxels::Voxels;

/// Fill below which a voxel is air.
const AIR: f32 = 0.5;

impl Voxels {
    /// Packs each column: as mixtures, the excess of a voxel moves to the one above, and its deficit is filled from
    /// there.
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

    /// Quanta that fill the lowest voxel of a column and the open part below it.
    #[must_use]
    pub fn lowest_room(&self, column: usize) -> u32 {
        let open = f32::from(self.lowest[column]) + 1.0 - self.floor_of(column);
        (open * self.layers.capacity as f32) as u32
    }

    /// Moves `quanta`, which must be present, from one voxel to another with their mixture.
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
        // Remainder of the rounding.
        for paint in &mut self.volume.paints {
            let goes = left.min(paint[from]);
            paint[from] -= goes;
            paint[to] += goes;
            left -= goes;
        }
    }

    /// Moves paint of the lowest voxel of each column into the open part below it, its place during the flow.
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

    /// Moves paint below the lowest voxel of each column into that voxel.
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
