//! A felt marker: it leaves an even film of the brush's colour, at most [`FILM_M`] thick, and neither pushes paint nor
//! takes any up.
//!
//! The smallest [`PaintModel`](maulstick_model::interface::PaintModel) that paints, and the one to copy for another:
//! footprint, head and load are those of every model, [`Marker`] is the step, [`Matte`] how its ink is shown, [`ENTRY`] what the
//! registry takes.
//!
//! ```
//! use maulstick_marker::Marker;
//! use maulstick_model::interface::PaintModel as _;
//!
//! let marker = Marker::default();
//! assert_eq!((marker.name(), marker.rest_halo()), ("marker", None));
//! ```

mod entry;
mod film;
mod matte;
mod step;

pub use entry::ENTRY;
pub use film::FILM_M;
pub use matte::Matte;
pub use step::Marker;
