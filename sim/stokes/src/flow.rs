//! Flow of the paint in a window: velocity and pressure from one step to the next.

use crate::domain::{Domain, LEAST_FILL, Part, Solids};
use crate::grid::Grid;
use crate::operator::{fields, fields_mut};
use crate::rheology::Paint;
use crate::split;
use crate::unified::{Room, Unified, weights};

/// How velocity and pressure are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scheme {
    /// Both at once, with the free surface's natural condition.
    #[default]
    Unified,
    /// The dissertation's: diffusion, then pressure; surface velocities are zeroed.
    Split,
}

/// Number of iterations of a step; nothing else ends them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Steps for velocity and pressure at once.
    pub steps: usize,
    /// Conjugate gradients that then make the velocity free of divergence.
    pub projections: usize,
}

impl Default for Effort {
    fn default() -> Self {
        Self {
            steps: 8,
            projections: 5,
        }
    }
}

/// Part of a cell that it may be fuller or emptier than full.
const SLACK: f32 = 1e-3;

/// What paint flows as and what pulls at it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// Side of a cell, m.
    pub cell_m: f64,
    /// Length of a step, s.
    pub seconds: f64,
    /// The paint.
    pub paint: Paint,
    /// Acceleration, m/s².
    pub pull: [f64; 3],
}

/// Velocity and pressure in a window.
#[derive(Clone, Debug)]
pub struct Flow {
    /// The grid.
    pub grid: Grid,
    /// Velocity on the lower faces of each axis, m/s.
    pub velocity: [Vec<f32>; 3],
    /// Pressure by density in each cell, m²/s².
    pub pressure: Vec<f32>,
    /// How they are found.
    pub scheme: Scheme,
    /// Iterations of a step.
    pub effort: Effort,
    /// Part of what a cell has too much or lacks that leaves or enters it in a step.
    pub relief: f32,
    /// Norms of the residual in the last step, with that of the first guess.
    pub norms: Vec<f64>,
    room: Room,
}

impl Flow {
    /// Paint at rest.
    #[must_use]
    pub fn new(grid: &Grid) -> Self {
        Self {
            grid: *grid,
            velocity: std::array::from_fn(|_| grid.field()),
            pressure: grid.field(),
            scheme: Scheme::default(),
            effort: Effort::default(),
            relief: 0.25,
            norms: Vec::new(),
            room: Room::default(),
        }
    }

    /// One step with cells filled to a fraction, between solids; returns what the equations saw of the window: its layers
    /// up to the second above the highest paint.
    pub fn step(&mut self, fill: &[f32], solids: &Solids, conditions: &Conditions) -> Domain {
        let least = match self.scheme {
            Scheme::Unified => LEAST_FILL,
            // Baxter 2004, § 5.3: more than half.
            Scheme::Split => 0.5,
        };
        let whole = self.grid;
        self.grid = whole.below(highest(&whole, fill, least) + 2);
        self.resize();
        let domain = self.step_within(fill, solids, conditions, least);
        self.grid = whole;
        self.resize();
        domain
    }

    /// Fits all fields to the grid.
    fn resize(&mut self) {
        let len = self.grid.len();
        for field in self.velocity.iter_mut().chain([&mut self.pressure]) {
            field.resize(len, 0.0);
        }
    }

