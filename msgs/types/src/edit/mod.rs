//! Edits of a painting on their way: a name and fields, whose meaning the painting alone knows.
//!
//! So no message, journal or recording changes when there is an edit more, or when one gets a further field with a
//! default.

mod fields;

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use crate::wire::define::wire_struct;

/// The name of an edit has at most this many bytes.
pub const EDIT_NAME_MAX: usize = 64;

wire_struct! {
    /// An edit of a painting.
    #[serde(try_from = "EditParts")]
    pub struct Edit {
        /// Name of its kind, such as `load_from`.
        pub name: String,
        /// Its fields, a JSON object with SI units.
        pub fields: String,
    }
}

/// An edit as it is decoded.
#[derive(serde::Deserialize)]
struct EditParts {
    name: String,
    fields: String,
}

impl TryFrom<EditParts> for Edit {
    type Error = EditFault;

    fn try_from(EditParts { name, fields }: EditParts) -> Result<Self, EditFault> {
        let is_letter = |c: char| c == '_' || c.is_ascii_lowercase() || c.is_ascii_digit();
        if name.is_empty() || name.len() > EDIT_NAME_MAX || !name.chars().all(is_letter) {
            let name = name.chars().take(EDIT_NAME_MAX).collect();
            return Err(EditFault::Unknown(name));
        }
        let edit = Self { name, fields };
        edit.object()?;
        Ok(edit)
    }
}

/// Reason why this program cannot apply an edit.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EditFault {
    /// A name that this program does not know.
    #[error("there is no edit called '{0}' in this version of the program")]
    Unknown(String),
    /// A field that this kind of edit does not have.
    #[error("the edit '{name}' has no field '{field}'")]
    NoField {
        /// Name of the edit.
        name: String,
        /// Path of the field, its parts joined by dots.
        field: String,
    },
    /// A value out of range.
    #[error("{what}")]
    Fields {
        /// Name of the edit.
        name: String,
        /// The error of the value.
        what: String,
    },
}

impl EditFault {
    /// Advice to a user.
    #[must_use]
    pub fn help(&self) -> &'static str {
        match self {
            Self::Unknown(_) => "use a newer version of the program",
            Self::NoField { .. } => "leave the field out, or use a newer version of the program",
            Self::Fields { .. } => "choose a value in range",
        }
    }
}

/// The fields of one kind of edit.
pub trait EditFields: Serialize + DeserializeOwned {
    /// Name of the kind on the wire and in files; it never changes.
    const NAME: &'static str;
}

impl Edit {
    /// An edit of a name, for those who send one and do not know the painting.
    #[must_use]
    pub fn named(name: &str, fields: &Value) -> Self {
        Self {
            name: name.to_owned(),
            fields: fields.to_string(),
        }
    }

    /// True if it is of this kind.
    #[must_use]
    pub fn is<T: EditFields>(&self) -> bool {
        self.name == T::NAME
    }

    /// Its fields, if it is of this kind and they are in range.
    #[must_use]
    pub fn get<T: EditFields>(&self) -> Option<T> {
        self.is::<T>().then(|| self.read().ok()).flatten()
    }

    /// Its fields.
    ///
    /// # Errors
    /// [`EditFault`] for another kind, an unknown field and a value out of range.
    pub fn read<T: EditFields>(&self) -> Result<T, EditFault> {
        if !self.is::<T>() {
            return Err(EditFault::Unknown(self.name.clone()));
        }
        let fault = |error: serde_json::Error| self.fault(error.to_string());
        let object = self.object()?;
        let known = fields::read::<T>(&object).map_err(fault)?;
        let own = serde_json::to_value(&known).map_err(fault)?;
        match fields::unknown(&Value::Object(object), &own) {
            Some(field) => Err(EditFault::NoField {
                name: self.name.clone(),
                field,
            }),
            None => Ok(known),
        }
    }

    /// A field that is a text, a number or a flag, in words; empty where there is none.
    #[must_use]
    pub fn word(&self, field: &str) -> String {
        match self.object().unwrap_or_default().get(field) {
            Some(Value::String(text)) => text.clone(),
            Some(Value::Number(number)) => number.to_string(),
            Some(Value::Bool(flag)) => flag.to_string(),
            _ => String::new(),
        }
    }

