//! Field tables: bodies of messages decoded without knowing their types beforehand.
//!
//! A table comes from this program's own messages or from the schema in a recording of another version; both are read from
//! the same JSON. What a newer version appended to a message is left alone.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::Deserialize;

use crate::wire::schema::Schema;

use super::value::{Fields, Value};

mod json_schema;

/// Deepest nesting of a value: a table may refer to itself.
const DEEPEST_NESTING: usize = 32;

/// Reason why a table or a body cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TableError {
    /// The JSON is no table.
    #[error("the schema is malformed: {0}")]
    Json(String),
    /// A type that is not defined.
    #[error("the schema has no type '{0}'")]
    Type(String),
    /// The body ends within a field.
    #[error("the message ends within '{field}'")]
    Short {
        /// The field.
        field: String,
    },
    /// A value that its type cannot have.
    #[error("'{field}' is {what}")]
    Invalid {
        /// The field.
        field: String,
        /// The value, in words.
        what: String,
    },
}

/// A type, as a body has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Type {
    U8,
    U16,
    U32,
    U64,
    I32,
    I64,
    F32,
    F64,
    Bool,
    Text,
    Bytes,
    List(Box<Self>),
    Array(Box<Self>, usize),
    Optional(Box<Self>),
    /// Place of a definition.
    Defined(usize),
}

/// A field: its name and its type.
pub(crate) type TypedField = (Arc<str>, Type);

/// An alternative of an enum.
type TypedVariant = (Arc<str>, Vec<TypedField>);

/// A definition.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Definition {
    Struct(Vec<TypedField>),
    Enum(Vec<TypedVariant>),
}

/// True for an enum whose alternatives have no fields: its values are texts.
fn is_plain(variants: &[TypedVariant]) -> bool {
    variants.iter().all(|(_, fields)| fields.is_empty())
}

/// The field table of a message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldTable {
    name: String,
    hash: u32,
    pub(crate) definitions: Vec<Definition>,
    /// Place of the message among them.
    pub(crate) message: usize,
}

/// A table in JSON, as `maulstick schema --json` and recordings have it.
#[derive(Deserialize)]
struct Written {
    name: String,
    hash: u32,
    types: BTreeMap<String, WrittenShape>,
}

#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum WrittenShape {
    Struct(Vec<WrittenField>),
    Enum(Vec<WrittenVariant>),
}

#[derive(Deserialize)]
struct WrittenField {
    name: String,
    #[serde(rename = "type")]
    ty: String,
}

#[derive(Deserialize)]
struct WrittenVariant {
    name: String,
    fields: Vec<WrittenField>,
}

impl FieldTable {
    /// The table in JSON.
    ///
    /// # Errors
    /// [`TableError`] where it is none.
    pub fn parse(json: &[u8]) -> Result<Self, TableError> {
        let json_fault = |error: serde_json::Error| TableError::Json(error.to_string());
        let written: Written = serde_json::from_slice(json).map_err(json_fault)?;
        let places: BTreeMap<&str, usize> =
            written.types.keys().map(String::as_str).zip(0..).collect();
        let typed = |fields: &[WrittenField]| {
            fields
                .iter()
                .map(|field| Ok((field.name.as_str().into(), type_of(&field.ty, &places, 0)?)))
                .collect::<Result<Vec<TypedField>, TableError>>()
        };
        let mut definitions = Vec::new();
        for shape in written.types.values() {
            definitions.push(match shape {
                WrittenShape::Struct(fields) => Definition::Struct(typed(fields)?),
                WrittenShape::Enum(variants) => {
                    let variant =
                        |own: &WrittenVariant| Ok((own.name.as_str().into(), typed(&own.fields)?));
                    let variants = variants.iter().map(variant);
                    Definition::Enum(variants.collect::<Result<_, TableError>>()?)
                }
            });
        }
        let message = places.get(written.name.as_str()).copied();
        let message = message.ok_or_else(|| TableError::Type(written.name.clone()))?;
        Ok(Self {
            hash: written.hash,
            name: written.name,
            definitions,
            message,
        })
    }

    /// The table of a message of this program.
    ///
    /// # Errors
    /// [`TableError`]; its own are readable, as a test shows.
    pub fn of(schema: &Schema) -> Result<Self, TableError> {
        let json = serde_json::to_vec(&schema.whole());
        Self::parse(&json.map_err(|error| TableError::Json(error.to_string()))?)
    }

