//! Recordings: what is written is read, also from a file that ends early.

use maulstick_streams::Recording;
use maulstick_streams::recording::RecordedMessage;

#[path = "support/foreign.rs"]
mod foreign;
#[path = "support/sample.rs"]
mod sample;

use std::collections::BTreeMap;

use foreign::{Sample, WIDE, write_as};
use mcap::WriteOptions;
use sample::{FOREIGN, MESSAGES, WHOLE, in_folder, message, numbers, write};

#[test]
fn what_is_written_is_read_with_its_notes_and_files() {
    let (_folder, path) = in_folder();
    write(&path, true);
    let mut recording = Recording::open(&path).expect("opened");
    assert_eq!(recording.damage(), None);
    assert_eq!(recording.notes()["recording"]["rig"], "studio");
    let settings = recording.attachment("rig.toml").expect("intact");
    assert_eq!(settings.as_deref(), Some(&b"[rig]"[..]));
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
    assert!(recording.damage().is_some());
    let last = (MESSAGES - 1) * 1_000_000 + 110;
    assert_eq!(recording.times_ns(), Some([110, last]));
    let late = numbers(&mut recording, [last - 1, u64::MAX]);
    assert_eq!(late, [MESSAGES - 1]);
    let found = numbers(&mut recording, WHOLE);
    assert_eq!(found, (0..MESSAGES).collect::<Vec<_>>());
    assert_eq!(recording.notes()["recording"]["rig"], "studio");
    let settings = recording.attachment("rig.toml").expect("intact");
    assert_eq!(settings.as_deref(), Some(&b"[rig]"[..]));
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
fn an_attached_file_is_what_it_was_or_damaged() {
    let (_folder, path) = in_folder();
    write(&path, true);
    let mut bytes = std::fs::read(&path).expect("read");
    let at = bytes.windows(5).position(|found| found == b"[rig]");
    bytes[at.expect("attached as it is")] ^= 1;
    std::fs::write(&path, &bytes).expect("written");
    let recording = Recording::open(&path).expect("opened");
    assert_eq!(recording.attachments()["rig.toml"].bytes, 5);
    let fault = recording.attachment("rig.toml").expect_err("damaged");
    assert!(fault.to_string().contains("damaged"), "{fault}");
    assert_eq!(recording.attachment("none"), Ok(None));
}

/// Numbers from 0 on in an order that is none, the same each time.
fn shuffled(count: u64) -> Vec<u64> {
    // 61 and the number have no common divisor.
    (0..count).map(|place| place * 61 % count).collect()
}

#[test]
fn a_file_without_chunks_or_index_is_read_as_one_that_has_them() {
    let (_folder, path) = in_folder();
    let in_order: Vec<u64> = (0..4000).collect();
    let options = WriteOptions::new;
    let small = || options().chunk_size(Some(4096));
    for (kind, options) in [
        ("as usual", options()),
        ("no chunks", options().use_chunks(false)),
        (
            "nor a summary",
            options().use_chunks(false).emit_summary_records(false),
        ),
        (
            "no summary",
            small()
                .emit_summary_records(false)
                .emit_summary_offsets(false),
        ),
        (
            "chunks that no index names",
            small().emit_chunk_indexes(false),
        ),
        ("no index of messages", small().emit_message_indexes(false)),
    ] {
        write_as(
            &path,
            options,
            in_order.iter().map(|number| Sample::Own(*number)),
        );
        let mut recording = Recording::open(&path).expect("opened");
        assert_eq!(recording.damage(), None, "{kind}");
        assert_eq!(recording.times_ns(), Some([0, 3_999_000_000]), "{kind}");
        assert_eq!(numbers(&mut recording, WHOLE), in_order, "{kind}");
        let part = numbers(&mut recording, [10_000_000, 12_000_000]);
        assert_eq!(part, [10, 11, 12], "{kind}");
        assert_eq!(recording.topics().len(), 1, "{kind}");
    }
}

#[test]
fn messages_come_in_order_of_time_wherever_they_stand() {
    let (_folder, path) = in_folder();
    for options in [
        WriteOptions::new(),
        WriteOptions::new().chunk_size(Some(4096)),
        WriteOptions::new().use_chunks(false),
    ] {
        let samples = shuffled(4000).into_iter().map(Sample::Own);
        write_as(&path, options, samples);
        let mut recording = Recording::open(&path).expect("opened");
        let found = numbers(&mut recording, WHOLE);
        assert_eq!(found, (0..4000).collect::<Vec<_>>());
        assert_eq!(recording.damage(), None);
    }
}

#[test]
fn a_chunk_that_packs_two_thousand_to_one_is_whole() {
    let (_folder, path) = in_folder();
    let options = WriteOptions::new().chunk_size(Some(8 << 20));
    let samples = (0..200).flat_map(|number| [Sample::Own(number), Sample::Wide(number)]);
    write_as(&path, options, samples);
    let bytes = std::fs::metadata(&path).expect("written").len();
    assert!(200 * WIDE as u64 > 1000 * bytes, "{bytes} bytes");
    let mut recording = Recording::open(&path).expect("opened");
    assert_eq!(numbers(&mut recording, WHOLE), (0..200).collect::<Vec<_>>());
    assert_eq!(recording.damage(), None);
    let found = recording.foreign().expect("read");
    assert_eq!(found.len(), 1);
    let camera = &found[0];
    assert_eq!((camera.name.as_str(), camera.messages), ("camera", 200));
    assert_eq!(camera.bytes, 200 * WIDE as u64);
    assert!((camera.rate_hz - 1000.0).abs() < 1e-6, "{camera:?}");
    assert_eq!(camera.encoding, "json");
}

#[test]
fn json_beside_messages_is_no_topic_and_json_alone_is_one_of_another_program() {
    let (_folder, path) = in_folder();
    let beside = (0..10).flat_map(|number| [Sample::Own(number), Sample::Copy(number)]);
    write_as(&path, WriteOptions::new(), beside);
    let mut recording = Recording::open(&path).expect("opened");
    assert_eq!(recording.foreign(), Ok(Vec::new()));
    write_as(&path, WriteOptions::new(), (0..10).map(Sample::Copy));
    let mut recording = Recording::open(&path).expect("opened");
    let found = recording.foreign().expect("read");
    let found: BTreeMap<&str, u64> = found
        .iter()
        .map(|topic| (topic.name.as_str(), topic.messages))
        .collect();
    assert_eq!(found, BTreeMap::from([("stylus/pen/sample", 10)]));
    assert!(recording.topics().is_empty());
}

#[test]
fn other_files_are_refused_with_what_to_do() {
    let (_folder, path) = in_folder();
    for content in ["", "a table\n"] {
        std::fs::write(&path, content).expect("written");
        let fault = Recording::open(&path).expect_err("refused");
        assert_eq!(fault.what, "this is not an MCAP file");
        assert!(fault.help.is_some());
    }
}
