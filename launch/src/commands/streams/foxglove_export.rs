//! Writes a recording for Foxglove: all of its messages as JSON channels.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufWriter, ErrorKind};
use std::path::Path;

use maulstick_rig::UserError;
use maulstick_rig::files::{Kind, write_whole};
use maulstick_streams::recording::Topic;
use maulstick_streams::{Recording, RecordingWriter};

use super::fault;
use super::message_lines::decoded;

/// Writes the messages of topics, by their channel numbers, that arrived in a range of times, rig clock, ns; returns
/// their number.
///
/// # Errors
/// A [`UserError`] where a file cannot be read or written, or a message cannot be decoded.
pub(super) fn write(
    recording: &mut Recording,
    topics: &BTreeMap<u16, Topic>,
    range_ns: [u64; 2],
    output: &Path,
) -> Result<u64, UserError> {
    let mut count = Ok(0);
    let written = write_whole(output, Kind::Take, |file| {
        count = write_to(recording, topics, range_ns, (output, file));
        // The error itself is in `count`.
        count
            .as_ref()
            .map(drop)
            .map_err(|_| ErrorKind::Other.into())
    });
    let count = count?;
    written.map_err(|error| UserError::writing(output, &error))?;
    Ok(count)
}

fn write_to(
    recording: &mut Recording,
    topics: &BTreeMap<u16, Topic>,
    range_ns: [u64; 2],
    (path, file): (&Path, &mut BufWriter<File>),
) -> Result<u64, UserError> {
    let writing = |error| fault(path, error);
    let mut writer = RecordingWriter::begin(file).map_err(writing)?;
    for (name, note) in recording.notes() {
        writer.note(name, note.clone()).map_err(writing)?;
    }
    let (mut count, mut wrong) = (0, None);
    recording.messages(range_ns, &mut |message| {
        let Some((topic, table)) = topics
            .get(&message.channel)
            .and_then(|topic| Some((topic, topic.table.as_ref().ok()?)))
        else {
            return true;
        };
        let written = decoded(topic, &message).and_then(|value| {
            let (header, arrived_ns) = (&message.header, message.arrived_ns);
            writer
                .write_json(&topic.name, table, header, &value, arrived_ns)
                .map_err(writing)
        });
        count += 1;
        wrong = written.err();
        wrong.is_none()
    })?;
    if let Some(fault) = wrong {
        return Err(fault);
    }
    writer.finish().map_err(writing)?;
    Ok(count)
}
