//! Paint in the cells of a window, counted in quanta, and its transport.
//!
//! The flux through a face is a number of quanta that one side loses and the other gains, so none is ever lost. A
//! cell's surface is a blend of a plane across one axis and a uniform fill, weighted by the normal (Noh and Woodward
//! 1976; Yokoi 2007), which keeps it within a cell or two. Axes follow one another, in a rotating order; a cell's
//! capacity changes with the flow through its faces along an axis, so that full cells stay full. Requests to a cell
//! beyond its content are scaled down together.

mod sweep;

use maulstick_num::wide;

use sweep::Sweep;

use crate::domain::{Domain, LEAST_FILL};
use crate::grid::Grid;

/// Greatest share of a cell that goes through one face in a part of a step.
const LARGEST_COURANT: f32 = 0.5;
/// Greatest number of parts of a step; faster paint moves only as far as they allow.
const MOST_PARTS: usize = 40;
/// Capacity of a cell filled by solids, relative to an open one.
const LEAST_ROOM: f32 = 0.3;
/// Orders of the axes, in rotation.
const ORDERS: [[usize; 3]; 6] = [
    [0, 1, 2],
    [2, 1, 0],
    [1, 2, 0],
    [0, 2, 1],
    [2, 0, 1],
    [1, 0, 2],
];

/// Paints of a window.
#[derive(Clone, Debug)]
pub struct Volume {
    /// The grid.
    pub grid: Grid,
    /// Quanta that fill a cell; below 2²².
    pub capacity: u32,
    /// Quanta of each paint, by cell.
    pub paints: Vec<Vec<u32>>,
    /// Quanta of all paints, by cell.
    total: Vec<u32>,
    /// True for each paint that is present.
    present: Vec<bool>,
    /// Capacity of each cell, quanta.
    room: Vec<f32>,
    fill: Vec<f32>,
    sweep: Sweep,
    /// Index of the next order of axes.
    turn: usize,
}

wide! {
    /// Adds a paint to the total, and its bits to the union of all bits.
    fn add(total: &mut [u32], paint: &[u32], bits: &mut u32) {
        let paint = &paint[..total.len()];
        let mut any = 0;
        for i in 0..total.len() {
            total[i] = total[i].wrapping_add(paint[i]);
            any |= paint[i];
        }
        *bits = any;
    }
}

wide! {
    fn fill_flat(fill: &mut [f32], total: &[u32], open: &[f32], capacity: f32) {
        let n = fill.len();
        let (total, open) = (&total[..n], &open[..n]);
        for i in 0..n {
            let open = if open[i] > LEAST_ROOM { open[i] } else { LEAST_ROOM };
            fill[i] = total[i] as f32 / (capacity * open);
        }
    }
}

wide! {
    fn find_rooms(room: &mut [f32], open: &[f32], capacity: f32) {
        let open = &open[..room.len()];
        for i in 0..room.len() {
            let open = if open[i] > LEAST_ROOM { open[i] } else { LEAST_ROOM };
            room[i] = capacity * open;
        }
    }
}

wide! {
    /// Largest absolute component, as bits, of velocities that are unknowns.
    fn find_fastest(most: &mut u32, u: &[f32], free: &[f32]) {
        let free = &free[..u.len()];
        let mut fastest = 0;
        for i in 0..u.len() {
            let bits = (free[i] * u[i].abs()).to_bits();
            fastest = if bits > fastest { bits } else { fastest };
        }
        *most = fastest;
    }
}

impl Volume {
    /// An empty window for `paints` paints.
    #[must_use]
    pub fn new(grid: &Grid, capacity: u32, paints: usize) -> Self {
        Self {
            grid: *grid,
            capacity,
            paints: vec![vec![0; grid.len()]; paints],
            total: vec![0; grid.len()],
            present: vec![false; paints],
            room: grid.field(),
            fill: grid.field(),
            sweep: Sweep::new(grid),
            turn: 0,
        }
    }