    /// Name of the message.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Hash that its messages carry.
    #[must_use]
    pub fn hash(&self) -> u32 {
        self.hash
    }

    /// True if a message may have a value at this path, as [`Value::at`] reads it: of several alternatives one has.
    #[must_use]
    pub fn has(&self, path: &str) -> bool {
        let parts: Vec<&str> = path.split('.').collect();
        self.type_has(&Type::Defined(self.message), &parts)
    }

    fn type_has(&self, of: &Type, path: &[&str]) -> bool {
        let Some((part, rest)) = path.split_first() else {
            return true;
        };
        match of {
            Type::Optional(of) => self.type_has(of, path),
            Type::List(of) => part.parse::<usize>().is_ok() && self.type_has(of, rest),
            Type::Array(of, count) => {
                part.parse().is_ok_and(|place: usize| place < *count) && self.type_has(of, rest)
            }
            Type::Defined(place) => match &self.definitions[*place] {
                Definition::Struct(fields) => self.fields_have(fields, path),
                Definition::Enum(variants) if is_plain(variants) => false,
                Definition::Enum(variants) => variants.iter().any(|(name, fields)| {
                    let named = **name == **part;
                    let below = rest.is_empty() || self.fields_have(fields, rest);
                    (named && below) || self.fields_have(fields, path)
                }),
            },
            _ => false,
        }
    }

    fn fields_have(&self, fields: &[TypedField], path: &[&str]) -> bool {
        let Some((part, rest)) = path.split_first() else {
            return true;
        };
        let mut own = fields.iter().filter(|(name, _)| **name == **part);
        own.any(|(_, of)| self.type_has(of, rest))
    }

    /// Decodes a body; bytes behind its last field are left alone.
    ///
    /// # Errors
    /// [`TableError`] where it is too short or has a value that its type cannot have.
    pub fn decode(&self, body: &[u8]) -> Result<Value, TableError> {
        let mut reader = Reader {
            definitions: &self.definitions,
            rest: body,
            path: Vec::new(),
            budget: 64 * (body.len() + 64),
        };
        reader.value(&Type::Defined(self.message))
    }
}

/// The type that a text names.
fn type_of(text: &str, places: &BTreeMap<&str, usize>, depth: usize) -> Result<Type, TableError> {
    let unknown = || TableError::Type(text.chars().take(80).collect());
    if depth > DEEPEST_NESTING {
        return Err(unknown());
    }
    let inner = |text: &str| Ok(Box::new(type_of(text, places, depth + 1)?));
    let within = |before: &str, after: &str| text.strip_prefix(before)?.strip_suffix(after);
    if let Some(of) = within("Vec<", ">") {
        return match of {
            "u8" => Ok(Type::Bytes),
            of => Ok(Type::List(inner(of)?)),
        };
    }
    if let Some(of) = within("Option<", ">") {
        return Ok(Type::Optional(inner(of)?));
    }
    if let Some(of) = within("[", "]") {
        let (of, count) = of.rsplit_once("; ").ok_or_else(unknown)?;
        return Ok(Type::Array(
            inner(of)?,
            count.parse().map_err(|_| unknown())?,
        ));
    }
    Ok(match text {
        "u8" => Type::U8,
        "u16" => Type::U16,
        "u32" => Type::U32,
        "u64" => Type::U64,
        "i32" => Type::I32,
        "i64" => Type::I64,
        "f32" => Type::F32,
        "f64" => Type::F64,
        "bool" => Type::Bool,
        "String" => Type::Text,
        name => Type::Defined(*places.get(name).ok_or_else(unknown)?),
    })
}

/// A body that is being read.
struct Reader<'a> {
    definitions: &'a [Definition],
    rest: &'a [u8],
    /// Names of the fields that lead here.
    path: Vec<Arc<str>>,
    /// Values that may still come: a hostile table has some without bytes.
    budget: usize,
}

