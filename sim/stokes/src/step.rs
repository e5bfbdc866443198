//! One step of the paint in a window.

use crate::body::{Rod, voxelise};
use crate::domain::{Domain, Solids};
use crate::flow::{Conditions, Flow};
use crate::grid::Grid;
use crate::volume::Volume;

/// Paint in a window, how it flows, and what it lies on.
#[derive(Clone, Debug)]
pub struct Stokes {
    /// The paint.
    pub volume: Volume,
    /// Its flow.
    pub flow: Flow,
    /// What does not move: canvas and walls.
    pub base: Solids,
}

impl Stokes {
    /// An empty window over a flat canvas, for so many paints; a cell holds so many quanta.
    #[must_use]
    pub fn new(grid: &Grid, capacity: u32, paints: usize) -> Self {
        Self {
            volume: Volume::new(grid, capacity, paints),
            flow: Flow::new(grid),
            base: Solids::walls(grid),
        }
    }

    /// Moves the paint for one step of a brush; returns what the equations saw.
    pub fn step(&mut self, brush: &[Rod], conditions: &Conditions) -> Domain {
        let grid = self.volume.grid;
        let mut solids = self.base.clone();
        voxelise(&grid, &mut solids, brush);
        let open = solids.open(&grid);
        let fill = self.volume.fill(&open);
        let domain = self.flow.step(&fill, &solids, conditions);
        let Conditions {
            seconds, cell_m, ..
        } = *conditions;
        self.volume
            .advect(&domain, &open, &self.flow.velocity, seconds, cell_m);
        domain
    }
}
