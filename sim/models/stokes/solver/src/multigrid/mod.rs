//! Multigrid of seven-point operators on irregular domains, and conjugate gradients that it preconditions (Tatebe 1993;
//! McAdams, Sifakis and Teran 2010).
//!
//! Coarse operators are those of coarse cells: links in series and in parallel, and half of every link to a known place
//! within a coarse cell. Values are interpolated linearly between existing places, so that a wall without a value
//! (Neumann) does not affect them. A level is smoothed by a Chebyshev polynomial before and after; polynomials of one
//! matrix commute, so the cycle is symmetric. All iteration counts are fixed.

mod transfer;

use maulstick_num::wide;
use transfer::{Along, Layers, Workspace, all_layers, can_halve, gather, halved, spread};

use crate::grid::Grid;
use crate::stencil::Stencil;
use crate::vector::{add_scaled, dot_in, scale_and_add};

/// Steps of smoothing: inverses of the roots of a Chebyshev polynomial on [1/3, 2], the part of the spectrum of D⁻¹A
/// that no coarser grid resolves.
const SMOOTHING: [f32; 2] = [0.569_5, 1.732];
/// Number of steps on the coarsest grid: Chebyshev on [1/50, 2].
const COARSEST_STEPS: usize = 16;
/// Greatest number of cells along an axis of the coarsest grid, if it can be halved down to that.
const COARSEST_CELLS: usize = 4;

/// A grid of the hierarchy.
#[derive(Clone, Debug)]
struct Level {
    grid: Grid,
    stencil: Stencil,
    /// Solution and right-hand side, on all but the first level.
    x: Vec<f32>,
    b: Vec<f32>,
    /// Scratch field, 0 where there are no unknowns.
    spare: Vec<f32>,
    layers: Layers,
    /// Transfer of this level to the next; `None` on the coarsest.
    down: Option<Down>,
}

/// From a grid to the next: along z, then y, then x.
#[derive(Clone, Debug)]
struct Down {
    along: [Along; 3],
    grids: [Grid; 3],
    fields: [Vec<f32>; 2],
    /// Scale of interpolated values: the inverse of the weights of the existing places.
    scale: Vec<f32>,
}

/// Hierarchy of grids of one operator.
#[derive(Clone, Debug)]
pub struct Multigrid {
    levels: Vec<Level>,
    along: [Along; 3],
    omegas: [f32; COARSEST_STEPS],
    /// Residual, preconditioned residual, direction and its image.
    gradients: [Vec<f32>; 4],
}

/// Share of the right-hand side at which a residual is rounding.
const ROUNDING: f64 = 1e-8;

impl Down {
    fn new(grid: &Grid, along: [Along; 3]) -> Self {
        let one = |grid: &Grid, axis| {
            if can_halve(grid, axis) {
                halved(grid, axis)
            } else {
                *grid
            }
        };
        let z = one(grid, 2);
        let y = one(&z, 1);
        let grids = [z, y, one(&y, 0)];
        Self {
            along,
            grids,
            fields: [z.field(), y.field()],
            scale: grid.field(),
        }
    }

    fn coarse(&self) -> &Grid {
        &self.grids[2]
    }

