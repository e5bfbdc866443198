//! The Stokes operator: momentum α·M·u + β·Eᵀ(2μE·u) + Gp on faces, and the volume that leaves each cell.
//!
//! E is the rate of strain, on cells and edges; G is minus the adjoint of the divergence.

use maulstick_num::wide;

use crate::domain::Domain;
use crate::grid::{Grid, others};
use crate::stencil::{Span, Stencil};

/// Velocities and pressure in one row of numbers, field after field.
pub type Unknowns = Vec<f32>;

/// The four fields of a row of numbers.
pub fn fields(unknowns: &[f32]) -> [&[f32]; 4] {
    let quarter = unknowns.len() / 4;
    let (a, rest) = unknowns.split_at(quarter);
    let (b, rest) = rest.split_at(quarter);
    let (c, d) = rest.split_at(quarter);
    [a, b, c, d]
}

/// The same, to be written.
pub fn fields_mut(unknowns: &mut [f32]) -> [&mut [f32]; 4] {
    let quarter = unknowns.len() / 4;
    let (a, rest) = unknowns.split_at_mut(quarter);
    let (b, rest) = rest.split_at_mut(quarter);
    let (c, d) = rest.split_at_mut(quarter);
    [a, b, c, d]
}

/// The operator on one window.
#[derive(Clone, Debug)]
pub struct Operator {
    grid: Grid,
    /// α·mass of faces.
    mass: [Vec<f32>; 3],
    /// 2β·μ·volume of cells.
    pub(crate) stretch: Vec<f32>,
    /// β·μ·volume of edges.
    edge: [Vec<f32>; 3],
    slope: [[Vec<f32>; 2]; 3],
    free: [Vec<f32>; 3],
    area: [Vec<f32>; 3],
    wet: Vec<f32>,
    /// Stress, by cell and by edge.
    normal: [Vec<f32>; 3],
    shear: [Vec<f32>; 3],
}

wide! {
    /// Normal stress along an axis.
    fn stretch(into: &mut [f32], weight: &[f32], u: &[f32], by: usize, span: Span) {
        let (weight, low, high) = (span.here(weight), span.here(u), span.after(u, by));
        let into = span.here_mut(into);
        for i in 0..into.len() {
            into[i] = weight[i] * (high[i] - low[i]);
        }
    }
}

wide! {
    /// Shear stress at an edge, of two velocities with their slopes.
    fn shear(into: &mut [f32], weight: &[f32], slope: &[Vec<f32>; 2], u: &[f32], v: &[f32], by: [usize; 2], span: Span) {
        let weight = span.here(weight);
        let (u_slope, v_slope) = (span.here(&slope[0]), span.here(&slope[1]));
        // The velocity along the first axis changes along the second.
        let (u_low, u) = (span.before(u, by[1]), span.here(u));
        let (v_low, v) = (span.before(v, by[0]), span.here(v));
        let into = span.here_mut(into);
        for i in 0..into.len() {
            into[i] = weight[i] * (u_slope[i] * (u[i] - u_low[i]) + v_slope[i] * (v[i] - v_low[i]));
        }
    }
}

/// What acts on the faces across an axis.
struct Face<'a> {
    mass: &'a [f32],
    free: &'a [f32],
    area: &'a [f32],
    by: usize,
    normal: &'a [f32],
    /// Shear, slope and stride of both edges beside it.
    edges: [(&'a [f32], &'a [f32], usize); 2],
}