impl<'a> Reader<'a> {
    fn field(&self) -> String {
        self.path.join(".")
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8], TableError> {
        let Some((taken, rest)) = self.rest.split_at_checked(count) else {
            return Err(TableError::Short {
                field: self.field(),
            });
        };
        self.rest = rest;
        Ok(taken)
    }

    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], TableError> {
        let mut bytes = [0; N];
        bytes.copy_from_slice(self.take(N)?);
        Ok(bytes)
    }

    /// A length, which is never more than what is left: no element is without bytes.
    fn length(&mut self) -> Result<usize, TableError> {
        let length = u64::from_le_bytes(self.bytes()?);
        let fits = usize::try_from(length)
            .ok()
            .filter(|length| *length <= self.rest.len());
        fits.ok_or_else(|| TableError::Short {
            field: self.field(),
        })
    }

    fn flag(&mut self) -> Result<bool, TableError> {
        match self.bytes::<1>()? {
            [0] => Ok(false),
            [1] => Ok(true),
            [other] => Err(TableError::Invalid {
                field: self.field(),
                what: format!("{other}, and neither 0 nor 1"),
            }),
        }
    }

    fn several(&mut self, of: &Type, count: usize) -> Result<Value, TableError> {
        if count > self.rest.len() {
            return Err(TableError::Short {
                field: self.field(),
            });
        }
        (0..count)
            .map(|_| self.value(of))
            .collect::<Result<_, _>>()
            .map(Value::List)
    }

    fn fields(&mut self, fields: &[TypedField]) -> Result<Fields, TableError> {
        if self.path.len() > DEEPEST_NESTING {
            return Err(TableError::Invalid {
                field: self.field(),
                what: "nested too deeply".into(),
            });
        }
        let mut read = Vec::with_capacity(fields.len());
        for (name, of) in fields {
            self.path.push(Arc::clone(name));
            read.push((Arc::clone(name), self.value(of)?));
            self.path.pop();
        }
        Ok(read)
    }

    fn value(&mut self, of: &Type) -> Result<Value, TableError> {
        self.budget = self
            .budget
            .checked_sub(1)
            .ok_or_else(|| TableError::Invalid {
                field: self.field(),
                what: "more than its bytes can hold".into(),
            })?;
        Ok(match of {
            Type::U8 => Value::Unsigned(u8::from_le_bytes(self.bytes()?).into()),
            Type::U16 => Value::Unsigned(u16::from_le_bytes(self.bytes()?).into()),
            Type::U32 => Value::Unsigned(u32::from_le_bytes(self.bytes()?).into()),
            Type::U64 => Value::Unsigned(u64::from_le_bytes(self.bytes()?)),
            Type::I32 => Value::Signed(i32::from_le_bytes(self.bytes()?).into()),
            Type::I64 => Value::Signed(i64::from_le_bytes(self.bytes()?)),
            Type::F32 => Value::Single(f32::from_le_bytes(self.bytes()?)),
            Type::F64 => Value::Real(f64::from_le_bytes(self.bytes()?)),
            Type::Bool => Value::Flag(self.flag()?),
            Type::Text => {
                let length = self.length()?;
                let text = String::from_utf8(self.take(length)?.to_vec());
                Value::Text(text.map_err(|_| TableError::Invalid {
                    field: self.field(),
                    what: "no UTF-8".into(),
                })?)
            }
            Type::Bytes => {
                let length = self.length()?;
                Value::Bytes(self.take(length)?.to_vec())
            }
            Type::List(of) => {
                let length = self.length()?;
                self.several(of, length)?
            }
            Type::Array(of, count) => self.several(of, *count)?,
            Type::Optional(of) => {
                if self.flag()? {
                    self.value(of)?
                } else {
                    Value::Absent
                }
            }
            Type::Defined(place) => match &self.definitions[*place] {
                Definition::Struct(fields) => Value::Fields(self.fields(fields)?),
                Definition::Enum(variants) => {
                    let tag = u32::from_le_bytes(self.bytes()?);
                    let variant = variants.get(tag as usize);
                    let (name, fields) = variant.ok_or_else(|| TableError::Invalid {
                        field: self.field(),
                        what: format!("alternative {tag} of {}", variants.len()),
                    })?;
                    if is_plain(variants) {
                        Value::Text(name.to_string())
                    } else {
                        Value::Variant(Arc::clone(name), self.fields(fields)?)
                    }
                }
            },
        })
    }
}

#[cfg(test)]
mod tests;
