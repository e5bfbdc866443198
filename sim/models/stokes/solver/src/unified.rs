//! Velocity and pressure at once: backward Euler for the unsteady Stokes equations (Baxter 2004, eq. 5.2, 5.3), with
//! the viscous and the pressure part of the free surface's condition together (Larionov, Batty and Bridson 2017).
//!
//! Generalised conjugate residuals (Eisenstat, Elman and Schultz 1983), preconditioned by a V-cycle for each component
//! of the velocity and, for the pressure, by Cahouet and Chabard (1988): α·L⁻¹ + 2βμ. The drag of walls on thin paint
//! acts like mass, so it is added to α: without it a film under a wide brush takes ten times as many steps.

use maulstick_num::{fork_join, wide};

use crate::domain::Domain;
use crate::multigrid::Multigrid;
use crate::operator::{Operator, Unknowns, laplacian, outflow};
use crate::residuals::Residuals;
use crate::runs::share;
use crate::stencil::{Span, Stencil};
use crate::vector::add_scaled;

/// Drag of walls on paint of thickness one, relative to its viscosity: between 3 for a film and 12 for a gap.
const GAP_DRAG: f32 = 6.0;

/// Number of unknowns of a component from which cores share the cycles.
const WORTH: usize = 3500;

/// The equations of one step on one window, in buffers kept from one step to the next.
#[derive(Clone, Debug)]
pub struct Unified {
    operator: Operator,
    /// Hierarchies of the three components of the velocity and of the pressure.
    hierarchies: [Multigrid; 4],
    /// Viscous response to a change of volume, by cell.
    bulk: Vec<f32>,
    alpha: f32,
    /// Drag of walls relative to α, which resists a pressure gradient like mass.
    wall: f32,
    residuals: Residuals,
    /// Volume deficit, and the pressure that it causes.
    lacking: [Vec<f32>; 2],
}

/// Weights of mass and viscosity for a step of τ = νΔt/h².
#[must_use]
pub fn weights(tau: f64) -> [f32; 2] {
    let whole = 1.0 + 6.0 * tau;
    [(1.0 / whole) as f32, (tau / whole) as f32]
}

impl Unified {
    /// Buffers for the equations of a window.
    #[must_use]
    pub fn new(domain: &Domain) -> Self {
        let grid = &domain.grid;
        Self {
            operator: Operator::default(),
            hierarchies: [Some(0), Some(1), Some(2), None]
                .map(|faces| Multigrid::empty(grid, faces)),
            bulk: Vec::new(),
            alpha: 0.0,
            wall: 0.0,
            residuals: Residuals::default(),
            lacking: [Vec::new(), Vec::new()],
        }
    }

    /// Sets the equations for a step of τ = νΔt/h² with ν times a field of relative viscosities.
    pub fn renew(&mut self, domain: &Domain, tau: f64, viscosity: &[f32]) {
        let grid = &domain.grid;
        let [alpha, beta] = weights(tau);
        for hierarchy in &mut self.hierarchies {
            hierarchy.fit(grid);
        }
        let [components @ .., pressure] = &mut self.hierarchies;
        self.operator
            .renew(domain, [alpha, beta], viscosity, components);
        let thickness = thickness(domain);
        self.wall = beta * GAP_DRAG / (alpha * thickness * thickness);
        laplacian(domain, self.wall, pressure.stencil_mut());
        share(grid.len(), &mut self.hierarchies, Multigrid::renew);
        self.alpha = alpha;
        self.bulk.resize(grid.len(), 0.0);
        let [u, v, w, p] = self.hierarchies.each_ref().map(Multigrid::stencil);
        let components = [u, v, w];
        p.runs.write([&mut *self.bulk], |run, [bulk]| {
            answer(bulk, domain, components, Span::of(grid, run));
        });
        for field in &mut self.lacking {
            if field.len() == grid.len() {
                p.clear_left(field);
            } else {
                field.clear();
                field.resize(grid.len(), 0.0);
            }
        }
        self.residuals
            .fit(self.hierarchies.each_ref().map(Multigrid::stencil));
    }

