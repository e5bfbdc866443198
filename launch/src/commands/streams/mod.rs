//! Commands of streams: the topics of a rig, live and recorded.
//!
//! | module | holds |
//! | --- | --- |
//! | [`echo`], [`measure`] | contents and rates of live streams |
//! | [`graph`] | the processes of a rig, and the streams between them, as a picture |
//! | [`record`], [`recorder_words`] | recordings within limits; their events in words |
//! | [`recording`], [`recording_info`], [`foxglove_export`] | recordings shown and exported for Foxglove |
//! | [`topic`] | the commands of live streams as a group |
//! | [`bridge`] | live streams for Foxglove |
//! | [`message_lines`] | messages as rows of a table and as lines of JSON |

mod bridge;
mod echo;
mod foxglove_export;
mod graph;
mod measure;
mod message_lines;
mod record;
pub(crate) mod recorder_words;
pub mod recording;
mod recording_info;
pub mod topic;

use std::path::Path;

use maulstick_rig::UserError;
use mcap::McapError;

/// The error of a file that could not be written.
fn fault(path: &Path, error: McapError) -> UserError {
    let error = match error {
        McapError::Io(error) => error,
        other => std::io::Error::other(other),
    };
    UserError::writing(path, &error)
}
