//! Generalised conjugate residuals: directions whose images under an operator are orthogonal to each other.
//!
//! Images are made orthogonal to earlier ones; directions are kept unchanged, and their weights are computed at the
//! end, which is half the work. After [`MEMORY`] directions the iteration restarts from its current solution.

use maulstick_num::{fork_join, wide};

use crate::operator::Unknowns;
use crate::stencil::Stencil;
use crate::vector::{Sum, add_products, add_scaled};

/// Greatest number of directions.
const MEMORY: usize = 24;
/// Number of places that loops over many fields process at a time.
const TILE: usize = 2048;
/// Number of places of all fields and directions from which cores share a loop over them.
const WORTH: usize = 1 << 14;
/// Share of an image's square below which its remainder is orthogonalised again.
const CANCELLED: f64 = 1e-3;

/// A direction, and its image made orthogonal to earlier ones.
#[derive(Clone, Debug, Default)]
struct Direction {
    z: Unknowns,
    q: Unknowns,
    /// Square of the image.
    squared: f64,
    /// Components along earlier images.
    parts: [f64; MEMORY],
    /// Part of the residual that it removes.
    answers: f64,
}

/// The residual and the directions so far, in reused buffers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Residuals {
    residual: Unknowns,
    directions: Vec<Direction>,
    used: usize,
    /// Stretches outside of which directions are 0.
    runs: [crate::runs::Runs; 4],
}

/// Sums of one field: products of an image with earlier ones, with itself and with the residual.
type Sums = [f64; MEMORY + 2];

/// One field of the unknowns with those of all directions.
struct Field<'a> {
    number: usize,
    stencil: &'a Stencil,
    own: &'a mut [f32],
    other: &'a mut [f32],
    sums: Sums,
}

impl Residuals {
    /// Fits all fields to the unknowns.
    pub(crate) fn fit(&mut self, stencils: [&Stencil; 4]) {
        let len = stencils[0].active.len();
        if self.residual[0].len() != len {
            self.directions.clear();
            self.residual.fill(vec![0.0; len]);
        }
        for (axis, (runs, stencil)) in self.runs.iter_mut().zip(stencils).enumerate() {
            if *runs == stencil.runs {
                continue;
            }
            let left = runs.without(&stencil.runs);
            for direction in &mut self.directions {
                left.iter()
                    .for_each(|run| direction.z[axis][run.clone()].fill(0.0));
            }
            runs.clone_from(&stencil.runs);
        }
    }

    /// The residual, into which A·x is to be written.
    pub(crate) const fn residual_mut(&mut self) -> &mut Unknowns {
        &mut self.residual
    }

    /// Subtracts A·x from b; returns the norm of the residual.
    pub(crate) fn begin(&mut self, stencils: [&Stencil; 4], b: &Unknowns) -> f64 {
        self.used = 0;
        let mut unused: [Vec<f32>; 4] = std::array::from_fn(|_| Vec::new());
        let sums = over((stencils, 1), &mut self.residual, &mut unused, |field| {
            for run in field.stencil.runs.iter() {
                let r = &mut field.own[run.clone()];
                subtract_from(r, &b[field.number][run]);
                add_square(&mut field.sums[0], r);
            }
        });
        sums[0].sqrt()
    }

    /// The residual, and buffers for the next direction and its image.
    pub(crate) fn next(
        &mut self,
        stencils: [&Stencil; 4],
        x: &mut Unknowns,
    ) -> (Unknowns, Unknowns, Unknowns) {
        if self.used == MEMORY {
            self.end(stencils, x);
        }
        if self.used == self.directions.len() {
            let field = || self.residual.each_ref().map(|field| vec![0.0; field.len()]);
            self.directions.push(Direction {
                z: field(),
                q: field(),
                ..Direction::default()
            });
        }
        let direction = &mut self.directions[self.used];
        let [r, z, q] = [&mut self.residual, &mut direction.z, &mut direction.q];
        (std::mem::take(r), std::mem::take(z), std::mem::take(q))
    }

    /// Adds a direction with its image; returns the norm of the reduced residual, or `None` if the direction is
    /// negligible.
    pub(crate) fn add(
        &mut self,
        stencils: [&Stencil; 4],
        r: Unknowns,
        z: Unknowns,
        mut q: Unknowns,
    ) -> Option<f64> {
        self.residual = r;
        let number = self.used;
        let (squared, answers, parts) = self.orthogonalise(stencils, &mut q);
        let is_none = !squared.is_finite() || squared <= f64::from(f32::MIN_POSITIVE);
        let answers = answers / squared;
        self.directions[number] = Direction {
            z,
            q,
            squared,
            parts,
            answers,
        };
        if is_none {
            return None;
        }
        self.used += 1;
        let q = &mut self.directions[number].q;
        let sums = over((stencils, 1), &mut self.residual, q, |field| {
            for run in field.stencil.runs.iter() {
                let r = &mut field.own[run.clone()];
                add_scaled(r, -answers as f32, &field.other[run]);
                add_square(&mut field.sums[0], r);
            }
        });
        Some(sums[0].sqrt())
    }

