//! Multigrid of seven-point operators on irregular domains, and conjugate gradients that it preconditions (Tatebe 1993;
//! McAdams, Sifakis and Teran 2010).
//!
//! Coarse operators are those of coarse cells: links in series and side by side, and half of every link to a known place
//! that falls within a coarse cell. Values are interpolated by lines between the places that there are, so that a wall
//! without a value (Neumann) does not pull at them. A level is smoothed by a Chebyshev polynomial before and after; polynomials of one matrix commute, so the cycle is symmetric. All numbers of steps are fixed.

mod transfer;

use transfer::{Along, can_halve, gather, halved, spread};

use crate::grid::Grid;
use crate::stencil::Stencil;
use crate::vector::{add_scaled, dot, norm, scale_and_add};

/// Steps of smoothing: inverses of the roots of a Chebyshev polynomial on [1/3, 2], where the spectrum of D⁻¹A lies that
/// no coarser grid sees.
const SMOOTHING: [f32; 2] = [0.569_5, 1.732];
/// Steps on the coarsest grid: Chebyshev on [1/50, 2].
const COARSEST_STEPS: usize = 16;
/// Cells of an axis of the coarsest grid at most, if it can be halved so far.
const COARSEST_CELLS: usize = 4;

/// A grid of the hierarchy.
#[derive(Clone, Debug)]
struct Level {
    grid: Grid,
    stencil: Stencil,
    /// Solution, right-hand side, and room.
    x: Vec<f32>,
    b: Vec<f32>,
    spare: Vec<f32>,
    /// What brings this level to the next; none on the coarsest.
    down: Option<Down>,
}

/// From a grid to the next: along z, then y, then x.
#[derive(Clone, Debug)]
struct Down {
    along: [Along; 3],
    grids: [Grid; 3],
    fields: [Vec<f32>; 2],
    /// Scale of interpolated values: the inverse of the weights of the places that there are.
    scale: Vec<f32>,
}

/// Hierarchy of grids of one operator.
#[derive(Clone, Debug)]
pub struct Multigrid {
    levels: Vec<Level>,
    omegas: [f32; COARSEST_STEPS],
    /// True if a constant is no residual: no value is known and there is no mass.
    is_singular: bool,
}

/// Part of the right-hand side at which a residual is rounding.
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

    /// Sums by weights of each axis, x first.
    fn gather(&mut self, grid: &Grid, weights: [[f32; 4]; 3], from: &mut [f32], into: &mut [f32]) {
        let [z, y, x] = self.grids;
        let [by_z, by_y] = &mut self.fields;
        grid.wrap(from);
        gather(2, weights[2], (grid, from), (&z, by_z));
        z.wrap(by_z);
        gather(1, weights[1], (&z, by_z), (&y, by_y));
        y.wrap(by_y);
        gather(0, weights[0], (&y, by_y), (&x, into));
        x.clear(into);
    }

    /// Interpolates.
    fn spread(&mut self, grid: &Grid, from: &mut [f32], into: &mut [f32]) {
        let [z, y, x] = self.grids;
        let [by_z, by_y] = &mut self.fields;
        x.wrap(from);
        spread(0, self.along[0], (&x, from), (&y, by_y));
        y.wrap(by_y);
        spread(1, self.along[1], (&y, by_y), (&z, by_z));
        z.wrap(by_z);
        spread(2, self.along[2], (&z, by_z), (grid, into));
    }

    /// Operator of the coarse grid.
    fn coarsen(&mut self, grid: &Grid, fine: &Stencil) -> Stencil {
        let coarse = *self.coarse();
        let mut into = Stencil::new(&coarse);
        // An axis that is not halved keeps its links and sums.
        let weights = |of: fn(Along) -> [f32; 4]| self.along.map(of);
        let (sums, children) = (weights(Along::sum), weights(Along::children));
        let along = self.along;
        for axis in 0..3 {
            let mut weights = sums;
            weights[axis] = along[axis].link();
            let mut links = fine.links[axis].clone();
            self.gather(grid, weights, &mut links, &mut into.links[axis]);
        }
        let mut lost = self.lost_links(grid, fine);
        add_scaled(&mut lost, 1.0, &fine.mass);
        self.gather(grid, sums, &mut lost, &mut into.mass);
        for (from, into) in [
            (&fine.active, &mut into.active),
            (&fine.known, &mut into.known),
        ] {
            self.gather(grid, children, &mut from.clone(), into);
            into.iter_mut()
                .for_each(|value| *value = f32::from(*value > 0.0));
        }
        into.finish(&coarse);
        let mut scale = std::mem::take(&mut self.scale);
        self.spread(grid, &mut into.known.clone(), &mut scale);
        for (scale, active) in scale.iter_mut().zip(&fine.active) {
            *scale = if *active > 0.0 && *scale > 0.0 {
                1.0 / *scale
            } else {
                0.0
            };
        }
        grid.clear(&mut scale);
        self.scale = scale;
        into
    }

    /// Half of the links with known places that fall within one coarse cell, by the place that is an unknown.
    fn lost_links(&self, grid: &Grid, fine: &Stencil) -> Vec<f32> {
        let mut lost = grid.field();
        for axis in 0..3 {
            let is_halved = self.coarse().cells[axis] != grid.cells[axis];
            if self.along[axis] == Along::Faces || !is_halved {
                continue;
            }
            let stride = grid.stride(axis);
            let odd = (1..grid.cells[axis] as isize).step_by(2);
            for place in odd.flat_map(|layer| grid.layer_at(axis, layer)) {
                let [low, high] = [place - stride, place];
                let half = 0.5 * fine.links[axis][place];
                match (fine.active[low] > 0.0, fine.active[high] > 0.0) {
                    (true, false) => lost[low] += half,
                    (false, true) => lost[high] += half,
                    _ => {}
                }
            }
        }
        lost
    }
}

