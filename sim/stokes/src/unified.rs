//! Velocity and pressure at once: backward Euler for the unsteady Stokes equations (Baxter 2004, eq. 5.2, 5.3), with the
//! viscous and the pressure part of the free surface's condition in one (Larionov, Batty and Bridson 2017).
//!
//! Generalised conjugate residuals (Eisenstat, Elman and Schultz 1983), preconditioned by a V-cycle for each component of
//! the velocity and, for the pressure, by Cahouet and Chabard (1988): α·L⁻¹ + 2βμ. Walls drag at thin paint as mass would, so
//! that part is added to α: without it a film under a wide brush takes ten times as many steps.

use crate::domain::{Domain, Part};
use crate::multigrid::Multigrid;
use crate::operator::{Operator, Unknowns, fields, fields_mut, laplacian};
use crate::stencil::Stencil;
use crate::vector::{add_scaled, dot, norm};

/// Drag of walls on paint of a thickness of one, by its viscosity: between 3 for a film and 12 for a gap.
const GAP_DRAG: f32 = 6.0;
/// Directions that a new one is made orthogonal to.
const MEMORY: usize = 10;

/// The equations of one step on one window.
#[derive(Clone, Debug)]
pub struct Unified {
    operator: Operator,
    components: [Multigrid; 3],
    pressure: Multigrid,
    /// What viscosity answers to volume, by cell.
    bulk: Vec<f32>,
    alpha: f32,
    /// α and the drag of walls: what a gradient of pressure has to overcome.
    drag: f32,
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
        let mut axis = 0..;
        let components = stencils.map(|stencil| Multigrid::new(grid, stencil, axis.next()));
        Self {
            components,
            bulk,
            pressure: Multigrid::new(grid, laplacian(domain), None),
            operator,
            alpha,
            drag: alpha + beta * GAP_DRAG / (thickness * thickness),
        }
    }

    /// z ≈ A⁻¹·r.
    fn precondition(&mut self, r: &[f32], z: &mut [f32], room: &mut [Vec<f32>; 2]) {
        let [first, second] = room;
        let from = fields(r);
        let [u, v, w, p] = fields_mut(z);
        let mut velocity = [u, v, w];
        for (axis, into) in velocity.iter_mut().enumerate() {
            self.components[axis].cycle(from[axis], into);
        }
        self.operator.outflow(velocity, first);
        for (first, r) in first.iter_mut().zip(from[3]) {
            *first = r - *first;
        }
        self.pressure.cycle(first, second);
        for (i, p) in p.iter_mut().enumerate() {
            *p = self.drag * second[i] + self.bulk[i] * first[i];
        }
    }

    /// Solves A·x = b by so many steps from x; returns the norm of each residual, with that of the first guess.
    pub fn solve(&mut self, b: &[f32], x: &mut Unknowns, steps: usize) -> Vec<f64> {
        let mut r = vec![0.0; x.len()];
        let mut room = [(); 2].map(|()| vec![0.0; x.len() / 4]);
        self.operator.apply(x, &mut r);
        for (r, b) in r.iter_mut().zip(b) {
            *r = b - *r;
        }
        let mut norms = vec![norm(&r)];
        let mut directions: Vec<(Unknowns, Unknowns, f64)> = Vec::new();
        for step in 0..steps {
            let mut z = vec![0.0; x.len()];
            let mut q = vec![0.0; x.len()];
            self.precondition(&r, &mut z, &mut room);
            self.operator.apply(&mut z, &mut q);
            for (direction, image, squared) in &directions {
                let share = (dot(&q, image) / squared) as f32;
                add_scaled(&mut z, -share, direction);
                add_scaled(&mut q, -share, image);
            }
            let squared = dot(&q, &q);
            if !squared.is_finite() || squared <= f64::from(f32::MIN_POSITIVE) {
                break;
            }
            let share = (dot(&r, &q) / squared) as f32;
            add_scaled(x, share, &z);
            add_scaled(&mut r, -share, &q);
            norms.push(norm(&r));
            let next = (z, q, squared);
            if directions.len() < MEMORY {
                directions.push(next);
            } else {
                directions[step % MEMORY] = next;
            }
        }
        norms
    }

    /// Takes what volume is still gained or lost out of a velocity, by so many conjugate gradients.
    pub fn project(&mut self, domain: &Domain, b: &[f32], x: &mut Unknowns, iterations: usize) {
        let grid = domain.grid;
        let [mut excess, mut phi] = [(); 2].map(|()| grid.field());
        let [u, v, w, p] = fields_mut(x);
        let velocity = [u, v, w];
        let velocity = {
            let [u, v, w] = velocity;
            self.operator.outflow([u, v, w], &mut excess);
            [u, v, w]
        };
        for (excess, b) in excess.iter_mut().zip(b) {
            *excess = b - *excess;
        }
        self.pressure.solve(&excess, &mut phi, iterations);
        for (axis, u) in velocity.into_iter().enumerate() {
            let by = grid.stride(axis);
            let (area, mass) = (&domain.area[axis], &domain.mass[axis]);
            for place in by..grid.len() {
                if area[place] > 0.0 {
                    u[place] -= area[place] / mass[place] * (phi[place] - phi[place - by]);
                }
            }
            grid.wrap(u);
        }
        add_scaled(p, self.alpha, &phi);
    }

    /// The momentum that a velocity has, and the volume that solids displace: the right-hand side.
    #[must_use]
    pub fn right_hand_side(&self, domain: &Domain, velocity: [&[f32]; 3], solids: &[Vec<f32>; 3]) -> Unknowns {
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
