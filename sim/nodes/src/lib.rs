//! The nodes of the simulation: each decodes, steps and encodes, and knows neither which transport
//! carries its messages nor what time it is, but for what the bus tells it.
//!
//! | module | holds |
//! | --- | --- |
//! | [`brush_node`] | stylus samples in, brush states and contact models out |
//! | [`arbiter`] | which of several devices moves the brush |
//! | [`backlog`] | what a live brush does while it may not send |
//! | [`outbox`] | states that are solved and wait for credit |
//! | [`feel`] | the contact model for the hand |
//! | [`paint_node`] | brush states and commands in, journal and credit out |
//! | [`frames`] | pictures of what changed, for whoever asks |
//! | [`keeper`] | the painting in its document |
//! | [`exporter`] | the painting for other programs, beside the painting |
//! | [`snapshots`] | its picture as a file, beside the painting |
//! | [`thumbnails`] | small pictures of it and of its versions |
//! | [`answers`] | what was answered to whom |
//! | [`offline`] | the same brush and paint in one process, without a bus |
//! | [`ticker`] | ticks of a clock |
//! | [`worker`] | a thread that a node cannot do without |

pub mod answers;
pub mod arbiter;
pub mod backlog;
pub mod brush_node;
pub mod exporter;
pub mod feel;
pub mod frames;
pub mod keeper;
pub mod offline;
pub mod outbox;
pub mod paint_node;
pub mod snapshots;
pub mod thumbnails;
pub mod ticker;
pub mod worker;

pub use brush_node::{BrushNode, BrushSettings};
pub use keeper::Keeper;
pub use offline::Offline;
pub use paint_node::PaintNode;
pub use worker::Worker;
