//! The brush node of a rig: stylus samples in; brush states, credit and contact models out.
//!
//! The node decodes, steps and encodes; transport and clock come from the bus.
//!
//! | module | holds |
//! | --- | --- |
//! | [`node`] | the node: its queues, its turn, its commands |
//! | [`arbiter`] | the choice among several devices that move one brush |
//! | [`path_simplifier`] | samples merged while credit is short |
//! | [`outbox`] | solved states that wait for credit |
//! | [`contact_model`] | the contact model for the hand |
//! | [`fluid_force`] | the drag of the paint on it |
//! | [`relief`] | the relief around the brush that it feels |

pub mod arbiter;
pub mod contact_model;
pub mod fluid_force;
pub mod node;
pub mod outbox;
pub mod path_simplifier;
pub mod relief;

pub use node::{BrushDevices, BrushNode, BrushSettings};
