//! Navier-Stokes equations around a probe in two dimensions (Baxter 2004, § 8.8.4; Stam 1999): semi-Lagrangian advection,
//! implicit viscosity, Chorin's projection, on a staggered grid. No step is too long for it.
//!
//! A [`Boundary::Covered`] probe is fluid of infinite viscosity (links conduct by the harmonic mean along them) without
//! a gap (the projection weighs faces by their open share; Batty, Bertails and Bridson 2007). All shares, and so the
//! force, change continuously with the probe's place.

use crate::five_point::FivePoint;
use crate::geometry::{Boundary, Geometry, ProbeState, Vessel};
use crate::grid::Grid;
use crate::polygon::Shape;
use crate::stress::{Fluid, Medium, StaggeredFields, Wrench, face_stresses};
use crate::viscosity::{Diffusion, SolidLink};

/// Residual of a solve by its right side.
const TOLERANCE: f64 = 1e-6;
/// Greatest number of iterations of a solve.
const ITERATIONS: usize = 2000;
/// Least open share of a face that lets fluid through.
const LEAST_OPEN: f64 = 1e-6;

/// Grid, vessel, fluid and probe of a bench.
#[derive(Clone, Debug)]
pub struct Bench {
    /// Cells that the equations are solved on.
    pub grid: Grid,
    /// Walls around the fluid.
    pub vessel: Vessel,
    /// Viscosity and density of what fills the vessel.
    pub fluid: Fluid,
    /// Outline of the probe at rest.
    pub shape: Shape,
    /// Boundary of the probe on the grid.
    pub boundary: Boundary,
}

/// A flow around a probe.
#[derive(Clone, Debug)]
pub struct Flow {
    bench: Bench,
    state: ProbeState,
    geometry: Geometry,
    /// Velocities on the faces across x and y, m/s.
    velocity: [Vec<f64>; 2],
    /// The same before the projection, which lets a fluid slip along its walls by Δt·∇p: those that viscous stress
    /// has acted on.
    stressed: [Vec<f64>; 2],
    /// Kinematic pressure in the cells, m²/s².
    pressure: Vec<f64>,
    /// Viscous force of the newest step.
    viscous: Wrench<2>,
}

impl Flow {
    /// A fluid at rest around a probe.
    #[must_use]
    pub fn new(bench: Bench, state: ProbeState) -> Self {
        let geometry = Geometry::new(
            &bench.grid,
            &bench.vessel,
            &bench.shape,
            &state,
            bench.boundary,
        );
        let still = [0, 1].map(|axis| vec![0.0; bench.grid.faces(axis).iter().product()]);
        Self {
            velocity: still.clone(),
            stressed: still,
            pressure: vec![0.0; bench.grid.count()],
            viscous: Wrench::ZERO,
            bench,
            state,
            geometry,
        }
    }

    /// Advances by `dt_s`, at the end of which the probe is as in `state`.
    pub fn step(&mut self, state: ProbeState, dt_s: f64) {
        let Bench {
            grid,
            vessel,
            shape,
            boundary,
            ..
        } = &self.bench;
        self.geometry = Geometry::new(grid, vessel, shape, &state, *boundary);
        self.state = state;
        self.advect(dt_s);
        let pressure = self.pressure.clone();
        self.press(&pressure, dt_s);
        self.diffuse(dt_s);
        self.project(dt_s);
    }

    /// Accelerates the fluid by a pressure.
    fn press(&mut self, pressure: &[f64], dt_s: f64) {
        let (grid, geometry) = (&self.bench.grid, &self.geometry);
        let by = dt_s / grid.cell_m;
        for axis in 0..2 {
            let [across, _] = grid.faces(axis);
            for (at, value) in self.velocity[axis].iter_mut().enumerate() {
                if geometry.is_fixed(axis, at) {
                    *value = geometry.rigid[axis][at];
                    continue;
                }
                let upper = (at / across) * grid.cells[0] + at % across;
                let lower = upper - [1, grid.cells[0]][axis];
                *value -= by * (pressure[upper] - pressure[lower]);
            }
        }
    }

