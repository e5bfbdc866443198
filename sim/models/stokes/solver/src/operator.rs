//! The Stokes operator: momentum α·M·u + β·Eᵀ(2μE·u) + Gp on faces, and the outflow of each cell.
//!
//! E is the rate of strain, on cells and edges; G is minus the adjoint of the divergence. The viscous part within one
//! component of the velocity is a [stencil](Stencil), which multigrid uses as preconditioner; the rest are cross terms
//! of edges.

use maulstick_num::wide;

use crate::domain::Domain;
use crate::grid::others;
use crate::multigrid::Multigrid;
use crate::runs::{Runs, share};
use crate::stencil::{Span, Stencil};

/// The three components of the velocity, and the pressure.
pub type Unknowns = [Vec<f32>; 4];

/// Weights of the viscous part, and its cross terms.
#[derive(Clone, Debug, Default)]
pub struct Operator {
    /// 2β·μ·volume of cells.
    stretch: Vec<f32>,
    /// β·μ·volume of edges.
    edge: [Vec<f32>; 3],
    /// Effect on each velocity of an edge by a slope of the other.
    cross: [Vec<f32>; 3],
}

/// Terms on the faces across an axis.
struct Face<'a> {
    stencil: &'a Stencil,
    area: &'a [f32],
    by: usize,
    /// For both edges beside it: cross weight, stride between them, and the other velocity.
    edges: [(&'a [f32], usize, &'a [f32]); 2],
}

wide! {
    fn force(into: &mut [f32], u: &[f32], p: &[f32], face: &Face<'_>, span: Span) {
        let links = &face.stencil.links;
        let (x, x_high) = (span.here(&links[0]), span.after(&links[0], 1));
        let (y, y_high) = (span.here(&links[1]), span.after(&links[1], span.row));
        let (z, z_high) = (span.here(&links[2]), span.after(&links[2], span.plane));
        let (mass, free) = (span.here(&face.stencil.mass), span.here(&face.stencil.active));
        let (west, east) = (span.before(u, 1), span.after(u, 1));
        let (south, north) = (span.before(u, span.row), span.after(u, span.row));
        let (down, up) = (span.before(u, span.plane), span.after(u, span.plane));
        let u = span.here(u);
        let area = span.here(face.area);
        let (p_low, p) = (span.before(p, face.by), span.here(p));
        let [(s, s_by, v), (t, t_by, w)] = face.edges;
        let (s, s_high) = (span.here(s), span.after(s, s_by));
        let (t, t_high) = (span.here(t), span.after(t, t_by));
        let (v_low, v_low_high) = (span.before(v, face.by), span.before(&v[s_by..], face.by));
        let (v, v_high) = (span.here(v), span.after(v, s_by));
        let (w_low, w_low_high) = (span.before(w, face.by), span.before(&w[t_by..], face.by));
        let (w, w_high) = (span.here(w), span.after(w, t_by));
        let into = span.own(into);
        for i in 0..into.len() {
            let x = x[i] * (u[i] - west[i]) + x_high[i] * (u[i] - east[i]);
            let y = y[i] * (u[i] - south[i]) + y_high[i] * (u[i] - north[i]);
            let z = z[i] * (u[i] - down[i]) + z_high[i] * (u[i] - up[i]);
            let s = s[i] * (v[i] - v_low[i]) - s_high[i] * (v_high[i] - v_low_high[i]);
            let t = t[i] * (w[i] - w_low[i]) - t_high[i] * (w_high[i] - w_low_high[i]);
            let stress = ((x + y) + z) + (s + t);
            into[i] = free[i] * (mass[i] * u[i] + stress + area[i] * (p[i] - p_low[i]));
        }
    }
}

wide! {
    /// into = weight·b + sign·(outflow of each wet cell).
    fn outflow_flat(into: &mut [f32], weights: [f32; 2], b: &[f32], u: [&[f32]; 3], domain: &Domain, span: Span) {
        let [weight, sign] = weights;
        let by = [1, span.row, span.plane];
        let area = &domain.area;
        let (ax, ax_high) = (span.here(&area[0]), span.after(&area[0], by[0]));
        let (ay, ay_high) = (span.here(&area[1]), span.after(&area[1], by[1]));
        let (az, az_high) = (span.here(&area[2]), span.after(&area[2], by[2]));
        let (ux, ux_high) = (span.here(u[0]), span.after(u[0], by[0]));
        let (uy, uy_high) = (span.here(u[1]), span.after(u[1], by[1]));
        let (uz, uz_high) = (span.here(u[2]), span.after(u[2], by[2]));
        let (wet, b) = (span.here(&domain.wet), span.here(b));
        let into = span.own(into);
        for i in 0..into.len() {
            let x = ax_high[i] * ux_high[i] - ax[i] * ux[i];
            let y = ay_high[i] * uy_high[i] - ay[i] * uy[i];
            let z = az_high[i] * uz_high[i] - az[i] * uz[i];
            into[i] = weight * b[i] + sign * (wet[i] * ((x + y) + z));
        }
    }
}