wide! {
    fn force(into: &mut [f32], u: &[f32], p: &[f32], face: &Face<'_>, span: Span) {
        let (mass, free, area) = (span.here(face.mass), span.here(face.free), span.here(face.area));
        let (n_low, n) = (span.before(face.normal, face.by), span.here(face.normal));
        let (p_low, p) = (span.before(p, face.by), span.here(p));
        let [(s, g, s_by), (t, h, t_by)] = face.edges;
        let (s, s_high, g, g_high) = (span.here(s), span.after(s, s_by), span.here(g), span.after(g, s_by));
        let (t, t_high, h, h_high) = (span.here(t), span.after(t, t_by), span.here(h), span.after(h, t_by));
        let u = span.here(u);
        let into = span.here_mut(into);
        for i in 0..into.len() {
            let shear = (g[i] * s[i] - g_high[i] * s_high[i]) + (h[i] * t[i] - h_high[i] * t_high[i]);
            let stress = (n_low[i] - n[i]) + shear;
            into[i] = free[i] * (mass[i] * u[i] + stress + area[i] * (p[i] - p_low[i]));
        }
    }
}

wide! {
    /// Volume that leaves each wet cell.
    fn outflow(into: &mut [f32], u: [&[f32]; 3], area: &[Vec<f32>; 3], wet: &[f32], span: Span) {
        let by = [1, span.row, span.plane];
        let (ax, ax_high) = (span.here(&area[0]), span.after(&area[0], by[0]));
        let (ay, ay_high) = (span.here(&area[1]), span.after(&area[1], by[1]));
        let (az, az_high) = (span.here(&area[2]), span.after(&area[2], by[2]));
        let (ux, ux_high) = (span.here(u[0]), span.after(u[0], by[0]));
        let (uy, uy_high) = (span.here(u[1]), span.after(u[1], by[1]));
        let (uz, uz_high) = (span.here(u[2]), span.after(u[2], by[2]));
        let wet = span.here(wet);
        let into = span.here_mut(into);
        for i in 0..into.len() {
            let x = ax_high[i] * ux_high[i] - ax[i] * ux[i];
            let y = ay_high[i] * uy_high[i] - ay[i] * uy[i];
            let z = az_high[i] * uz_high[i] - az[i] * uz[i];
            into[i] = wet[i] * ((x + y) + z);
        }
    }
}

/// Place of an axis among the [others] of an edge.
fn which(edge: usize, axis: usize) -> usize {
    usize::from(others(edge)[1] == axis)
}

impl Operator {
    /// The operator with weights α of the mass and β of viscosity, which is relative to the window's by cell.
    #[must_use]
    pub fn new(domain: &Domain, alpha: f32, beta: f32, viscosity: &[f32]) -> Self {
        let grid = domain.grid;
        let mut operator = Self {
            grid,
            mass: domain.mass.clone(),
            stretch: domain.volume.clone(),
            edge: domain.edge.clone(),
            slope: domain.slope.clone(),
            free: domain.free.clone(),
            area: domain.area.clone(),
            wet: domain.wet.clone(),
            normal: std::array::from_fn(|_| grid.field()),
            shear: std::array::from_fn(|_| grid.field()),
        };
        for mass in &mut operator.mass {
            mass.iter_mut().for_each(|mass| *mass *= alpha);
        }
        for (stretch, viscosity) in operator.stretch.iter_mut().zip(viscosity) {
            *stretch *= 2.0 * beta * viscosity;
        }
        for edge in 0..3 {
            let [a, b] = others(edge).map(|axis| grid.stride(axis));
            for place in grid.block([0; 3], grid.cells.map(|cells| cells as isize + 1)) {
                if operator.edge[edge][place] > 0.0 {
                    // Only cells with paint have a viscosity.
                    let around = [0, a, b, a + b].map(|by| place - by);
                    let wet: f32 = around.iter().map(|at| domain.wet[*at]).sum();
                    let sum: f32 = around
                        .iter()
                        .map(|at| domain.wet[*at] * viscosity[*at])
                        .sum();
                    operator.edge[edge][place] *= beta * sum / wet.max(1.0);
                }
            }
            grid.wrap(&mut operator.edge[edge]);
        }
        operator
    }

