//! The painting and its journal.
//!
//! Pure: brush states and commands come in, tiles and reports go out. [`Sequencer`] decides the
//! order and keeps the journal; [`Painting`] does what the journal says; a
//! [`PaintModel`](maulstick_model::interface::PaintModel) moves the paint of one step.
//!
//! | module | holds |
//! | --- | --- |
//! | [`Painting`] | surfaces, brushes, what is done to them |
//! | [`sequencer`] | the order of states and commands |
//! | [`models`] | the paint models that a surface can have |
//! | [`setup`] | the scene of a new painting |
//! | [`ledger`], [`history`] | the books, undo |
//! | [`beginning`] | where the record of what was accepted begins |
//! | [`Apply`] | edits as the painting carries them out |
//! | [`clock`] | ticks, and the dryings that they drive |
//! | [`snapshot`] | the part of a document that is not tiles |
//! | [`picture`] | pictures of its surfaces |
//! | [`brush_colour`] | the paint on a brush as it is shown |
//!
//! A film of paint, undone; the books are even to the quantum both times:
//!
//! ```
//! use maulstick_optics::PaintLibrary;
//! use maulstick_painting::{Painting, PaintingSetup};
//! use maulstick_types::edits::{Fill, FillPaint};
//! use maulstick_types::scene::CANVAS;
//! use maulstick_types::values::FilmThickness;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let setup = PaintingSetup { cells: [128, 96], ..PaintingSetup::default() };
//! let mut painting = Painting::new(&setup, PaintLibrary::measured()?)?;
//! painting.apply(Fill {
//!     paint: FillPaint::Mixture { mixture: "Cobalt Blue=0.7,Titanium White=0.3".parse()? },
//!     thickness: FilmThickness::in_unit(40.0)?,
//!     surface: CANVAS,
//! })?;
//! let report = painting.report();
//! assert_eq!((report.covered_cells, report.quanta_missing), (128 * 96, 0));
//! painting.undo(None)?;
//! let report = painting.report();
//! assert_eq!((report.covered_cells, report.quanta_missing), (0, 0));
//! # Ok(())
//! # }
//! ```

mod apply;
pub mod beginning;
pub mod brush_colour;
pub mod clock;
mod error;
pub mod history;
pub mod ledger;
pub mod models;
mod painting;
pub mod picture;
pub mod sequencer;
pub mod setup;
pub mod snapshot;

pub use apply::{Applied, Apply};
pub use beginning::{Beginning, RecordChange};
pub use error::paint_error;
pub use painting::{Checkpoint, LaidTile, NOW, Named, Painting, Restored, UnderBrush, Wetness};
pub use sequencer::{Effect, Sequencer};
pub use setup::PaintingSetup;
