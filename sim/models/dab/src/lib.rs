//! dAb (Baxter 2004, ch. 4): the lightweight paint model. Paint has a wet surface layer and a dry or deep layer, is
//! moved in whole units, mixes additively, and is not pushed.
//!
//! It keeps no planes of its own: additive colour is linear in the volumes of the paints, so counts by slot contain the
//! RGB textures. [`Dab`] is the step, [`Layers`] the appearance of its paint.
//!
//! | module | holds |
//! | --- | --- |
//! | [`volume`] | units of paint: 8 bits a layer, 32 of the surface in a deep one |
//! | [`dither`] | volumes below a unit |
//! | [`touching`] | contact of brush and canvas |
//! | [`transfer`] | transfer from brush to canvas and back |
//! | [`raster`] | the brush over the cells that it touches |
//! | [`reservoir`] | the surface of a brush filled again |
//! | [`stroke`] | stroking algorithms: faster, better, along a spline |
//! | [`layers`], `wet_over`, [`emboss`] | colour and relief |
//! | `sheet` | panels of the sheet of effects |
//!
//! A loaded brush over wet paint deposits its own and takes up the other; no quantum is made or lost:
//!
//! ```
//! use maulstick_brush::{BrushFile, HeadPose};
//! use maulstick_dab::Dab;
//! use maulstick_model::trial::Trial;
//!
//! # fn main() -> Result<(), maulstick_brush::BrushError> {
//! let file = BrushFile::library("round")?.scaled_to(6.0)?;
//! let mut trial = Trial::new(file, 256, 2.5e-4).expect("a surface");
//! trial.wet();
//! let mut load = trial.full();
//! let poses: Vec<HeadPose> =
//!     (0..30).map(|step| trial.pose([50.0 + 4.0 * f64::from(step), 128.0], 0.0)).collect();
//! let lying = |trial: &Trial, slot| -> f64 {
//!     trial.window.plane(slot).into_iter().flatten().map(|count| f64::from(*count)).sum()
//! };
//! let (canvas, brush) = (lying(&trial, 0), load.total() as f64);
//! trial.steps(&mut Dab::default(), &mut load, &poses);
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
//! - A unit of volume is 512 quanta, 255 units at most in a layer. Rounding uses quasi-random thresholds over cells and
//!   steps, so small volumes are not lost and no cell waits for another.
//! - Stroking: Algorithms 1 and 2, and the parabola through three heads; the doublings of a step select one. The head
//!   is drawn once for all blends in which its parts move alike to within half a cell. The films of its texels are
//!   distributed over their cells, the raster is blended with the canvas at each place of its path, and the films
//!   return to the texels in integers.
//! - On a device (feature `device`) the processor sends a record for each blend of a step; the device draws the head
//!   once a drawing, and a dispatch blends it at each place. Thresholds are the processor's in fixed point and
//!   quotients are rounded alike, so on the same drawing both give the same counts. Reservoirs are filled in f32.
//! - Heights are those of the counts. The text keeps them as differences of a byte (§ 4.8), which would save nothing beside
//!   the counts.
//! - Colours depend on the wet paint over a layer when it dried, which the dry page notes (`wet_over`); so eq. 4.1 and
//!   its inverse (§ 4.7) hold for any number of layers. The optics neither shade nor bake this paint
//!   (`Colouring::Volumes`).

#[cfg(feature = "device")]
pub mod device;
pub mod dither;
pub mod emboss;
mod entry;
mod films;
pub mod layers;
pub mod raster;
pub mod reservoir;
mod sheet;
mod step;
pub mod stroke;
pub mod touching;
pub mod transfer;
pub mod volume;

pub use entry::ENTRY;
pub use layers::Layers;
pub use step::{Dab, first_blend};
