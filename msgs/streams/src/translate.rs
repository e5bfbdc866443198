//! Messages of other versions: a value that one field table gave, as the body that another one has.
//!
//! Fields and alternatives are found by name. What the value lacks is 0, none or empty; what the table does not have is left
//! out. A text where the table has an enum with an alternative [`WORDS`] is that alternative: an earlier version had in words
//! what is typed now, and reads them itself ([`maulstick_types::wire::worded`]).

use std::sync::Arc;

use maulstick_types::{DecodeError, Header, Message, decode};

use crate::field_table::{Definition, FieldTable, TableError, Type, TypedField};
use crate::recording::{RecordedMessage, Topic};
use crate::value::{Fields, Value};

/// Name of the alternative for words, and of its field.
const WORDS: [&str; 2] = ["Words", "words"];

/// Deepest nesting of what is filled in: a table may refer to itself.
const DEEPEST_NESTING: usize = 32;

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

impl FieldTable {
    /// The body that has a value.
    ///
    /// # Errors
    /// [`TableError::Invalid`] where a value is of another type, or an alternative is not known.
    pub fn encode(&self, value: &Value) -> Result<Vec<u8>, TableError> {
        let mut writer = Writer {
            definitions: &self.definitions,
            bytes: Vec::new(),
        };
        writer.value(&Type::Defined(self.message), Some(value), 0)?;
        Ok(writer.bytes)
    }
}

struct Writer<'a> {
    definitions: &'a [Definition],
    bytes: Vec<u8>,
}

impl Writer<'_> {
    fn put(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    fn length(&mut self, length: usize) {
        self.put(&(length as u64).to_le_bytes());
    }

    fn value(&mut self, of: &Type, value: Option<&Value>, depth: usize) -> Result<(), TableError> {
        if depth > DEEPEST_NESTING {
            return Err(TableError::Json("it refers to itself".into()));
        }
        let mismatch = |value: &Value| TableError::Invalid {
            field: format!("{value:?}").chars().take(40).collect(),
            what: "of another type than in this version".into(),
        };
        match (of, value) {
            (Type::U8 | Type::Bool, value) if is_whole(value) => self.whole(value, 1),
            (Type::U16, value) if is_whole(value) => self.whole(value, 2),
            (Type::U32 | Type::I32, value) if is_whole(value) => self.whole(value, 4),
            (Type::U64 | Type::I64, value) if is_whole(value) => self.whole(value, 8),
            (Type::F32, None) => self.put(&[0; 4]),
            (Type::F32, Some(Value::Single(value))) => self.put(&value.to_le_bytes()),
            (Type::F64, None) => self.put(&[0; 8]),
            (Type::F64, Some(Value::Real(value))) => self.put(&value.to_le_bytes()),
            (Type::F64, Some(Value::Single(value))) => self.put(&f64::from(*value).to_le_bytes()),
            (Type::Text | Type::Bytes | Type::List(_), None) => self.length(0),
            (Type::Text, Some(Value::Text(text))) => {
                self.length(text.len());
                self.put(text.as_bytes());
            }
            (Type::Bytes, Some(Value::Bytes(bytes))) => {
                self.length(bytes.len());
                self.put(bytes);
            }
            (Type::List(of), Some(Value::List(list))) => {
                self.length(list.len());
                for value in list {
                    self.value(of, Some(value), depth + 1)?;
                }
            }
            (Type::Array(of, count), None) => {
                for _ in 0..*count {
                    self.value(of, None, depth + 1)?;
                }
            }
            (Type::Array(of, count), Some(Value::List(list))) => {
                for place in 0..*count {
                    self.value(of, list.get(place), depth + 1)?;
                }
            }
            (Type::Optional(_), None | Some(Value::Absent)) => self.put(&[0]),
            (Type::Optional(of), value) => {
                self.put(&[1]);
                self.value(of, value, depth + 1)?;
            }
            (Type::Defined(place), value) => {
                let definitions = self.definitions;
                self.defined(&definitions[*place], value, depth + 1)?;
            }
            (_, Some(value)) => return Err(mismatch(value)),
            (_, None) => {}
        }
        Ok(())
    }

    /// Writes a whole number, or 0 without one, in its lowest bytes.
    fn whole(&mut self, value: Option<&Value>, bytes: usize) {
        let number = match value {
            Some(Value::Unsigned(number)) => *number,
            Some(Value::Signed(number)) => number.cast_unsigned(),
            Some(Value::Flag(flag)) => u64::from(*flag),
            _ => 0,
        };
        self.put(&number.to_le_bytes()[..bytes]);
    }

    fn defined(
        &mut self,
        definition: &Definition,
        value: Option<&Value>,
        depth: usize,
    ) -> Result<(), TableError> {
        match (definition, value) {
            (Definition::Struct(fields), Some(Value::Fields(values))) => {
                self.fields(fields, values, depth)
            }
            (Definition::Struct(fields), None) => self.fields(fields, &Vec::new(), depth),
            (Definition::Enum(variants), Some(Value::Variant(name, values))) => {
                self.variant(variants, name, values, depth)
            }
            (Definition::Enum(variants), Some(Value::Text(text))) => {
                let [words, field] = WORDS;
                let has = |wanted: &str| variants.iter().any(|(own, _)| **own == *wanted);
                if has(text) || !has(words) {
                    self.variant(variants, text, &Vec::new(), depth)
                } else {
                    let fields = vec![(field.into(), Value::Text(text.clone()))];
                    self.variant(variants, words, &fields, depth)
                }
            }
            (Definition::Enum(variants), None) => {
                self.put(&[0; 4]);
                let first = variants.first().map_or(&[][..], |(_, fields)| fields);
                self.fields(first, &Vec::new(), depth)
            }
            (_, Some(value)) => Err(TableError::Invalid {
                field: format!("{value:?}").chars().take(40).collect(),
                what: "of another type than in this version".into(),
            }),
        }
    }

    fn variant(
        &mut self,
        variants: &[(Arc<str>, Vec<TypedField>)],
        name: &str,
        values: &Fields,
        depth: usize,
    ) -> Result<(), TableError> {
        let place = variants.iter().position(|(own, _)| **own == *name);
        let Some(place) = place else {
            return Err(TableError::Invalid {
                field: name.to_owned(),
                what: "no alternative that this version knows".into(),
            });
        };
        self.put(&(place as u32).to_le_bytes());
        self.fields(&variants[place].1, values, depth)
    }

    fn fields(
        &mut self,
        fields: &[TypedField],
        values: &Fields,
        depth: usize,
    ) -> Result<(), TableError> {
        fields.iter().try_for_each(|(name, of)| {
            let value = values.iter().find(|(own, _)| own == name);
            self.value(of, value.map(|(_, value)| value), depth)
        })
    }
}

/// True for a whole number or a flag, and for nothing, which stands for 0.
fn is_whole(value: Option<&Value>) -> bool {
    matches!(
        value,
        None | Some(Value::Unsigned(_) | Value::Signed(_) | Value::Flag(_))
    )
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