    fn workspace(&mut self) -> Workspace<'_> {
        let [by_z, by_y] = &mut self.fields;
        Workspace {
            grids: &self.grids,
            by_z,
            by_y,
        }
    }

    /// Operator of the coarse grid.
    fn coarsen(&mut self, grid: &Grid, fine: &Stencil, into: &mut Stencil) {
        let coarse = *self.coarse();
        let layers = all_layers(&coarse);
        // An axis that is not halved keeps its links and sums.
        let along = self.along;
        let weights = |of: fn(Along) -> [f32; 4]| along.map(of);
        let (sums, children) = (weights(Along::sum), weights(Along::children));
        for axis in 0..3 {
            let mut weights = sums;
            weights[axis] = along[axis].link();
            let links = (grid, fine.links[axis].as_slice());
            gather(
                weights,
                links,
                &mut into.links[axis],
                &layers,
                &mut self.workspace(),
            );
        }
        let mut lost = std::mem::take(&mut self.scale);
        self.lost_links(grid, fine, &mut lost);
        gather(
            sums,
            (grid, &lost),
            &mut into.mass,
            &layers,
            &mut self.workspace(),
        );
        self.scale = lost;
        for (from, into) in [
            (&fine.active, &mut into.active),
            (&fine.known, &mut into.known),
        ] {
            gather(children, (grid, from), into, &layers, &mut self.workspace());
            into.iter_mut()
                .for_each(|value| *value = if *value > 0.0 { 1.0 } else { 0.0 });
        }
        into.finish(&coarse);
        let mut scale = std::mem::take(&mut self.scale);
        scale.fill(0.0);
        let layers = all_layers(grid);
        let known = (grid, scale.as_mut_slice(), fine.active.as_slice());
        spread(along, &into.known, known, &layers, &mut self.workspace());
        for scale in &mut scale {
            *scale = if *scale > 0.0 { 1.0 / *scale } else { 0.0 };
        }
        self.scale = scale;
    }

    /// Mass, and half of the links with known places within one coarse cell, by the place that is an unknown.
    fn lost_links(&self, grid: &Grid, fine: &Stencil, lost: &mut [f32]) {
        lost.copy_from_slice(&fine.mass);
        let rows = grid.len() / grid.stride(1);
        let width = grid.stride(1);
        for axis in 0..3 {
            let is_halved = self.coarse().cells[axis] != grid.cells[axis];
            if self.along[axis] == Along::Faces || !is_halved {
                continue;
            }
            let (links, active) = (&fine.links[axis], &fine.active);
            for row in 0..rows {
                let start = row * width;
                if axis == 0 {
                    let own = start + 1..start + 1 + (width - 3).next_multiple_of(2).min(width - 1);
                    let (links, active) = (&links[own.clone()], &active[own.clone()]);
                    lose_along(&mut lost[own], links, active, grid.cells[0]);
                    continue;
                }
                let [number, per] = if axis == 1 {
                    [row % (grid.cells[1] + 3), grid.cells[1]]
                } else {
                    [row / (grid.cells[1] + 3), grid.cells[2]]
                };
                // The second cell of a coarse one.
                if number >= 2 && number.is_multiple_of(2) && number < per + 1 {
                    let stride = grid.stride(axis);
                    let (low, high) = lost.split_at_mut(start);
                    let low = &mut low[start - stride..start - stride + width];
                    let links = &links[start..start + width];
                    let active = [start - stride, start].map(|at| &active[at..at + width]);
                    lose(low, &mut high[..width], links, active);
                }
            }
        }
        grid.wrap(lost);
    }
}

wide! {
    fn lose(low: &mut [f32], high: &mut [f32], links: &[f32], active: [&[f32]; 2]) {
        let n = low.len();
        let (high, links, a, b) = (&mut high[..n], &links[..n], &active[0][..n], &active[1][..n]);
        for i in 0..n {
            let half = 0.5 * links[i];
            low[i] += a[i] * (1.0 - b[i]) * half;
            high[i] += b[i] * (1.0 - a[i]) * half;
        }
    }
}

wide! {
    /// Lost links along a row that begins with its first cell.
    fn lose_along(lost: &mut [f32], links: &[f32], active: &[f32], cells: usize) {
        let pairs = lost.as_chunks_mut::<2>().0.iter_mut();
        let links = links.as_chunks::<2>().0;
        let active = active.as_chunks::<2>().0;
        for (lost, (link, active)) in pairs.zip(links.iter().zip(active)).take(cells / 2) {
            let half = 0.5 * link[1];
            let [a, b] = *active;
            lost[0] += a * (1.0 - b) * half;
            lost[1] += b * (1.0 - a) * half;
        }
    }
}

