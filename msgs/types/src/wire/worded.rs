//! Typed values that earlier versions had in words: their words are read, in files and in recordings.

use serde::{Deserialize, Deserializer};

/// A value with an alternative for the words of another version.
pub trait Worded: Sized {
    /// The value of these words; [its alternative](Self::words) for words where they are not known.
    fn of_words(words: &str) -> Self;

    /// The words, if it has only these.
    fn words(&self) -> Option<&str>;
}

/// [`Worded::words`] of an enum whose alternative is called `Words`.
macro_rules! words_alternative {
    () => {
        fn words(&self) -> Option<&str> {
            match self {
                Self::Words { words } => Some(words),
                _ => None,
            }
        }
    };
}
pub(crate) use words_alternative;

#[derive(Deserialize)]
#[serde(untagged)]
enum TypedOrWords<T> {
    Typed(T),
    Words(String),
}

/// Reads a value; in JSON words may stand in its place.
///
/// # Errors
/// The error of the deserializer.
pub fn read<'de, D, T>(deserializer: D) -> Result<T, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de> + Worded,
{
    let read = if deserializer.is_human_readable() {
        match TypedOrWords::deserialize(deserializer)? {
            TypedOrWords::Typed(value) => value,
            TypedOrWords::Words(words) => T::of_words(&words),
        }
    } else {
        T::deserialize(deserializer)?
    };
    // A recording's words are translated to that alternative.
    Ok(match read.words() {
        Some(words) => T::of_words(words),
        None => read,
    })
}
