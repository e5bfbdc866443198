//! Commands of streams: what a rig's topics carry, live and recorded.
//!
//! | module | holds |
//! | --- | --- |
//! | [`listener`] | messages of a running rig |
//! | [`echo`], [`measure`], [`nodes`] | contents, rates and senders of live streams |
//! | [`graph`] | the processes of a rig, and what they send each other, as a picture |
//! | [`record`], [`ring`], [`recording`] | recordings, made, kept within bounds, and looked at |
//! | [`message_lines`] | messages as rows of a table and as lines of JSON |

pub mod echo;
pub mod graph;
mod listener;
pub mod measure;
mod message_lines;
pub mod nodes;
pub mod record;
pub mod recording;
mod ring;