    /// Fill of each cell, as a share of its open volume.
    #[must_use]
    pub fn fill(&mut self, open: &[f32]) -> Vec<f32> {
        let mut fill = self.grid.field();
        self.fill_into(open, &mut fill);
        fill
    }

    /// Fill of each cell, written into a field.
    pub fn fill_into(&mut self, open: &[f32], fill: &mut [f32]) {
        self.add_up();
        fill_flat(fill, &self.total, open, self.capacity as f32);
    }

    /// Quanta of each paint.
    #[must_use]
    pub fn counts(&self) -> Vec<u64> {
        let sum = |paint: &Vec<u32>| {
            self.grid
                .places()
                .map(|place| u64::from(paint[place]))
                .sum()
        };
        self.paints.iter().map(sum).collect()
    }

    fn add_up(&mut self) {
        self.total.fill(0);
        self.present.clear();
        for paint in &self.paints {
            let mut bits = 0;
            add(&mut self.total, paint, &mut bits);
            self.present.push(bits != 0);
        }
        self.grid.wrap(&mut self.total);
    }

    /// Moves the paint for `seconds` with velocities in m/s on cells of `cell_m`; returns the number of parts.
    pub fn advect(
        &mut self,
        domain: &Domain,
        open: &[f32],
        velocity: &[Vec<f32>; 3],
        seconds: f64,
        cell_m: f64,
    ) -> usize {
        let courant = (seconds / cell_m) as f32;
        let fastest = [0, 1, 2].map(|axis| {
            let mut most = 0;
            let len = domain.grid.len();
            find_fastest(&mut most, &velocity[axis][..len], &domain.free[axis]);
            f32::from_bits(most)
        });
        let most = fastest.into_iter().fold(0.0, f32::max) * courant;
        let parts = ((most / LARGEST_COURANT).ceil() as usize).clamp(1, MOST_PARTS);
        self.add_up();
        self.sweep.begin(domain, self.capacity);
        for _ in 0..parts {
            // Cells are squeezed along one axis and stretched along another; full cells stay full in between.
            find_rooms(&mut self.room, open, self.capacity as f32);
            self.turn = (self.turn + 1) % 6;
            for axis in ORDERS[self.turn] {
                let courant = courant / parts as f32;
                let cells = (&mut *self.total, &mut *self.room);
                let paints = self.paints.iter_mut().zip(&self.present);
                let paints = paints.filter_map(|(paint, is_present)| is_present.then_some(paint));
                self.sweep.along(
                    domain,
                    (axis, courant),
                    (&velocity[axis], open),
                    cells,
                    paints,
                );
            }
        }
        self.settle(domain, open);
        parts
    }

    /// Lets drops that are too small to flow sink by a cell, where there is room for them.
    fn settle(&mut self, domain: &Domain, open: &[f32]) {
        let mut fill = std::mem::take(&mut self.fill);
        fill_flat(&mut fill, &self.total, open, self.capacity as f32);
        let (grid, by) = (domain.grid, domain.grid.stride(2));
        let [width, height, depth] = grid.cells;
        for row in 0..height * depth {
            let start = grid.at([0, (row % height) as isize, (row / height) as isize]);
            let cells = start..start + width;
            if !has_drops(&self.total[cells.clone()], &domain.wet[cells.clone()]) {
                continue;
            }
            for place in cells {
                let below = place - by;
                let is_drop = domain.wet[place] == 0.0 && fill[place] < LEAST_FILL;
                let has_room = fill[below] + fill[place] <= 1.0;
                if is_drop && has_room && domain.solid[2][place] == 0.0 {
                    let below = grid.before(2, place);
                    for paint in &mut self.paints {
                        paint[below] += std::mem::take(&mut paint[place]);
                    }
                }
            }
        }
        self.fill = fill;
    }
}

/// True if a row contains paint that does not flow.
fn has_drops(total: &[u32], wet: &[f32]) -> bool {
    let mut found = 0;
    for (total, wet) in total.iter().zip(wet) {
        found |= if *wet == 0.0 { *total } else { 0 };
    }
    found > 0
}
