//! Damaged recordings: what is left of one becomes a whole one, and no byte of it makes a reader panic or ask for memory.

#[path = "../../../daemons/device/tests/counting/mod.rs"]
mod counting;
#[path = "support/sample.rs"]
mod sample;

use std::io::Cursor;
use std::path::Path;

use maulstick_streams::Recording;
use maulstick_streams::recording::RecordedMessage;
use maulstick_streams::recovery::{DamagedRecording, Recovered};
use proptest::prelude::*;
use sample::{MESSAGES, WHOLE, in_folder, numbers, write};

/// Largest allocation for a recording of `length` bytes: a chunk may become 256 times as large, but 1 MiB in any case.
fn bound(length: usize) -> usize {
    length * 512 + (4 << 20)
}

/// What is left of a file, as the bytes of a whole one.
fn recovered(path: &Path) -> (Vec<u8>, Recovered) {
    let mut to = Cursor::new(Vec::new());
    let recovered = DamagedRecording::open(path)
        .expect("MCAP")
        .recover(&mut to)
        .expect("written");
    (to.into_inner(), recovered)
}

/// Reads all that a file may hold, by every reader.
fn read_all(path: &Path) {
    if let Ok(mut recording) = Recording::open(path) {
        let topics = recording.topics().clone();
        let mut see = |message: RecordedMessage| {
            let topic = topics.get(&message.channel);
            if let Some(value) = topic.and_then(|topic| topic.decode(&message.bytes).ok()) {
                assert!(!value.columns().is_empty());
            }
            true
        };
        recording.messages(WHOLE, &mut see).ok();
        for name in recording.attachments().keys() {
            recording.attachment(name).ok();
        }
    }
    if let Ok(damaged) = DamagedRecording::open(path) {
        damaged.recover(Cursor::new(Vec::new())).ok();
    }
}

#[test]
fn wherever_a_file_is_cut_off_it_becomes_a_whole_one_with_what_can_be_read_of_it() {
    let (_folder, path) = in_folder();
    let mut most = 0;
    for ends in [true, false] {
        write(&path, ends);
        let whole = std::fs::read(&path).expect("read");
        let steps = (8..whole.len()).step_by(whole.len() / 97);
        for keep in steps.chain(whole.len() - 40..whole.len()) {
            std::fs::write(&path, &whole[..keep]).expect("cut");
            let mut damaged = Recording::open(&path).expect("opened");
            let found = numbers(&mut damaged, WHOLE);
            let (bytes, recovered) = recovered(&path);
            let damage = recovered.damage.expect("it is cut off");
            assert!(damage.contains("byte"), "{keep}: {damage}");
            std::fs::write(&path, bytes).expect("written");
            let mut mended = Recording::open(&path).expect("whole");
            assert_eq!(mended.damage(), None, "{keep}");
            assert_eq!(numbers(&mut mended, WHOLE), found, "{keep}");
            assert_eq!(recovered.messages, found.len() as u64);
            assert_eq!(mended.notes()["recovered"]["damage"], damage);
            assert_eq!(mended.times_ns(), damaged.times_ns());
            most = most.max(found.len());
        }
    }
    assert_eq!(most as u64, MESSAGES);
}

#[test]
fn a_whole_recording_is_copied_with_schemas_notes_and_files_and_nothing_is_said_of_damage() {
    let (_folder, path) = in_folder();
    write(&path, true);
    let before = Recording::open(&path).expect("opened");
    let (bytes, recovered) = recovered(&path);
    assert_eq!(recovered.damage, None);
    assert_eq!((recovered.messages, recovered.files), (MESSAGES, 1));
    std::fs::write(&path, bytes).expect("written");
    let after = Recording::open(&path).expect("opened");
    assert_eq!(after.notes(), before.notes());
    assert_eq!(after.attachment("rig.toml"), before.attachment("rig.toml"));
    let messages = |recording: &Recording| -> Vec<Option<String>> {
        let topics = recording.topics().values();
        topics.map(|topic| topic.message.clone()).collect()
    };
    assert_eq!(messages(&after), messages(&before));
}

#[test]
fn a_chunk_whose_bytes_changed_is_skipped_and_the_rest_stays() {
    let (_folder, path) = in_folder();
    write(&path, true);
    let whole = std::fs::read(&path).expect("read");
    let (mut least, mut missed) = (MESSAGES, 0);
    for at in (whole.len() / 4..whole.len() / 2).step_by(whole.len() / 23) {
        let mut bytes = whole.clone();
        bytes[at..at + 8].iter_mut().for_each(|byte| *byte ^= 0x55);
        std::fs::write(&path, bytes).expect("written");
        let (_, recovered) = recovered(&path);
        // An index is made anew, so its damage harms nothing.
        let is_whole = recovered.messages == MESSAGES;
        assert!(is_whole || recovered.damage.is_some(), "{at}");
        least = least.min(recovered.messages);
        missed += u32::from(recovered.messages < MESSAGES);
    }
    assert!(least > MESSAGES / 2 && missed > 0, "{least} {missed}");
}

#[test]
fn a_file_without_its_beginning_is_mended_and_another_file_is_refused() {
    let (_folder, path) = in_folder();
    write(&path, true);
    let mut bytes = std::fs::read(&path).expect("read");
    bytes[..8].fill(0);
    std::fs::write(&path, bytes).expect("written");
    assert_eq!(recovered(&path).1.messages, MESSAGES);
    std::fs::write(&path, "a table\n".repeat(100)).expect("written");
    let fault = DamagedRecording::open(&path).expect_err("refused");
    assert_eq!(fault.what, "this is not an MCAP file");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    /// Sizes in a file may be any number: none is believed before it is compared with the file.
    #[test]
    fn changed_bytes_make_nothing_panic_and_no_reader_asks_for_more_memory_than_the_file_may_become(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        large in any::<bool>(),
    ) {
        let (_folder, path) = in_folder();
        write(&path, true);
        let mut bytes = std::fs::read(&path).expect("read");
        for (place, value) in changes {
            // Lengths stand in the head and at the end of a file.
            let at = if large { bytes.len() - 1 - place.index(2000.min(bytes.len())) } else { place.index(bytes.len()) };
            bytes[at] = value;
        }
        std::fs::write(&path, &bytes).expect("written");
        let largest = counting::largest(|| read_all(&path));
        prop_assert!(largest < bound(bytes.len()), "{largest} of {}", bytes.len());
    }
}
