//! A brush among the cells: rods with a velocity at either end, so that a rotating brush moves each cell with its
//! rotation (Baxter 2004, § 5.4.1).

use std::ops::Range;

use maulstick_num::wide;

use crate::domain::Solids;
use crate::grid::Grid;

/// A rod with round ends, as a segment of a bristle strip, a knife's edge or a handle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rod {
    /// Both ends, cells.
    pub ends: [[f32; 3]; 2],
    /// Radius, cells.
    pub radius: f32,
    /// Velocity of each end, m/s.
    pub velocity: [[f32; 3]; 2],
}

/// Distance from a rod within which faces have its velocity, cells.
const BESIDE: f32 = 1.5;

/// A rod's lowest end and the vector to the other, with precomputed terms for its distance from places of a row.
#[derive(Clone, Copy)]
struct Line {
    from: [f32; 3],
    way: [f32; 3],
    /// Inverse of the vector's square; 0 of a ball.
    inverse: f32,
    radius: f32,
}

impl Line {
    fn of(rod: &Rod) -> Self {
        let [from, to] = rod.ends;
        let way = [0, 1, 2].map(|axis| to[axis] - from[axis]);
        let squared = way.iter().map(|way| way * way).sum::<f32>();
        Self {
            from,
            way,
            inverse: if squared > 0.0 { 1.0 / squared } else { 0.0 },
            radius: rod.radius,
        }
    }

    /// Distance from its surface, and parameter of the nearest place along it, 0 to 1.
    #[inline(always)]
    fn nearest(&self, x: f32, y: f32, z: f32) -> [f32; 2] {
        let (x, y, z) = (x - self.from[0], y - self.from[1], z - self.from[2]);
        let [a, b, c] = self.way;
        let along = ((a * x + b * y) + c * z) * self.inverse;
        let share = if along > 0.0 { along } else { 0.0 };
        let share = if share < 1.0 { share } else { 1.0 };
        let (x, y, z) = (x - share * a, y - share * b, z - share * c);
        [((x * x + y * y) + z * z).sqrt() - self.radius, share]
    }
}

impl Rod {
    /// True if its numbers are finite; other rods are ignored.
    fn is_finite(&self) -> bool {
        let numbers = self.ends.iter().chain(&self.velocity).flatten();
        self.radius.is_finite() && numbers.into_iter().all(|number| number.is_finite())
    }
}

wide! {
    /// Distances at the corners of a row that begins at a place.
    fn near_corners(distance: &mut [f32], line: Line, start: [f32; 3]) {
        let [x, y, z] = start;
        for i in 0..distance.len() {
            let [found, _] = line.nearest(x + i as i32 as f32, y, z);
            distance[i] = if found < distance[i] { found } else { distance[i] };
        }
    }
}

wide! {
    /// Distances and velocities at the middles of a row's faces, the first of which is at a place.
    fn near_faces(nearest: &mut [f32], velocity: &mut [f32], line: Line, ends: [f32; 2], start: [f32; 3]) {
        let [x, y, z] = start;
        let [first, last] = ends;
        let velocity = &mut velocity[..nearest.len()];
        for i in 0..nearest.len() {
            let [found, share] = line.nearest(x + i as i32 as f32, y, z);
            let is_nearer = found < nearest[i];
            nearest[i] = if is_nearer { found } else { nearest[i] };
            velocity[i] = if is_nearer { first + share * (last - first) } else { velocity[i] };
        }
    }
}

/// Buffers for rods among the cells.
#[derive(Clone, Debug, Default)]
pub(crate) struct Voxels {
    /// Distance of the nearest rod from each face, by axis; [`BESIDE`] between steps.
    nearest: [Vec<f32>; 3],
    /// Rows that were written.
    rows: Vec<Range<usize>>,
}

impl Voxels {
    /// Adds rods to the solids of a window. Among several nearby rods the nearest one's velocity is used.
    pub(crate) fn add(&mut self, grid: &Grid, solids: &mut Solids, rods: &[Rod]) {
        for nearest in &mut self.nearest {
            nearest.resize(grid.len(), BESIDE);
        }
        self.rows.clear();
        for rod in rods.iter().filter(|rod| rod.is_finite()) {
            let reach = rod.radius + BESIDE + 1.0;
            let bound = |axis: usize, of: fn(f32, f32) -> f32, by: f32| {
                let most = (grid.cells[axis] + 1) as f32;
                (of(rod.ends[0][axis], rod.ends[1][axis]) + by).clamp(-1.0, most) as isize
            };
            let from = [0, 1, 2].map(|axis| bound(axis, f32::min, -reach));
            let to = [0, 1, 2].map(|axis| bound(axis, f32::max, reach) + 1);
            let line = Line::of(rod);
            for z in from[2]..to[2] {
                for y in from[1]..to[1] {
                    let start = grid.at([from[0], y, z]);
                    let row = start..start + (to[0] - from[0]).max(0) as usize;
                    self.rows.push(row.clone());
                    let corner = [from[0], y, z].map(|at| at as f32);
                    near_corners(&mut solids.distance[row.clone()], line, corner);
                    for axis in 0..3 {
                        let mut middle = corner.map(|at| at + 0.5);
                        middle[axis] = corner[axis];
                        let nearest = &mut self.nearest[axis][row.clone()];
                        let velocity = &mut solids.velocity[axis][row.clone()];
                        let ends = rod.velocity.map(|velocity| velocity[axis]);
                        near_faces(nearest, velocity, line, ends, middle);
                    }
                }
            }
        }
        for row in self.rows.drain(..) {
            for nearest in &mut self.nearest {
                nearest[row.clone()].fill(BESIDE);
            }
        }
    }
}

/// Adds rods to the solids of a window. Among several nearby rods the nearest one's velocity is used.
pub fn voxelise(grid: &Grid, solids: &mut Solids, rods: &[Rod]) {
    Voxels::default().add(grid, solids, rods);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turning_rod_moves_each_cell_as_it_turns() {
        let grid = Grid::walled([16; 3]);
        let mut solids = Solids::walls(&grid);
        let rod = Rod {
            ends: [[4.0, 8.0, 8.0], [12.0, 8.0, 8.0]],
            radius: 1.5,
            velocity: [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]],
        };
        voxelise(&grid, &mut solids, &[rod]);
        let at = |x| grid.at([x, 8, 8]);
        assert_eq!(solids.velocity[1][at(8)], 0.125);
        assert_eq!(solids.velocity[1][at(12)], 1.0);
        assert!((solids.velocity[1][at(5)] + 0.625).abs() < 1e-6);
        assert!(solids.distance[at(8)] < 0.0 && solids.distance[grid.at([8, 11, 8])] > 0.0);
        assert_eq!(solids.velocity[1][grid.at([8, 14, 8])], 0.0, "far away");
    }

    #[test]
    fn rods_outside_and_without_numbers_change_nothing_inside() {
        let grid = Grid::walled([8; 3]);
        let walls = Solids::walls(&grid);
        for start in [f32::NAN, f32::INFINITY, 1e30, -500.0] {
            let mut solids = walls.clone();
            let rod = Rod {
                ends: [[start; 3]; 2],
                radius: 1.0,
                velocity: [[1.0; 3]; 2],
            };
            voxelise(&grid, &mut solids, &[rod]);
            assert!(solids.distance == walls.distance, "{start}");
        }
    }
}
