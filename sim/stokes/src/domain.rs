//! What the equations see of a window: which cells and faces take part, and how much of each.
//!
//! A cell is filled to a fraction; the average over cells beside a face or around an edge is how much of the face's or
//! edge's volume is paint (Batty and Bridson 2008; Larionov, Batty and Bridson 2017). An edge at which one of the four
//! velocities is of air takes up no shear: that is the free surface's natural condition.
//!
//! Solids are given by their distance, so that a wall between two faces is where it is: a velocity at distance θ from a
//! wall has (u − u_wall)/θ as its gradient, over a volume of θ. For a wall in the middle that is a reflected ghost.

use crate::grid::{Ends, Grid, Side, others};

/// Fill of a cell from which on it resists pressure.
pub const LEAST_FILL: f32 = 0.1;
/// Smallest mass of a face.
const LEAST_MASS: f32 = 0.05;
/// Smallest distance of a velocity from a wall, in cells.
const LEAST_DISTANCE: f32 = 0.1;
/// Distance where no solid is near, cells.
const FAR: f32 = 64.0;
/// Distance at which a face belongs to a solid.
const TOUCHES: f32 = 1e-4;

/// Solids in a window.
#[derive(Clone, Debug)]
pub struct Solids {
    /// Distance of each lower corner from the nearest solid, cells; negative inside. The grid's sides do not count.
    pub distance: Vec<f32>,
    /// Velocity of the solid at each face, by axis, m/s.
    pub velocity: [Vec<f32>; 3],
    /// Resistance of bristles at each face, by axis: h²/K with K their permeability. They move with `velocity`, and paint goes
    /// through them (Brinkman 1949). None where there are no bristles.
    pub resistance: Option<[Vec<f32>; 3]>,
}

impl Solids {
    /// None but the grid's own sides, at rest.
    #[must_use]
    pub fn walls(grid: &Grid) -> Self {
        Self {
            distance: vec![FAR; grid.len()],
            velocity: std::array::from_fn(|_| grid.field()),
            resistance: None,
        }
    }

    /// Adds a solid by its distance from each corner, which is given in cells.
    pub fn add(&mut self, grid: &Grid, distance: impl Fn([f32; 3]) -> f32) {
        for (place, near) in self.distance.iter_mut().enumerate() {
            *near = near.min(distance(grid.cell(place).map(|at| at as f32)));
        }
    }
}

impl Solids {
    /// Open share of each cell.
    #[must_use]
    pub fn open(&self, grid: &Grid) -> Vec<f32> {
        let mut corners = self.distance.clone();
        grid.wrap(&mut corners);
        let [x, y, z] = [0, 1, 2].map(|axis| grid.stride(axis));
        let mut shares = grid.field();
        for place in grid.places() {
            let eight = [0, x, y, x + y, z, x + z, y + z, x + y + z];
            shares[place] = open(&eight.map(|by| corners[place + by]));
        }
        grid.wrap(&mut shares);
        shares
    }
}

/// Part that a face has in the flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Nothing that flows is beside it.
    Air,
    /// It moves as a solid does.
    Solid,
    /// Its velocity is an unknown.
    Paint,
}

/// Cells, faces and edges of a window as the equations see them, in cells.
#[derive(Clone, Debug)]
pub struct Domain {
    /// The grid.
    pub grid: Grid,
    /// 1 for a cell with a pressure, otherwise 0.
    pub wet: Vec<f32>,
    /// Part of each face, by axis.
    pub part: [Vec<Part>; 3],
    /// 1 for a face whose velocity is an unknown, otherwise 0.
    pub free: [Vec<f32>; 3],
    /// Open part of a face whose velocity is an unknown, otherwise 0.
    pub area: [Vec<f32>; 3],
    /// Share of a face's volume that is paint; 0 where its velocity is none.
    pub mass: [Vec<f32>; 3],
    /// Share of a cell that is paint; 0 where it has no pressure.
    pub volume: Vec<f32>,
    /// Share of an edge's volume that is sheared paint; edge a runs along axis a.
    pub edge: [Vec<f32>; 3],
    /// Of each edge, the inverses of the distances between the velocities of the two [other](others) axes.
    pub slope: [[Vec<f32>; 2]; 3],
}

