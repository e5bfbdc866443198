//! Commands of streams: what a rig's topics carry, live and recorded.
//!
//! | module | holds |
//! | --- | --- |
//! | [`listener`] | messages of a running rig |
//! | [`echo`], [`measure`], [`nodes`] | contents, rates and senders of live streams |
//! | [`record`], [`ring`], [`recording`] | recordings, made, kept within bounds, and looked at |
//! | [`message_lines`] | messages as rows of a table and as lines of JSON |

pub mod echo;
mod listener;
pub mod measure;
mod message_lines;
pub mod nodes;
pub mod record;
pub mod recording;
mod ring;
