//! Velocity and pressure at once: backward Euler for the unsteady Stokes equations (Baxter 2004, eq. 5.2, 5.3), with the
//! viscous and the pressure part of the free surface's condition in one (Larionov, Batty and Bridson 2017).
//!
//! Generalised conjugate residuals (Eisenstat, Elman and Schultz 1983), preconditioned by a V-cycle for each component of
//! the velocity and, for the pressure, by Cahouet and Chabard (1988): α·L⁻¹ + 2βμ. Walls drag at thin paint as mass would, so
//! that part is added to α: without it a film under a wide brush takes ten times as many steps.

use maulstick_num::fork_join;

use crate::domain::{Domain, Part};
use crate::multigrid::Multigrid;
use crate::operator::{Operator, Unknowns, fields, fields_mut, laplacian};
use crate::stencil::Stencil;
use crate::vector::{add_scaled, dot, norm};

/// Drag of walls on paint of a thickness of one, by its viscosity: between 3 for a film and 12 for a gap.
const GAP_DRAG: f32 = 6.0;
/// Directions that a new one is made orthogonal to at most.
const MEMORY: usize = 24;

/// Room for the iterations, kept from one step to the next.
#[derive(Clone, Debug, Default)]
pub struct Room {
    residual: Unknowns,
    fields: [Vec<f32>; 2],
    /// Directions, what the operator makes of them, and the square of that.
    directions: Vec<(Unknowns, Unknowns, f64)>,
}

impl Room {
    fn fit(&mut self, unknowns: usize, steps: usize) {
        if self.residual.len() != unknowns {
            self.residual = vec![0.0; unknowns];
            self.fields = [(); 2].map(|()| vec![0.0; unknowns / 4]);
            self.directions.clear();
        }
        let empty = || (vec![0.0; unknowns], vec![0.0; unknowns], 0.0);
        let wanted = steps.min(MEMORY).max(self.directions.len());
        self.directions.resize_with(wanted, empty);
    }
}

/// The equations of one step on one window.
#[derive(Clone, Debug)]
pub struct Unified {
    operator: Operator,
    /// Of the three components of the velocity and of the pressure.
    hierarchies: Vec<Multigrid>,
    /// What viscosity answers to volume, by cell.
    bulk: Vec<f32>,
    alpha: f32,
    /// Drag of walls, by α: what a gradient of pressure has to overcome beside mass.
    wall: f32,
}

/// Weights of mass and viscosity for a step of τ = νΔt/h².
#[must_use]
pub fn weights(tau: f64) -> [f32; 2] {
    let whole = 1.0 + 6.0 * tau;
    [(1.0 / whole) as f32, (tau / whole) as f32]
}

impl Unified {
    /// The equations for a step of τ = νΔt/h² with ν times a field of relative viscosities.
    #[must_use]
    pub fn new(domain: &Domain, tau: f64, viscosity: &[f32]) -> Self {
        let [alpha, beta] = weights(tau);
        let operator = Operator::new(domain, alpha, beta, viscosity);
        let grid = &domain.grid;
        let stencils = [0, 1, 2].map(|axis| operator.component(domain, axis));
        let bulk = bulk(domain, &stencils);
        let thickness = thickness(domain);
        let wall = beta * GAP_DRAG / (alpha * thickness * thickness);
        let [u, v, w] = stencils;
        let mut hierarchies = [
            (u, Some(0)),
            (v, Some(1)),
            (w, Some(2)),
            (laplacian(domain, wall), None),
        ]
        .map(|(stencil, faces)| (Some(stencil), faces, None));
        fork_join::each(&mut hierarchies, |(stencil, faces, hierarchy)| {
            *hierarchy = stencil
                .take()
                .map(|stencil| Multigrid::new(grid, stencil, *faces));
        });
        Self {
            hierarchies: hierarchies
                .into_iter()
                .filter_map(|(.., made)| made)
                .collect(),
            bulk,
            operator,
            alpha,
            wall,
        }
    }

    /// z ≈ A⁻¹·r.
    fn precondition(&mut self, r: &[f32], z: &mut [f32], [first, second]: &mut [Vec<f32>; 2]) {
        let [from @ .., r_pressure] = fields(r);
        let [u, v, w, p] = fields_mut(z);
        let mut velocity = [u, v, w];
        let mut shares: Vec<_> = self
            .hierarchies
            .iter_mut()
            .zip(from)
            .zip(velocity.iter_mut())
            .collect();
        fork_join::each(&mut shares, |((hierarchy, from), into)| {
            hierarchy.cycle(from, into)
        });
        self.operator.outflow(velocity, first);
        for (first, r) in first.iter_mut().zip(r_pressure) {
            *first = r - *first;
        }
        self.hierarchies[3].cycle(first, second);
        for (p, (bulk, parts)) in p
            .iter_mut()
            .zip(self.bulk.iter().zip(first.iter().zip(&*second)))
        {
            *p = self.alpha * parts.1 + bulk * parts.0;
        }
    }