impl Domain {
    /// The window with cells filled to a fraction of what the solids leave open; below the least fill a cell is air.
    #[must_use]
    pub fn new(grid: &Grid, fill: &[f32], solids: &Solids, least: f32) -> Self {
        let mut domain = Self {
            grid: *grid,
            wet: grid.field(),
            part: std::array::from_fn(|_| vec![Part::Air; grid.len()]),
            free: std::array::from_fn(|_| grid.field()),
            area: std::array::from_fn(|_| grid.field()),
            mass: std::array::from_fn(|_| grid.field()),
            volume: grid.field(),
            edge: std::array::from_fn(|_| grid.field()),
            slope: std::array::from_fn(|_| std::array::from_fn(|_| vec![1.0; grid.len()])),
        };
        let mut fill = fill.to_vec();
        let mut corners = solids.distance.clone();
        grid.wrap(&mut fill);
        grid.wrap(&mut corners);
        let near = domain.find_faces(&corners);
        domain.find_cells(&fill, &corners, least);
        domain.find_free();
        domain.find_edges(&fill, &near);
        domain
    }

    /// What transport needs of the window: its faces, without masses, edges and slopes.
    #[must_use]
    pub fn for_transport(grid: &Grid, fill: &[f32], solids: &Solids, least: f32) -> Self {
        let mut domain = Self {
            grid: *grid,
            wet: grid.field(),
            part: std::array::from_fn(|_| vec![Part::Air; grid.len()]),
            free: std::array::from_fn(|_| Vec::new()),
            area: std::array::from_fn(|_| grid.field()),
            mass: std::array::from_fn(|_| Vec::new()),
            volume: Vec::new(),
            edge: std::array::from_fn(|_| Vec::new()),
            slope: std::array::from_fn(|_| std::array::from_fn(|_| Vec::new())),
        };
        domain.find_faces(&solids.distance);
        for place in grid.places() {
            domain.wet[place] = f32::from(fill[place] >= least);
        }
        for axis in 0..3 {
            let stride = grid.stride(axis);
            for place in stride..grid.len() {
                let is_wet = domain.wet[place] + domain.wet[place - stride] > 0.0;
                if is_wet && domain.part[axis][place] == Part::Air {
                    domain.part[axis][place] = Part::Paint;
                }
            }
        }
        domain
    }

    /// Distance of each face, by axis, and those that belong to a solid.
    fn find_faces(&mut self, corners: &[f32]) -> [Vec<f32>; 3] {
        let grid = self.grid;
        let mut near = [0, 1, 2].map(|_| vec![0.0; grid.len()]);
        for axis in 0..3 {
            let [b, c] = others(axis).map(|axis| grid.stride(axis));
            let last = grid.len() - b - c;
            for place in 0..last {
                let four = [0, b, c, b + c].map(|by| corners[place + by]);
                let distance = 0.25 * ((four[0] + four[1]) + (four[2] + four[3]));
                near[axis][place] = distance;
                if distance <= TOUCHES {
                    self.part[axis][place] = Part::Solid;
                } else {
                    self.area[axis][place] = open(&four);
                }
            }
            self.find_sides(axis);
            grid.wrap(&mut near[axis]);
            grid.wrap(&mut self.part[axis]);
            grid.wrap(&mut self.area[axis]);
        }
        near
    }

    /// Faces across an axis in the sides of the grid and beyond them.
    fn find_sides(&mut self, axis: usize) {
        let grid = self.grid;
        for along in 0..3 {
            let Ends::Sides([low, high]) = grid.ends[along] else {
                continue;
            };
            let last = grid.cells[along] as isize + isize::from(along == axis);
            let close = |layer: isize, side: Side, domain: &mut Self| {
                let is_in_side = along == axis && (layer == 0 || layer == last - 1);
                if is_in_side || side == Side::NoSlip {
                    for place in grid.layer_at(along, layer) {
                        domain.part[axis][place] = Part::Solid;
                        domain.area[axis][place] = 0.0;
                    }
                }
            };
            close(-1, low, self);
            for layer in last..=grid.cells[along] as isize + 1 {
                close(layer, high, self);
            }
            if along == axis {
                close(0, low, self);
                close(last - 1, high, self);
            }
        }
    }