/// into = weight·b + sign·(outflow of each wet cell), in stretches; velocities are wrapped.
pub(crate) fn outflow(
    domain: &Domain,
    runs: &Runs,
    velocity: [&[f32]; 3],
    (weights, b): ([f32; 2], &[f32]),
    into: &mut [f32],
) {
    let grid = domain.grid;
    runs.write([&mut *into], |run, [into]| {
        outflow_flat(into, weights, b, velocity, domain, Span::of(&grid, run));
    });
    grid.clear(into);
}

wide! {
    /// Weight of an edge: its share times the mean viscosity of the wet cells around it.
    fn weigh_edges(into: &mut [f32], edge: &[f32], beta: f32, wet: &[f32], viscosity: &[f32], by: [usize; 2], span: Span) {
        let [a, b] = by;
        let (one, two) = (span.here(wet), span.before(wet, a));
        let (three, four) = (span.before(wet, b), span.before(wet, a + b));
        let (m1, m2) = (span.here(viscosity), span.before(viscosity, a));
        let (m3, m4) = (span.before(viscosity, b), span.before(viscosity, a + b));
        let edge = span.here(edge);
        let into = span.here_mut(into);
        for i in 0..into.len() {
            let wet = (one[i] + two[i]) + (three[i] + four[i]);
            let sum = (one[i] * m1[i] + two[i] * m2[i]) + (three[i] * m3[i] + four[i] * m4[i]);
            // Only cells with paint have a viscosity.
            into[i] = edge[i] * (beta * sum / if wet > 1.0 { wet } else { 1.0 });
        }
    }
}

wide! {
    fn multiply(into: &mut [f32], scale: f32, a: &[f32], b: &[f32]) {
        let (a, b) = (&a[..into.len()], &b[..into.len()]);
        for i in 0..into.len() {
            into[i] = scale * a[i] * b[i];
        }
    }
}

wide! {
    fn multiply_three(into: &mut [f32], a: &[f32], b: &[f32], c: &[f32]) {
        let n = into.len();
        let (a, b, c) = (&a[..n], &b[..n], &c[..n]);
        for i in 0..n {
            into[i] = a[i] * b[i] * c[i];
        }
    }
}

wide! {
    fn add(into: &mut [f32], a: &[f32], b: &[f32]) {
        let n = into.len();
        let (a, b) = (&a[..n], &b[..n]);
        for i in 0..n {
            into[i] = a[i] + b[i];
        }
    }
}

/// Index of an axis among the [others] of an edge.
fn which(edge: usize, axis: usize) -> usize {
    usize::from(others(edge)[1] == axis)
}

impl Operator {
    /// Computes the weights for α of the mass and β of viscosity, which is relative to the window's by cell, and writes
    /// the stencil of each component of the velocity.
    pub fn renew(
        &mut self,
        domain: &Domain,
        [alpha, beta]: [f32; 2],
        viscosity: &[f32],
        components: &mut [Multigrid],
    ) {
        let grid = domain.grid;
        let len = grid.len();
        self.stretch.resize(len, 0.0);
        multiply(&mut self.stretch, 2.0 * beta, &domain.volume, viscosity);
        let mut edges = [0, 1, 2];
        let mut fields: Vec<_> = edges
            .iter_mut()
            .zip(self.edge.iter_mut().zip(&mut self.cross))
            .collect();
        share(len, &mut fields, |(edge, (weight, cross))| {
            let by = others(**edge).map(|axis| grid.stride(axis));
            let (shares, slopes) = (&domain.edge[**edge], &domain.slope[**edge]);
            weight.resize(len, 0.0);
            cross.resize(len, 0.0);
            let span = Span::of(&grid, by[0] + by[1]..len);
            weigh_edges(weight, shares, beta, &domain.wet, viscosity, by, span);
            grid.wrap(weight);
            multiply_three(cross, weight, &slopes[0], &slopes[1]);
        });
        let mut axes: Vec<_> = components.iter_mut().take(3).enumerate().collect();
        let own = &*self;
        share(len, &mut axes, |(axis, component)| {
            own.component(domain, *axis, alpha, component.stencil_mut());
        });
    }

