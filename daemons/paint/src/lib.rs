//! The paint node of a rig: brush states and commands in; journal, credit and frames out.
//!
//! The node decodes, steps and encodes; transport and clock come from the bus.
//!
//! | module | holds |
//! | --- | --- |
//! | [`node`] | the node: its queues, its turn, its status |
//! | [`frames`] | tiles of the picture that changed, for each window |
//! | [`exporter`] | exports for other programs, on a thread beside the painting |
//! | `refusal` | why something is not done, with advice |
//! | [`snapshots`] | pictures as files, on a thread beside the painting |
//! | [`thumbnails`] | small pictures of the painting and of its versions |
//! | [`worker`] | a thread whose panic ends the node |
//!
//! A picture and its ledger as a running rig writes them; no quantum of the paint is missing.
//!
//! ```
//! use maulstick_appearance::picture::Export;
//! use maulstick_optics::PaintLibrary;
//! use maulstick_paint_node::snapshots::write_snapshot;
//! use maulstick_painting::edits::{Fill, FillPaint};
//! use maulstick_painting::{Painting, PaintingSetup};
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
//! let folder = tempfile::tempdir()?;
//! let [picture, ledger] = ["sea.png", "sea.json"].map(|name| folder.path().join(name));
//! write_snapshot(&mut painting, &picture, Some(&ledger), &Export::default()).map_err(|(_, error)| error)?;
//!
//! let ledger: serde_json::Value = serde_json::from_slice(&std::fs::read(&ledger)?)?;
//! assert_eq!(ledger["quanta_missing"], 0);
//! assert_eq!(ledger["covered_cells"], 128 * 96);
//! # Ok(())
//! # }
//! ```
//!
//! # Frames
//!
//! Views pull: one query in flight for each surface waits for a change, up to 1.6 s at rest. Colour is computed on a
//! thread of its own, only for tiles in view and at their level of detail; coarse tiles are made in parts, for a tenth
//! of a second a reply, and kept. Films over hair follow 15 times a second at most, while a view asks. The status comes
//! ten times a second while it changes, else twice, since each one wakes every listener.
//!
//! # Takes and sessions
//!
//! - `TakeCommand::Begin` says which take a player plays and what its strokes load; replayed states of any other take
//!   paint nothing. Until the sample with the flag *last*, or until the player's token is gone, no other device moves
//!   that brush and its live states paint nothing. So a take gives the same bytes whoever else is at the desk, and can
//!   be played again after a crash without the half-painted one.
//! - A repeated session is accepted in batches; its player is gone after ten seconds of silence.
//!
//! Exports, snapshots and thumbnails work on a still, beside the painting. The journal says when the backend changes.

pub mod exporter;
pub mod frames;
pub mod node;
mod refusal;
pub mod snapshots;
pub mod thumbnails;
pub mod worker;

pub use node::PaintNode;
pub use refusal::Refusal;
pub use worker::Worker;
