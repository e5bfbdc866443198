//! Names, paths and file contents of bounded length.

use std::fmt;
use std::ops::Deref;
use std::str::FromStr;

use serde::de::{Deserialize, Deserializer, Error, Visitor};

use super::ValueError;
use crate::limits::{
    BRUSH_FILE_MAX, DEVICE_MAX, DEVICE_NAME_MAX, LAYER_NAME_MAX, PAINT_NAME_MAX, PATH_MAX,
    SPECTRUM_MAX, VERSION_NAME_MAX,
};
use crate::wire::schema::{TypeTable, Wire};
use crate::wire::topics::check_name;

/// Reads a text, or a whole number in its digits.
struct Word;

impl Visitor<'_> for Word {
    type Value = String;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a text")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<String, E> {
        Ok(text.to_owned())
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<String, E> {
        if number >= 0 {
            Ok(number.to_string())
        } else {
            Err(E::invalid_value(
                serde::de::Unexpected::Signed(number),
                &self,
            ))
        }
    }
}

macro_rules! text {
    ($(#[$meta:meta])* $name:ident: $check:expr) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
        pub struct $name(String);

        impl $name {
            /// A text, if it is one of these.
            ///
            /// # Errors
            /// [`ValueError`].
            pub fn new(text: impl Into<String>) -> Result<Self, ValueError> {
                let (text, check): (String, fn(&str) -> Result<(), ValueError>) = (text.into(), $check);
                check(&text)?;
                Ok(Self(text))
            }

            /// The text.
            #[must_use]
            pub fn as_str(&self) -> &str {
                &self.0
            }
        }

        impl Deref for $name {
            type Target = str;

            fn deref(&self) -> &str {
                &self.0
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(&self.0)
            }
        }

        impl PartialEq<str> for $name {
            fn eq(&self, other: &str) -> bool {
                self.0 == other
            }
        }

        impl PartialEq<&str> for $name {
            fn eq(&self, other: &&str) -> bool {
                self.0 == *other
            }
        }

        impl From<$name> for String {
            fn from(text: $name) -> Self {
                text.0
            }
        }

        impl FromStr for $name {
            type Err = ValueError;

            fn from_str(text: &str) -> Result<Self, ValueError> {
                Self::new(text)
            }
        }

        impl TryFrom<String> for $name {
            type Error = ValueError;

            fn try_from(text: String) -> Result<Self, ValueError> {
                Self::new(text)
            }
        }

        impl TryFrom<&str> for $name {
            type Error = ValueError;

            fn try_from(text: &str) -> Result<Self, ValueError> {
                Self::new(text)
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                let text = if from.is_human_readable() { from.deserialize_any(Word)? } else { String::deserialize(from)? };
                Self::new(text).map_err(D::Error::custom)
            }
        }

        impl Wire for $name {
            fn type_name() -> String {
                String::type_name()
            }

            fn describe(_: &mut TypeTable) {}
        }
    };
}

fn bounded(what: &'static str, text: &str, most: usize) -> Result<(), ValueError> {
    let bytes = text.len();
    if bytes > most {
        Err(ValueError::Length { what, bytes, most })
    } else {
        Ok(())
    }
}

fn readable(what: &'static str, text: &str, most: usize) -> Result<(), ValueError> {
    bounded(what, text, most)?;
    if text.trim().is_empty() || text.contains(char::is_control) {
        Err(ValueError::Unreadable { what })
    } else {
        Ok(())
    }
}

text! {
    /// Name of a brush of the rig.
    BrushName: |name| {
        bounded("brush's name", name, 2 * PAINT_NAME_MAX)?;
        check_name(name).map_err(|fault| ValueError::Brush { fault: fault.to_string() })
    }
}
text! {
    /// Name of a dry layer.
    LayerName: |name| readable("layer's name", name, LAYER_NAME_MAX)
}
text! {
    /// Name of a version of the painting.
    VersionName: |name| readable("version's name", name, VERSION_NAME_MAX)
}
text! {
    /// Name of a ground or tooth, or the path of its file.
    MaterialName: |name| readable("ground's or tooth's name", name, PATH_MAX)
}
text! {
    /// Name of a paint model.
    ModelName: |name| readable("paint model's name", name, PAINT_NAME_MAX)
}
text! {
    /// Reflectances, a CSV file of nm,reflectance.
    SpectrumText: |text| bounded("spectrum", text, SPECTRUM_MAX)
}
text! {
    /// A brush file, TOML.
    BrushToml: |toml| bounded("brush file", toml, BRUSH_FILE_MAX)
}
text! {
    /// Name of a device of the rig.
    DeviceName: |name| readable("device's name", name, DEVICE_NAME_MAX)
}
text! {
    /// The settings of a device, TOML.
    DeviceToml: |toml| bounded("settings of the device", toml, DEVICE_MAX)
}
text! {
    /// A path that begins at the root.
    WholePath: |path| {
        bounded("path", path, PATH_MAX)?;
        if path.starts_with('/') && !path.contains('\0') { Ok(()) } else { Err(ValueError::NotWhole) }
    }
}

impl BrushName {
    /// Default name of a rig's first brush.
    #[must_use]
    pub fn main() -> Self {
        Self("main".to_owned())
    }
}

impl Default for BrushName {
    fn default() -> Self {
        Self::main()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_long_is_rejected_in_few_words() {
        let long = "x".repeat(70_000);
        let error = BrushName::new(long.clone())
            .expect_err("too long")
            .to_string();
        assert!(
            error.contains("70000 bytes") && error.len() < 200,
            "{error}"
        );
        assert!(LayerName::new(long.clone()).is_err());
        assert!(WholePath::new(format!("/{long}")).is_err());
        assert!(BrushName::new("a/b").is_err());
    }

    #[test]
    fn names_can_be_read_and_paths_are_whole() {
        assert!(LayerName::new("Sky").is_ok());
        for name in ["", "  ", "a\nb"] {
            assert!(
                LayerName::new(name).is_err() && VersionName::new(name).is_err(),
                "{name:?}"
            );
        }
        assert!(WholePath::new("/tmp/a.maul").is_ok());
        for path in ["", "a.maul", "/a\0b"] {
            assert_eq!(WholePath::new(path), Err(ValueError::NotWhole), "{path:?}");
        }
    }
}
