//! Stokes Paint as a paint model (Baxter 2004, ch. 5): a brush lays paint into voxels, takes it up and drags it along, and the
//! paint flows as [`maulstick_stokes`] says.
//!
//! | module | holds |
//! | --- | --- |
//! | [`layers`] | layers of voxels over a surface |
//! | [`voxels`] | the paint of an area, from the counts of a window and back |
//! | [`coarse`] | the grid on which the flow is found |
//! | [`flow_backend`] | who finds that flow: the processor, or a device |
//! | [`drag`] | bristles as a porous body, and the flow around them |
//! | `packing` | paint of a column without voids |
//! | `loose` | paint that hangs on nothing falls |
//! | [`columns`] | pieces of paint over each cell, and the air between them |
//! | `film` | the pieces of one film |
//! | [`overhangs`] | how high such paint is shown |
//! | [`reach`] | how deep a brush lays and takes up |
//!
//! ```
//! use maulstick_model::interface::PaintModel as _;
//! use maulstick_stokes_paint::StokesPaint;
//!
//! assert_eq!(StokesPaint::default().name(), "stokes");
//! ```

pub mod coarse;
pub mod columns;
pub mod drag;
mod film;
pub mod flow_backend;
pub mod layers;
mod loose;
pub mod overhangs;
mod packing;
pub mod reach;
mod step;
pub mod voxels;

pub use step::StokesPaint;