/// Inverses of the roots of the Chebyshev polynomial on [1/50, 2], large and small in turn to keep rounding small.
fn coarsest_omegas() -> [f32; COARSEST_STEPS] {
    let (low, high) = (0.02, 2.0);
    let mut order = [0; COARSEST_STEPS];
    let mut filled = 1;
    while filled < COARSEST_STEPS {
        for i in (0..filled).rev() {
            order[2 * i] = order[i];
            order[2 * i + 1] = 2 * filled - 1 - order[2 * i];
        }
        filled *= 2;
    }
    order.map(|number| {
        let angle = std::f64::consts::PI * (number as f64 + 0.5) / COARSEST_STEPS as f64;
        let root = 0.5 * (high + low) + 0.5 * (high - low) * maulstick_num::cos(angle);
        (1.0 / root) as f32
    })
}

impl Multigrid {
    /// The hierarchy of an operator whose values are in the middle of cells, or on the faces across an axis.
    #[must_use]
    pub fn new(grid: &Grid, stencil: Stencil, faces: Option<usize>) -> Self {
        let mut multigrid = Self::empty(grid, faces);
        multigrid.levels[0].stencil = stencil;
        multigrid.renew();
        multigrid
    }

    /// A hierarchy whose [operator](Self::stencil_mut) is still to be written.
    #[must_use]
    pub fn empty(grid: &Grid, faces: Option<usize>) -> Self {
        let along = [0, 1, 2].map(|axis| {
            if faces == Some(axis) {
                Along::Faces
            } else {
                Along::Middles
            }
        });
        let mut multigrid = Self {
            levels: Vec::new(),
            along,
            omegas: coarsest_omegas(),
            gradients: std::array::from_fn(|_| Vec::new()),
        };
        multigrid.fit(grid);
        multigrid
    }

    /// Fits the hierarchy to another grid.
    pub fn fit(&mut self, grid: &Grid) {
        if self.levels.first().is_some_and(|level| level.grid == *grid) {
            return;
        }
        self.levels.clear();
        let mut grid = *grid;
        loop {
            let is_coarsest = grid.cells.iter().all(|cells| *cells <= COARSEST_CELLS)
                || (0..3).all(|axis| !can_halve(&grid, axis));
            let down = (!is_coarsest).then(|| Down::new(&grid, self.along));
            let next = down.as_ref().map(|down| *down.coarse());
            let own = || {
                if self.levels.is_empty() {
                    Vec::new()
                } else {
                    grid.field()
                }
            };
            let level = Level {
                grid,
                stencil: Stencil::new(&grid),
                x: own(),
                b: own(),
                spare: grid.field(),
                layers: [0..0, 0..0],
                down,
            };
            self.levels.push(level);
            let Some(next) = next else { break };
            grid = next;
        }
    }

    /// Computes the diagonal of the operator, and that of each coarser grid.
    pub fn renew(&mut self) {
        let mut rest = self.levels.as_mut_slice();
        if let Some(first) = rest.first_mut() {
            first.stencil.finish(&first.grid);
            for field in &mut self.gradients {
                if field.len() == first.grid.len() {
                    first.stencil.clear_left(field);
                } else {
                    field.clear();
                    field.resize(first.grid.len(), 0.0);
                }
            }
        }
        while let Some((level, coarser)) = rest.split_first_mut() {
            let grid = level.grid;
            level.layers = layers(&grid, &level.stencil);
            if let (Some(down), Some(next)) = (&mut level.down, coarser.first_mut()) {
                down.coarsen(&grid, &level.stencil, &mut next.stencil);
                next.stencil.clear_left(&mut next.x);
            }
            level.stencil.clear_left(&mut level.spare);
            rest = coarser;
        }
    }

    /// Operator on the finest grid.
    #[must_use]
    pub fn stencil(&self) -> &Stencil {
        &self.levels[0].stencil
    }