    /// Advects velocities: each is traced back to its origin (Stam 1999), with the velocity at the middle of its path.
    fn advect(&mut self, dt_s: f64) {
        let grid = self.bench.grid;
        let old = &self.velocity;
        let at = |place| [0, 1].map(|axis| grid.sample(axis, &old[axis], place));
        let back = |[x, y]: [f64; 2], [u, v]: [f64; 2], s: f64| [x - s * u, y - s * v];
        let new = [0, 1].map(|axis| {
            let [width, height] = grid.faces(axis);
            let from = |index: usize| {
                let place = grid.face_m(axis, [index % width, index / width]);
                let middle = back(place, at(place), 0.5 * dt_s);
                let came = back(place, at(middle), dt_s);
                grid.sample(axis, &old[axis], came)
            };
            (0..width * height).map(from).collect()
        });
        self.velocity = new;
    }

    /// Backward Euler for viscosity, an axis at a time, and the viscous force on the probe.
    fn diffuse(&mut self, dt_s: f64) {
        self.viscous = Wrench::ZERO;
        for axis in 0..2 {
            self.diffuse_axis(axis, dt_s);
        }
        self.stressed.clone_from(&self.velocity);
    }

    fn diffuse_axis(&mut self, axis: usize, dt_s: f64) {
        let grid = &self.bench.grid;
        let rate = self.bench.fluid.viscosity_m2_s * dt_s / (grid.cell_m * grid.cell_m);
        let values = &mut self.velocity[axis];
        let mut diffusion = Diffusion::new(&self.geometry, axis, grid.faces(axis), rate, values);
        diffusion.add_walls();
        diffusion.add_links(values);
        diffusion
            .system
            .solve(&diffusion.right_side, values, TOLERANCE, ITERATIONS);
        let links = diffusion.solid_links;
        self.add_viscous_force(axis, &links);
    }

    /// Adds the viscous force through the links into the probe.
    fn add_viscous_force(&mut self, axis: usize, links: &[SolidLink]) {
        let (grid, geometry) = (&self.bench.grid, &self.geometry);
        let [width, _] = grid.faces(axis);
        let (values, rigid) = (&self.velocity[axis], &geometry.rigid[axis]);
        let mu = self.bench.fluid.dynamic_pa_s();
        for link in links {
            if geometry.probe[axis][link.inner] <= 0.0 {
                continue;
            }
            let lower = link.outer.min(link.inner);
            let mut place = grid.face_m(axis, [lower % width, lower / width]);
            place[link.along] += 0.5 * grid.cell_m;
            let coupling = geometry.links[axis][link.along][lower];
            let mut force = [0.0; 2];
            force[axis] = mu * coupling * (values[link.outer] - rigid[link.outer]);
            let about = self.state.place_m;
            self.viscous
                .add(force, [place[0] - about[0], place[1] - about[1]]);
        }
    }

    /// The pressure that leaves no divergence, and the velocities with it.
    fn project(&mut self, dt_s: f64) {
        let (grid, geometry) = (&self.bench.grid, &self.geometry);
        let [width, height] = grid.cells;
        let mut system = FivePoint::new(width, height);
        let mut right_side = vec![0.0; grid.count()];
        let scale = grid.cell_m / dt_s;
        for axis in 0..2 {
            let [across, _] = grid.faces(axis);
            for at in 0..self.velocity[axis].len() {
                let index = [at % across, at / across];
                if index[axis] == 0 || index[axis] == grid.cells[axis] {
                    continue;
                }
                let upper = index[1] * width + index[0];
                let lower = upper - [1, width][axis];
                let solid = geometry.solid[axis][at];
                let open = 1.0 - solid;
                let own = solid * geometry.rigid[axis][at];
                let flux = scale * (open * self.velocity[axis][at] + own);
                right_side[lower] -= flux;
                right_side[upper] += flux;
                if open > LEAST_OPEN {
                    system.diagonal[lower] += open;
                    system.diagonal[upper] += open;
                    let row = match axis {
                        0 => &mut system.right,
                        _ => &mut system.up,
                    };
                    row[lower] = open;
                }
            }
        }
        for (right_side, diagonal) in right_side.iter_mut().zip(&system.diagonal) {
            if *diagonal == 0.0 {
                *right_side = 0.0;
            }
        }
        let mut change = vec![0.0; grid.count()];
        system.solve(&right_side, &mut change, TOLERANCE, ITERATIONS);
        self.press(&change, dt_s);
        for (at, pressure) in self.pressure.iter_mut().enumerate() {
            *pressure += change[at];
            // Within the probe there is no equation.
            if system.diagonal[at] == 0.0 {
                *pressure = 0.0;
            }
        }
    }