    /// The part of momentum within one component.
    fn component(&self, domain: &Domain, axis: usize, alpha: f32, stencil: &mut Stencil) {
        let grid = domain.grid;
        stencil.fit(&grid);
        multiply(
            &mut stencil.mass,
            alpha,
            &domain.mass[axis],
            &domain.free[axis],
        );
        stencil.active.copy_from_slice(&domain.free[axis]);
        add(&mut stencil.known, &domain.free[axis], &domain.solid[axis]);
        let by = grid.stride(axis);
        stencil.links[axis][by..].copy_from_slice(&self.stretch[..grid.len() - by]);
        stencil.links[axis][..by].fill(0.0);
        for along in others(axis) {
            let edge = 3 - axis - along;
            let slopes = &domain.slope[edge][which(edge, axis)];
            multiply_three(&mut stencil.links[along], &self.edge[edge], slopes, slopes);
        }
    }

    /// into = A·x for the window of these hierarchies of components and Laplacian; wraps x.
    pub fn apply(
        &self,
        domain: &Domain,
        hierarchies: &[Multigrid],
        x: &mut Unknowns,
        into: &mut Unknowns,
    ) {
        let grid = domain.grid;
        for field in &mut *x {
            grid.wrap(field);
        }
        let [u, v, w, p] = &*x;
        let velocity: [&[f32]; 3] = [u, v, w];
        let [f, g, h, leaves] = into;
        for (axis, into) in [f, g, h].into_iter().enumerate() {
            let stencil = hierarchies[axis].stencil();
            let edges = others(axis).map(|along| {
                let edge = 3 - axis - along;
                (
                    self.cross[edge].as_slice(),
                    grid.stride(along),
                    velocity[along],
                )
            });
            let face = Face {
                stencil,
                area: &domain.area[axis],
                by: grid.stride(axis),
                edges,
            };
            stencil.runs.write([&mut **into], |run, [into]| {
                force(into, velocity[axis], p, &face, Span::of(&grid, run));
            });
            grid.clear(into);
        }
        let runs = &hierarchies[3].stencil().runs;
        outflow(domain, runs, velocity, ([0.0, 1.0], p), leaves);
    }
}

wide! {
    /// Links of the pressure across an axis.
    fn square_areas(into: &mut [f32], area: &[f32], mass: &[f32], wall: f32) {
        let n = into.len();
        let (area, mass) = (&area[..n], &mass[..n]);
        for i in 0..n {
            into[i] = if mass[i] > 0.0 { area[i] * area[i] / (mass[i] + wall) } else { 0.0 };
        }
    }
}

wide! {
    /// Air beside paint has no unknown pressure.
    fn mark_known(known: &mut [f32], links: &[Vec<f32>; 3], span: Span) {
        let (x, x_high) = (span.here(&links[0]), span.after(&links[0], 1));
        let (y, y_high) = (span.here(&links[1]), span.after(&links[1], span.row));
        let (z, z_high) = (span.here(&links[2]), span.after(&links[2], span.plane));
        let known = span.here_mut(known);
        for i in 0..known.len() {
            let links = (x[i] + x_high[i]) + (y[i] + y_high[i]) + (z[i] + z_high[i]);
            known[i] = if links > 0.0 { 1.0 } else { known[i] };
        }
    }
}

/// Writes the pressure's Laplacian: the outflow of a cell by the pressure gradient on faces, with their mass and the
/// walls' drag, counted as mass.
pub fn laplacian(domain: &Domain, wall: f32, stencil: &mut Stencil) {
    let grid = domain.grid;
    stencil.fit(&grid);
    stencil.active.copy_from_slice(&domain.wet);
    stencil.known.copy_from_slice(&domain.wet);
    stencil.mass.fill(0.0);
    for axis in 0..3 {
        square_areas(
            &mut stencil.links[axis],
            &domain.area[axis],
            &domain.mass[axis],
            wall,
        );
    }
    let span = Span::of(&grid, 0..grid.len() - grid.stride(2));
    mark_known(&mut stencil.known, &stencil.links, span);
}
