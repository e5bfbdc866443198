//! Paint in the cells of a window, counted in quanta, and its transport.
//!
//! What goes through a face is a number of quanta that one side loses and the other gains, so none is ever lost. A cell's
//! surface is a plane across one axis in part and none in part, weighted by the normal (Noh and Woodward 1976; Yokoi 2007),
//! which keeps it within a cell or two. Axes follow one another, in an order that turns; a cell's room changes with what
//! flows through its faces along an axis, so that full cells stay full. What is asked of a cell beyond what it has is
//! scaled down together.

use crate::domain::{Domain, LEAST_FILL, Part};
use crate::grid::Grid;

/// Most of a cell that goes through one face in a part of a step.
const LARGEST_COURANT: f32 = 0.5;
/// Parts of a step at most; what is faster goes as far as they bring it.
const MOST_PARTS: usize = 40;
/// Room of a cell that solids fill, by that of an open one.
const LEAST_ROOM: f32 = 0.3;
/// Orders of the axes, in turn.
const ORDERS: [[usize; 3]; 6] = [
    [0, 1, 2],
    [2, 1, 0],
    [1, 2, 0],
    [0, 2, 1],
    [2, 0, 1],
    [1, 0, 2],
];
/// Gradient of fill below which a cell has no surface.
const LEAST_GRADIENT: f32 = 1e-3;

/// Paints of a window.
#[derive(Clone, Debug)]
pub struct Volume {
    /// The grid.
    pub grid: Grid,
    /// Quanta that fill a cell.
    pub capacity: u32,
    /// Quanta of each paint, by cell.
    pub paints: Vec<Vec<u32>>,
    /// Quanta of all paints, by cell.
    total: Vec<u32>,
    /// Quanta that are asked of each cell.
    asked: Vec<u32>,
    /// Donor, taker and quanta of each face that something goes through.
    moves: Vec<[u32; 3]>,
    /// Quanta of a paint before.
    before: Vec<u32>,
    fill: Vec<f32>,
    /// Number of the next order of axes.
    turn: usize,
}

impl Volume {
    /// An empty window for so many paints.
    #[must_use]
    pub fn new(grid: &Grid, capacity: u32, paints: usize) -> Self {
        Self {
            grid: *grid,
            capacity,
            paints: vec![vec![0; grid.len()]; paints],
            total: vec![0; grid.len()],
            asked: vec![0; grid.len()],
            moves: Vec::new(),
            before: vec![0; grid.len()],
            fill: grid.field(),
            turn: 0,
        }
    }

    /// Fraction of each cell that is filled, of what solids leave open of it.
    #[must_use]
    pub fn fill(&mut self, open: &[f32]) -> Vec<f32> {
        self.add_up();
        let rooms = self.rooms(open);
        let cells = self.total.iter().zip(rooms);
        cells.map(|(total, room)| *total as f32 / room).collect()
    }

    /// Quanta that each cell has room for.
    fn rooms(&self, open: &[f32]) -> Vec<f32> {
        let rooms = open
            .iter()
            .map(|open| self.capacity as f32 * open.max(LEAST_ROOM));
        rooms.collect()
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
        for paint in &self.paints {
            for (total, count) in self.total.iter_mut().zip(paint) {
                *total += count;
            }
        }
        self.grid.wrap(&mut self.total);
    }

    /// Moves the paint for so many seconds with velocities in m/s on cells of `cell_m`; returns the number of parts.
    pub fn advect(
        &mut self,
        domain: &Domain,
        open: &[f32],
        velocity: &[Vec<f32>; 3],
        seconds: f64,
        cell_m: f64,
    ) -> usize {
        let courant = (seconds / cell_m) as f32;
        let fastest = (0..3).flat_map(|axis| {
            let free = domain.part[axis].iter().zip(&velocity[axis]);
            free.map(|(part, u)| if *part == Part::Paint { u.abs() } else { 0.0 })
        });
        let most = fastest.fold(0.0, f32::max) * courant;
        let parts = ((most / LARGEST_COURANT).ceil() as usize).clamp(1, MOST_PARTS);
        for _ in 0..parts {
            // Cells are squeezed along one axis and stretched along another; what is full stays full on the way.
            let mut room = self.rooms(open);
            self.turn = (self.turn + 1) % 6;
            for axis in ORDERS[self.turn] {
                self.sweep(
                    domain,
                    axis,
                    &velocity[axis],
                    courant / parts as f32,
                    &mut room,
                );
            }
        }
        self.settle(domain, open);
        parts
    }

