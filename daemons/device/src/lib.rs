//! What device daemons share.
//!
//! | module | holds |
//! | --- | --- |
//! | [`take`] | recorded samples as MCAP files |
//! | [`table`] | tables of strokes, imported as takes |
//! | [`demo`] | a performance made from a seed |
//! | [`player`] | a device that plays a take |
//! | [`commander`] | commands to the paint node, repeated until answered |

pub mod commander;
pub mod demo;
pub mod player;
pub mod table;
pub mod take;

pub use take::{Take, TakeSample};
