//! The table of all edits, by their names.

use maulstick_types::values::{BrushName, ValueError};
use maulstick_types::{Edit, EditFault, EditFields};

#[cfg(feature = "cli")]
use super::CommandForm;
use super::{Form, PaintingEdit, StepForm};

/// A kind of edit.
#[derive(Debug)]
pub struct EditEntry {
    /// Its name.
    pub name: &'static str,
    /// Its steps in scripts.
    pub steps: &'static [StepForm],
    /// Words of the command line that means the example.
    pub arguments: Option<&'static [&'static str]>,
    /// Its command.
    #[cfg(feature = "cli")]
    pub command: Option<CommandForm>,
    /// One of its kind.
    pub example: fn() -> Result<Edit, ValueError>,
    /// Reads its fields.
    pub read: fn(&Edit) -> Result<Box<dyn PaintingEdit>, EditFault>,
    /// The same for another brush, where it is for one.
    pub for_brush: fn(&Edit, &BrushName) -> Result<Edit, EditFault>,
}

impl EditEntry {
    const fn of<T: Form + 'static>() -> Self {
        Self {
            name: <T as EditFields>::NAME,
            steps: T::STEPS,
            arguments: T::ARGUMENTS,
            #[cfg(feature = "cli")]
            command: T::COMMAND,
            example: || T::example().map(Into::into),
            read: |edit| Ok(Box::new(edit.read::<T>()?)),
            for_brush: |edit, brush| {
                let mut edit: T = edit.read()?;
                if let Some(own) = edit.brush_mut() {
                    own.clone_from(brush);
                }
                Ok(edit.into())
            },
        }
    }

    /// The kind of an edit.
    ///
    /// # Errors
    /// [`EditFault::Unknown`].
    pub fn find(edit: &Edit) -> Result<&'static Self, EditFault> {
        let found = entries().iter().find(|entry| entry.name == edit.name);
        found.ok_or_else(|| EditFault::Unknown(edit.name.clone()))
    }
}

macro_rules! table {
    ($($edit:ident),*) => {
        const ENTRIES: &[EditEntry] = &[$(EditEntry::of::<super::$edit>()),*];
    };
}

crate::for_each_edit!(table);

/// All kinds of edits.
#[must_use]
pub fn entries() -> &'static [EditEntry] {
    ENTRIES
}

/// An edit in executable form.
///
/// # Errors
/// [`EditFault`] for an unknown one, and for a field that is out of range.
pub fn read(edit: &Edit) -> Result<Box<dyn PaintingEdit>, EditFault> {
    (EditEntry::find(edit)?.read)(edit)
}

#[cfg(test)]
mod tests {
    use maulstick_types::command::Command;
    use maulstick_types::paint::{Entry, JournalEntry};
    use serde_json::{Value, json};

    use super::*;

    #[test]
    fn names_are_those_of_the_wire_each_once() {
        let mut names: Vec<_> = entries().iter().map(|entry| entry.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), entries().len());
        for entry in entries() {
            let edit = (entry.example)().expect("in range");
            assert_eq!(edit.name, entry.name);
            let read = (entry.read)(&edit).expect("its own fields");
            let words = read.log_words();
            assert!(words.starts_with(char::is_lowercase), "{words}");
            for code in ['{', '}', '"', '_', '['] {
                assert!(!words.contains(code), "{words} for {edit:?}");
            }
            assert!(
                !words.contains("null") && !words.contains("0000"),
                "{words}"
            );
        }
        let other = Edit::named("gild", &json!({}));
        assert_eq!(
            read(&other).err(),
            Some(EditFault::Unknown("gild".to_owned()))
        );
    }

    /// Entries of version 12, in which edits were an enum, each with the name of its edit. No line is ever changed.
    const EARLIER: &str = include_str!("../../../../msgs/types/tests/journal_12.txt");

    /// The edit of a stored entry.
    fn stored(line: &str) -> Edit {
        let hex = line.split_whitespace().last().expect("bytes");
        let byte = |at: usize| u8::from_str_radix(&hex[at..at + 2], 16).expect("hexadecimal");
        let bytes: Vec<u8> = (0..hex.len()).step_by(2).map(byte).collect();
        let (_, entry) = JournalEntry::decode_stored(&bytes).expect("read");
        match entry.entry {
            Entry::Command {
                command: Command::Edit(edit),
                ..
            } => edit,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn edits_of_earlier_journals_are_the_same_by_name_and_field() {
        let mut count = 0;
        for line in EARLIER.lines() {
            let edit = stored(line);
            let entry = EditEntry::find(&edit).expect(line);
            let example = (entry.example)().expect("in range");
            let fields = |edit: &Edit| serde_json::from_str::<Value>(&edit.fields).expect("JSON");
            let mut expected = fields(&example);
            // A light had no surroundings then, which is read as even ones.
            let light = expected
                .pointer_mut("/light")
                .and_then(Value::as_object_mut);
            let added = light.and_then(|light| light.remove("environment"));
            assert!(added.is_none_or(|added| added == "Even"), "{line}");
            assert_eq!(fields(&edit), expected, "{line}");
            (entry.read)(&edit).expect(line);
            count += 1;
        }
        assert_eq!(count, 27);
        // A changed byte of a number is detected.
        let dry = EARLIER
            .lines()
            .find(|line| line.starts_with("Dry "))
            .expect("dry");
        let [half, third] = [0.5f32, 0.3].map(|share| {
            let bytes = share.to_le_bytes().into_iter();
            bytes.map(|byte| format!("{byte:02x}")).collect::<String>()
        });
        assert_ne!(stored(&dry.replacen(&half, &third, 1)), stored(dry));
    }

    /// The places of the numbers in a value.
    fn numbers(value: &Value, path: String, found: &mut Vec<String>) {
        match value {
            Value::Number(number) if number.is_f64() => found.push(path),
            Value::Array(list) => {
                for (place, value) in list.iter().enumerate() {
                    numbers(value, format!("{path}/{place}"), found);
                }
            }
            Value::Object(object) => {
                for (name, value) in object {
                    numbers(value, format!("{path}/{name}"), found);
                }
            }
            _ => {}
        }
    }

    /// Fields without that of a name.
    fn without(fields: &Value, name: &str) -> Value {
        let mut fields = fields.clone();
        fields.as_object_mut().expect("an object").remove(name);
        fields
    }

    /// NaN is null in JSON, which an optional number alone may be: it is absent then. 1e300 is in no range.
    #[test]
    fn no_number_out_of_range_is_read() {
        let mut rejected = 0;
        for entry in entries() {
            let edit = (entry.example)().expect("in range");
            let fields: Value = serde_json::from_str(&edit.fields).expect("JSON");
            let mut places = Vec::new();
            numbers(&fields, String::new(), &mut places);
            for place in places {
                let read = |wrong: Value| {
                    let mut fields = fields.clone();
                    *fields.pointer_mut(&place).expect("its own place") = wrong;
                    (entry.read)(&Edit::named(entry.name, &fields))
                };
                assert!(read(json!(1e300)).is_err(), "{place} of {edit:?}");
                match read(Value::Null) {
                    Err(_) => rejected += 1,
                    Ok(edit) => {
                        let absent = Edit::named(entry.name, &without(&fields, &place[1..]));
                        let absent = (entry.read)(&absent).expect("optional");
                        assert_eq!(format!("{edit:?}"), format!("{absent:?}"), "{place}");
                    }
                }
            }
        }
        assert!(rejected > 12, "{rejected}");
    }
}
