//! Seven-point operators, symmetric and positive: the pressure's Laplacian, and the part of viscosity that lies within
//! one component of the velocity.
//!
//! (A·x)ᵢ = dᵢ·xᵢ − Σ lᵢⱼ·xⱼ with d the mass and all links l. A link to a place that is not active is one to the value 0.

use maulstick_num::wide;

use crate::grid::Grid;

/// A seven-point operator, times the volume of a cell, in cells.
#[derive(Clone, Debug)]
pub struct Stencil {
    /// By axis, the link of each place with the one before it.
    pub links: [Vec<f32>; 3],
    /// Mass of each place.
    pub mass: Vec<f32>,
    /// 1 for an unknown, otherwise 0.
    pub active: Vec<f32>,
    /// 1 for an unknown or a place whose value is known to be 0; 0 for one that there is not.
    pub known: Vec<f32>,
    /// Diagonal, 0 where not active.
    pub(crate) diagonal: Vec<f32>,
    /// Its inverse, 0 where not active.
    pub(crate) inverse: Vec<f32>,
}

impl Stencil {
    /// One without links.
    #[must_use]
    pub fn new(grid: &Grid) -> Self {
        Self {
            links: std::array::from_fn(|_| grid.field()),
            mass: grid.field(),
            active: grid.field(),
            known: grid.field(),
            diagonal: grid.field(),
            inverse: grid.field(),
        }
    }

    /// Finds the diagonal, once links and mass are known.
    pub fn finish(&mut self, grid: &Grid) {
        for axis in (0..3).filter(|axis| grid.is_periodic(*axis)) {
            // A cell that lies beside itself has no link.
            if grid.cells[axis] == 1 {
                self.links[axis].fill(0.0);
            }
        }
        let [x, y, z] = &mut self.links;
        for field in [x, y, z, &mut self.mass, &mut self.active, &mut self.known] {
            grid.wrap(field);
        }
        sum_links(self, Span::of(grid));
        grid.wrap(&mut self.inverse);
    }
}

/// Places of a flat loop and the strides to neighbours.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    pub(crate) from: usize,
    pub(crate) to: usize,
    pub(crate) row: usize,
    pub(crate) plane: usize,
}

impl Span {
    pub(crate) fn of(grid: &Grid) -> Self {
        let range = grid.range();
        Self {
            from: range.start,
            to: range.end,
            row: grid.stride(1),
            plane: grid.stride(2),
        }
    }

    /// The places of the loop.
    #[inline(always)]
    pub(crate) fn here<'a>(&self, field: &'a [f32]) -> &'a [f32] {
        &field[self.from..self.to]
    }

    /// The same, of a field that is written.
    #[inline(always)]
    pub(crate) fn here_mut<'a>(&self, field: &'a mut [f32]) -> &'a mut [f32] {
        &mut field[self.from..self.to]
    }

    /// Places so far before those of the loop.
    #[inline(always)]
    pub(crate) fn before<'a>(&self, field: &'a [f32], by: usize) -> &'a [f32] {
        &field[self.from - by..self.to - by]
    }

    /// Places so far after those of the loop.
    #[inline(always)]
    pub(crate) fn after<'a>(&self, field: &'a [f32], by: usize) -> &'a [f32] {
        &field[self.from + by..self.to + by]
    }
}

