//! Field tables: what a message holds, in a form that any language can read, and its hash.

use std::collections::BTreeMap;

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::wire::header::HEADER_FIELDS;

/// A type that can travel: it knows its name and describes itself to a [`TypeTable`].
pub trait Wire: Serialize + DeserializeOwned {
    /// The name used in field tables, for example `[f64; 3]` or `Pose`.
    fn type_name() -> String;
    /// Adds the definitions of this type and of those inside it.
    fn describe(table: &mut TypeTable);
}

/// A named field and the name of its type.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Field {
    /// Name of the field.
    pub name: String,
    /// Name of its type.
    #[serde(rename = "type")]
    pub ty: String,
}

/// One alternative of an enum; its tag is its place, as a u32.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Variant {
    /// Name of the alternative.
    pub name: String,
    /// Fields that follow the tag.
    pub fields: Vec<Field>,
}

/// Structure of a defined type.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Shape {
    /// Fields, one after the other, nothing between them.
    Struct(Vec<Field>),
    /// A u32 tag, then the fields of the alternative.
    Enum(Vec<Variant>),
}

/// The definitions that a message needs, by name.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct TypeTable {
    types: BTreeMap<String, Shape>,
}

impl TypeTable {
    /// Adds a definition once; `shape` may add those it refers to.
    pub fn define(&mut self, name: &str, shape: impl FnOnce(&mut Self) -> Shape) {
        if !self.types.contains_key(name) {
            self.types
                .insert(name.to_owned(), Shape::Struct(Vec::new()));
            let shape = shape(self);
            self.types.insert(name.to_owned(), shape);
        }
    }

    /// Describes `T` and returns a field of it.
    pub fn field<T: Wire>(&mut self, name: &str) -> Field {
        T::describe(self);
        Field {
            name: name.to_owned(),
            ty: T::type_name(),
        }
    }

    /// The definition called `name`.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&Shape> {
        self.types.get(name)
    }
}

/// A message's field table and the hash that its header carries.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Schema {
    /// Name of the message.
    pub name: String,
    /// FNV-1a of [`Schema::canonical`]; of a message of a contract, of its first version.
    pub hash: u32,
    /// All types, the message itself among them.
    pub types: TypeTable,
}

/// Encoding of bodies, for readers without this program.
pub const ENCODING: &str = "little endian, fixed width, no padding; Vec and String: u64 length; enum: u32 tag, \
                            the place of its variant; Option and bool: u8";

/// All that it takes to decode a message: its header, its field table, and how both are encoded.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct WholeSchema<'a> {
    /// The field table.
    #[serde(flatten)]
    pub schema: &'a Schema,
    /// Fields before those of the message.
    pub header: Vec<Field>,
    /// [`ENCODING`].
    pub encoding: &'static str,
}

impl Schema {
    /// The schema with what is the same for all messages.
    #[must_use]
    pub fn whole(&self) -> WholeSchema<'_> {
        WholeSchema {
            schema: self,
            header: header_fields(),
            encoding: ENCODING,
        }
    }

    /// The schema of `T`.
    #[must_use]
    pub fn of<T: Wire>() -> Self {
        let mut types = TypeTable::default();
        T::describe(&mut types);
        let name = T::type_name();
        let hash = fnv1a(canonical(&name, &types).as_bytes());
        Self { name, hash, types }
    }

    /// The schema of `T`, a message of a contract: its hash stays that of its first version.
    #[must_use]
    pub fn frozen<T: Wire>(hash: u32) -> Self {
        Self {
            hash,
            ..Self::of::<T>()
        }
    }

    /// The text that is hashed: the message's name, then every type in order of name.
    #[must_use]
    pub fn canonical(&self) -> String {
        canonical(&self.name, &self.types)
    }
}

/// The header's [`HEADER_FIELDS`].
#[must_use]
pub fn header_fields() -> Vec<Field> {
    let fields = HEADER_FIELDS.iter().map(|(name, ty)| Field {
        name: (*name).to_owned(),
        ty: (*ty).to_owned(),
    });
    fields.collect()
}

fn canonical(name: &str, table: &TypeTable) -> String {
    let mut text = format!("{name};");
    let fields = |fields: &[Field]| {
        fields
            .iter()
            .map(|f| format!("{}:{}", f.name, f.ty))
            .collect::<Vec<_>>()
            .join(",")
    };
    for (name, shape) in &table.types {
        match shape {
            Shape::Struct(members) => {
                text.push_str(&format!("{name}{{{}}}", fields(members)));
            }
            Shape::Enum(variants) => {
                text.push_str(&format!("{name}<"));
                for variant in variants {
                    text.push_str(&format!("{}{{{}}}", variant.name, fields(&variant.fields)));
                }
                text.push('>');
            }
        }
    }
    text
}

/// FNV-1a, 32 bits.
pub(crate) fn fnv1a(bytes: &[u8]) -> u32 {
    bytes.iter().fold(0x811c_9dc5, |hash, byte| {
        (hash ^ u32::from(*byte)).wrapping_mul(0x0100_0193)
    })
}

macro_rules! primitive {
    ($($ty:ty),*) => {
        $(
            impl Wire for $ty {
                fn type_name() -> String {
                    stringify!($ty).to_owned()
                }
                fn describe(_: &mut TypeTable) {}
            }
        )*
    };
}

primitive!(u8, u16, u32, u64, i32, i64, f32, f64, bool, String);

impl Wire for serde_bytes::ByteBuf {
    fn type_name() -> String {
        "Vec<u8>".to_owned()
    }
    fn describe(_: &mut TypeTable) {}
}

impl<T: Wire> Wire for Vec<T> {
    fn type_name() -> String {
        format!("Vec<{}>", T::type_name())
    }
    fn describe(table: &mut TypeTable) {
        T::describe(table);
    }
}

impl<T: Wire> Wire for Option<T> {
    fn type_name() -> String {
        format!("Option<{}>", T::type_name())
    }
    fn describe(table: &mut TypeTable) {
        T::describe(table);
    }
}

macro_rules! array {
    ($($n:literal),*) => {
        $(
            impl<T: Wire> Wire for [T; $n] {
                fn type_name() -> String {
                    format!("[{}; {}]", T::type_name(), $n)
                }
                fn describe(table: &mut TypeTable) {
                    T::describe(table);
                }
            }
        )*
    };
}

array!(2, 3, 4, 6);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fnv1a_matches_the_published_vectors() {
        assert_eq!(fnv1a(b""), 0x811c_9dc5);
        assert_eq!(fnv1a(b"a"), 0xe40c_292c);
        assert_eq!(fnv1a(b"foobar"), 0xbf9c_f968);
    }
}