    fn step_within(
        &mut self,
        fill: &[f32],
        solids: &Solids,
        conditions: &Conditions,
        least: f32,
    ) -> Domain {
        let mut domain = Domain::new(&self.grid, fill, solids, least);
        let Conditions {
            cell_m,
            seconds,
            paint,
            pull,
        } = conditions;
        let tau = paint.viscosity * seconds / (cell_m * cell_m);
        for (axis, u) in self.velocity.iter_mut().enumerate() {
            for (place, u) in u.iter_mut().enumerate() {
                *u = match domain.part[axis][place] {
                    Part::Solid => solids.velocity[axis][place],
                    Part::Paint => *u,
                    Part::Air => 0.0,
                };
            }
            self.grid.wrap(u);
        }
        match self.scheme {
            Scheme::Unified => self.unified(&mut domain, fill, solids, conditions, tau),
            Scheme::Split => {
                let pull = pull.map(|pull| (pull * seconds) as f32);
                let to_pressure = (cell_m / seconds) as f32;
                let pressure = &mut self.pressure;
                rescale(pressure, &domain.wet, 1.0 / to_pressure);
                split::step(
                    &domain,
                    (tau, pull),
                    &mut self.velocity,
                    &solids.velocity,
                    pressure,
                );
                rescale(pressure, &domain.wet, to_pressure);
            }
        }
        extrapolate(&domain, &mut self.velocity);
        domain
    }

    fn unified(
        &mut self,
        domain: &mut Domain,
        fill: &[f32],
        solids: &Solids,
        conditions: &Conditions,
        tau: f64,
    ) {
        let pulled: [Vec<f32>; 3] = std::array::from_fn(|axis| {
            let gains = (conditions.pull[axis] * conditions.seconds) as f32;
            let mut pulled: Vec<f32> = self.velocity[axis].iter().map(|u| u + gains).collect();
            if let Some(resistance) = &solids.resistance {
                let bristles = (&resistance[axis][..], &solids.velocity[axis][..]);
                drag(domain, (axis, tau as f32), bristles, &mut pulled);
                let guesses = self.velocity[axis].iter_mut().zip(&pulled);
                for ((u, pulled), free) in guesses.zip(&domain.free[axis]) {
                    *u += free * (pulled - *u);
                }
            }
            pulled
        });
        let paint = &conditions.paint;
        let [u, v, w] = &self.velocity;
        let viscosities = paint.viscosities(domain, [u, v, w], conditions.cell_m);
        let mut equations = Unified::new(domain, tau, &viscosities);
        let [f, g, h] = &pulled;
        let mut b = equations.right_hand_side(domain, [f, g, h], &solids.velocity);
        // The equations know the pressure by the velocity that it makes in a step.
        let alpha = f64::from(weights(tau)[0]);
        let to_pressure = (conditions.cell_m / (alpha * conditions.seconds)) as f32;
        rescale(&mut self.pressure, &domain.wet, 1.0 / to_pressure);
        let mut x = [u, v, w, &self.pressure].map(Vec::as_slice).concat();
        self.relieve(domain, fill, conditions, &mut b);
        self.norms = equations.solve(&b, &mut x, self.effort.steps, &mut self.room);
        equations.project(domain, fields(&b)[3], &mut x, self.effort.projections);
        let [u, v, w, p] = fields_mut(&mut x);
        for (into, from) in self.velocity.iter_mut().zip([u, v, w]) {
            into.copy_from_slice(from);
        }
        self.pressure.copy_from_slice(p);
        rescale(&mut self.pressure, &domain.wet, to_pressure);
    }

    /// Lets a cell that is fuller than full, as rounding and moving solids leave it, give a part of that away in a step,
    /// and one within the paint that is not full take as much in.
    fn relieve(&self, domain: &Domain, fill: &[f32], conditions: &Conditions, b: &mut [f32]) {
        let grid = self.grid;
        let per_step = self.relief * (conditions.cell_m / conditions.seconds) as f32;
        let [.., displaced] = fields_mut(b);
        for place in grid.places().filter(|place| domain.wet[*place] > 0.0) {
            let beside = (0..3)
                .map(|axis| grid.stride(axis))
                .flat_map(|by| [place - by, place + by]);
            let is_inside = || beside.into_iter().all(|cell| domain.wet[cell] > 0.0);
            let excess = fill[place] - 1.0;
            if excess > SLACK || excess < -SLACK && is_inside() {
                displaced[place] += per_step * excess.min(1.0);
            }
        }
    }

