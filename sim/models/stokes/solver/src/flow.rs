//! Flow of the paint in a window: velocity and pressure from one step to the next.

mod flat;

use std::sync::Arc;

use crate::domain::{Domain, LEAST_FILL, Part, Solids};
use crate::grid::Grid;
use crate::operator::Unknowns;
use crate::rheology::Paint;
use crate::split;
use crate::stencil::Span;
use crate::unified::{Unified, weights};

/// Scheme for velocity and pressure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scheme {
    /// Both at once, with the free surface's natural condition.
    #[default]
    Unified,
    /// The dissertation's: diffusion, then pressure; surface velocities are zeroed.
    Split,
}

/// Fixed numbers of iterations of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Number of iterations for velocity and pressure at once.
    pub steps: usize,
    /// Number of conjugate gradients that then remove the divergence of the velocity.
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

/// Rheology of the paint, time step and body force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Conditions {
    /// Side of a cell, m.
    pub cell_m: f64,
    /// Duration of a step, s.
    pub seconds: f64,
    /// Rheology of the paint.
    pub paint: Paint,
    /// Acceleration of the body force, m/s².
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
    /// Scheme for velocity and pressure.
    pub scheme: Scheme,
    /// Numbers of iterations of a step.
    pub effort: Effort,
    /// Share of a cell's excess or deficit of volume that is corrected in a step.
    pub relief: f32,
    /// Norms of the residual in the last step, the first guess's included.
    pub norms: Vec<f64>,
    workspace: Option<Workspace>,
}