    /// Operator on the finest grid, for writing; [`renew`](Self::renew) then updates the hierarchy.
    #[must_use]
    pub fn stencil_mut(&mut self) -> &mut Stencil {
        &mut self.levels[0].stencil
    }

    /// x ≈ A⁻¹·b by one symmetric V-cycle. Where there are no unknowns x is 0 before and after.
    pub fn cycle(&mut self, b: &[f32], x: &mut [f32]) {
        descend(&mut self.levels, &self.omegas, b, x);
    }

    /// Solves A·x = b by `iterations` of preconditioned conjugate gradients from x, which is 0 where there are no
    /// unknowns; returns the norm of each residual, the first guess's included.
    pub fn solve(&mut self, b: &[f32], x: &mut [f32], iterations: usize) -> Vec<f64> {
        let grid = self.levels[0].grid;
        let [mut r, mut z, mut q, mut p] = std::mem::take(&mut self.gradients);
        let stencil = self.stencil();
        stencil.residual(&grid, &stencil.active, b, x, &mut r);
        grid.clear(&mut r);
        if is_singular(&grid, stencil) {
            self.level_out(&mut r);
        }
        let runs = self.stencil().runs.clone();
        let mut norms = Vec::with_capacity(iterations + 1);
        norms.push(dot_in(&runs, &r, &r).sqrt());
        let rounding = ROUNDING * dot_in(&runs, b, b).sqrt();
        let mut before = 0.0;
        while norms.len() <= iterations && norms[norms.len() - 1] > rounding {
            self.cycle(&r, &mut z);
            let now = dot_in(&runs, &r, &z);
            // The residual has reached rounding.
            if !now.is_finite() || now <= 0.0 {
                break;
            }
            let beta = if before > 0.0 { now / before } else { 0.0 };
            runs.write([&mut *p], |run, [p]| scale_and_add(p, beta as f32, &z[run]));
            self.stencil().apply(&grid, &mut p, &mut q);
            let curvature = dot_in(&runs, &p, &q);
            if !curvature.is_finite() || curvature <= 0.0 {
                break;
            }
            let alpha = (now / curvature) as f32;
            runs.write([&mut *x, &mut *r], |run, [x, r]| {
                add_scaled(x, alpha, &p[run.clone()]);
                add_scaled(r, -alpha, &q[run]);
            });
            before = now;
            norms.push(dot_in(&runs, &r, &r).sqrt());
        }
        grid.wrap(x);
        self.gradients = [r, z, q, p];
        norms
    }

    /// Solves A·x = b in f64 down to a share of the norm of b: up to `rounds` rounds of conjugate gradients in f32 on
    /// the residual. Returns the remaining share.
    pub fn refine(&mut self, b: &[f64], x: &mut [f64], part: f64, rounds: usize) -> f64 {
        let grid = self.levels[0].grid;
        let squares = |r: &[f64]| r.iter().map(|r| r * r).sum::<f64>().sqrt();
        let whole = squares(b).max(f64::MIN_POSITIVE);
        let mut left = 1.0;
        let mut r = vec![0.0; b.len()];
        for round in 0..=rounds {
            self.stencil().residual_f64(&grid, b, x, &mut r);
            left = squares(&r) / whole;
            if left <= part || round == rounds {
                break;
            }
            let scale = left * whole;
            let small: Vec<f32> = r.iter().map(|r| (r / scale) as f32).collect();
            let mut z = grid.field();
            self.solve(&small, &mut z, 5);
            for (x, z) in x.iter_mut().zip(&z) {
                *x += scale * f64::from(*z);
            }
        }
        left
    }

