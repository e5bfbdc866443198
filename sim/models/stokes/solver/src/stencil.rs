//! Seven-point operators, symmetric and positive: the pressure's Laplacian, and the part of viscosity within one
//! component of the velocity.
//!
//! (A·x)ᵢ = dᵢ·xᵢ − Σ lᵢⱼ·xⱼ with d the mass and all links l. A link to a place that is not active is one to the value 0.

use std::ops::Range;

use maulstick_num::wide;

use crate::grid::Grid;
use crate::runs::Runs;

/// A seven-point operator, times the volume of a cell, in cells.
#[derive(Clone, Debug, Default)]
pub struct Stencil {
    /// By axis, the link of each place with the one before it.
    pub links: [Vec<f32>; 3],
    /// Mass of each place.
    pub mass: Vec<f32>,
    /// 1 for an unknown, otherwise 0.
    pub active: Vec<f32>,
    /// 1 for an unknown or a place whose value is known to be 0; 0 for an absent one.
    pub known: Vec<f32>,
    /// Diagonal, 0 where not active.
    pub(crate) diagonal: Vec<f32>,
    /// Inverse of the diagonal, 0 where not active.
    pub(crate) inverse: Vec<f32>,
    /// Stretches with unknowns.
    pub(crate) runs: Runs,
    /// Earlier stretches with unknowns.
    runs_before: Runs,
}

impl Stencil {
    /// A stencil without links.
    #[must_use]
    pub fn new(grid: &Grid) -> Self {
        let mut stencil = Self::default();
        stencil.fit(grid);
        stencil
    }

    /// Fits all fields to a grid; their contents must be rewritten.
    pub(crate) fn fit(&mut self, grid: &Grid) {
        let [x, y, z] = &mut self.links;
        let (mass, active, known) = (&mut self.mass, &mut self.active, &mut self.known);
        let (diagonal, inverse) = (&mut self.diagonal, &mut self.inverse);
        for field in [x, y, z, mass, active, known, diagonal, inverse] {
            field.resize(grid.len(), 0.0);
        }
    }

    /// Computes the diagonal, once links and mass are known.
    pub fn finish(&mut self, grid: &Grid) {
        for axis in (0..3).filter(|axis| grid.is_periodic(*axis)) {
            // A cell beside itself has no link.
            if grid.cells[axis] == 1 {
                self.links[axis].fill(0.0);
            }
        }
        let [x, y, z] = &mut self.links;
        for field in [x, y, z, &mut self.mass, &mut self.active, &mut self.known] {
            grid.wrap(field);
        }
        sum_links(self, Span::of(grid, grid.range()));
        grid.wrap(&mut self.inverse);
        std::mem::swap(&mut self.runs, &mut self.runs_before);
        self.runs.find(grid.range(), &self.active);
    }

    /// Clears the places of former unknowns in a field that is 0 elsewhere.
    pub(crate) fn clear_left(&self, field: &mut [f32]) {
        if self.runs != self.runs_before {
            for run in self.runs_before.without(&self.runs) {
                field[run].fill(0.0);
            }
        }
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
    /// A stretch of a grid.
    pub(crate) const fn of(grid: &Grid, run: Range<usize>) -> Self {
        Self {
            from: run.start,
            to: run.end,
            row: grid.stride(1),
            plane: grid.stride(2),
        }
    }

    /// The places of the loop.
    #[inline(always)]
    pub(crate) fn here<'a, T>(&self, field: &'a [T]) -> &'a [T] {
        &field[self.from..self.to]
    }

    /// The places of the loop, for writing.
    #[inline(always)]
    pub(crate) fn here_mut<'a, T>(&self, field: &'a mut [T]) -> &'a mut [T] {
        &mut field[self.from..self.to]
    }

    /// A whole field with only the places of the loop.
    #[inline(always)]
    pub(crate) fn own<'a, T>(&self, field: &'a mut [T]) -> &'a mut [T] {
        &mut field[..self.to - self.from]
    }

    /// Places at an offset before those of the loop.
    #[inline(always)]
    pub(crate) fn before<'a, T>(&self, field: &'a [T], by: usize) -> &'a [T] {
        &field[self.from - by..self.to - by]
    }

    /// Places at an offset after those of the loop.
    #[inline(always)]
    pub(crate) fn after<'a, T>(&self, field: &'a [T], by: usize) -> &'a [T] {
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

