//! Fields of an edit out of JSON. They are read as any other message is, numbers in SI, and not as a person writes them.

use serde::de::value::{MapDeserializer, SeqDeserializer};
use serde::de::{
    Deserialize, DeserializeSeed, Deserializer, EnumAccess, Error as _, IntoDeserializer,
    VariantAccess, Visitor,
};
use serde_json::{Error, Map, Value};

/// Reads a struct.
///
/// # Errors
/// Those of its fields.
pub(super) fn read<'de, T: Deserialize<'de>>(object: &'de Map<String, Value>) -> Result<T, Error> {
    let fields = object
        .iter()
        .map(|(key, value)| (key.as_str(), Field(value)));
    T::deserialize(Fields(MapDeserializer::new(fields)))
}

/// Path of the first field of `given` that `own`, which was read out of it, does not have.
pub(super) fn unknown(given: &Value, own: &Value) -> Option<String> {
    let below = |key: &str, rest: String| format!("{key}.{rest}");
    match (given, own) {
        (Value::Object(given), Value::Object(own)) => given.iter().find_map(|(key, value)| {
            let Some(known) = own.get(key) else {
                return Some(key.clone());
            };
            Some(below(key, unknown(value, known)?))
        }),
        (Value::Array(given), Value::Array(own)) => {
            let mut pairs = given.iter().zip(own).enumerate();
            pairs.find_map(|(place, (value, known))| {
                Some(below(&place.to_string(), unknown(value, known)?))
            })
        }
        _ => None,
    }
}

/// A struct.
struct Fields<D>(D);

impl<'de, D: Deserializer<'de>> Deserializer<'de> for Fields<D> {
    type Error = D::Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, D::Error> {
        self.0.deserialize_any(visitor)
    }

    fn is_human_readable(&self) -> bool {
        false
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map struct enum identifier ignored_any
    }
}

/// A value.
#[derive(Clone, Copy)]
struct Field<'de>(&'de Value);

impl<'de> IntoDeserializer<'de, Error> for Field<'de> {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

impl<'de> Deserializer<'de> for Field<'de> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.0 {
            Value::Null => visitor.visit_unit(),
            Value::Bool(flag) => visitor.visit_bool(*flag),
            Value::Number(number) => number.deserialize_any(visitor),
            Value::String(text) => visitor.visit_borrowed_str(text),
            Value::Array(list) => {
                SeqDeserializer::new(list.iter().map(Field)).deserialize_any(visitor)
            }
            Value::Object(object) => {
                let fields = object
                    .iter()
                    .map(|(key, value)| (key.as_str(), Field(value)));
                MapDeserializer::new(fields).deserialize_any(visitor)
            }
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        match self.0 {
            Value::Null => visitor.visit_none(),
            _ => visitor.visit_some(self),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        visitor.visit_enum(self)
    }

    fn is_human_readable(&self) -> bool {
        false
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct seq tuple
        tuple_struct map struct identifier ignored_any
    }
}

/// An alternative: a text if it has no fields, else an object of its name alone.
impl<'de> EnumAccess<'de> for Field<'de> {
    type Error = Error;
    type Variant = Alternative<'de>;

    fn variant_seed<S: DeserializeSeed<'de>>(
        self,
        seed: S,
    ) -> Result<(S::Value, Alternative<'de>), Error> {
        let (name, fields) = match self.0 {
            Value::String(name) => (name, None),
            Value::Object(object) if object.len() == 1 => {
                let only = object.iter().next();
                let (name, fields) = only.ok_or_else(|| Error::custom("no alternative"))?;
                (name, Some(Field(fields)))
            }
            _ => return Err(Error::custom("no alternative")),
        };
        let name: serde::de::value::StrDeserializer<'_, Error> = name.as_str().into_deserializer();
        Ok((seed.deserialize(name)?, Alternative(fields)))
    }
}

/// The fields of an alternative.
struct Alternative<'de>(Option<Field<'de>>);

impl<'de> Alternative<'de> {
    fn fields(self) -> Result<Field<'de>, Error> {
        self.0
            .ok_or_else(|| Error::custom("an alternative lacks its fields"))
    }
}

impl<'de> VariantAccess<'de> for Alternative<'de> {
    type Error = Error;

    fn unit_variant(self) -> Result<(), Error> {
        match self.0 {
            None => Ok(()),
            Some(_) => Err(Error::custom("an alternative has no fields")),
        }
    }

    fn newtype_variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<S::Value, Error> {
        seed.deserialize(self.fields()?)
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Error> {
        self.fields()?.deserialize_any(visitor)
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.fields()?.deserialize_any(visitor)
    }
}
