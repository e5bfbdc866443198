//! One step of the paint in a window.

use std::sync::Arc;

use crate::body::{Rod, Voxels};
use crate::domain::{Domain, Solids};
use crate::flow::{Conditions, Flow};
use crate::grid::Grid;
use crate::surface;
use crate::volume::Volume;

/// Paint in a window, its flow, and its base.
#[derive(Clone, Debug)]
pub struct Stokes {
    /// The paint.
    pub volume: Volume,
    /// Flow of the paint.
    pub flow: Flow,
    /// Solids at rest: canvas and walls.
    pub base: Solids,
    /// Base and brush, the open share of each cell, its fill, and buffers.
    solids: Solids,
    open: Vec<f32>,
    fill: Vec<f32>,
    voxels: Voxels,
}

impl Stokes {
    /// An empty window over a flat canvas, for `paints` paints; a cell holds `capacity` quanta.
    #[must_use]
    pub fn new(grid: &Grid, capacity: u32, paints: usize) -> Self {
        Self {
            volume: Volume::new(grid, capacity, paints),
            flow: Flow::new(grid),
            base: Solids::walls(grid),
            solids: Solids::walls(grid),
            open: grid.field(),
            fill: grid.field(),
            voxels: Voxels::default(),
        }
    }

    /// Moves the paint for one step of a brush; returns the domain of the equations, whose buffers the next step reuses
    /// once it is dropped.
    pub fn step(&mut self, brush: &[Rod], conditions: &Conditions) -> Arc<Domain> {
        let grid = self.volume.grid;
        self.solids.copy_from(&self.base);
        self.voxels.add(&grid, &mut self.solids, brush);
        self.solids.open_into(&grid, &mut self.open);
        self.volume.fill_into(&self.open, &mut self.fill);
        let domain = self.flow.step(&self.fill, &self.solids, conditions);
        let Conditions {
            seconds, cell_m, ..
        } = *conditions;
        self.volume
            .advect(&domain, &self.open, &self.flow.velocity, seconds, cell_m);
        domain
    }

    /// Dries all paint: it becomes a part of the base, whose surface is that of the paint to an eighth of a cell
    /// (Baxter 2004, § 5.4.6). Returns the quanta of each paint by cell, which are removed from the window.
    pub fn dry(&mut self) -> Vec<Vec<u32>> {
        let grid = self.volume.grid;
        let heights = self.heights();
        let [width, height, _] = grid.cells.map(|cells| cells as isize);
        // Height of a corner, the mean of the columns around it.
        let corner = |x: isize, y: isize| {
            let columns = [[x - 1, y - 1], [x, y - 1], [x - 1, y], [x, y]];
            let inside = columns.map(|[x, y]| [x.clamp(0, width - 1), y.clamp(0, height - 1)]);
            inside
                .iter()
                .map(|[x, y]| heights[(x + width * y) as usize])
                .sum::<f32>()
                / 4.0
        };
        for (place, distance) in self.base.distance.iter_mut().enumerate() {
            let [x, y, z] = grid.cell(place);
            *distance = distance.min(z as f32 - corner(x, y));
        }
        let empty = vec![vec![0; grid.len()]; self.volume.paints.len()];
        std::mem::replace(&mut self.volume.paints, empty)
    }

    /// Height of the surface of each column, including the base, cells; row by row.
    #[must_use]
    pub fn heights(&self) -> Vec<f32> {
        let grid = self.volume.grid;
        let mut taken = self.base.open(&grid);
        for open in &mut taken {
            *open = 1.0 - *open;
        }
        for paint in &self.volume.paints {
            for (taken, count) in taken.iter_mut().zip(paint) {
                *taken += *count as f32 / self.volume.capacity as f32;
            }
        }
        let heights = surface::heights(&grid, &taken);
        heights.into_iter().map(Option::unwrap_or_default).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rheology::Paint;

    const CAPACITY: u32 = 167_772;

    /// A swell of paint, some of it under half a cell over the canvas's lowest cells.
    fn swell(grid: &Grid) -> Stokes {
        let mut stokes = Stokes::new(grid, CAPACITY, 1);
        for place in grid.places() {
            let [x, y, z] = grid.cell(place).map(|at| at as f64);
            let height = 3.4 + 1.2 * maulstick_num::sin(0.4 * x) * maulstick_num::cos(0.3 * y);
            let filled = (height - z).clamp(0.0, 1.0);
            stokes.volume.paints[0][place] = (filled * f64::from(CAPACITY)) as u32;
        }
        stokes
    }

    #[test]
    fn dry_paint_has_the_surface_that_it_had_wet() {
        let grid = Grid::walled([20, 16, 10]);
        let mut stokes = swell(&grid);
        let (before, counts) = (stokes.heights(), stokes.volume.counts());
        let dried = stokes.dry();
        let all: u64 = grid.places().map(|place| u64::from(dried[0][place])).sum();
        assert_eq!((vec![all], stokes.volume.counts()), (counts, vec![0]));
        let pairs = before.iter().zip(stokes.heights());
        let off = pairs
            .map(|(wet, dry)| (wet - dry).abs())
            .fold(0.0, f32::max);
        assert!(off < 0.15, "{off}");
        // The rounded height of a whole cell.
        let rounded = before.iter().map(|height| (height - height.round()).abs());
        assert!(rounded.fold(0.0, f32::max) > 0.4);
    }

    #[test]
    fn paint_flows_over_dry_paint_and_leaves_it() {
        let grid = Grid::walled([20, 16, 10]);
        let mut stokes = swell(&grid);
        let dried = stokes.dry();
        assert_eq!(dried.len(), 1);
        let relief = stokes.base.distance.clone();
        for place in grid.block([4, 4, 5], [10, 10, 8]) {
            stokes.volume.paints[0][place] = CAPACITY;
        }
        let counts = stokes.volume.counts();
        let conditions = Conditions {
            cell_m: 2.5e-4,
            seconds: 0.02,
            paint: Paint::newtonian(1e-2),
            pull: [0.0, 0.0, -9.81],
        };
        let highest = |stokes: &Stokes| stokes.heights().into_iter().fold(0.0, f32::max);
        let before = highest(&stokes);
        for _ in 0..50 {
            stokes.step(&[], &conditions);
        }
        assert_eq!(stokes.volume.counts(), counts);
        assert!(stokes.base.distance == relief);
        let after = highest(&stokes);
        assert!(after < before - 0.2, "the heap sinks: {before} {after}");
    }
}