/// Inverses of the roots of the Chebyshev polynomial on [1/50, 2], large and small in turn so that rounding stays small.
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
    /// The hierarchy of an operator whose values lie in the middle of cells, or on the faces across an axis.
    #[must_use]
    pub fn new(grid: &Grid, stencil: Stencil, faces: Option<usize>) -> Self {
        let along = [0, 1, 2].map(|axis| {
            if faces == Some(axis) {
                Along::Faces
            } else {
                Along::Middles
            }
        });
        let is_singular = is_singular(grid, &stencil);
        let mut levels = Vec::new();
        let (mut grid, mut stencil) = (*grid, stencil);
        loop {
            let is_coarsest = grid.cells.iter().all(|cells| *cells <= COARSEST_CELLS)
                || (0..3).all(|axis| !can_halve(&grid, axis));
            let mut down = (!is_coarsest).then(|| Down::new(&grid, along));
            let next = (down.as_mut()).map(|down| (*down.coarse(), down.coarsen(&grid, &stencil)));
            levels.push(Level {
                grid,
                stencil,
                x: grid.field(),
                b: grid.field(),
                spare: grid.field(),
                down,
            });
            let Some(next) = next else { break };
            (grid, stencil) = next;
        }
        Self {
            levels,
            omegas: coarsest_omegas(),
            is_singular,
        }
    }

    /// The operator.
    #[must_use]
    pub fn stencil(&self) -> &Stencil {
        &self.levels[0].stencil
    }

    /// x ≈ A⁻¹·b by one symmetric V-cycle; b is 0 where there are no unknowns.
    pub fn cycle(&mut self, b: &[f32], x: &mut [f32]) {
        self.levels[0].b.copy_from_slice(b);
        descend(&mut self.levels, &self.omegas);
        x.copy_from_slice(&self.levels[0].x);
    }

    /// Solves A·x = b by so many preconditioned conjugate gradients from x; returns the norm of each residual, with that
    /// of the first guess.
    pub fn solve(&mut self, b: &[f32], x: &mut [f32], iterations: usize) -> Vec<f64> {
        let grid = self.levels[0].grid;
        let [mut r, mut z, mut q] = [(); 3].map(|()| grid.field());
        self.stencil().residual(&grid, b, x, &mut r);
        if self.is_singular {
            self.level_out(&mut r);
        }
        let mut norms = vec![norm(&r)];
        let rounding = ROUNDING * norm(b);
        let mut p = grid.field();
        let mut before = 0.0;
        while norms.len() <= iterations && norms[norms.len() - 1] > rounding {
            self.cycle(&r, &mut z);
            let now = dot(&r, &z);
            // Rounding has the last word: what is left is none.
            if !now.is_finite() || now <= 0.0 {
                break;
            }
            let beta = if before > 0.0 { now / before } else { 0.0 };
            scale_and_add(&mut p, beta as f32, &z);
            self.stencil().apply(&grid, &mut p, &mut q);
            let curvature = dot(&p, &q);
            if !curvature.is_finite() || curvature <= 0.0 {
                break;
            }
            let alpha = (now / curvature) as f32;
            add_scaled(x, alpha, &p);
            add_scaled(&mut r, -alpha, &q);
            before = now;
            norms.push(norm(&r));
        }
        grid.wrap(x);
        norms
    }

    /// Solves A·x = b in f64 down to a part of the norm of b: rounds of conjugate gradients in f32 on what is left, at
    /// most so many. Returns the part that is left.
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

    /// Takes the mean out of a residual that a constant cannot answer.
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
    let mut ones = stencil.active.clone();
    let mut rows = grid.field();
    stencil.apply(grid, &mut ones, &mut rows);
    let unknowns = grid.places().filter(|place| stencil.active[*place] > 0.0);
    unknowns
        .into_iter()
        .all(|place| rows[place].abs() <= 1e-6 * stencil.diagonal[place])
}

/// A V-cycle from x = 0 on the first level.
fn descend(levels: &mut [Level], omegas: &[f32]) {
    let Some((level, coarser)) = levels.split_first_mut() else {
        return;
    };
    let (grid, stencil) = (level.grid, &level.stencil);
    let (x, spare, b) = (&mut level.x, &mut level.spare, &level.b);
    let Some(down) = &mut level.down else {
        stencil.begin(b, x, omegas[0]);
        for omega in &omegas[1..] {
            stencil.relax(&grid, b, x, spare, *omega);
        }
        return;
    };
    stencil.begin(b, x, SMOOTHING[0]);
    for omega in &SMOOTHING[1..] {
        stencil.relax(&grid, b, x, spare, *omega);
    }
    stencil.residual(&grid, b, x, spare);
    for (spare, scale) in spare.iter_mut().zip(&down.scale) {
        *spare *= scale;
    }
    let weights = down.along.map(Along::restriction);
    down.gather(&grid, weights, spare, &mut coarser[0].b);
    mask(&mut coarser[0]);
    descend(coarser, omegas);
    down.spread(&grid, &mut coarser[0].x, spare);
    for ((x, spare), scale) in x.iter_mut().zip(&*spare).zip(&down.scale) {
        *x += scale * spare;
    }
    for omega in SMOOTHING.iter().rev() {
        stencil.relax(&grid, b, x, spare, *omega);
    }
}

/// Drops what was asked of places that are no unknowns.
fn mask(level: &mut Level) {
    for (b, active) in level.b.iter_mut().zip(&level.stencil.active) {
        *b *= active;
    }
}
