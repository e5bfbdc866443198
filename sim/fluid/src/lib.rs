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

pub use geometry::{Boundary, ProbeState, Vessel};
pub use grid::Grid;
pub use polygon::Shape;
pub use solver::{Bench, Flow};
pub use stress::{Fluid, Wrench};