/// Fields kept from one step to the next, so that a step allocates nothing.
#[derive(Clone, Debug)]
struct Workspace {
    domain: Arc<Domain>,
    equations: Unified,
    right: Unknowns,
    viscosities: Vec<f32>,
    spare: Vec<f32>,
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
            workspace: None,
        }
    }

    /// Paint at rest on another grid, in the same buffers.
    pub fn restart(&mut self, grid: &Grid) {
        self.grid = *grid;
        for field in self.velocity.iter_mut().chain([&mut self.pressure]) {
            field.clear();
            field.resize(grid.len(), 0.0);
        }
    }

    /// One step with cells filled to a fraction, between solids. Returns the domain of the equations: the layers up to
    /// the second above the highest paint. Dropping it frees its buffers for the next step.
    pub fn step(&mut self, fill: &[f32], solids: &Solids, conditions: &Conditions) -> Arc<Domain> {
        let least = match self.scheme {
            Scheme::Unified => LEAST_FILL,
            // Baxter 2004, § 5.3: more than half.
            Scheme::Split => 0.5,
        };
        let whole = self.grid;
        self.grid = layers_with_paint(&whole, fill, least);
        self.resize();
        let mut workspace = match self.workspace.take() {
            Some(mut workspace) => {
                if Arc::get_mut(&mut workspace.domain).is_none() {
                    workspace.domain = Arc::new(Domain::clone(&workspace.domain));
                }
                if let Some(domain) = Arc::get_mut(&mut workspace.domain) {
                    domain.renew(&self.grid, fill, solids, least);
                }
                workspace
            }
            None => Workspace::new(Domain::new(&self.grid, fill, solids, least)),
        };
        if let Some(domain) = Arc::get_mut(&mut workspace.domain) {
            self.drag(domain, solids, conditions);
        }
        let domain = Arc::clone(&workspace.domain);
        self.step_within(&domain, &mut workspace, fill, solids, conditions);
        self.workspace = Some(workspace);
        self.grid = whole;
        self.resize();
        domain
    }

    /// Drag of bristles on paint: a face takes the share d/(1 + d) of their velocity, with d = τR and R their
    /// resistance, and its inertia grows accordingly. The body force acts on paint alone.
    fn drag(&mut self, domain: &mut Domain, solids: &Solids, conditions: &Conditions) {
        let Some(resistance) = &solids.resistance else {
            return;
        };
        let Conditions {
            cell_m, seconds, ..
        } = conditions;
        let tau = (conditions.paint.viscosity * seconds / (cell_m * cell_m)) as f32;
        for axis in 0..3 {
            let pull = (conditions.pull[axis] * seconds) as f32;
            let (free, mass) = (&domain.free[axis], &mut domain.mass[axis]);
            let bristles = resistance[axis].iter().zip(&solids.velocity[axis]);
            let faces = self.velocity[axis].iter_mut().zip(mass).zip(free);
            for (((u, mass), free), (resistance, velocity)) in faces.zip(bristles) {
                let drags = tau * resistance * free;
                *u = (*u + drags * (velocity - pull)) / (1.0 + drags);
                *mass *= 1.0 + drags;
            }
        }
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
        domain: &Domain,
        workspace: &mut Workspace,
        fill: &[f32],
        solids: &Solids,
        conditions: &Conditions,
    ) {
        let Conditions {
            cell_m,
            seconds,
            paint,
            pull,
        } = conditions;
        let tau = paint.viscosity * seconds / (cell_m * cell_m);
        for (axis, u) in self.velocity.iter_mut().enumerate() {
            let (free, solid) = (&domain.free[axis], &domain.solid[axis]);
            flat::choose(u, free, solid, &solids.velocity[axis]);
            self.grid.wrap(u);
        }
        match self.scheme {
            Scheme::Unified => self.unified(domain, workspace, fill, solids, conditions, tau),
            Scheme::Split => {
                let pull = pull.map(|pull| (pull * seconds) as f32);
                let to_pressure = (cell_m / seconds) as f32;
                let pressure = &mut self.pressure;
                flat::rescale(pressure, &domain.wet, 1.0 / to_pressure);
                split::step(
                    domain,
                    (tau, pull),
                    &mut self.velocity,
                    &solids.velocity,
                    pressure,
                );
                flat::rescale(pressure, &domain.wet, to_pressure);
            }
        }
        self.extrapolate(domain, &mut workspace.spare);
    }

    fn unified(
        &mut self,
        domain: &Domain,
        workspace: &mut Workspace,
        fill: &[f32],
        solids: &Solids,
        conditions: &Conditions,
        tau: f64,
    ) {
        let paint = &conditions.paint;
        let [u, v, w] = &self.velocity;
        paint.viscosities(
            domain,
            [u, v, w],
            conditions.cell_m,
            (&mut workspace.viscosities, &mut workspace.spare),
        );
        workspace
            .equations
            .renew(domain, tau, &workspace.viscosities);
        let pull = conditions
            .pull
            .map(|pull| (pull * conditions.seconds) as f32);
        workspace.equations.right_hand_side(
            domain,
            ([u, v, w], pull),
            &solids.velocity,
            &mut workspace.right,
        );
        // The unknown pressure is the velocity that it causes in a step.
        let alpha = f64::from(weights(tau)[0]);
        let to_pressure = (conditions.cell_m / (alpha * conditions.seconds)) as f32;
        flat::rescale(&mut self.pressure, &domain.wet, 1.0 / to_pressure);
        self.relieve(domain, fill, conditions, &mut workspace.right[3]);
        let [u, v, w] = std::mem::take(&mut self.velocity);
        let mut x = [u, v, w, std::mem::take(&mut self.pressure)];
        let Effort { steps, projections } = self.effort;
        self.norms = workspace
            .equations
            .solve(domain, &workspace.right, &mut x, steps);
        workspace
            .equations
            .project(domain, &workspace.right, &mut x, projections);
        let [u, v, w, p] = x;
        self.velocity = [u, v, w];
        self.pressure = p;
        flat::rescale(&mut self.pressure, &domain.wet, to_pressure);
    }

    /// Lets an overfull cell, left by rounding and moving solids, expel a part of its excess in a step, and one within
    /// the paint that is not full take in a part of its deficit.
    fn relieve(
        &self,
        domain: &Domain,
        fill: &[f32],
        conditions: &Conditions,
        displaced: &mut [f32],
    ) {
        let per_step = self.relief * (conditions.cell_m / conditions.seconds) as f32;
        let span = Span::of(&self.grid, self.grid.range());
        flat::relieve(displaced, &domain.wet, fill, per_step, span);
    }

    /// Velocities of air beside paint: the mean of those around it, so that paint that arrives there keeps its motion.
    fn extrapolate(&mut self, domain: &Domain, spare: &mut Vec<f32>) {
        let span = Span::of(&self.grid, self.grid.range());
        for (axis, u) in self.velocity.iter_mut().enumerate() {
            spare.clear();
            spare.extend_from_slice(u);
            flat::extrapolate(u, spare, &domain.free[axis], &domain.solid[axis], span);
            self.grid.wrap(u);
        }
    }

    /// Largest divergence of the paint, relative to the largest velocity divided by a cell.
    #[must_use]
    pub fn divergence(&self, domain: &Domain, solids: &Solids) -> f64 {
        let flux = |axis: usize, place: usize| {
            let area = match domain.part(axis, place) {
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

/// The layers of a window that a step solves: up to the second above the highest cell with at least the fill `least`.
#[must_use]
pub fn layers_with_paint(grid: &Grid, fill: &[f32], least: f32) -> Grid {
    grid.below(highest(grid, fill, least) + 2)
}

/// Number of layers up to the highest cell with at least the fill `least`.
fn highest(grid: &Grid, fill: &[f32], least: f32) -> usize {
    let [width, height, depth] = grid.cells.map(|cells| cells as isize);
    let has_paint = |z: &isize| {
        let starts = (0..height).map(|y| grid.at([0, y, *z]));
        let mut rows = starts.map(|start| &fill[start..start + width as usize]);
        rows.any(|row| row.iter().any(|fill| *fill >= least))
    };
    (0..depth)
        .rev()
        .find(has_paint)
        .map_or(0, |z| z as usize + 1)
}

impl Workspace {
    fn new(domain: Domain) -> Self {
        Self {
            equations: Unified::new(&domain),
            domain: Arc::new(domain),
            right: Unknowns::default(),
            viscosities: Vec::new(),
            spare: Vec::new(),
        }
    }
}