impl Around<'_> {
    /// Σ lᵢⱼ·xⱼ·yⱼ with y of `other`.
    #[inline(always)]
    fn pull_times(&self, other: &Self, i: usize) -> f32 {
        let [[a, b], [c, d], [e, f]] = self.links;
        let [[l, r], [s, n], [u, o]] = self.x;
        let [[v, w], [x, y], [z, t]] = other.x;
        let along_x = a[i] * (l[i] * v[i]) + b[i] * (r[i] * w[i]);
        let along_y = c[i] * (s[i] * x[i]) + d[i] * (n[i] * y[i]);
        let along_z = e[i] * (u[i] * z[i]) + f[i] * (o[i] * t[i]);
        along_x + along_y + along_z
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
    /// into = weight·(b − A·x), with weight 0 where not active.
    fn residual_flat(into: &mut [f32], weight: &[f32], b: &[f32], x: &[f32], stencil: &Stencil, span: Span) {
        let around = Around::of(&span, stencil, x);
        let (b, x, weight) = (span.here(b), span.here(x), span.here(weight));
        let diagonal = span.here(&stencil.diagonal);
        let into = span.own(into);
        for i in 0..into.len() {
            into[i] = weight[i] * (b[i] - diagonal[i] * x[i] + around.pull(i));
        }
    }
}

wide! {
    /// into = A·x.
    fn apply_flat(into: &mut [f32], x: &[f32], stencil: &Stencil, span: Span) {
        let around = Around::of(&span, stencil, x);
        let x = span.here(x);
        let (diagonal, active) = (span.here(&stencil.diagonal), span.here(&stencil.active));
        let into = span.own(into);
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
        let into = span.own(into);
        for i in 0..into.len() {
            into[i] = x[i] + omega * (inverse[i] * (b[i] + around.pull(i)) - x[i]);
        }
    }
}

wide! {
    /// x = ω·D⁻¹·b.
    fn begin_flat(x: &mut [f32], b: &[f32], omega: f32, inverse: &[f32]) {
        let (b, inverse) = (&b[..x.len()], &inverse[..x.len()]);
        for i in 0..x.len() {
            x[i] = omega * (b[i] * inverse[i]);
        }
    }
}

wide! {
    /// Two steps from x = 0: by ω, then by ψ.
    fn begin_twice_flat(into: &mut [f32], b: &[f32], omegas: [f32; 2], stencil: &Stencil, span: Span) {
        let [omega, psi] = omegas;
        let inverse = &stencil.inverse;
        let of_b = Around::of(&span, stencil, b);
        let of_inverse = Around::of(&span, stencil, inverse);
        let (b, inverse) = (span.here(b), span.here(inverse));
        let into = span.own(into);
        for i in 0..into.len() {
            let first = omega * (inverse[i] * b[i]);
            let pull = of_b.pull_times(&of_inverse, i);
            into[i] = first + psi * (inverse[i] * (b[i] + omega * pull) - first);
        }
    }
}

/// A stencil writes the places of its unknowns, in stretches; elsewhere a field keeps its values.
impl Stencil {
    /// into = A·x; wraps x.
    pub fn apply(&self, grid: &Grid, x: &mut [f32], into: &mut [f32]) {
        grid.wrap(x);
        self.runs.write([&mut *into], |run, [into]| {
            apply_flat(into, x, self, Span::of(grid, run));
        });
        grid.clear(into);
    }

    /// into = weight·(b − A·x), with weight 0 where not active; wraps x.
    pub(crate) fn residual(
        &self,
        grid: &Grid,
        weight: &[f32],
        b: &[f32],
        x: &mut [f32],
        into: &mut [f32],
    ) {
        grid.wrap(x);
        self.runs.write([into], |run, [into]| {
            residual_flat(into, weight, b, x, self, Span::of(grid, run));
        });
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

    /// A damped Jacobi step from x.
    pub(crate) fn relax(
        &self,
        grid: &Grid,
        b: &[f32],
        x: &mut [f32],
        omega: f32,
        into: &mut [f32],
    ) {
        grid.wrap(x);
        self.runs.write([into], |run, [into]| {
            relax_flat(into, b, x, omega, self, Span::of(grid, run));
        });
    }

    /// The first Jacobi step, from x = 0.
    pub(crate) fn begin(&self, b: &[f32], omega: f32, into: &mut [f32]) {
        self.runs.write([into], |run, [into]| {
            begin_flat(into, &b[run.clone()], omega, &self.inverse[run]);
        });
    }

    /// The first two Jacobi steps, with a second field as scratch.
    pub(crate) fn begin_twice(
        &self,
        grid: &Grid,
        b: &[f32],
        omegas: [f32; 2],
        into: &mut [f32],
        spare: &mut [f32],
    ) {
        if (0..3).any(|axis| grid.is_periodic(axis)) {
            self.begin(b, omegas[0], spare);
            return self.relax(grid, b, spare, omegas[1], into);
        }
        self.runs.write([into], |run, [into]| {
            begin_twice_flat(into, b, omegas, self, Span::of(grid, run));
        });
    }
}