    /// Removes the mean of a residual, which no solution reduces.
    fn level_out(&self, r: &mut [f32]) {
        let active = &self.stencil().active;
        let range = self.levels[0].grid.places();
        let (mut sum, mut count) = (0.0, 0.0);
        for place in range.filter(|place| active[*place] > 0.0) {
            sum += f64::from(r[place]);
            count += 1.0;
        }
        let mean = (sum / f64::max(count, 1.0)) as f32;
        for (r, active) in r.iter_mut().zip(active) {
            *r -= mean * active;
        }
        self.levels[0].grid.clear(r);
    }
}

/// True if every link is one between unknowns and there is no mass.
fn is_singular(grid: &Grid, stencil: &Stencil) -> bool {
    let strides = [0, 1, 2].map(|axis| grid.stride(axis));
    let active = &stencil.active;
    let mut unknowns = grid.places().filter(|place| active[*place] > 0.0);
    unknowns.all(|place| {
        let mut left = stencil.diagonal[place];
        for (links, by) in stencil.links.iter().zip(strides) {
            left -= links[place] * active[place - by] + links[place + by] * active[place + by];
        }
        left.abs() <= 1e-6 * stencil.diagonal[place]
    })
}

/// Layers that contain unknowns.
fn layers(grid: &Grid, stencil: &Stencil) -> Layers {
    let [row, plane] = [1, 2].map(|axis| grid.stride(axis));
    let mut layers = [(); 2].map(|()| usize::MAX..usize::default());
    for run in stencil.runs.iter() {
        let [low, high] = [run.start / plane, (run.end - 1) / plane];
        let rows = if low == high {
            run.start % plane / row..(run.end - 1) % plane / row + 1
        } else {
            0..grid.cells[1] + 3
        };
        for (layers, found) in layers.iter_mut().zip([rows, low..high + 1]) {
            *layers = layers.start.min(found.start)..layers.end.max(found.end);
        }
    }
    let [all_rows, all_planes] = all_layers(grid);
    let [rows, planes] = layers;
    [(rows, all_rows), (planes, all_planes)]
        .map(|(some, all)| some.start.clamp(all.start, all.end)..some.end.min(all.end))
}

/// A V-cycle from x = 0.
fn descend(levels: &mut [Level], omegas: &[f32], b: &[f32], x: &mut [f32]) {
    let Some((level, coarser)) = levels.split_first_mut() else {
        return;
    };
    let (grid, stencil, spare) = (level.grid, &level.stencil, &mut level.spare);
    let (Some(down), Some(next)) = (&mut level.down, coarser.first_mut()) else {
        // An even number, so the last one ends in x.
        stencil.begin_twice(&grid, b, [omegas[0], omegas[1]], x, spare);
        for omegas in omegas[2..].chunks(2) {
            stencil.relax(&grid, b, x, omegas[0], spare);
            stencil.relax(&grid, b, spare, omegas[1], x);
        }
        return;
    };
    let [first, second] = SMOOTHING;
    stencil.begin_twice(&grid, b, SMOOTHING, x, spare);
    stencil.residual(&grid, &down.scale, b, x, spare);
    grid.wrap(spare);
    let weights = down.along.map(Along::restriction);
    let (mut coarse_x, mut coarse_b) = (std::mem::take(&mut next.x), std::mem::take(&mut next.b));
    gather(
        weights,
        (&grid, spare),
        &mut coarse_b,
        &next.layers,
        &mut down.workspace(),
    );
    descend(coarser, omegas, &coarse_b, &mut coarse_x);
    let coarse = *down.coarse();
    coarse.wrap(&mut coarse_x);
    let scale = std::mem::take(&mut down.scale);
    let into = (&grid, &mut *x, scale.as_slice());
    let (along, mut workspace) = (down.along, down.workspace());
    spread(along, &coarse_x, into, &level.layers, &mut workspace);
    down.scale = scale;
    if let Some(next) = coarser.first_mut() {
        (next.x, next.b) = (coarse_x, coarse_b);
    }
    stencil.relax(&grid, b, x, second, spare);
    stencil.relax(&grid, b, spare, first, x);
}
