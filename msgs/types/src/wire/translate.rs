//! Values of other versions as bodies of this one.
//!
//! Fields and alternatives are found by name. What the value lacks is 0, none or empty; what the table does not have is left
//! out. Two values have changed their kind since: a text where the table has an enum with an alternative [`WORDS`] is that
//! alternative, for an earlier version had in words what is typed now ([`super::worded`]); and an alternative where the table
//! has an [`EDIT`] is its name and its fields, for edits were an enum.

use std::sync::Arc;

use serde_json::json;

use super::field_table::{Definition, FieldTable, TableError, Type, TypedField};
use super::value::{Fields, Value};

/// Name of the alternative for words, and of its field.
const WORDS: [&str; 2] = ["Words", "words"];
/// Fields of an edit.
const EDIT: [&str; 2] = ["name", "fields"];

/// Deepest nesting of what is filled in: a table may refer to itself.
const DEEPEST: usize = 32;

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
        if depth > DEEPEST {
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
            (Definition::Struct(fields), Some(Value::Variant(name, values)))
                if fields.iter().map(|(own, _)| &**own).eq(EDIT) =>
            {
                let own = values.first().map_or(&Value::Absent, |(_, value)| value);
                let values = [snake_case(name), as_json(own).to_string()];
                let values = EDIT
                    .map(Into::into)
                    .into_iter()
                    .zip(values.map(Value::Text));
                self.fields(fields, &values.collect(), depth)
            }
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

/// A type's name as an edit's: `LoadFrom` is `load_from`.
fn snake_case(name: &str) -> String {
    let mut words = String::new();
    for (place, letter) in name.char_indices() {
        if letter.is_uppercase() && place > 0 {
            words.push('_');
        }
        words.extend(letter.to_lowercase());
    }
    words
}

/// A value as serde writes its type in JSON, each number exactly.
fn as_json(value: &Value) -> serde_json::Value {
    let object = |fields: &Fields| {
        let fields = fields.iter();
        fields
            .map(|(name, value)| (name.to_string(), as_json(value)))
            .collect()
    };
    match value {
        Value::Unsigned(number) => json!(number),
        Value::Signed(number) => json!(number),
        Value::Single(number) => json!(f64::from(*number)),
        Value::Real(number) => json!(number),
        Value::Flag(flag) => json!(flag),
        Value::Text(text) => json!(text),
        Value::Bytes(bytes) => json!(bytes),
        Value::List(list) => list.iter().map(as_json).collect(),
        Value::Absent => serde_json::Value::Null,
        Value::Fields(fields) => serde_json::Value::Object(object(fields)),
        Value::Variant(name, fields) if fields.is_empty() => json!(**name),
        Value::Variant(name, fields) => {
            json!({ &**name: serde_json::Value::Object(object(fields)) })
        }
    }
}

/// True for a whole number or a flag, and for nothing, which stands for 0.
fn is_whole(value: Option<&Value>) -> bool {
    matches!(
        value,
        None | Some(Value::Unsigned(_) | Value::Signed(_) | Value::Flag(_))
    )
}
