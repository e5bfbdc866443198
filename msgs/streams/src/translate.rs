//! Messages of other versions, read as those of this one.

use maulstick_types::{DecodeError, Header, Message, decode};

use crate::recording::{RecordedMessage, Topic};
use crate::{FieldTable, TableError};

/// Why a recorded message cannot be read as one of this program.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ReadError {
    /// It is another message.
    #[error("it is a {found}, not a {wanted}")]
    Other {
        /// Name of the message.
        found: String,
        /// Name of the message that was wanted.
        wanted: &'static str,
    },
    /// Its field table, or its body.
    #[error(transparent)]
    Table(#[from] TableError),
    /// Its body in this version.
    #[error(transparent)]
    Decode(#[from] DecodeError),
}

impl Topic {
    /// A message of it as one of this program, whatever version it has.
    ///
    /// # Errors
    /// [`ReadError`].
    pub fn read<M: Message>(&self, message: &RecordedMessage) -> Result<(Header, M), ReadError> {
        if message.header.schema == M::schema().hash {
            return Ok(decode::<M>(&message.bytes)?);
        }
        if self.message_name() != Some(M::NAME) {
            return Err(ReadError::Other {
                found: self.message_name().unwrap_or("unknown message").to_owned(),
                wanted: M::NAME,
            });
        }
        let value = self.decode(&message.bytes)?;
        let body = FieldTable::of(M::schema())?.encode(&value)?;
        Ok((message.header, M::decode_body(M::VERSION, &body)?))
    }
}

#[cfg(test)]
mod tests {
    use maulstick_types::brush::BrushState;
    use maulstick_types::command::{Command, TakeCommand};
    use maulstick_types::paint::{Decision, Entry, JournalEntry};
    use maulstick_types::wire::header::HEADER_BYTES;
    use maulstick_types::{Flags, Origin, encode};

    use super::*;
    use crate::catalogue::KnownTables;

    fn entry() -> JournalEntry {
        let command = TakeCommand::Begin {
            brush: maulstick_types::values::BrushName::main(),
            device: 1,
            device_epoch: 2,
            loads: vec!["Cobalt Blue=0.7,Titanium White=0.3".parse().expect("one")],
            again: true,
        };
        JournalEntry {
            index: 7,
            entry: Entry::Command {
                client: 3,
                number: 4,
                command: Command::from(command),
            },
        }
    }

    fn message(entry: &JournalEntry) -> Vec<u8> {
        let origin = Origin {
            source: 1,
            epoch: 1,
        };
        encode(&origin, Flags::NONE, 0, 0, 0, entry).expect("short")
    }

    #[test]
    fn a_body_is_the_same_by_its_own_table() {
        let table = FieldTable::of(JournalEntry::schema()).expect("its own");
        let bytes = message(&entry());
        let body = &bytes[HEADER_BYTES..];
        let value = table.decode(body).expect("whole");
        assert_eq!(table.encode(&value).expect("known"), body);
    }

    /// Every golden message, units of enums among them.
    #[test]
    fn every_message_is_the_same_by_its_own_table() {
        let mut known = KnownTables::default();
        let mut count = 0;
        for line in include_str!("../../types/tests/golden.txt").lines() {
            let hex = line.split_whitespace().last().unwrap_or_default();
            let pairs = hex.as_bytes().chunks_exact(2).map(|pair| {
                let digits = std::str::from_utf8(pair).ok()?;
                u8::from_str_radix(digits, 16).ok()
            });
            let Some(bytes) = pairs.collect::<Option<Vec<u8>>>() else {
                continue;
            };
            let Ok(header) = Header::from_bytes(&bytes) else {
                continue;
            };
            let table = known.of(header.schema).expect("its own");
            let body = &bytes[HEADER_BYTES..];
            let value = table.decode(body).expect("whole");
            assert_eq!(table.encode(&value).expect("known"), body, "{line}");
            count += 1;
        }
        assert!(count > 50, "{count}");
    }

    /// Edits were an enum.
    #[test]
    fn edits_have_names_and_fields() {
        let table = include_str!("../../types/src/paint/journal_12.json");
        let table = FieldTable::parse(table.as_bytes()).expect("a table");
        let older = Topic::of(table);
        let lines = include_str!("../../types/tests/journal_12.txt").lines();
        let mut names = Vec::new();
        for line in lines {
            let hex = line.split_whitespace().last().expect("bytes");
            let byte = |at: usize| u8::from_str_radix(&hex[at..at + 2], 16).expect("hexadecimal");
            let bytes: Vec<u8> = (0..hex.len()).step_by(2).map(byte).collect();
            let message = RecordedMessage {
                channel: 0,
                arrived_ns: 0,
                header: Header::from_bytes(&bytes).expect("whole"),
                bytes,
            };
            let (_, read) = older.read::<JournalEntry>(&message).expect(line);
            match read.entry {
                Entry::Command {
                    command: Command::Edit(edit),
                    ..
                } => names.push(edit.name),
                other => panic!("{other:?}"),
            }
        }
        assert_eq!(names.len(), 27);
        assert_eq!(names[..2], ["load", "load_from"]);
    }

    /// A topic whose messages lacked some fields and alternatives, and had others.
    fn older(change: impl Fn(&str) -> String) -> Topic {
        let json = serde_json::to_string(&JournalEntry::schema().whole()).expect("JSON");
        let hash = JournalEntry::schema().hash.to_string();
        let older = change(&json).replacen(&hash, "77", 1);
        Topic::of(FieldTable::parse(older.as_bytes()).expect("a table"))
    }

    /// Decisions were words in the field that is an enum now.
    #[test]
    fn decisions_in_words_are_typed() {
        let json = |message: &str| {
            let schema = JournalEntry::schema().whole();
            let json = serde_json::to_string(&schema).expect("JSON");
            let typed = r#"{"name":"what","type":"Decision"}"#;
            assert!(json.contains(typed), "{json}");
            json.replace(typed, &format!(r#"{{"name":"what","type":"{message}"}}"#))
        };
        let older = older(|_| json("String"));
        for (words, typed) in [
            ("the painting goes on", Decision::Resumed),
            (
                "model dab proposed",
                Decision::LighterModel {
                    model: "dab".into(),
                },
            ),
            (
                "none that is known",
                Decision::Words {
                    words: "none that is known".into(),
                },
            ),
        ] {
            let tagged = |tag: u32, text: &str| {
                let length = (text.len() as u64).to_le_bytes();
                [&tag.to_le_bytes()[..], &length, text.as_bytes()].concat()
            };
            let mut bytes = message(&entry());
            bytes.truncate(HEADER_BYTES + 8);
            bytes.extend(tagged(4, words));
            let length = (bytes.len() - HEADER_BYTES) as u32;
            bytes[20..24].copy_from_slice(&length.to_le_bytes());
            let (_, read) = older.read::<JournalEntry>(&recorded(bytes)).expect("older");
            assert_eq!(read.entry, Entry::Decision { what: typed });
        }
    }

    fn recorded(mut bytes: Vec<u8>) -> RecordedMessage {
        bytes[4..8].copy_from_slice(&77u32.to_le_bytes());
        RecordedMessage {
            channel: 0,
            arrived_ns: 0,
            header: Header::from_bytes(&bytes).expect("whole"),
            bytes,
        }
    }

    #[test]
    fn an_older_message_is_read_and_a_newer_one_says_what_is_unknown() {
        let same = older(str::to_owned);
        let read = same.read::<JournalEntry>(&recorded(message(&entry())));
        assert_eq!(read.expect("older").1, entry());
        // That version had no field `index`: it is 0 here.
        let field = r#"{"name":"index","type":"u64"},"#;
        let lacking = older(|json| {
            assert!(json.contains(field), "{json}");
            json.replace(field, "")
        });
        let mut bytes = message(&entry());
        bytes.drain(HEADER_BYTES..HEADER_BYTES + 8);
        let length = (bytes.len() - HEADER_BYTES) as u32;
        bytes[20..24].copy_from_slice(&length.to_le_bytes());
        let read = lacking.read::<JournalEntry>(&recorded(bytes));
        let expected = JournalEntry {
            index: 0,
            ..entry()
        };
        assert_eq!(read.expect("older").1, expected);
        let newer = older(|json| json.replace(r#""name":"Begin""#, r#""name":"Commence""#));
        let fault = newer.read::<JournalEntry>(&recorded(message(&entry())));
        let fault = fault.expect_err("unknown").to_string();
        assert!(fault.contains("Commence"), "{fault}");
        let fault = same.read::<BrushState>(&recorded(message(&entry())));
        assert!(matches!(fault, Err(ReadError::Other { .. })));
    }
}
