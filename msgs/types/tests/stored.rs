//! Journal entries of a painting's file from before edits had names and decisions were typed.

use maulstick_types::command::Command;
use maulstick_types::paint::{Decision, Entry, JournalEntry};
use maulstick_types::{Edit, HEADER_BYTES, Header, Message as _, encode};

/// Entries of version 12, each with the name of its edit.
const EDITS: &str = include_str!("journal_12.txt");
/// Bytes of an entry of each kind, version 11. No line is ever changed.
const WORDED: &str = include_str!("worded.txt");

/// Entries of the lines.
fn entries() -> [Entry; 6] {
    let brush = || "main".to_owned();
    let undo = Edit::named("undo", &serde_json::json!({ "brush": null }));
    [
        Entry::States {
            brush: brush(),
            epoch: 1,
            from: 2,
            to: 3,
        },
        Entry::Command {
            client: 1,
            number: 2,
            command: undo.into(),
        },
        Entry::Tick { count: 4 },
        Entry::Cut {
            client: 1,
            number: 2,
            brush: brush(),
            epoch: 1,
            from: 4,
            to: 6,
            whole: true,
        },
        Entry::Decision {
            what: Decision::Backend { name: "cpu".into() },
        },
        Entry::Brush {
            brush: brush(),
            toml: "kind".into(),
        },
    ]
}

fn bytes(line: &str) -> Vec<u8> {
    let hex = line.split_whitespace().last().expect("bytes");
    let byte = |at: usize| u8::from_str_radix(&hex[at..at + 2], 16).expect("hexadecimal");
    (0..hex.len()).step_by(2).map(byte).collect()
}

#[test]
fn entries_with_decisions_in_words_are_read_from_files() {
    let [own, _, worded] = JournalEntry::stored_hashes()[..] else {
        panic!("three versions");
    };
    assert_eq!(WORDED.lines().count(), entries().len());
    for (line, entry) in WORDED.lines().zip(entries()) {
        let old = bytes(line);
        assert_eq!(Header::from_bytes(&old).expect("whole").schema, worded);
        let (header, read) = JournalEntry::decode_stored(&old).expect("read");
        assert_eq!((read.index, &read.entry), (3, &entry));
        let Header { flags, seq, .. } = header;
        let new = encode(
            &header.origin(),
            flags,
            seq,
            header.event_ns,
            header.sent_ns,
            &read,
        );
        let new = new.expect("short");
        let (header, again) = JournalEntry::decode_stored(&new).expect("its own bytes");
        assert_eq!((header.schema, again), (own, read));
    }
}

/// An entry is longer as JSON, most of all where control characters are escaped.
#[test]
fn an_entry_of_an_earlier_version_may_outgrow_the_limit_when_translated() {
    // The name of a layer is the last field: its length, and its letters.
    let short = EDITS.lines().find(|line| line.starts_with("NameLayer "));
    let short = bytes(short.expect("a name of a layer"));
    let before = short.len() - b"sky".len();
    assert_eq!(&short[before..], b"sky");
    let letters = JournalEntry::MAX_BYTES - (before - HEADER_BYTES);
    let mut long = short[..before - 8].to_vec();
    long.extend((letters as u64).to_le_bytes());
    long.extend(vec![1; letters]);
    long[20..24].copy_from_slice(&(JournalEntry::MAX_BYTES as u32).to_le_bytes());
    let (_, read) = JournalEntry::decode_stored(&long).expect("read");
    let Entry::Command {
        command: Command::Edit(edit),
        ..
    } = read.entry
    else {
        panic!("no edit");
    };
    assert_eq!(edit.word("name").len(), letters);
}
