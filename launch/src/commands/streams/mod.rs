//! Commands of streams: what a rig's topics carry, live and recorded.
//!
//! | module | holds |
//! | --- | --- |
//! | [`listener`] | messages of a running rig |
//! | [`echo`], [`measure`], [`nodes`] | contents, rates and senders of live streams |
//! | [`graph`] | the processes of a rig, and what they send each other, as a picture |
//! | [`record`], [`painting_copy`], [`ring`], [`recording`], [`foxglove_export`] | recordings, made, kept within bounds, looked at, written for Foxglove |
//! | [`bridge`], [`foxglove_server`] | live streams for Foxglove |
//! | [`message_lines`] | messages as rows of a table and as lines of JSON |

pub mod bridge;
pub mod echo;
mod foxglove_export;
mod foxglove_server;
pub mod graph;
mod listener;
pub mod measure;
mod message_lines;
pub mod nodes;
mod painting_copy;
pub mod record;
pub mod recording;
mod ring;

use std::path::Path;

use maulstick_rig::UserError;
use mcap::McapError;

/// Why a file could not be written.
fn fault(path: &Path, error: McapError) -> UserError {
    let error = match error {
        McapError::Io(error) => error,
        other => std::io::Error::other(other),
    };
    UserError::writing(path, &error)
}
