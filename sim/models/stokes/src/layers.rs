//! Layers of voxels: cubes of a cell's side, counted from a floor that is the same for a whole surface.

use maulstick_canvas::own_plane::LAYERS_MOST;
use maulstick_canvas::quantum::QUANTUM_M;
use maulstick_canvas::relief::Relief;
use maulstick_canvas::window::Window;

/// Side of a cell on which flow is found, m, where voxels are smaller.
const SIDE_M: f64 = 5e-4;

/// Voxels along the side of a cell of the flow, for voxels of `cell_m`.
fn voxels_a_side(cell_m: f64) -> usize {
    ((SIDE_M / cell_m) as usize).max(1)
}

/// Least open share of a voxel that paint may occupy; a smaller one belongs to the voxel above.
const LEAST_OPEN: f32 = 0.3;

/// Layers of voxels on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layers {
    /// Quanta that fill a voxel.
    pub capacity: u32,
    /// Cells from the lowest layer's floor up to the surface's highest bare peaks.
    pub below: f32,
    /// Voxels along the side of a cell of the flow.
    pub side: usize,
}

impl Layers {
    /// Layers of a window with cells of side `cell_m`.
    #[must_use]
    pub fn of(window: &Window, cell_m: f64) -> Self {
        Self::new(window.ride_below(), cell_m)
    }

    fn new(below: f32, cell_m: f64) -> Self {
        Self {
            capacity: (cell_m / QUANTUM_M) as u32,
            below,
            side: voxels_a_side(cell_m),
        }
    }

    /// Layers of a surface with this relief and cells of side `cell_m`.
    #[must_use]
    pub fn over(relief: &Relief, cell_m: f64) -> Self {
        let below = relief.depth_m() as f32 * relief.cells_per_m();
        Self::new(below, cell_m)
    }

    /// Height of the surface that catches paint above the lowest layer's floor, cells.
    #[must_use]
    pub fn floor(&self, window: &Window, cell: usize) -> f32 {
        (window.base()[cell] + self.below).max(0.0)
    }

    /// The lowest layer of a column with room for paint, by the height of its floor over the lowest layer's.
    #[must_use]
    pub fn lowest(&self, floor: f32) -> usize {
        ((floor + LEAST_OPEN) as usize).min(LAYERS_MOST - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sliver_of_a_voxel_belongs_to_the_next() {
        let layers = Layers {
            capacity: 100,
            below: 1.0,
            side: 1,
        };
        assert_eq!(
            [0.0, 0.6, 0.8, 1.6].map(|floor| layers.lowest(floor)),
            [0, 0, 1, 1]
        );
    }
}
