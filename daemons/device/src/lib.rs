//! What device daemons share.
//!
//! | module | holds |
//! | --- | --- |
//! | [`take`] | recorded samples as MCAP files |
//! | [`salvage`](mod@salvage) | what a take holds, whole or damaged |
//! | [`kit`] | what a take is painted with, embedded in it |
//! | [`table`] | tables of strokes, imported as takes |
//! | [`demo`], [`sheet`] | performances made from a seed |
//! | [`player`] | a device that plays a take |
//! | [`brush`] | the brush that a section of `rig.toml` asks for |
//! | [`missing`] | what is said of a device that is not there |
//! | [`mover`] | the free hand moves the canvas |
//! | [`fitting`] | a device's frame on the desk |
//! | [`corners`] | the corners of the canvas, as a hand shows them |
//! | [`actions`] | what the switches of a stylus do |
//! | [`collections`] | what a HID device says that it is |

pub mod actions;
pub mod brush;
pub mod collections;
pub mod corners;
pub mod demo;
pub mod fitting;
pub mod kit;
pub mod missing;
pub mod mover;
pub mod player;
mod records;
pub mod salvage;
pub mod sheet;
pub mod table;
pub mod take;

pub use brush::{brush_file, read_brush};
pub use kit::Kit;
pub use take::{Take, TakeSample};
