//! Recordings: what is written is read, also from a file that ends early, and no byte of one makes a reader panic.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use maulstick_streams::recording::RecordedMessage;
use maulstick_streams::{Recording, RecordingWriter};
use maulstick_types::stylus::StylusSample;
use maulstick_types::{Flags, Header, Origin, encode};
use proptest::prelude::*;

const MESSAGES: u64 = 4000;
/// A message of no kind that this program knows.
const FOREIGN: u64 = 7;
/// The whole of a recording.
const WHOLE: [u64; 2] = [0, u64::MAX];

/// The message of a number: one a millisecond.
fn message(number: u64) -> Vec<u8> {
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
fn write(path: &Path, ends: bool) {
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
    match ends {
        true => writer.finish().expect("finished"),
        // As a killed process leaves it: what was flushed, and no end.
        false => std::mem::forget(writer),
    }
}

fn in_folder() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("session.mcap");
    (folder, path)
}

/// Numbers of the messages that arrived in a range of times.
fn numbers(recording: &mut Recording, range: [u64; 2]) -> Vec<u64> {
    let mut numbers = Vec::new();
    let mut see = |message: RecordedMessage| {
        numbers.push(message.header.seq);
        true
    };
    recording.messages(range, &mut see).expect("read");
    numbers
}

#[test]
fn what_is_written_is_read_with_its_notes_and_files() {
    let (_folder, path) = in_folder();
    write(&path, true);
    let mut recording = Recording::open(&path).expect("opened");
    assert_eq!(recording.damage, None);
    assert_eq!(recording.notes["recording"]["rig"], "studio");
    assert_eq!(recording.files["rig.toml"], b"[rig]");
    let last = (MESSAGES - 1) * 1_000_000 + 110;
    assert_eq!(recording.times_ns(), Some([110, last]));
    let mut same = 0;
    let topics = recording.topics().clone();
    let mut see = |read: RecordedMessage| {
        same += u64::from(read.bytes == message(same));
        let topic = &topics[&read.channel];
        assert_eq!(topic.name, "stylus/pen/sample");
        let decoded = topic.decode(&read.bytes);
        if read.header.seq == FOREIGN {
            assert!(decoded.is_err() && topic.message.is_none());
        } else {
            let decoded = decoded.expect("decoded");
            let switches = decoded.at("switches").and_then(|value| value.number());
            assert_eq!(switches, Some(read.header.seq as f64));
        }
        true
    };
    recording.messages(WHOLE, &mut see).expect("read");
    assert_eq!(same, MESSAGES);
}

#[test]
fn a_range_of_times_is_read_and_reading_ends_where_it_is_told() {
    let (_folder, path) = in_folder();
    write(&path, true);
    let mut recording = Recording::open(&path).expect("opened");
    let found = numbers(&mut recording, [1_000_000_110, 1_002_000_110]);
    assert_eq!(found, [1000, 1001, 1002]);
    let mut count = 0;
    let mut see = |_| {
        count += 1;
        count < 3
    };
    recording.messages(WHOLE, &mut see).expect("read");
    assert_eq!(count, 3);
}

#[test]
fn a_recorder_that_was_killed_leaves_all_that_it_had_flushed() {
    let (_folder, path) = in_folder();
    write(&path, false);
    let mut recording = Recording::open(&path).expect("opened");
    let damage = recording.damage.clone();
    assert!(damage.is_some_and(|damage| damage.contains("no index")));
    let last = (MESSAGES - 1) * 1_000_000 + 110;
    assert_eq!(recording.times_ns(), Some([110, last]));
    let late = numbers(&mut recording, [last - 1, u64::MAX]);
    assert_eq!(late, [MESSAGES - 1]);
    let found = numbers(&mut recording, WHOLE);
    assert_eq!(found, (0..MESSAGES).collect::<Vec<_>>());
    assert_eq!(recording.notes["recording"]["rig"], "studio");
    assert_eq!(recording.files["rig.toml"], b"[rig]");
}

#[test]
fn wherever_a_file_is_cut_off_what_is_whole_can_be_read() {
    let (_folder, path) = in_folder();
    write(&path, true);
    let whole = std::fs::read(&path).expect("read");
    let mut most = 0;
    for keep in (8..whole.len()).step_by(whole.len() / 61) {
        std::fs::write(&path, &whole[..keep]).expect("cut");
        let mut recording = Recording::open(&path).expect("opened");
        let found = numbers(&mut recording, WHOLE);
        assert_eq!(found, (0..found.len() as u64).collect::<Vec<_>>(), "{keep}");
        assert!(found.len() >= most, "{keep}");
        most = found.len();
    }
    assert!(most as u64 > MESSAGES / 2);
}

#[test]
fn other_files_are_refused_with_what_to_do() {
    let (_folder, path) = in_folder();
    for content in ["", "a table\n"] {
        std::fs::write(&path, content).expect("written");
        let fault = Recording::open(&path).expect_err("refused");
        assert_eq!(fault.what, "this is no MCAP file");
        assert!(fault.help.is_some());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    /// Sizes in a file may be any number: none is believed before it is compared with the file.
    #[test]
    fn changed_bytes_make_nothing_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let (_folder, path) = in_folder();
        write(&path, true);
        let mut bytes = std::fs::read(&path).expect("read");
        for (place, value) in changes {
            let at = place.index(bytes.len());
            bytes[at] = value;
        }
        std::fs::write(&path, &bytes).expect("written");
        if let Ok(mut recording) = Recording::open(&path) {
            let topics = recording.topics().clone();
            let mut see = |message: RecordedMessage| {
                if let Some(topic) = topics.get(&message.channel) {
                    topic.decode(&message.bytes).ok();
                }
                true
            };
            recording.messages(WHOLE, &mut see).ok();
        }
    }
}