    /// z ≈ A⁻¹·r.
    fn precondition(&mut self, domain: &Domain, r: &Unknowns, z: &mut Unknowns) {
        let grid = domain.grid;
        let [u, v, w, p] = z;
        let [pressure_r] = [&r[3]];
        let [one, two, three, pressure] = &mut self.hierarchies;
        let unknowns = three.stencil().runs.len();
        // The third component's loops, like those of the pressure, are shared among cores.
        let mut pairs = [(&mut *one, &r[0], &mut *u), (&mut *two, &r[1], &mut *v)];
        let work = |(hierarchy, from, into): &mut (&mut Multigrid, &Vec<f32>, &mut Vec<f32>)| {
            hierarchy.cycle(from, into);
        };
        if unknowns < WORTH {
            pairs.iter_mut().for_each(work);
        } else {
            fork_join::each(&mut pairs, work);
        }
        three.cycle(&r[2], w);
        for field in [&mut *u, &mut *v, &mut *w] {
            grid.wrap(field);
        }
        let [lacking, answer] = &mut self.lacking;
        let runs = &pressure.stencil().runs;
        outflow(domain, runs, [u, v, w], ([1.0, -1.0], pressure_r), lacking);
        pressure.cycle(lacking, answer);
        let (bulk, alpha) = (&self.bulk, self.alpha);
        pressure.stencil().runs.write([&mut **p], |run, [p]| {
            mix(
                p,
                alpha,
                &answer[run.clone()],
                &bulk[run.clone()],
                &lacking[run],
            );
        });
    }

    /// Solves A·x = b by `steps` iterations from x; returns the norm of each residual, the first guess's included.
    pub fn solve(
        &mut self,
        domain: &Domain,
        b: &Unknowns,
        x: &mut Unknowns,
        steps: usize,
    ) -> Vec<f64> {
        let mut residuals = std::mem::take(&mut self.residuals);
        self.operator
            .apply(domain, &self.hierarchies, x, residuals.residual_mut());
        let mut norms = Vec::with_capacity(steps + 1);
        norms.push(residuals.begin(self.stencils(), b));
        for _ in 0..steps {
            let (r, mut z, mut q) = residuals.next(self.stencils(), x);
            self.precondition(domain, &r, &mut z);
            self.operator
                .apply(domain, &self.hierarchies, &mut z, &mut q);
            let Some(norm) = residuals.add(self.stencils(), r, z, q) else {
                break;
            };
            norms.push(norm);
        }
        residuals.end(self.stencils(), x);
        self.residuals = residuals;
        norms
    }

    fn stencils(&self) -> [&Stencil; 4] {
        self.hierarchies.each_ref().map(Multigrid::stencil)
    }

    /// Removes the remaining divergence of a velocity, by `iterations` of conjugate gradients.
    pub fn project(&mut self, domain: &Domain, b: &Unknowns, x: &mut Unknowns, iterations: usize) {
        let grid = domain.grid;
        let [u, v, w, p] = x;
        for field in [&mut *u, &mut *v, &mut *w] {
            grid.wrap(field);
        }
        let [excess, phi] = &mut self.lacking;
        let [components @ .., pressure] = &mut self.hierarchies;
        let runs = &pressure.stencil().runs;
        outflow(domain, runs, [u, v, w], ([1.0, -1.0], &b[3]), excess);
        runs.iter().for_each(|run| phi[run].fill(0.0));
        pressure.solve(excess, phi, iterations);
        for (axis, u) in [u, v, w].into_iter().enumerate() {
            let (area, mass) = (&domain.area[axis], &domain.mass[axis]);
            components[axis]
                .stencil()
                .runs
                .write([&mut **u], |run, [u]| {
                    let span = Span::of(&grid, run);
                    correct(u, area, (mass, self.wall), phi, grid.stride(axis), span);
                });
            grid.wrap(u);
        }
        let runs = &pressure.stencil().runs;
        runs.write([&mut **p], |run, [p]| add_scaled(p, self.alpha, &phi[run]));
    }

    /// The right-hand side: momentum of a velocity with the body force added, and the volume displaced by solids.
    pub fn right_hand_side(
        &self,
        domain: &Domain,
        (velocity, pull): ([&[f32]; 3], [f32; 3]),
        solids: &[Vec<f32>; 3],
        b: &mut Unknowns,
    ) {
        let grid = domain.grid;
        for field in &mut *b {
            field.resize(grid.len(), 0.0);
        }
        for axis in 0..3 {
            let stencil = self.hierarchies[axis].stencil();
            stencil.runs.write([&mut *b[axis]], |run, [b]| {
                let mass = &stencil.mass[run.clone()];
                momentum(b, mass, &velocity[axis][run], pull[axis]);
            });
            grid.clear(&mut b[axis]);
        }
        let runs = &self.hierarchies[3].stencil().runs;
        runs.iter().for_each(|run| b[3][run].fill(0.0));
        for axis in 0..3 {
            runs.write([&mut *b[3]], |run, [b]| {
                let span = Span::of(&grid, run);
                displace(b, domain, axis, &solids[axis], span);
            });
        }
    }
}