    fn object(&self) -> Result<Map<String, Value>, EditFault> {
        serde_json::from_str(&self.fields).map_err(|error| self.fault(error.to_string()))
    }

    fn fault(&self, what: String) -> EditFault {
        EditFault::Fields {
            name: self.name.clone(),
            what,
        }
    }
}

impl<T: EditFields> From<T> for Edit {
    fn from(edit: T) -> Self {
        Self {
            name: T::NAME.to_owned(),
            // Structs of numbers and texts have a form in JSON.
            fields: serde_json::to_string(&edit).unwrap_or_default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::values::{Distance, Share};

    #[derive(Debug, PartialEq, serde::Serialize, serde::Deserialize)]
    struct Sample {
        share: Share,
        x: Distance,
        seed: u64,
        #[serde(default)]
        name: Option<String>,
        #[serde(default)]
        parts: Vec<Part>,
    }

    #[derive(Debug, PartialEq, serde::Serialize, serde::Deserialize)]
    struct Part {
        paint: String,
    }

    impl EditFields for Sample {
        const NAME: &'static str = "sample";
    }

    fn sample() -> Sample {
        Sample {
            share: Share::new(0.1).expect("in range"),
            x: Distance::new(0.1 + 0.2).expect("in range"),
            seed: u64::MAX,
            name: None,
            parts: Vec::new(),
        }
    }

    #[test]
    fn numbers_come_back_exactly() {
        let edit = Edit::from(sample());
        assert_eq!(edit.read(), Ok(sample()));
        // Another would be read as another.
        let other = edit.fields.replace("0.30000000000000004", "0.3");
        assert_ne!(other, edit.fields);
        let other = Edit {
            fields: other,
            ..edit
        };
        assert_ne!(other.read(), Ok(sample()));
    }

    #[test]
    fn fields_are_known_and_in_range() {
        let given = json!({ "share": 1.0, "x": 0.1, "seed": 3 });
        let edit = Edit::named("sample", &given);
        assert_eq!(edit.read::<Sample>().map(|own| own.seed), Ok(3));
        for (field, value) in [
            ("share", json!(2.0)),
            ("share", Value::Null),
            ("seed", json!(-1)),
        ] {
            let mut wrong = given.clone();
            wrong[field] = value;
            let edit = Edit::named("sample", &wrong);
            assert!(
                matches!(edit.read::<Sample>(), Err(EditFault::Fields { .. })),
                "{wrong}"
            );
            assert_eq!(edit.get::<Sample>(), None);
        }
        for (field, value, path) in [
            ("thickness", json!(1), "thickness"),
            (
                "parts",
                json!([{ "paint": "Bone Black", "share": 1 }]),
                "parts.0.share",
            ),
        ] {
            let mut wrong = given.clone();
            wrong[field] = value;
            let unknown = EditFault::NoField {
                name: "sample".to_owned(),
                field: path.to_owned(),
            };
            let read = Edit::named("sample", &wrong).read::<Sample>();
            assert_eq!(read, Err(unknown));
        }
        let other = Edit::named("other", &given);
        assert_eq!(
            other.read::<Sample>(),
            Err(EditFault::Unknown("other".to_owned()))
        );
    }

    #[test]
    fn what_is_no_name_and_no_object_is_rejected() {
        let decoded = |name: &str, fields: &str| {
            let (name, fields) = (name.to_owned(), fields.to_owned());
            Edit::try_from(EditParts { name, fields })
        };
        assert!(decoded("load_from", "{}").is_ok());
        let long = "a".repeat(EDIT_NAME_MAX + 1);
        for name in ["", "Load", "a b", long.as_str()] {
            assert!(decoded(name, "{}").is_err(), "{name}");
        }
        let deep = format!("{{\"a\":{}1{}}}", "[".repeat(200), "]".repeat(200));
        for fields in ["", "[]", "1", "{", "{} {}", deep.as_str()] {
            assert!(decoded("a", fields).is_err(), "{fields}");
        }
    }
}