    /// Makes an image orthogonal to earlier ones, twice where much of it cancels: its square, its product with the
    /// residual, and the components that were taken away.
    fn orthogonalise(
        &mut self,
        stencils: [&Stencil; 4],
        q: &mut Unknowns,
    ) -> (f64, f64, [f64; MEMORY]) {
        let (before, _) = self.directions.split_at(self.used);
        let size = (stencils, self.used + 1);
        let mut parts = [0.0; MEMORY];
        let (mut squared, mut answers) = (0.0, 0.0);
        for round in 0..2 {
            let products = over(size, q, &mut self.residual, |field| {
                multiply_with(field, before);
            });
            let shares: Vec<f64> = before
                .iter()
                .zip(products)
                .map(|(each, product)| product / each.squared)
                .collect();
            let whole = products[MEMORY];
            if before.is_empty() {
                (squared, answers) = (whole, products[MEMORY + 1]);
            } else {
                let sums = over(size, q, &mut self.residual, |field| {
                    take_away(field, before, &shares);
                });
                (squared, answers) = (sums[MEMORY], sums[MEMORY + 1]);
            }
            for (part, share) in parts.iter_mut().zip(shares) {
                *part += share;
            }
            if round == 1 || squared > CANCELLED * whole {
                break;
            }
        }
        (squared, answers, parts)
    }

    /// Adds the directions, weighted, to the solution.
    pub(crate) fn end(&mut self, stencils: [&Stencil; 4], x: &mut Unknowns) {
        let directions = &self.directions[..self.used];
        let mut weights = [0.0; MEMORY];
        for number in (0..self.used).rev() {
            let later = number + 1..self.used;
            let taken: f64 = later
                .map(|later| directions[later].parts[number] * weights[later])
                .sum();
            weights[number] = directions[number].answers - taken;
        }
        let mut unused: [Vec<f32>; 4] = std::array::from_fn(|_| Vec::new());
        over((stencils, self.used), x, &mut unused, |field| {
            for tile in tiles(field.stencil) {
                let x = &mut field.own[tile.clone()];
                for (direction, weight) in directions.iter().zip(weights) {
                    add_scaled(x, weight as f32, &direction.z[field.number][tile.clone()]);
                }
            }
        });
        self.used = 0;
    }
}

/// Calls for each of the four fields, on several cores where the number of directions justifies it; sums are added up
/// in their order.
fn over(
    (stencils, directions): ([&Stencil; 4], usize),
    own: &mut Unknowns,
    other: &mut Unknowns,
    work: impl Fn(&mut Field<'_>) + Sync,
) -> Sums {
    let [a, b, c, d] = own;
    let [e, f, g, h] = other;
    let mut number = 0;
    let mut fields = [(a, e), (b, f), (c, g), (d, h)].map(|(own, other)| {
        number += 1;
        Field {
            number: number - 1,
            stencil: stencils[number - 1],
            own,
            other,
            sums: [0.0; MEMORY + 2],
        }
    });
    let places: usize = stencils.iter().map(|stencil| stencil.runs.len()).sum();
    if places < WORTH || places * directions < 2 * WORTH {
        fields.iter_mut().for_each(&work);
    } else {
        fork_join::each(&mut fields, &work);
    }
    let mut total = [0.0; MEMORY + 2];
    for field in &fields {
        total
            .iter_mut()
            .zip(field.sums)
            .for_each(|(total, sum)| *total += sum);
    }
    total
}

/// The stretches, cut into pieces that stay in the cache.
fn tiles(stencil: &Stencil) -> impl Iterator<Item = std::ops::Range<usize>> + '_ {
    stencil.runs.iter().flat_map(|run| {
        let end = run.end;
        run.step_by(TILE)
            .map(move |start| start..(start + TILE).min(end))
    })
}

/// Products of an image with earlier ones, with itself and with the residual.
fn multiply_with(field: &mut Field<'_>, before: &[Direction]) {
    let mut sums: [Sum; MEMORY + 2] = [Sum::default(); MEMORY + 2];
    for tile in tiles(field.stencil) {
        let q = &field.own[tile.clone()];
        for (sum, direction) in sums.iter_mut().zip(before) {
            add_products(sum, q, &direction.q[field.number][tile.clone()]);
        }
        add_products(&mut sums[MEMORY], q, q);
        if before.is_empty() {
            add_products(&mut sums[MEMORY + 1], q, &field.other[tile]);
        }
    }
    field.sums = sums.map(|sum| sum.iter().sum());
}

/// Subtracts shares of earlier images from an image; its square and its product with the residual.
fn take_away(field: &mut Field<'_>, before: &[Direction], shares: &[f64]) {
    let mut sums: [Sum; 2] = [Sum::default(); 2];
    for tile in tiles(field.stencil) {
        let q = &mut field.own[tile.clone()];
        for (share, direction) in shares.iter().zip(before) {
            add_scaled(q, -*share as f32, &direction.q[field.number][tile.clone()]);
        }
        add_products(&mut sums[0], q, q);
        add_products(&mut sums[1], q, &field.other[tile]);
    }
    [field.sums[MEMORY], field.sums[MEMORY + 1]] = sums.map(|sum| sum.iter().sum());
}

fn add_square(total: &mut f64, field: &[f32]) {
    let mut sums = Sum::default();
    add_products(&mut sums, field, field);
    *total += sums.iter().sum::<f64>();
}

wide! {
    fn subtract_from(into: &mut [f32], b: &[f32]) {
        let b = &b[..into.len()];
        for i in 0..into.len() {
            into[i] = b[i] - into[i];
        }
    }
}
