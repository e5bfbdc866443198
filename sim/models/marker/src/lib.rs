//! A felt marker: it deposits an even film of the brush's colour, at most [`FILM_M`] thick, and neither pushes paint
//! nor takes any up.
//!
//! The smallest [`PaintModel`](maulstick_model::interface::PaintModel) that paints, and the one to copy for another:
//! footprint, head and load are those of every model, [`Marker`] is the step, [`Matte`] the appearance of its ink,
//! [`ENTRY`] its entry in the registry.
//!
//! A stroke with a full marker; going over it again adds little:
//!
//! ```
//! use maulstick_brush::{BrushFile, HeadPose};
//! use maulstick_canvas::quantum::QUANTUM_M;
//! use maulstick_marker::{FILM_M, Marker};
//! use maulstick_model::trial::Trial;
//!
//! # fn main() -> Result<(), maulstick_brush::BrushError> {
//! let file = BrushFile::library("round")?.scaled_to(6.0)?;
//! let mut trial = Trial::new(file, 256, 2.5e-4).expect("a surface");
//! let poses: Vec<HeadPose> =
//!     (0..40).map(|step| trial.pose([60.0 + 3.0 * f64::from(step), 128.0], 0.0)).collect();
//! let thickest_m = |trial: &mut Trial| {
//!     trial.stroke(&mut Marker::default(), &poses);
//!     let film = trial.window.plane(1).expect("ink");
//!     QUANTUM_M * f64::from(film.iter().copied().fold(0.0, f32::max))
//! };
//! let (once, twice) = (thickest_m(&mut trial), thickest_m(&mut trial));
//! println!("{:.1} µm, then {:.1} µm", 1e6 * once, 1e6 * twice);
//! assert!(once > 0.5 * FILM_M && twice <= FILM_M + QUANTUM_M);
//! # Ok(())
//! # }
//! ```

mod entry;
mod film;
mod matte;
mod step;

pub use entry::ENTRY;
pub use film::FILM_M;
pub use matte::Matte;
pub use step::Marker;