    /// into = A·x; wraps x.
    pub fn apply(&mut self, x: &mut [f32], into: &mut [f32]) {
        let grid = self.grid;
        let span = Span::of(&grid);
        for field in fields_mut(x) {
            grid.wrap(field);
        }
        let [u, v, w, p] = fields(x);
        let velocity = [u, v, w];
        self.stress(velocity);
        let mut into = fields_mut(into);
        for (axis, into) in into.iter_mut().enumerate().take(3) {
            let edges = others(axis).map(|along| {
                let edge = 3 - axis - along;
                let slope = &self.slope[edge][which(edge, axis)];
                (
                    self.shear[edge].as_slice(),
                    slope.as_slice(),
                    grid.stride(along),
                )
            });
            let face = Face {
                mass: &self.mass[axis],
                free: &self.free[axis],
                area: &self.area[axis],
                by: grid.stride(axis),
                normal: &self.normal[axis],
                edges,
            };
            force(into, velocity[axis], p, &face, span);
            grid.clear(into);
        }
        outflow(into[3], velocity, &self.area, &self.wet, span);
        grid.clear(into[3]);
    }

    /// Stress of a velocity, which is wrapped.
    fn stress(&mut self, velocity: [&[f32]; 3]) {
        let (grid, span) = (self.grid, Span::of(&self.grid));
        for axis in 0..3 {
            stretch(
                &mut self.normal[axis],
                &self.stretch,
                velocity[axis],
                grid.stride(axis),
                span,
            );
            let [a, b] = others(axis);
            let by = [a, b].map(|axis| grid.stride(axis));
            let (weight, slope) = (&self.edge[axis], &self.slope[axis]);
            shear(
                &mut self.shear[axis],
                weight,
                slope,
                velocity[a],
                velocity[b],
                by,
                span,
            );
            grid.wrap(&mut self.normal[axis]);
            grid.wrap(&mut self.shear[axis]);
        }
    }

    /// Volume that leaves each wet cell; wraps the velocity.
    pub fn outflow(&self, velocity: [&mut [f32]; 3], into: &mut [f32]) {
        let [u, v, w] = velocity.map(|field| {
            self.grid.wrap(field);
            &*field
        });
        outflow(into, [u, v, w], &self.area, &self.wet, Span::of(&self.grid));
        self.grid.clear(into);
    }

    /// The part of momentum within one component.
    #[must_use]
    pub fn component(&self, domain: &Domain, axis: usize) -> Stencil {
        let grid = self.grid;
        let mut stencil = Stencil::new(&grid);
        stencil.mass.clone_from(&self.mass[axis]);
        stencil.active.clone_from(&self.free[axis]);
        for (known, part) in stencil.known.iter_mut().zip(&domain.part[axis]) {
            *known = f32::from(*part != crate::domain::Part::Air);
        }
        let by = grid.stride(axis);
        stencil.links[axis][by..].copy_from_slice(&self.stretch[..grid.len() - by]);
        for along in others(axis) {
            let edge = 3 - axis - along;
            let slopes = &self.slope[edge][which(edge, axis)];
            let links = stencil.links[along].iter_mut();
            for (link, (weight, slope)) in links.zip(self.edge[edge].iter().zip(slopes)) {
                *link = weight * slope * slope;
            }
        }
        stencil.finish(&grid);
        stencil
    }
}

/// The pressure's Laplacian: what leaves a cell by the gradient that a pressure gives to faces with their mass and what walls
/// drag at them, as if it were mass.
#[must_use]
pub fn laplacian(domain: &Domain, wall: f32) -> Stencil {
    let grid = domain.grid;
    let mut stencil = Stencil::new(&grid);
    stencil.active.clone_from(&domain.wet);
    stencil.known.clone_from(&domain.wet);
    for axis in 0..3 {
        let by = grid.stride(axis);
        for place in by..grid.len() {
            let area = domain.area[axis][place];
            if area > 0.0 {
                stencil.links[axis][place] = area * area / (domain.mass[axis][place] + wall);
                // Air beside paint has no pressure.
                stencil.known[place] = 1.0;
                stencil.known[place - by] = 1.0;
            }
        }
    }
    stencil.finish(&grid);
    stencil
}
