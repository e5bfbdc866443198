//! Stokes Paint as a paint model (Baxter 2004, ch. 5): a brush deposits paint in voxels, takes it up and drags it
//! along, and [`maulstick_stokes`] computes its flow.
//!
//! | module | holds |
//! | --- | --- |
//! | [`layers`] | layers of voxels over a surface |
//! | [`layer_planes`] | paint by layer, as planes beside the counts |
//! | [`voxels`] | the paint of an area, from the counts of a window and back |
//! | [`coarse`] | the grid of the flow |
//! | [`flow_backend`] | the backend of the flow: the processor, or a device |
//! | [`drag`] | bristles as a porous body, and the flow around them |
//! | `packing` | paint of a column without voids |
//! | `loose` | unsupported paint falls |
//! | [`columns`] | pieces of paint over each cell, and the air between them |
//! | `film` | the pieces of one film |
//! | [`overhangs`] | displayed height of such paint |
//! | [`reach`] | depth of a brush's exchange |
//!
//! A loaded brush over wet paint deposits its own and takes up the other; no quantum is made or lost:
//!
//! ```
//! use maulstick_brush::{BrushFile, HeadPose};
//! use maulstick_stokes_paint::StokesPaint;
//! use maulstick_model::trial::Trial;
//!
//! # fn main() -> Result<(), maulstick_brush::BrushError> {
//! let file = BrushFile::library("round")?.scaled_to(6.0)?;
//! let mut trial = Trial::new(file, 128, 2.5e-4).expect("a surface");
//! trial.wet();
//! let mut load = trial.full();
//! let poses: Vec<HeadPose> =
//!     (0..12).map(|step| trial.pose([50.0 + 1.0 * f64::from(step), 64.0], 0.0)).collect();
//! let lying = |trial: &Trial, slot| -> f64 {
//!     trial.window.plane(slot).into_iter().flatten().map(|count| f64::from(*count)).sum()
//! };
//! let (canvas, brush) = (lying(&trial, 0), load.total() as f64);
//! trial.steps(&mut StokesPaint::default(), &mut load, &poses);
//! let [canvas_paint, brush_paint] = [0, 1].map(|slot| lying(&trial, slot));
//! println!("{brush_paint} quanta laid, {} taken up", canvas - canvas_paint);
//! assert!(brush_paint > 0.0 && canvas_paint < canvas);
//! assert_eq!(canvas_paint + brush_paint + load.total() as f64, canvas + brush);
//! # Ok(())
//! # }
//! ```
//!
//! # Notes
//!
//! - Counts by slot are all the paint of a cell, as with every model; separate planes have the part in each layer above
//!   the lowest. So wells, fills, drying, undo, ledger and document are independent of layers, and films below a voxel
//!   need none. Optics see it from above: with its total thickness, and the mixture of its upper 150 µm.
//! - Every second step bristles are put into the voxels as a porous body, the flow around them is solved from rest on
//!   cells of .5 mm, and carries the paint voxel by voxel: marks of bristles stay as fine as the cells, and a step
//!   depends on the cells around it alone. Brush and canvas then exchange paint as in `impasto`, down to the bristles,
//!   and at least 100 µm deep. After a stroke the thin film of `impasto` levels it.
//! - Films below two fifths of a voxel are not pushed, column by column. A sliver of a voxel over the ground belongs to
//!   the voxel above it, except for the flow.
//! - Paint not connected to the ground by half-full voxels falls, since the flow throws up specks and brushes cut
//!   stalks. Columns have no voids except air under an overhang: voids are sinks of the flow and leave pimples. Columns
//!   with air are displayed at the height of their highest piece.
//! - On a device (feature `device`) the unified solver runs in f32: always the same dispatches over one buffer, sums
//!   reduced in a fixed order, quotients kept on the device and guarded against division by zero, nothing read back
//!   within a step. One workgroup a component does all levels of 2048 cells and fewer. Fields have the processor's
//!   layout; a stage that writes beside a periodic side writes the copy too. An image of a search direction that
//!   cancels is orthogonalised again by dispatches that otherwise return at once. Distances and velocities of solids
//!   come from the processor.
//! - `auto` gives the device windows of 16,384 cells and more, below which its 300 dispatches take longer than a core
//!   does; `gpu` gives it all. `GpuFlow::restart` clears the same buffers for another window, so no window depends on
//!   an earlier one.
//! - A device behind `FlowBackend` may compute the flow; the rest of a step runs on the processor. A device without
//!   room for a window solves on cells twice as wide until it fits, noted once in the journal; one that is lost, or has
//!   no room for the coarsest window, leaves all steps to the processor.

pub mod coarse;
pub mod columns;
#[cfg(feature = "device")]
pub mod device;
pub mod drag;
mod entry;
mod film;
pub mod flow_backend;
pub mod layer_planes;
pub mod layers;
mod loose;
pub mod overhangs;
mod packing;
pub mod reach;
mod step;
pub mod voxels;

pub use entry::ENTRY;
pub use step::StokesPaint;
