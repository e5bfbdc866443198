//! Stokes Paint: viscous paint as a volume (Baxter 2004, ch. 5).
//!
//! A window of cells holds paint in counted quanta ([`volume`]). In each step the brush is put among the cells
//! ([`body`]), velocity and pressure are computed on a staggered grid ([`flow`]), and paint is advected: [`step`] has
//! all of it. [`surface`] finds the surface.
//!
//! The solver ([`unified`]) computes velocity and pressure at once, by backward Euler, so that steps of any length are
//! stable. Its domain is volume fractions and distances ([`domain`]), on which [`operator`] acts; [`multigrid`]
//! preconditions it. The dissertation's scheme is [`flow::Scheme::Split`]. Stresses are those of a Herschel-Bulkley
//! fluid ([`rheology`]).
//!
//! ```
//! use maulstick_stokes::body::Rod;
//! use maulstick_stokes::flow::Conditions;
//! use maulstick_stokes::grid::Grid;
//! use maulstick_stokes::rheology::Paint;
//! use maulstick_stokes::step::Stokes;
//!
//! // Eight by eight by six cells of .25 mm, the lower half full of paint, and a rod that is drawn through.
//! let grid = Grid::walled([8, 8, 6]);
//! let mut stokes = Stokes::new(&grid, 167_772, 1);
//! for place in grid.block([0, 0, 0], [8, 8, 3]) {
//!     stokes.volume.paints[0][place] = 167_772;
//! }
//! let before = stokes.volume.counts();
//! let rod = Rod {
//!     ends: [[2.0, 4.0, 3.0], [2.0, 4.0, 6.0]],
//!     radius: 1.0,
//!     velocity: [[0.01, 0.0, 0.0]; 2],
//! };
//! let conditions = Conditions {
//!     cell_m: 2.5e-4,
//!     seconds: 0.01,
//!     paint: Paint::newtonian(1e-2),
//!     pull: [0.0, 0.0, -9.81],
//! };
//! stokes.step(&[rod], &conditions);
//! assert_eq!(stokes.volume.counts(), before);
//! assert!(stokes.flow.fastest() > 0.0);
//! ```
//!
//! # Notes on the solver
//!
//! - Cells and faces take part by volume fractions, walls and brush by distance, so a surface may be anywhere in a
//!   cell. Dry paint lowers the distance to the base of the window. Edges with a velocity of air transmit no shear,
//!   which is the free surface's whole condition.
//! - Velocity and pressure are found by generalised conjugate residuals, preconditioned by a V-cycle for each velocity
//!   component and one for the pressure. The drag of walls on thin paint counts as mass: preconditioned by mass and
//!   viscosity alone (Cahouet and Chabard), paint four cells thick under a brush 128 cells wide does not converge in
//!   fifty iterations; with it the residual falls tenfold every three. A cell's viscous part uses the diagonals of its
//!   own faces; a common number stalls at cells cut by a solid. Conjugate gradients with multigrid then remove the
//!   remaining divergence. All iteration counts are fixed.
//! - Loops visit stretches with unknowns, in parts that are independent of the number of cores.
//! - Paint moves in quanta, one axis after the other in a rotating order. An excess left by rounding and solids is a
//!   source in the next step's continuity equation.
//! - The oracle (`tests/oracle`) writes a step as a sum of squares and eliminates.

pub mod body;
pub mod domain;
pub mod flow;
pub mod grid;
pub mod multigrid;
pub mod operator;
mod residuals;
pub mod rheology;
mod runs;
mod split;
pub mod stencil;
pub mod step;
pub mod surface;
pub mod unified;
pub mod vector;
pub mod volume;