    /// Cells that resist pressure.
    fn find_cells(&mut self, fill: &[f32], corners: &[f32], least: f32) {
        let grid = self.grid;
        let [x, y, z] = [0, 1, 2].map(|axis| grid.stride(axis));
        for place in grid.places() {
            if fill[place] < least {
                continue;
            }
            let is_closed = (0..3).all(|axis| {
                [0, grid.stride(axis)]
                    .iter()
                    .all(|by| self.part[axis][place + by] == Part::Solid)
            });
            if !is_closed {
                let eight = [0, x, y, x + y, z, x + z, y + z, x + y + z];
                let eight = eight.map(|by| corners[place + by]);
                self.wet[place] = 1.0;
                self.volume[place] = fill[place].min(1.0) * open(&eight);
            }
        }
        grid.wrap(&mut self.wet);
        grid.wrap(&mut self.volume);
    }

    /// Faces whose velocities are unknowns.
    fn find_free(&mut self) {
        let grid = self.grid;
        for axis in 0..3 {
            let stride = grid.stride(axis);
            for place in 0..grid.len() {
                let beside = [place.saturating_sub(stride), place];
                let is_wet = beside.iter().any(|cell| self.wet[*cell] > 0.0);
                let is_free = is_wet && self.part[axis][place] == Part::Air;
                if is_free {
                    let [low, high] = beside.map(|cell| self.volume[cell]);
                    self.part[axis][place] = Part::Paint;
                    self.free[axis][place] = 1.0;
                    self.mass[axis][place] = (0.5 * (low + high)).max(LEAST_MASS);
                } else {
                    self.area[axis][place] = 0.0;
                }
            }
            grid.wrap(&mut self.part[axis]);
            for field in [&mut self.free, &mut self.area, &mut self.mass] {
                grid.wrap(&mut field[axis]);
            }
        }
    }

    /// Shares and slopes of edges.
    fn find_edges(&mut self, fill: &[f32], near: &[Vec<f32>; 3]) {
        let grid = self.grid;
        for edge in 0..3 {
            let [a, b] = others(edge);
            let [by_a, by_b] = [a, b].map(|axis| grid.stride(axis));
            for place in grid.block([0; 3], grid.cells.map(|cells| cells as isize + 1)) {
                if self.part[a][place] == Part::Air || self.part[b][place] == Part::Air {
                    continue;
                }
                // The velocities along a lie beside each other along b.
                let pairs = [(a, by_b), (b, by_a)]
                    .map(|(axis, by)| [place, place - by].map(|at| (axis, at)));
                let parts = pairs.map(|pair| pair.map(|(axis, at)| self.part[axis][at]));
                let has = |part| parts.iter().flatten().any(|each| *each == part);
                if has(Part::Air) || !has(Part::Paint) {
                    continue;
                }
                let mut share = 1.0;
                if !has(Part::Solid) {
                    let around = [0, by_a, by_b, by_a + by_b].map(|by| fill[place - by].min(1.0));
                    share = 0.25 * ((around[0] + around[1]) + (around[2] + around[3]));
                }
                for (which, pair) in pairs.iter().enumerate() {
                    let [one, other] = parts[which];
                    if one != other {
                        let [d, e] = pair.map(|(axis, at)| near[axis][at]);
                        let (paint, solid) = if one == Part::Paint { (d, e) } else { (e, d) };
                        let distance = if solid > TOUCHES {
                            // The grid's own side lies in the middle.
                            0.5
                        } else {
                            (paint / (paint - solid.min(0.0))).max(LEAST_DISTANCE)
                        };
                        self.slope[edge][which][place] = 1.0 / distance;
                        share *= distance;
                    }
                }
                self.edge[edge][place] = share;
            }
            grid.wrap(&mut self.edge[edge]);
            self.slope[edge]
                .iter_mut()
                .for_each(|slope| grid.wrap(slope));
        }
    }
}

/// Open share of a face or a cell by the distances of its corners; exact for a plane along the grid.
fn open(corners: &[f32]) -> f32 {
    // Nothing is near.
    if corners[0] > 2.0 {
        return 1.0;
    }
    let sum = |of: fn(f32) -> f32| corners.iter().map(|distance| of(*distance)).sum::<f32>();
    let all = sum(f32::abs);
    if all > 0.0 {
        sum(|d| d.max(0.0)) / all
    } else {
        0.0
    }
}
