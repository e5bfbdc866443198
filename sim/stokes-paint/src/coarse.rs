//! The grid on which the flow around a brush is found: cubes of several voxels, from which velocities come back to the faces
//! of the voxels.
//!
//! Paint is moved voxel by voxel, so the marks of bristles are as fine as the cells of the surface, and the flow that carries
//! them is as wide as a brush makes it (Baxter 2004, § 5.6).

use maulstick_stokes::domain::Solids;
use maulstick_stokes::grid::Grid;

use crate::voxels::Voxels;

/// Side of a cell on which flow is found, m, where voxels are smaller.
const SIDE_M: f64 = 5e-4;

/// Voxels along the side of a cell of the flow, for voxels of `cell_m`.
#[must_use]
pub fn voxels_a_side(cell_m: f64) -> usize {
    ((SIDE_M / cell_m) as usize).max(1)
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
    /// What the paint lies on; bristles as they are [added](Self::resist).
    pub solids: Solids,
    /// Paint of each cell, in voxels.
    paint: Vec<f32>,
    resistance: Vec<f32>,
    carried: [Vec<f32>; 2],
}

impl Coarse {
    /// The paint of an area, so many voxels to the side of a cell; `open` is the share of each voxel that is.
    #[must_use]
    pub fn of(voxels: &Voxels, open: &[f32], side: usize) -> Self {
        let fine = voxels.volume.grid;
        let grid = Grid::walled(fine.cells.map(|cells| cells.div_ceil(side)));
        let capacity = voxels.volume.capacity as f32;
        let (mut filled, mut room) = (grid.field(), grid.field());
        for place in fine.places() {
            let coarse = grid.at(fine.cell(place).map(|at| at / side as isize));
            filled[coarse] += voxels.total(place) as f32 / capacity;
            room[coarse] += open[place];
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

    /// Adds bristles that hold so much paint of a voxel, in voxels: their resistance h²/K for a cell of this grid, and their
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

    /// Puts the bristles on the faces between cells.
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

    /// Velocities on the faces of the voxels, between those on the faces of this grid.
    #[must_use]
    pub fn refine(&self, velocity: &[Vec<f32>; 3], fine: &Grid) -> [Vec<f32>; 3] {
        if self.side == 1 {
            return velocity.clone();
        }
        let side = self.side as f32;
        let from = self.grid;
        std::array::from_fn(|axis| {
            // Along its own axis a face lies on a face, across it in the middle of cells.
            let place = |at: isize, along: usize| {
                let at = (at as f32 + if along == axis { 0.0 } else { 0.5 }) / side;
                let at = if along == axis { at } else { at - 0.5 };
                let low = at.floor();
                let last = from.cells[along] as isize + 1;
                let whole = (low as isize).clamp(-1, last - 1);
                (whole, at - low)
            };
            let field = &velocity[axis];
            let mut refined = fine.field();
            for face in fine.faces(axis) {
                let cell = fine.cell(face);
                let [(x, u), (y, v), (z, w)] = [0, 1, 2].map(|along| place(cell[along], along));
                let corner = from.at([x, y, z]);
                let [dx, dy, dz] = [0, 1, 2].map(|along| from.stride(along));
                let row = |at: usize| field[at] + u * (field[at + dx] - field[at]);
                let sheet = |at: usize| row(at) + v * (row(at + dy) - row(at));
                refined[face] = sheet(corner) + w * (sheet(corner + dz) - sheet(corner));
            }
            refined
        })
    }
}

/// What the paint lies on, at the corners of the cells.
fn relief(grid: &Grid, side: usize, voxels: &Voxels) -> Solids {
    let mut solids = Solids::walls(grid);
    let plane = grid.stride(2);
    let corners: Vec<f32> = (0..plane)
        .map(|place| {
            let [x, y, _] = grid.cell(place).map(|at| at * side as isize);
            voxels.floor_at([x, y]) / side as f32
        })
        .collect();
    for (place, distance) in solids.distance.iter_mut().enumerate() {
        *distance = distance.min(grid.cell(place)[2] as f32 - corners[place % plane]);
    }
    solids
}