    /// Lets drops that are too small to flow sink by a cell, where there is room for them.
    fn settle(&mut self, domain: &Domain, open: &[f32]) {
        let fill = self.fill(open);
        let (grid, by) = (domain.grid, domain.grid.stride(2));
        for place in grid.places().filter(|place| self.total[*place] > 0) {
            let below = place - by;
            let is_drop = domain.wet[place] == 0.0 && fill[place] < LEAST_FILL;
            let has_room = fill[below] + fill[place] <= 1.0;
            if is_drop && has_room && domain.part[2][place] != Part::Solid {
                let below = grid.before(2, place);
                for paint in &mut self.paints {
                    paint[below] += std::mem::take(&mut paint[place]);
                }
            }
        }
    }

    /// Moves paint along one axis.
    fn sweep(
        &mut self,
        domain: &Domain,
        axis: usize,
        velocity: &[f32],
        courant: f32,
        room: &mut [f32],
    ) {
        let grid = domain.grid;
        let strides = [0, 1, 2].map(|axis| grid.stride(axis));
        self.add_up();
        let least = LEAST_ROOM * self.capacity as f32;
        for (fill, (total, room)) in self.fill.iter_mut().zip(self.total.iter().zip(&*room)) {
            // What came too fast for the other axes to take away leaves no less room than a solid does.
            *fill = *total as f32 / room.max(least);
        }
        self.moves.clear();
        self.asked.fill(0);
        for place in grid.faces(axis) {
            if domain.part[axis][place] != Part::Paint {
                continue;
            }
            let c = domain.area[axis][place] * courant * velocity[place];
            let c = c.clamp(-LARGEST_COURANT, LARGEST_COURANT);
            let beside = grid.before(axis, place);
            let moved = c * self.capacity as f32;
            room[beside] -= moved;
            room[place] += moved;
            let donor = if c > 0.0 { beside } else { place };
            if self.total[donor] > 0 {
                let share = leaving(&self.fill, donor, (axis, c), strides);
                let asks = (share.abs() * self.capacity as f32) as u32;
                let asks = asks.min(self.total[donor]);
                let taker = if c > 0.0 { place } else { beside };
                self.asked[donor] += asks;
                self.moves.push([donor as u32, taker as u32, asks]);
            }
        }
        grid.wrap(room);
        self.limit();
        self.carry();
    }

    /// Scales what is asked of a cell down to what it has.
    fn limit(&mut self) {
        for [donor, _, goes] in &mut self.moves {
            let donor = *donor as usize;
            let [asks, asked, has] = [*goes, self.asked[donor], self.total[donor]].map(u64::from);
            if asked > has {
                *goes = (asks * has / asked) as u32;
            }
        }
    }

    /// Moves the paints, each by its share of the cell that gives.
    fn carry(&mut self) {
        for paint in &mut self.paints {
            self.before.copy_from_slice(paint);
            for [donor, taker, goes] in &self.moves {
                let (donor, taker) = (*donor as usize, *taker as usize);
                let share = u64::from(*goes) * u64::from(self.before[donor]);
                let goes = (share / u64::from(self.total[donor].max(1))) as u32;
                paint[donor] -= goes;
                paint[taker] += goes;
            }
        }
    }
}

/// Share of a cell that leaves a donor along an axis for a Courant number.
fn leaving(fill: &[f32], donor: usize, (axis, c): (usize, f32), strides: [usize; 3]) -> f32 {
    let f = fill[donor];
    if f >= 1.0 {
        return c * f;
    }
    let slope =
        |axis: usize| fill[donor + strides[axis]].min(1.0) - fill[donor - strides[axis]].min(1.0);
    let slopes = [slope(0), slope(1), slope(2)];
    let sum = slopes[0].abs() + slopes[1].abs() + slopes[2].abs();
    if sum < LEAST_GRADIENT {
        return c * f;
    }
    let across = slopes[axis].abs() / sum;
    let reach = c.abs();
    // Paint lies on the side that it leaves to, or behind air.
    let piled = if (slopes[axis] > 0.0) == (c > 0.0) {
        reach.min(f)
    } else {
        (reach - (1.0 - f)).max(0.0)
    };
    across * piled + (1.0 - across) * reach * f
}