/// Fields of a stencil and of a vector beside each place of a loop.
struct Around<'a> {
    links: [[&'a [f32]; 2]; 3],
    x: [[&'a [f32]; 2]; 3],
}

impl<'a> Around<'a> {
    #[inline(always)]
    fn of(span: &Span, stencil: &'a Stencil, x: &'a [f32]) -> Self {
        let by = [1, span.row, span.plane];
        let links = |a: usize| {
            let links = &stencil.links[a];
            [span.here(links), span.after(links, by[a])]
        };
        let values = |a: usize| [span.before(x, by[a]), span.after(x, by[a])];
        Self {
            links: [links(0), links(1), links(2)],
            x: [values(0), values(1), values(2)],
        }
    }

    /// Σ lᵢⱼ·xⱼ.
    #[inline(always)]
    fn pull(&self, i: usize) -> f32 {
        // Without a closure, which would be compiled for other registers.
        let [[a, b], [c, d], [e, f]] = self.links;
        let [[l, r], [s, n], [u, o]] = self.x;
        (a[i] * l[i] + b[i] * r[i]) + (c[i] * s[i] + d[i] * n[i]) + (e[i] * u[i] + f[i] * o[i])
    }
}

wide! {
    /// Diagonal and its inverse.
    fn sum_links(stencil: &mut Stencil, span: Span) {
        let [x, y, z] = &stencil.links;
        let (x, x_high) = (span.here(x), span.after(x, 1));
        let (y, y_high) = (span.here(y), span.after(y, span.row));
        let (z, z_high) = (span.here(z), span.after(z, span.plane));
        let (mass, active) = (span.here(&stencil.mass), span.here(&stencil.active));
        let diagonal = span.here_mut(&mut stencil.diagonal);
        let inverse = span.here_mut(&mut stencil.inverse);
        for i in 0..diagonal.len() {
            let links = (x[i] + x_high[i]) + (y[i] + y_high[i]) + (z[i] + z_high[i]);
            let sum = active[i] * (mass[i] + links);
            diagonal[i] = sum;
            inverse[i] = if sum > 0.0 { 1.0 / sum } else { 0.0 };
        }
    }
}

wide! {
    /// into = b − A·x.
    fn residual_flat(into: &mut [f32], b: &[f32], x: &[f32], stencil: &Stencil, span: Span) {
        let around = Around::of(&span, stencil, x);
        let (b, x) = (span.here(b), span.here(x));
        let (diagonal, active) = (span.here(&stencil.diagonal), span.here(&stencil.active));
        let into = span.here_mut(into);
        for i in 0..into.len() {
            into[i] = b[i] - diagonal[i] * x[i] + active[i] * around.pull(i);
        }
    }
}

wide! {
    /// into = A·x.
    fn apply_flat(into: &mut [f32], x: &[f32], stencil: &Stencil, span: Span) {
        let around = Around::of(&span, stencil, x);
        let x = span.here(x);
        let (diagonal, active) = (span.here(&stencil.diagonal), span.here(&stencil.active));
        let into = span.here_mut(into);
        for i in 0..into.len() {
            into[i] = diagonal[i] * x[i] - active[i] * around.pull(i);
        }
    }
}

wide! {
    /// into = x + ω·D⁻¹·(b − A·x).
    fn relax_flat(into: &mut [f32], b: &[f32], x: &[f32], omega: f32, stencil: &Stencil, span: Span) {
        let around = Around::of(&span, stencil, x);
        let (b, x) = (span.here(b), span.here(x));
        let inverse = span.here(&stencil.inverse);
        let into = span.here_mut(into);
        for i in 0..into.len() {
            into[i] = x[i] + omega * (inverse[i] * (b[i] + around.pull(i)) - x[i]);
        }
    }
}

wide! {
    /// x = ω·D⁻¹·b.
    fn begin_flat(x: &mut [f32], b: &[f32], omega: f32, inverse: &[f32]) {
        for (x, (b, inverse)) in x.iter_mut().zip(b.iter().zip(inverse)) {
            *x = omega * (*b * *inverse);
        }
    }
}

impl Stencil {
    /// into = A·x; wraps x.
    pub fn apply(&self, grid: &Grid, x: &mut [f32], into: &mut [f32]) {
        grid.wrap(x);
        apply_flat(into, x, self, Span::of(grid));
        grid.clear(into);
    }

    /// into = b − A·x; wraps x.
    pub fn residual(&self, grid: &Grid, b: &[f32], x: &mut [f32], into: &mut [f32]) {
        grid.wrap(x);
        residual_flat(into, b, x, self, Span::of(grid));
        grid.clear(into);
    }

    /// into = b − A·x in f64; x is wrapped.
    pub(crate) fn residual_f64(&self, grid: &Grid, b: &[f64], x: &mut [f64], into: &mut [f64]) {
        grid.wrap(x);
        let strides = [0, 1, 2].map(|axis| grid.stride(axis));
        for place in grid.places().filter(|place| self.active[*place] > 0.0) {
            let mut sum = b[place] - f64::from(self.diagonal[place]) * x[place];
            for (links, by) in self.links.iter().zip(strides) {
                sum += f64::from(links[place]) * x[place - by];
                sum += f64::from(links[place + by]) * x[place + by];
            }
            into[place] = sum;
        }
    }

    /// A damped Jacobi step from x, by way of a second field.
    pub(crate) fn relax(
        &self,
        grid: &Grid,
        b: &[f32],
        x: &mut Vec<f32>,
        spare: &mut Vec<f32>,
        omega: f32,
    ) {
        grid.wrap(x);
        relax_flat(spare, b, x, omega, self, Span::of(grid));
        std::mem::swap(x, spare);
    }

    /// The first one, from x = 0.
    pub(crate) fn begin(&self, b: &[f32], x: &mut [f32], omega: f32) {
        begin_flat(x, b, omega, &self.inverse);
    }
}
