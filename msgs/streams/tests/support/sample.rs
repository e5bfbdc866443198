//! A small recording.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use maulstick_streams::recording::RecordedMessage;
use maulstick_streams::{Recording, RecordingWriter};
use maulstick_types::stylus::StylusSample;
use maulstick_types::{Flags, Header, Origin, encode};

pub(crate) const MESSAGES: u64 = 4000;
/// A message of no kind that this program knows.
pub(crate) const FOREIGN: u64 = 7;
/// The whole of a recording.
pub(crate) const WHOLE: [u64; 2] = [0, u64::MAX];

/// The message of a number: one a millisecond.
pub(crate) fn message(number: u64) -> Vec<u8> {
    let origin = Origin {
        source: 5,
        epoch: 1,
    };
    let sample = StylusSample {
        switches: number as u32,
        ..StylusSample::away()
    };
    let (event, sent) = (number * 1_000_000, number * 1_000_000 + 10);
    let mut bytes = encode(&origin, Flags::NONE, number, event, sent, &sample).expect("encoded");
    if number == FOREIGN {
        bytes[4] ^= 1;
    }
    bytes
}

/// Writes a recording as a recorder does; with or without its end.
pub(crate) fn write(path: &Path, ends: bool) {
    let file = BufWriter::new(File::create(path).expect("a file"));
    let mut writer = RecordingWriter::begin(file).expect("begun");
    let note = BTreeMap::from([("rig".to_owned(), "studio".to_owned())]);
    writer.note("recording", note).expect("noted");
    let settings = b"[rig]";
    writer
        .attach("rig.toml", "application/toml", settings)
        .expect("attached");
    for number in 0..MESSAGES {
        let bytes = message(number);
        let header = Header::from_bytes(&bytes).expect("a header");
        let arrived = header.sent_ns + 100;
        writer
            .write("stylus/pen/sample", &header, &bytes, arrived)
            .expect("written");
        if number % 500 == 499 {
            writer.flush().expect("flushed");
        }
    }
    if ends {
        writer.finish().expect("finished")
    } else {
        // As a killed process leaves it: what was flushed, and no end.
        std::mem::forget(writer)
    }
}

pub(crate) fn in_folder() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("session.mcap");
    (folder, path)
}

/// Numbers of the messages that arrived in a range of times.
pub(crate) fn numbers(recording: &mut Recording, range: [u64; 2]) -> Vec<u64> {
    let mut numbers = Vec::new();
    let mut see = |message: RecordedMessage| {
        numbers.push(message.header.seq);
        true
    };
    recording.messages(range, &mut see).expect("read");
    numbers
}
