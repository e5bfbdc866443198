//! Values that options do not take.

use std::ops::RangeInclusive;

use thiserror::Error;

/// Why an option does not take a text.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub(super) enum OptionError {
    /// It is something else, or out of range.
    #[error("'{text}' is not {expected}")]
    Unexpected {
        /// The text.
        text: String,
        /// What the option takes.
        expected: String,
    },
    /// A range ends before it begins.
    #[error("'{0}': FROM must be less than TO, as in 0..40")]
    Backwards(String),
}

impl OptionError {
    /// A text in the place of what is expected.
    pub(super) fn unexpected(text: &str, expected: impl Into<String>) -> Self {
        Self::Unexpected {
            text: text.to_owned(),
            expected: expected.into(),
        }
    }
}

/// Reads a number within a range, called so.
///
/// # Errors
/// An [`OptionError`] for another text.
pub(super) fn number_within(
    text: &str,
    range: RangeInclusive<f64>,
    called: &str,
) -> Result<f64, OptionError> {
    let value = text.trim().parse().ok();
    let value = value.filter(|value| range.contains(value));
    let (least, most) = (range.start(), range.end());
    value.ok_or_else(|| OptionError::unexpected(text, format!("a {called} from {least} to {most}")))
}
