//! Shared parts of the device daemons.
//!
//! | module | holds |
//! | --- | --- |
//! | [`take`] | recorded samples as MCAP files |
//! | [`salvage`](mod@salvage) | reading of takes, whole or damaged |
//! | [`take_setup`], [`use_kit`] | settings and files that a take embeds, and their use |
//! | [`table`] | tables of strokes, imported as takes |
//! | [`demo`], [`mark_sheet`] | performances made from a seed |
//! | [`player`] | a device that plays a take |
//! | [`brush`] | the brush of a section of `rig.toml` |
//! | [`device_missing`] | report of a device that is not there |
//! | [`node_watch`] | nodes of devices that appear |
//! | [`canvas_mover`] | motion of the canvas by a 6-DOF mouse |
//! | [`registration`] | a device's frame on the desk |
//! | [`corner_calibration`] | corners of the canvas, as a hand shows them |
//! | [`actions`] | actions of a stylus's switches |
//! | [`pen`] | presence of a pen: away, hovering, touching |
//! | [`pressure_curve`] | pressure of a pen as it is sensed and given |
//! | [`pen_stream`] | samples of a pen on the bus |
//! | [`hid_collections`] | application collections of a HID report descriptor |
//!
//! The marks of a seeded performance, written as a take and read again:
//!
//! ```
//! use maulstick_device::Take;
//! use maulstick_device::demo::{Subject, performance};
//! use maulstick_device::pressure_curve::given;
//! use maulstick_types::stylus::StylusPose;
//!
//! # fn main() -> Result<(), maulstick_rig::UserError> {
//! let folder = tempfile::tempdir().expect("a folder");
//! let path = folder.path().join("marks.mcap");
//! performance(Subject::Marks, 7).write(&path)?;
//! let take = Take::read(&path)?;
//! assert_eq!(take, performance(Subject::Marks, 7), "the same seed, the same hand");
//!
//! // A soft curve gives more pressure to a light hand, and the same to one that presses fully.
//! let soft = [[0.0, 0.0], [0.4, 0.7], [1.0, 1.0]];
//! for sample in &take.samples {
//!     if let StylusPose::Contact { pressure, .. } = sample.sample.pose {
//!         assert!(given(&soft, pressure) >= pressure - 1e-12);
//!     }
//! }
//! println!("{} samples in {:.1} s", take.samples.len(), take.length_ns() as f64 * 1e-9);
//! # Ok(())
//! # }
//! ```
//!
//! # Notes
//!
//! - A device is any program that publishes `StylusSample`; `docs/devices.md` has one in Python.
//! - Switches send commands to the paint node, so they lie in the journal and a replay repeats them; only the clutch is
//!   the daemon's own. The free hand moves the canvas by `Place` commands.
//! - A take is MCAP, with chunks of 64 KB, checksums, and a schema that alone tells how its messages are decoded. A
//!   damaged take is reported, and read on behind the damage.
//! - A player waits for credit. Brush credit tells it which state holds its last sample, and the launcher's snapshot
//!   waits for exactly that state.

pub mod actions;
pub mod brush;
pub mod canvas_mover;
pub mod corner_calibration;
pub mod device_missing;
pub mod hid_collections;
pub mod node_watch;
pub mod pen;
pub mod pen_stream;
mod performance;
pub mod pressure_curve;
pub mod registration;
mod takes;

pub use brush::{brush_file, read_brush};
pub(crate) use performance::strokes;
pub use performance::{demo, mark_sheet};
pub use take::{Take, TakeSample};
pub use take_setup::TakeSetup;
pub use takes::{held_brush, player, salvage, table, take, take_setup, use_kit};
