//! Commands of streams: what a rig's topics carry, live and recorded.
//!
//! | module | holds |
//! | --- | --- |
//! | [`listener`] | messages of a running rig |
//! | [`echo`], [`measure`], [`nodes`] | contents, rates and senders of live streams |
//! | [`record`], [`recording`] | recordings, made and looked at |
//! | [`table`] | tables in text |

pub mod echo;
mod listener;
pub mod measure;
pub mod nodes;
pub mod record;
pub mod recording;
mod table;