    /// Largest divergence of the paint, by the largest velocity and a cell.
    #[must_use]
    pub fn divergence(&self, domain: &Domain, solids: &Solids) -> f64 {
        let flux = |axis: usize, place: usize| {
            let area = match domain.part[axis][place] {
                Part::Solid => 0.0,
                Part::Paint | Part::Air => domain.area[axis][place],
            };
            let moves = f64::from(self.velocity[axis][place] * area);
            moves + f64::from((1.0 - area) * solids.velocity[axis][place])
        };
        let leaves = |place: usize| {
            let axes = (0..3).map(|a| flux(a, place + domain.grid.stride(a)) - flux(a, place));
            axes.sum::<f64>().abs()
        };
        let wet = (domain.grid.places()).filter(|place| domain.wet[*place] > 0.0);
        let most = wet.map(leaves).fold(0.0, f64::max);
        most / self.fastest().max(f64::MIN_POSITIVE)
    }

    /// Largest component of a velocity, m/s.
    #[must_use]
    pub fn fastest(&self) -> f64 {
        let all = self.velocity.iter().flatten();
        all.fold(0.0, |most, u| f64::from(u.abs()).max(most))
    }

    /// Kinetic energy by density, in cells.
    #[must_use]
    pub fn energy(&self, domain: &Domain) -> f64 {
        let axis = |axis: usize| {
            let pairs = self.velocity[axis].iter().zip(&domain.mass[axis]);
            let free = pairs.zip(&domain.free[axis]);
            free.map(|((u, mass), free)| f64::from(free * mass * u * u))
                .sum::<f64>()
        };
        0.5 * (0..3).map(axis).sum::<f64>()
    }
}

/// Number of layers up to the highest cell that is filled so far.
fn highest(grid: &Grid, fill: &[f32], least: f32) -> usize {
    let [width, height, depth] = grid.cells.map(|cells| cells as isize);
    let has_paint = |z: &isize| {
        let layer = grid.block([0, 0, *z], [width, height, z + 1]);
        layer.into_iter().any(|place| fill[place] >= least)
    };
    (0..depth)
        .rev()
        .find(has_paint)
        .map_or(0, |z| z as usize + 1)
}

/// Bristles drag paint along: a face has their velocity by a share τR/(1 + τR), R their resistance, and then resists change by as
/// much more.
fn drag(
    domain: &mut Domain,
    (axis, tau): (usize, f32),
    (resistance, velocity): (&[f32], &[f32]),
    pulled: &mut [f32],
) {
    for (place, u) in pulled.iter_mut().enumerate() {
        let drags = tau * resistance[place] * domain.free[axis][place];
        *u = (*u + drags * velocity[place]) / (1.0 + drags);
        domain.mass[axis][place] *= 1.0 + drags;
    }
}

/// Multiplies a field where it is wet; elsewhere it is 0.
fn rescale(field: &mut [f32], wet: &[f32], by: f32) {
    for (value, wet) in field.iter_mut().zip(wet) {
        *value = if *wet > 0.0 { *value * by } else { 0.0 };
    }
}

/// Velocities of air beside paint: the mean of those around it, so that paint that comes there moves on with it.
fn extrapolate(domain: &Domain, velocity: &mut [Vec<f32>; 3]) {
    let grid = domain.grid;
    for (axis, u) in velocity.iter_mut().enumerate() {
        let part = &domain.part[axis];
        let strides = [0, 1, 2].map(|axis| grid.stride(axis));
        for place in grid.range().filter(|place| part[*place] == Part::Air) {
            let (mut sum, mut count) = (0.0, 0.0);
            for by in strides {
                for beside in [place - by, place + by] {
                    if part[beside] == Part::Paint {
                        sum += u[beside];
                        count += 1.0;
                    }
                }
            }
            if count > 0.0 {
                u[place] = sum / count;
            }
        }
        grid.wrap(u);
    }
}
