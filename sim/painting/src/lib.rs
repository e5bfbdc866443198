//! The painting and its journal.
//!
//! Pure: brush states and commands come in, tiles and reports go out. [`Sequencer`] decides the
//! order and keeps the journal; [`Painting`] does what the journal says; a
//! [`PaintModel`](maulstick_model::interface::PaintModel) moves the paint of one step.
//!
//! | module | holds |
//! | --- | --- |
//! | [`Painting`] | a clock and a workbench: the desk with its surfaces, brushes, backend, accounts, past |
//! | [`sequencer`] | the order of states and commands |
//! | [`setup`] | the scene of a new painting |
//! | [`ledger`], [`history`] | the books, undo |
//! | [`beginning`] | beginning of the record |
//! | [`edits`] | all changes of a painting besides strokes, each in its own file |
//! | [`clock`] | ticks, and the dryings that they drive |
//! | [`snapshot`] | the part of a document that is not tiles |
//! | [`picture`] | pictures of its surfaces |
//! | [`brush_colour`] | the paint on a brush as it is shown |
//! | [`EditError`] | why an edit is refused, data until a person reads it |
//!
//! A film of paint, undone; the books are even to the quantum both times:
//!
//! ```
//! use maulstick_optics::PaintLibrary;
//! use maulstick_painting::{Painting, PaintingSetup};
//! use maulstick_painting::edits::{Fill, FillPaint};
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
//!
//! # Order and journal
//!
//! - The sequencer alone decides the order: accepted brush states and commands get an index and go into the journal in
//!   that order.
//! - An undo more than half a second ahead of the paint drops the waiting states of its stroke: they are consumed
//!   unpainted, a journal entry `Cut` names them, and the painted part of the stroke is undone.
//! - While a session is repeated, live states are consumed unpainted, edits and takes of others are refused, and only
//!   the session's ticks pass; files are still written.
//!
//! # Time
//!
//! Ticks of 1/60 s in the journal. The paint node enters them by its clock while something dries, at most 60 a turn;
//! offline they follow the take or a script's `wait`; a replay follows the journal. A drying takes at most 32 tiles a
//! tick, and none while a brush is in contact, so no stroke is divided.
//!
//! # Undo
//!
//! - A step is the tiles before and after, loads and bookings, as a difference. Each brush has its own open step; when
//!   it reaches a tile that another open step has reached, that one ends, so no two open steps share a tile. A step can
//!   be undone while nothing later lies on what it changed.
//! - Over the quota the two oldest steps are merged; the newest sixteen stay separate, and so do those before and since
//!   a take began.
//! - The beginning is the whole painting at the place from which the record can be replayed. It shares pages and has no
//!   finished steps, which would keep every older page; undoing one starts a new record.
//!
//! # Surfaces and brushes
//!
//! - `maulstick-models` lists the paint models that a surface can have. A lighter model is proposed, never chosen, after three late strokes, where the setting `model` is `auto`.
//! - Wells are refilled before each step of a brush in them: what was pushed in goes to the cleaner's account, what was
//!   taken comes from the tubes'. A paint takes a slot when a brush first touches it. The jar of medium is a well of
//!   thinner that is emptied after each step. A moved well takes its wet paint along: each cell gets that of one cell
//!   or of none, so nothing is doubled. Wells belong to the materials of a step, so undo brings them back.
//! - When the zoom asks for other strips, what they carry is merged into the nearest or divided, to the quantum.
//! - Looking beside the painting (exports, snapshots, thumbnails) uses a *still*: the same tiles, shared, without
//!   brushes and history.
//! - Backend: processor, or a graphics device whose steps stay unsettled until somebody reads them; surfaces with wells
//!   are the processor's.
//! - An edit reaches the parts that it changes: `bench` and `clock`. One that takes or dries wet paint stops a drying
//!   (`clock.stop`), leaves the paint of wells (`SurfaceState::staying`) and decides about planes of a model's own
//!   (`Planes::own`). One that moves paint has open windows written back first; `begin_step` ends open steps.
//! - Of the parts the desk knows no brush, the brushes know no history, and the workbench, which has all of them, knows no
//!   clock: dryings are handed it.

pub mod beginning;
pub mod brush_colour;
pub mod clock;
pub mod edits;
mod error;
pub mod history;
pub mod ledger;
mod painting;
pub mod picture;
pub mod sequencer;
pub mod setup;
pub mod snapshot;

pub use beginning::{Beginning, RecordChange};
pub use edits::Applied;
pub use error::{BrushError, EditError, HistoryError, LayerError, SurfaceError, VersionError};
pub use painting::{Checkpoint, LaidTile, NOW, Named, Painting, Restored, UnderBrush, Wetness};
pub use sequencer::{Effect, Sequencer};
pub use setup::PaintingSetup;
