//! A mixture of paints by volume, written `"Cobalt Blue=0.7,Titanium White=0.3"`.

use std::fmt;
use std::str::FromStr;

use crate::command::{PAINT_NAME_MAX, PARTS_MAX};
use crate::wire::define::wire_struct;

wire_struct! {
    /// One paint of a mixture.
    pub struct Part {
        /// Name of the paint as in the paint file.
        pub paint: String,
        /// Share of the volume, above 0 and at most 1.
        pub share: f64,
    }
}

wire_struct! {
    /// Paints and their shares by volume; the shares sum to 1 within 1e-3.
    #[serde(try_from = "Parts")]
    pub struct Mixture {
        /// At least one part, no paint twice.
        pub parts: Vec<Part>,
    }
}

/// A mixture as it is decoded.
#[derive(serde::Deserialize)]
struct Parts {
    parts: Vec<Part>,
}

impl TryFrom<Parts> for Mixture {
    type Error = MixtureError;

    fn try_from(Parts { parts }: Parts) -> Result<Self, MixtureError> {
        let mixture = Self { parts };
        mixture.check()?;
        Ok(mixture)
    }
}

/// Error of a text that is not a mixture.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MixtureError {
    /// Nothing between the commas, or nothing at all.
    #[error("a mixture names at least one paint, as in \"Cobalt Blue=0.7,Titanium White=0.3\"")]
    Empty,
    /// The share is not a number between 0 and 1.
    #[error("the share of '{paint}' is '{share}', not a number above 0 and at most 1")]
    Share {
        /// The paint.
        paint: String,
        /// Text after its `=`.
        share: String,
    },
    /// The shares do not sum to 1.
    #[error("the shares of '{mixture}' sum to {sum:.4}, not to 1")]
    Sum {
        /// The text.
        mixture: String,
        /// The sum.
        sum: f64,
    },
    /// Too many paints.
    #[error("a mixture of {0} paints: it has at most {PARTS_MAX}")]
    Parts(usize),
    /// The name of a paint is too long.
    #[error("a paint's name of {0} bytes: it has at most {PAINT_NAME_MAX}")]
    Name(usize),
    /// A paint twice.
    #[error("'{paint}' stands twice in the mixture")]
    Twice {
        /// The paint.
        paint: String,
    },
}

impl Mixture {
    /// One paint, pure.
    #[must_use]
    pub fn pure(paint: &str) -> Self {
        Self {
            parts: vec![Part {
                paint: paint.to_owned(),
                share: 1.0,
            }],
        }
    }

    /// Checks shares and names.
    ///
    /// # Errors
    /// [`MixtureError`].
    pub fn check(&self) -> Result<(), MixtureError> {
        if self.parts.is_empty() || self.parts.iter().any(|part| part.paint.is_empty()) {
            return Err(MixtureError::Empty);
        }
        if self.parts.len() > PARTS_MAX {
            return Err(MixtureError::Parts(self.parts.len()));
        }
        let mut lengths = self.parts.iter().map(|part| part.paint.len());
        if let Some(length) = lengths.find(|length| *length > PAINT_NAME_MAX) {
            return Err(MixtureError::Name(length));
        }
        for (place, part) in self.parts.iter().enumerate() {
            if !(part.share > 0.0 && part.share <= 1.0 + 1e-3) {
                return Err(MixtureError::Share {
                    paint: part.paint.clone(),
                    share: part.share.to_string(),
                });
            }
            if self.parts[..place]
                .iter()
                .any(|other| other.paint == part.paint)
            {
                return Err(MixtureError::Twice {
                    paint: part.paint.clone(),
                });
            }
        }
        let sum: f64 = self.parts.iter().map(|part| part.share).sum();
        if (sum - 1.0).abs() > 1e-3 {
            return Err(MixtureError::Sum {
                mixture: self.to_string(),
                sum,
            });
        }
        Ok(())
    }
}

impl FromStr for Mixture {
    type Err = MixtureError;

    fn from_str(text: &str) -> Result<Self, MixtureError> {
        let mut parts = Vec::new();
        for part in text.split(',') {
            let (paint, share) = match part.split_once('=') {
                Some((paint, share)) => (paint.trim(), Some(share.trim())),
                None => (part.trim(), None),
            };
            let share = match share {
                None if !text.contains(',') => 1.0,
                _ => share.and_then(|share| share.parse().ok()).ok_or_else(|| {
                    MixtureError::Share {
                        paint: paint.to_owned(),
                        share: share.unwrap_or_default().to_owned(),
                    }
                })?,
            };
            parts.push(Part {
                paint: paint.to_owned(),
                share,
            });
        }
        let mixture = Self { parts };
        mixture.check()?;
        Ok(mixture)
    }
}

impl fmt::Display for Mixture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (place, part) in self.parts.iter().enumerate() {
            let comma = if place == 0 { "" } else { "," };
            write!(f, "{comma}{}={}", part.paint, part.share)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_and_writes_the_same_text() {
        let text = "Cobalt Blue=0.7,Titanium White=0.3";
        assert_eq!(
            text.parse::<Mixture>().map(|m| m.to_string()),
            Ok(text.to_owned())
        );
        assert_eq!("Bone Black".parse(), Ok(Mixture::pure("Bone Black")));
    }

    #[test]
    fn refuses_what_is_no_mixture() {
        let error = |text: &str| text.parse::<Mixture>().expect_err(text);
        assert_eq!(error(""), MixtureError::Empty);
        assert!(matches!(error("A=0.5,B=0.4"), MixtureError::Sum { sum, .. } if sum == 0.9));
        assert!(matches!(error("A=x,B=0.4"), MixtureError::Share { .. }));
        assert!(matches!(error("A=NaN"), MixtureError::Share { .. }));
        assert!(matches!(error("A=1.5,B=-0.5"), MixtureError::Share { .. }));
        assert!(matches!(error("A,B=0.5"), MixtureError::Share { .. }));
        assert!(matches!(error("A=0.5,A=0.5"), MixtureError::Twice { .. }));
    }
}
