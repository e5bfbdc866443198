//! Field tables: bodies of messages decoded without knowing their types beforehand.
//!
//! A table comes from this program's own messages or from the schema in a recording of another version; both are read from
//! the same JSON. What a newer version appended to a message is left alone.

use std::collections::BTreeMap;
use std::sync::Arc;

use maulstick_types::wire::schema::Schema;
use serde::Deserialize;

use crate::value::{Fields, Value};

/// Deepest nesting of a value: a table may refer to itself.
const DEEPEST: usize = 32;

/// Why a table or a body cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TableError {
    /// The JSON is no table.
    #[error("the schema is no field table: {0}")]
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
enum Type {
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
type TypedField = (Arc<str>, Type);

/// A definition.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Definition {
    Struct(Vec<TypedField>),
    Enum(Vec<(Arc<str>, Vec<TypedField>)>),
}

/// The field table of a message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldTable {
    name: String,
    hash: u32,
    definitions: Vec<Definition>,
    message: usize,
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

    /// Decodes a body; bytes behind its last field are left alone.
    ///
    /// # Errors
    /// [`TableError`] where it is too short or has a value that its type cannot have.
    pub fn decode(&self, body: &[u8]) -> Result<Value, TableError> {
        let mut reader = Reader {
            definitions: &self.definitions,
            rest: body,
            path: Vec::new(),
        };
        reader.value(&Type::Defined(self.message))
    }
}

/// The type that a text names.
fn type_of(text: &str, places: &BTreeMap<&str, usize>, depth: usize) -> Result<Type, TableError> {
    let unknown = || TableError::Type(text.chars().take(80).collect());
    if depth > DEEPEST {
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
        (0..count)
            .map(|_| self.value(of))
            .collect::<Result<_, _>>()
            .map(Value::List)
    }

    fn fields(&mut self, fields: &[TypedField]) -> Result<Fields, TableError> {
        if self.path.len() > DEEPEST {
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
            Type::Optional(of) => match self.flag()? {
                true => self.value(of)?,
                false => Value::Absent,
            },
            Type::Defined(place) => match &self.definitions[*place] {
                Definition::Struct(fields) => Value::Fields(self.fields(fields)?),
                Definition::Enum(variants) => {
                    let tag = u32::from_le_bytes(self.bytes()?);
                    let variant = variants.get(tag as usize);
                    let (name, fields) = variant.ok_or_else(|| TableError::Invalid {
                        field: self.field(),
                        what: format!("alternative {tag} of {}", variants.len()),
                    })?;
                    Value::Variant(Arc::clone(name), self.fields(fields)?)
                }
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use std::sync::LazyLock;

    use maulstick_types::stylus::{StylusPose, StylusSample};
    use maulstick_types::{CATALOGUE, Flags, Message as _, Origin, encode};
    use proptest::prelude::*;

    use super::*;

    /// A body of a sample: what a message holds behind its header.
    fn body(sample: &StylusSample) -> Vec<u8> {
        let origin = Origin {
            source: 1,
            epoch: 1,
        };
        let bytes = encode(&origin, Flags::NONE, 0, 0, 0, sample).expect("encoded");
        bytes[48..].to_vec()
    }

    fn sample() -> StylusSample {
        StylusSample {
            pose: StylusPose::Contact {
                point_m: [0.25, -0.5, 0.0],
                tilt_rad: [0.1, 0.2],
                twist_rad: 3.0,
                pressure: 0.75,
            },
            switches: 5,
            in_range: true,
            ..StylusSample::away()
        }
    }

    #[test]
    fn every_message_of_the_rig_has_a_readable_table() {
        for entry in CATALOGUE {
            let schema = (entry.schema)();
            let table = FieldTable::of(schema).expect(entry.name);
            assert_eq!((table.name(), table.hash()), (entry.name, schema.hash));
        }
    }

    #[test]
    fn a_body_is_read_by_name() {
        let table = FieldTable::of(StylusSample::schema()).expect("a table");
        let mut bytes = body(&sample());
        let value = table.decode(&bytes).expect("read");
        let json = serde_json::to_value(&value).expect("JSON");
        assert_eq!(json["pose"]["Contact"]["point_m"][1], -0.5);
        assert_eq!(json["pose"]["Contact"]["pressure"], 0.75);
        assert_eq!(
            (&json["switches"], &json["in_range"]),
            (&5.into(), &true.into())
        );
        bytes.extend([1, 2, 3]);
        assert_eq!(
            table.decode(&bytes),
            Ok(value),
            "what a newer version appends"
        );
        for cut in 0..body(&sample()).len() {
            assert!(table.decode(&bytes[..cut]).is_err(), "{cut}");
        }
    }

    #[test]
    fn what_is_wrong_is_told_with_its_field() {
        let table = FieldTable::of(StylusSample::schema()).expect("a table");
        let bytes = body(&sample());
        let told = |bytes: &[u8]| table.decode(bytes).expect_err("wrong").to_string();
        assert_eq!(told(&bytes[..2]), "the message ends within 'senses'");
        assert_eq!(told(&bytes[..20]), "the message ends within 'pose.point_m'");
        let mut other = bytes.clone();
        other[4] = 9;
        assert_eq!(told(&other), "'pose' is alternative 9 of 2");
        let mut flag = bytes;
        *flag.last_mut().expect("a byte") = 7;
        assert_eq!(told(&flag), "'in_range' is 7, and neither 0 nor 1");
    }

    #[test]
    fn a_table_that_refers_to_itself_or_to_nothing_is_told() {
        let table = |types: &str| {
            let json = format!(r#"{{"name": "A", "hash": 1, "types": {types}}}"#);
            FieldTable::parse(json.as_bytes())
        };
        let own = table(r#"{"A": {"struct": [{"name": "a", "type": "A"}]}}"#).expect("a table");
        assert!(own.decode(&[]).is_err());
        let list =
            table(r#"{"A": {"struct": []}, "B": {"struct": [{"name": "a", "type": "Vec<A>"}]}}"#);
        assert!(list.is_ok());
        let nothing = table(r#"{"A": {"struct": [{"name": "a", "type": "Vec<C>"}]}}"#);
        assert_eq!(nothing, Err(TableError::Type("C".into())));
        assert_eq!(table("{}"), Err(TableError::Type("A".into())));
        let deep = format!("{}u8{}", "Vec<".repeat(99), ">".repeat(99));
        let deep = table(&format!(
            r#"{{"A": {{"struct": [{{"name": "a", "type": "{deep}"}}]}}}}"#
        ));
        assert!(deep.is_err());
        assert!(FieldTable::parse(b"[1]").is_err());
    }

    static TABLES: LazyLock<Vec<FieldTable>> = LazyLock::new(|| {
        let tables = CATALOGUE
            .iter()
            .map(|entry| FieldTable::of((entry.schema)()));
        tables.collect::<Result<_, _>>().expect("tables")
    });

    proptest! {
        #[test]
        fn no_bytes_make_it_panic_or_take_much_memory(
            place in 0..CATALOGUE.len(),
            bytes in prop::collection::vec(any::<u8>(), 0..400),
        ) {
            TABLES[place].decode(&bytes).ok();
        }
    }
}
