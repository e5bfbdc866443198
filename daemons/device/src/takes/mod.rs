//! Takes: recorded samples as files, what they embed, tables imported as takes, and their player.

mod kit;
pub mod player;
pub mod salvage;
pub mod table;
pub mod take;
pub mod take_setup;

pub use kit::{held_brush, use_kit};
