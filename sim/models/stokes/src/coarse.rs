//! The grid of the flow around a brush: cubes of several voxels, whose velocities are interpolated to the faces of the
//! voxels.
//!
//! Paint is moved voxel by voxel, so the marks of bristles are as fine as the cells of the surface, while the flow
//! varies on the scale of a brush (Baxter 2004, § 5.6).

use maulstick_stokes::domain::Solids;
use maulstick_stokes::flow::Conditions;
use maulstick_stokes::grid::Grid;

use crate::voxels::Voxels;

/// Paint at rest in a window, and what moves it.
#[derive(Clone, Copy, Debug)]
pub struct FlowWindow<'a> {
    /// The cells.
    pub grid: &'a Grid,
    /// Fill of each cell.
    pub fill: &'a [f32],
    /// What the paint lies on, and the bristles in it.
    pub solids: &'a Solids,
    /// Step, paint and gravity.
    pub conditions: &'a Conditions,
}

/// The paint of an area on the grid of the flow.
#[derive(Clone, Debug)]
pub struct Coarse {
    /// Its cells.
    pub grid: Grid,
    /// Voxels along the side of a cell.
    pub side: usize,
    /// Fill of each cell.
    pub fill: Vec<f32>,
    /// Base of the paint; bristles are [added](Self::resist).
    pub solids: Solids,
    /// Paint of each cell, in voxels.
    paint: Vec<f32>,
    resistance: Vec<f32>,
    carried: [Vec<f32>; 2],
}

impl Coarse {
    /// The paint of an area on cells of `side` voxels; `open` is the open share of each voxel, `totals` its quanta.
    #[must_use]
    pub fn of(voxels: &Voxels, (open, totals): (&[f32], &[u32]), side: usize) -> Self {
        let fine = voxels.volume.grid;
        let mut cells = fine.cells.map(|cells| cells.div_ceil(side));
        // The voxels' layers of air above the paint may be less than one such cell.
        cells[2] += usize::from(side > voxels.side());
        let grid = Grid::walled(cells);
        let capacity = voxels.volume.capacity as f32;
        let (mut filled, mut room) = (grid.field(), grid.field());
        for z in 0..fine.cells[2] {
            for y in 0..fine.cells[1] {
                let from = fine.at([0, y as isize, z as isize]);
                let to = grid.at([0, (y / side) as isize, (z / side) as isize]);
                for x in 0..fine.cells[0] {
                    filled[to + x / side] += totals[from + x] as f32 / capacity;
                    room[to + x / side] += open[from + x];
                }
            }
        }
        let least = 0.05 * (side * side * side) as f32;
        let fill = filled.iter().zip(&room);
        let fill = fill.map(|(filled, room)| filled / room.max(least));
        Self {
            fill: fill.collect(),
            solids: relief(&grid, side, voxels),
            paint: filled,
            resistance: grid.field(),
            carried: [grid.field(), grid.field()],
            grid,
            side,
        }
    }

    /// Adds bristles in so much paint of a voxel, in voxels: their resistance h²/K for a cell of this grid, and their
    /// velocity along the surface, m/s.
    pub fn resist(
        &mut self,
        voxel: [isize; 3],
        (held, resistance): (f32, f32),
        velocity: [f32; 2],
    ) {
        let place = self.grid.at(voxel.map(|at| at / self.side as isize));
        let share = resistance * held / self.paint[place].max(f32::MIN_POSITIVE);
        self.resistance[place] += share;
        for (carried, velocity) in self.carried.iter_mut().zip(velocity) {
            carried[place] += share * velocity;
        }
    }

    /// Averages the bristles onto the faces between cells.
    pub fn hold(&mut self) {
        let grid = self.grid;
        let cells = &self.resistance;
        let resistance: [Vec<f32>; 3] = std::array::from_fn(|axis| {
            let by = grid.stride(axis);
            let velocity = &mut self.solids.velocity[axis];
            let carried = self.carried.get(axis);
            let face = |place: usize| {
                let Some(before) = place.checked_sub(by) else {
                    return 0.0;
                };
                let resists = cells[before] + cells[place];
                if let Some(carried) = carried
                    && resists > 0.0
                {
                    velocity[place] = (carried[before] + carried[place]) / resists;
                }
                0.5 * resists
            };
            (0..grid.len()).map(face).collect()
        });
        self.solids.resistance = Some(resistance);
    }

    /// The window of the flow.
    #[must_use]
    pub fn window<'a>(&'a self, conditions: &'a Conditions) -> FlowWindow<'a> {
        FlowWindow {
            grid: &self.grid,
            fill: &self.fill,
            solids: &self.solids,
            conditions,
        }
    }

    /// Velocities on the faces of the voxels, interpolated from the faces of this grid.
    #[must_use]
    pub fn refine(&self, velocity: &[Vec<f32>; 3], fine: &Grid) -> [Vec<f32>; 3] {
        if self.side == 1 {
            return velocity.clone();
        }
        let [dx, dy, dz] = [0, 1, 2].map(|along| self.grid.stride(along));
        std::array::from_fn(|axis| {
            let [xs, ys, zs] = [0, 1, 2].map(|along| self.places(along, axis, fine));
            let field = &velocity[axis];
            let mut refined = fine.field();
            for (z, (low_z, w)) in zs.iter().enumerate() {
                for (y, (low_y, v)) in ys.iter().enumerate() {
                    let row = self.grid.at([0, *low_y, *low_z]);
                    let to = fine.at([0, y as isize, z as isize]);
                    let into = &mut refined[to..to + xs.len()];
                    for (into, (low_x, u)) in into.iter_mut().zip(&xs) {
                        let corner = row.wrapping_add_signed(*low_x);
                        let along = |at: usize| field[at] + u * (field[at + dx] - field[at]);
                        let across = |at: usize| along(at) + v * (along(at + dy) - along(at));
                        let (below, above) = (across(corner), across(corner + dz));
                        *into = below + w * (above - below);
                    }
                }
            }
            refined
        })
    }

    /// For the faces across an axis of voxels along another one: the cell before each, and its distance beyond it.
    fn places(&self, along: usize, axis: usize, fine: &Grid) -> Vec<(isize, f32)> {
        let (side, last) = (self.side as f32, self.grid.cells[along] as isize);
        let count = fine.cells[along] + usize::from(along == axis);
        let place = |at: usize| {
            // Along its own axis a face coincides with a face, across it it is in the middle of cells.
            let at = if along == axis {
                at as f32 / side
            } else {
                (at as f32 + 0.5) / side - 0.5
            };
            let low = at.floor();
            ((low as isize).clamp(-1, last), at - low)
        };
        (0..count).map(place).collect()
    }
}

/// Base of the paint, at the corners of the cells.
fn relief(grid: &Grid, side: usize, voxels: &Voxels) -> Solids {
    let mut solids = Solids::walls(grid);
    let plane = grid.stride(2);
    let corners: Vec<f32> = (0..plane)
        .map(|place| {
            let [x, y, _] = grid.cell(place).map(|at| at * side as isize);
            voxels.floor_at([x, y]) / side as f32
        })
        .collect();
    for (layer, distances) in solids.distance.chunks_exact_mut(plane).enumerate() {
        let height = layer as f32 - 1.0;
        for (distance, corner) in distances.iter_mut().zip(&corners) {
            *distance = distance.min(height - corner);
        }
    }
    solids
}