wide! {
    fn mix(p: &mut [f32], alpha: f32, answer: &[f32], bulk: &[f32], lacking: &[f32]) {
        let n = p.len();
        let (answer, bulk, lacking) = (&answer[..n], &bulk[..n], &lacking[..n]);
        for i in 0..n {
            p[i] = alpha * answer[i] + bulk[i] * lacking[i];
        }
    }
}

wide! {
    fn correct(u: &mut [f32], area: &[f32], heft: (&[f32], f32), phi: &[f32], by: usize, span: Span) {
        let (area, mass, wall) = (span.here(area), span.here(heft.0), heft.1);
        let (low, high) = (span.before(phi, by), span.here(phi));
        let u = span.own(u);
        for i in 0..u.len() {
            let share = if area[i] > 0.0 { area[i] / (mass[i] + wall) } else { 0.0 };
            u[i] -= share * (high[i] - low[i]);
        }
    }
}

wide! {
    fn momentum(b: &mut [f32], mass: &[f32], u: &[f32], pull: f32) {
        let n = b.len();
        let (mass, u) = (&mass[..n], &u[..n]);
        for i in 0..n {
            b[i] = mass[i] * (u[i] + pull);
        }
    }
}

wide! {
    /// Subtracts the inflow from solids into wet cells across an axis.
    fn displace(b: &mut [f32], domain: &Domain, axis: usize, u: &[f32], span: Span) {
        let by = [1, span.row, span.plane][axis];
        let (solid, free, area) = (&domain.solid[axis], &domain.free[axis], &domain.area[axis]);
        let (s, f, a, u_low) = (span.here(solid), span.here(free), span.here(area), span.here(u));
        let (t, g, c, u_high) = (span.after(solid, by), span.after(free, by), span.after(area, by), span.after(u, by));
        let wet = span.here(&domain.wet);
        let b = span.own(b);
        for i in 0..b.len() {
            let low = (s[i] + f[i] * (1.0 - a[i])) * u_low[i];
            let high = (t[i] + g[i] * (1.0 - c[i])) * u_high[i];
            b[i] -= wet[i] * (high - low);
        }
    }
}

wide! {
    /// The viscous part of the inverse Schur complement by cell: 2βμ far from all sides. Elsewhere it follows from the
    /// diagonals of the velocities around a cell; it is larger beside a wall and smaller beside air.
    fn answer(bulk: &mut [f32], domain: &Domain, stencils: [&Stencil; 3], span: Span) {
        let wet = span.here(&domain.wet);
        let bulk = span.own(bulk);
        bulk.fill(0.0);
        for axis in 0..3 {
            let by = [1, span.row, span.plane][axis];
            let area = &domain.area[axis];
            let (diagonal, mass) = (&stencils[axis].diagonal, &stencils[axis].mass);
            let (a, d, m) = (span.here(area), span.here(diagonal), span.here(mass));
            let (b, e, n) = (span.after(area, by), span.after(diagonal, by), span.after(mass, by));
            for i in 0..bulk.len() {
                let (low, high) = (d[i] - m[i], e[i] - n[i]);
                let low = if low > 0.0 { a[i] * a[i] / low } else { 0.0 };
                let high = if high > 0.0 { b[i] * b[i] / high } else { 0.0 };
                bulk[i] += low + high;
            }
        }
        for i in 0..bulk.len() {
            // Six faces, each with a diagonal of 8βμ, make 2βμ.
            bulk[i] = if bulk[i] > 0.0 { wet[i] * 1.5 / bulk[i] } else { 0.0 };
        }
    }
}

/// Mean thickness of the paint, cells above each other.
fn thickness(domain: &Domain) -> f32 {
    let grid = domain.grid;
    let [width, height, depth] = grid.cells;
    let (mut wet, mut columns) = (0.0, 0.0);
    let mut row = vec![0.0; width];
    for y in 0..height as isize {
        row.fill(0.0);
        for z in 0..depth as isize {
            let start = grid.at([0, y, z]);
            add_scaled(&mut row, 1.0, &domain.wet[start..start + width]);
        }
        for cells in &row {
            wet += cells;
            columns += if *cells > 0.0 { 1.0 } else { 0.0 };
        }
    }
    if columns > 0.0 { wet / columns } else { 1.0 }
}
