//! Force of a viscous flow on a probe in it (Baxter 2004, § 8.8), and the bench on which the dissertation shows it
//! (§ 8.9.2). Pure, deterministic, SI units.
//!
//! | module | holds |
//! | --- | --- |
//! | [`stress`] | force and torque on a probe of whole cells, in two and three dimensions, of any staggered fields |
//! | [`solver`] | Navier-Stokes equations around a probe in two dimensions |
//! | [`geometry`] | the probe's outline on the grid: a staircase, or shares of nodes and links |
//! | [`hand`] | a sweep a thousand times a second, raw and filtered |
//! | [`sweep`] | the sweep along an arc of fig. 8.6-8.8, and the noise of the force along a straight one |
//!
//! Drag on a square that is drawn through a fluid at rest grows with its speed:
//!
//! ```
//! use maulstick_fluid_force::sweep::{FLUID, bench};
//! use maulstick_fluid_force::{Boundary, Flow, ProbeState};
//!
//! let drag_n_per_m = |speed_m_s: f64| {
//!     let state = |time_s: f64| ProbeState {
//!         place_m: [0.3 + speed_m_s * time_s, 0.5],
//!         angle_rad: 0.0,
//!         velocity_m_s: [speed_m_s, 0.0],
//!         spin_rad_s: 0.0,
//!     };
//!     let dt_s = 1.0 / 60.0;
//!     let mut flow = Flow::new(bench(32, Boundary::Covered, FLUID), state(0.0));
//!     for step in 1..=30 {
//!         flow.step(state(f64::from(step) * dt_s), dt_s);
//!     }
//!     -flow.wrench().force_n[0]
//! };
//! let (slow, fast) = (drag_n_per_m(0.2), drag_n_per_m(0.4));
//! println!("{slow:.4} N/m at .2 m/s, {fast:.4} N/m at .4 m/s");
//! assert!(slow > 0.0 && fast > 2.0 * slow, "inertia counts beside viscosity");
//! ```
//!
//! # Choices
//!
//! The probe is covered cells, not cut ones: a node is solid by the share of its box that the probe covers, a link
//! conducts by the inverse of its open share. The force then changes continuously with place, and its noise is a
//! seventh of a staircase's. The projection starts from the pressure of the step before; Chorin's own has the drag in a
//! channel wrong by half at steps that are long for viscosity.

mod five_point;
pub mod geometry;
pub mod grid;
pub mod hand;
pub mod polygon;
pub mod solver;
pub mod stress;
pub mod sweep;
mod viscosity;

pub use geometry::{Boundary, ProbeState, Vessel};
pub use grid::Grid;
pub use polygon::Shape;
pub use solver::{Bench, Flow};
pub use stress::{Fluid, Wrench};
