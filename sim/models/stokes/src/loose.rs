//! Unsupported paint falls: specks thrown up by the flow, and lumps whose stalk a brush has cut.

use crate::voxels::Voxels;

/// Fill from which a voxel supports its neighbours beside and above.
const HOLDS: f32 = 0.5;
/// Fill from which the lowest voxel of a column, part of which may be closed, supports its neighbours.
const HOLDS_LOW: f32 = 0.3;

impl Voxels {
    /// Drops the paint that is not connected to the ground by voxels at least half full. Paint at the border of the
    /// area stays, because paint beyond may support it.
    pub fn drop_loose(&mut self) {
        let mut totals = self.totals();
        let held = self.held(&totals);
        let up = self.volume.grid.stride(2);
        let whole = self.volume.capacity;
        for column in 0..self.area.cells() {
            let bottom = self.bottom(column);
            let mut under = bottom;
            for voxel in self.column(column) {
                if held[voxel] {
                    under = voxel;
                    continue;
                }
                while under < voxel && totals[voxel] > 0 {
                    let room = if under == bottom {
                        self.lowest_room(column)
                    } else {
                        whole
                    };
                    let falls = totals[voxel].min(room.saturating_sub(totals[under]));
                    self.shift([voxel, under], falls);
                    totals[under] += falls;
                    totals[voxel] -= falls;
                    if totals[voxel] > 0 {
                        under += up;
                    }
                }
            }
        }
    }

    /// True for each voxel that is connected to the ground, from all their quanta.
    fn held(&self, totals: &[u32]) -> Vec<bool> {
        let grid = self.volume.grid;
        let [width, height] = self.area.size;
        let capacity = self.volume.capacity as f32;
        let [holds, holds_low] = [HOLDS, HOLDS_LOW].map(|fill| (fill * capacity) as u32);
        let mut held = vec![false; grid.len()];
        let mut next = Vec::new();
        for column in 0..self.area.cells() {
            let (x, y) = (column % width, column / width);
            let bottom = self.bottom(column);
            held[bottom] = true;
            if totals[bottom] >= holds_low {
                next.push(bottom);
            }
            if x == 0 || y == 0 || x + 1 == width || y + 1 == height {
                let border = self.column(column).filter(|voxel| totals[*voxel] > 0);
                border.for_each(|voxel| {
                    held[voxel] = true;
                    next.push(voxel);
                });
            }
        }
        while let Some(voxel) = next.pop() {
            for axis in 0..3 {
                let by = grid.stride(axis);
                for beside in [voxel - by, voxel + by] {
                    if totals[beside] == 0 || std::mem::replace(&mut held[beside], true) {
                        continue;
                    }
                    // Thin paint hangs on others, and supports none.
                    if totals[beside] >= holds {
                        next.push(beside);
                    }
                }
            }
        }
        held
    }
}
