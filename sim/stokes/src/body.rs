//! A brush among the cells: rods with a velocity at either end, so that a turning brush moves each cell as it turns
//! (Baxter 2004, § 5.4.1).

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

/// Cells beyond a rod whose faces have its velocity.
const BESIDE: f32 = 1.5;

impl Rod {
    /// Distance from its surface, and how far along it the nearest place lies, from 0 to 1.
    fn nearest(&self, point: [f32; 3]) -> [f32; 2] {
        let [from, to] = self.ends;
        let (mut along, mut squared) = (0.0, 0.0);
        for axis in 0..3 {
            let way = to[axis] - from[axis];
            along += way * (point[axis] - from[axis]);
            squared += way * way;
        }
        let share = if squared > 0.0 {
            (along / squared).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let mut away = 0.0;
        for axis in 0..3 {
            let d = point[axis] - from[axis] - share * (to[axis] - from[axis]);
            away += d * d;
        }
        [away.sqrt() - self.radius, share]
    }

    /// True if it is somewhere: a rod without finite numbers is nowhere.
    fn is_finite(&self) -> bool {
        let numbers = self.ends.iter().chain(&self.velocity).flatten();
        self.radius.is_finite() && numbers.into_iter().all(|number| number.is_finite())
    }
}

/// Adds rods to the solids of a window. Where several are near, the nearest one's velocity counts.
pub fn voxelise(grid: &Grid, solids: &mut Solids, rods: &[Rod]) {
    let mut nearest = [(); 3].map(|()| vec![BESIDE; grid.len()]);
    for rod in rods.iter().filter(|rod| rod.is_finite()) {
        let reach = rod.radius + BESIDE + 1.0;
        let bound = |axis: usize, of: fn(f32, f32) -> f32, by: f32| {
            let most = (grid.cells[axis] + 1) as f32;
            (of(rod.ends[0][axis], rod.ends[1][axis]) + by).clamp(-1.0, most) as isize
        };
        let from = [0, 1, 2].map(|axis| bound(axis, f32::min, -reach));
        let to = [0, 1, 2].map(|axis| bound(axis, f32::max, reach) + 1);
        for place in grid.block(from, to) {
            let corner = grid.cell(place).map(|at| at as f32);
            let near = &mut solids.distance[place];
            *near = near.min(rod.nearest(corner)[0]);
            for axis in 0..3 {
                let mut middle = corner.map(|at| at + 0.5);
                middle[axis] = corner[axis];
                let [distance, share] = rod.nearest(middle);
                if distance < nearest[axis][place] {
                    nearest[axis][place] = distance;
                    let [first, last] = rod.velocity.map(|velocity| velocity[axis]);
                    solids.velocity[axis][place] = first + share * (last - first);
                }
            }
        }
    }
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