    /// Solves A·x = b by so many steps from x; returns the norm of each residual, with that of the first guess.
    pub fn solve(
        &mut self,
        b: &[f32],
        x: &mut Unknowns,
        steps: usize,
        room: &mut Room,
    ) -> Vec<f64> {
        room.fit(x.len(), steps);
        let Room {
            residual: r,
            fields,
            directions,
        } = room;
        self.operator.apply(x, r);
        for (r, b) in r.iter_mut().zip(b) {
            *r = b - *r;
        }
        let mut norms = vec![norm(r)];
        for step in 0..steps {
            let (place, kept) = (step % MEMORY, step.min(MEMORY));
            let (mut z, mut q, _) = std::mem::take(&mut directions[place]);
            self.precondition(r, &mut z, fields);
            self.operator.apply(&mut z, &mut q);
            for (_, (direction, image, squared)) in directions
                .iter()
                .enumerate()
                .take(kept)
                .filter(|(other, _)| *other != place)
            {
                let share = (dot(&q, image) / squared) as f32;
                add_scaled(&mut z, -share, direction);
                add_scaled(&mut q, -share, image);
            }
            let squared = dot(&q, &q);
            let is_none = !squared.is_finite() || squared <= f64::from(f32::MIN_POSITIVE);
            if !is_none {
                let share = (dot(r, &q) / squared) as f32;
                add_scaled(x, share, &z);
                add_scaled(r, -share, &q);
                norms.push(norm(r));
            }
            directions[place] = (z, q, squared);
            if is_none {
                break;
            }
        }
        norms
    }

    /// Takes what volume is still gained or lost out of a velocity, by so many conjugate gradients.
    pub fn project(&mut self, domain: &Domain, b: &[f32], x: &mut Unknowns, iterations: usize) {
        let grid = domain.grid;
        let [mut excess, mut phi] = [(); 2].map(|()| grid.field());
        let [u, v, w, p] = fields_mut(x);
        self.operator
            .outflow([&mut *u, &mut *v, &mut *w], &mut excess);
        for (excess, b) in excess.iter_mut().zip(b) {
            *excess = b - *excess;
        }
        self.hierarchies[3].solve(&excess, &mut phi, iterations);
        for (axis, u) in [u, v, w].into_iter().enumerate() {
            let by = grid.stride(axis);
            let (area, mass) = (&domain.area[axis], &domain.mass[axis]);
            for place in by..grid.len() {
                if area[place] > 0.0 {
                    u[place] -=
                        area[place] / (mass[place] + self.wall) * (phi[place] - phi[place - by]);
                }
            }
            grid.wrap(u);
        }
        add_scaled(p, self.alpha, &phi);
    }

    /// The momentum that a velocity has, and the volume that solids displace: the right-hand side.
    #[must_use]
    pub fn right_hand_side(
        &self,
        domain: &Domain,
        velocity: [&[f32]; 3],
        solids: &[Vec<f32>; 3],
    ) -> Unknowns {
        let grid = domain.grid;
        let mut b = vec![0.0; 4 * grid.len()];
        let fields = fields_mut(&mut b);
        let [f, g, h, displaced] = fields;
        for (axis, into) in [f, g, h].into_iter().enumerate() {
            let (mass, u) = (&domain.mass[axis], velocity[axis]);
            for (place, into) in into.iter_mut().enumerate() {
                *into = self.alpha * mass[place] * u[place];
            }
            grid.clear(into);
            let by = grid.stride(axis);
            let flux = |place: usize| {
                let shut = match domain.part[axis][place] {
                    Part::Solid => 1.0,
                    Part::Paint => 1.0 - domain.area[axis][place],
                    Part::Air => 0.0,
                };
                shut * solids[axis][place]
            };
            for place in grid.places().filter(|place| domain.wet[*place] > 0.0) {
                displaced[place] -= flux(place + by) - flux(place);
            }
        }
        b
    }
}

/// The viscous part of the inverse Schur complement by cell: far from all sides 2βμ. Elsewhere the velocities around a
/// cell answer as their diagonals say, which is more beside a wall and less beside air.
fn bulk(domain: &Domain, stencils: &[Stencil; 3]) -> Vec<f32> {
    let grid = domain.grid;
    let mut bulk = grid.field();
    for place in grid.places().filter(|place| domain.wet[*place] > 0.0) {
        let mut yields = 0.0;
        for (axis, stencil) in stencils.iter().enumerate() {
            for face in [place, place + grid.stride(axis)] {
                let viscous = stencil.diagonal[face] - stencil.mass[face];
                if domain.area[axis][face] > 0.0 && viscous > 0.0 {
                    yields += domain.area[axis][face] * domain.area[axis][face] / viscous;
                }
            }
        }
        // Six faces, each with a diagonal of 8βμ, make 2βμ.
        bulk[place] = if yields > 0.0 { 1.5 / yields } else { 0.0 };
    }
    bulk
}

/// Mean thickness of the paint, cells: how many lie above each other.
fn thickness(domain: &Domain) -> f32 {
    let grid = domain.grid;
    let [width, height, depth] = grid.cells.map(|cells| cells as isize);
    let (mut wet, mut columns) = (0.0, 0.0);
    for base in grid.block([0; 3], [width, height, 1]) {
        let column = (0..depth as usize).map(|z| domain.wet[base + z * grid.stride(2)]);
        let cells: f32 = column.sum();
        wet += cells;
        columns += cells.min(1.0);
    }
    if columns > 0.0 { wet / columns } else { 1.0 }
}