    /// Force and torque about the probe's place: with whole cells from the stresses on their faces, otherwise from the
    /// momentum that links and pressure bring into it.
    #[must_use]
    pub fn wrench(&self) -> Wrench<2> {
        match self.bench.boundary {
            Boundary::Staircase => {
                Wrench::of(face_stresses(self, self.bench.fluid), self.state.place_m)
            }
            Boundary::Covered => self.covered_wrench(),
        }
    }

    fn covered_wrench(&self) -> Wrench<2> {
        let grid = &self.bench.grid;
        let mut wrench = self.viscous;
        for axis in 0..2 {
            let [across, _] = grid.faces(axis);
            for (at, share) in self.geometry.probe[axis].iter().enumerate() {
                let index = [at % across, at / across];
                let inside = index[axis] > 0 && index[axis] < grid.cells[axis];
                if *share <= 0.0 || !inside {
                    continue;
                }
                let upper = index[1] * grid.cells[0] + index[0];
                let lower = upper - [1, grid.cells[0]][axis];
                let rise = self.pressure[upper] - self.pressure[lower];
                let mut force = [0.0; 2];
                force[axis] = -self.bench.fluid.density_kg_m3 * share * rise * grid.cell_m;
                let place = grid.face_m(axis, index);
                let about = self.state.place_m;
                wrench.add(force, [place[0] - about[0], place[1] - about[1]]);
            }
        }
        wrench
    }

    /// Place and motion of the probe at the end of the newest step.
    #[must_use]
    pub fn state(&self) -> &ProbeState {
        &self.state
    }

    /// Greatest divergence of a cell of fluid that no wall cuts, 1/s.
    #[must_use]
    pub fn divergence(&self) -> f64 {
        let grid = &self.bench.grid;
        let mut most: f64 = 0.0;
        for j in 0..grid.cells[1] {
            for i in 0..grid.cells[0] {
                let mut sum = 0.0;
                let mut solid = 0.0;
                for axis in 0..2 {
                    let [across, _] = grid.faces(axis);
                    let lower = j * across + i;
                    let upper = lower + [1, across][axis];
                    sum += self.velocity[axis][upper] - self.velocity[axis][lower];
                    solid += self.geometry.probe[axis][upper] + self.geometry.probe[axis][lower];
                }
                if solid == 0.0 {
                    most = most.max((sum / grid.cell_m).abs());
                }
            }
        }
        most
    }
}

impl StaggeredFields<2> for Flow {
    fn cells(&self) -> [usize; 2] {
        self.bench.grid.cells
    }
    fn cell_m(&self) -> f64 {
        self.bench.grid.cell_m
    }
    fn medium(&self, [i, j]: [usize; 2]) -> Medium {
        self.geometry.media[j * self.bench.grid.cells[0] + i]
    }
    fn pressure(&self, [i, j]: [usize; 2]) -> f64 {
        self.pressure[j * self.bench.grid.cells[0] + i]
    }
    fn velocity(&self, axis: usize, [i, j]: [usize; 2]) -> f64 {
        let [across, _] = self.bench.grid.faces(axis);
        self.stressed[axis][j * across + i]
    }
    fn wall_velocity(&self, place: [f64; 2]) -> [f64; 2] {
        self.state.velocity_at(place)
    }
}

#[cfg(test)]
mod tests;
