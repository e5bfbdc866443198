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
