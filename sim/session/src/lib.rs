//! Brush and paint in one process, without a bus.
//!
//! | module | holds |
//! | --- | --- |
//! | [`offline`] | samples in, a painting out: the same bytes as from a rig |
//! | [`autosave`] | a painting saved continually in its document |
//! | [`recorded`] | a recorded session as the records accepted by its painting |
//! | [`reexecution`] | replay of a document's record |
//! | [`work_clock`] | working time of a record, without pauses |
//! | [`painting_log`](mod@painting_log) | senders, actions and times |
//! | [`ticker`] | ticks of a clock |
//!
//! A stroke of a loaded flat, 40 mm long; the ledger of the painting balances to the quantum:
//!
//! ```
//! use maulstick_brush::BrushFile;
//! use maulstick_optics::PaintLibrary;
//! use maulstick_painting::{Painting, PaintingSetup};
//! use maulstick_session::Offline;
//! use maulstick_types::stylus::{StylusPose, StylusSample, axes};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let painting = Painting::new(&PaintingSetup::default(), PaintLibrary::measured()?)?;
//! let loads = vec!["Cobalt Blue=0.7,Titanium White=0.3".parse()?];
//! let mut offline = Offline::new(painting, "main", BrushFile::library("flat")?, 0.5, loads)?;
//! for millimetre in 0..=41u32 {
//!     let sample = StylusSample {
//!         senses: axes::POSITION | axes::PRESSURE,
//!         in_range: true,
//!         pose: StylusPose::Contact {
//!             point_m: [1e-3 * f64::from(millimetre) - 0.02, 0.0, 0.0],
//!             tilt_rad: [0.4, 0.0],
//!             twist_rad: 0.0,
//!             pressure: if millimetre == 41 { 0.0 } else { 0.5 },
//!         },
//!         ..StylusSample::away()
//!     };
//!     offline.sample(u64::from(millimetre) * 10_000_000, &sample)?;
//! }
//! let report = offline.painting_mut().report();
//! assert_eq!(report.quanta_missing, 0);
//! # Ok(())
//! # }
//! ```
//!
//! # Notes
//!
//! - A session is a recording with the painting at its beginning, so journal and brush states give the accepted
//!   records, which any sequencer accepts again with the same bytes: `render` in a copy, `recording replay` in a rig.
//! - Offline the brush runs on a thread ahead of the paint, and gives the bytes of a rig.

pub mod autosave;
pub mod offline;
pub mod painting_log;
pub mod recorded;
pub mod reexecution;
pub mod ticker;
pub mod work_clock;

pub use autosave::Autosave;
pub use offline::Offline;
pub use painting_log::{Logged, LoggedStroke, LoggedWhat, painting_log};
pub use recorded::RecordedSession;
pub use reexecution::{Reexecution, TilePrints, each_record, tile_prints};
pub use work_clock::WorkClock;
