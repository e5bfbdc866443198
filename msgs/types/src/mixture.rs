//! A mixture of paints by volume, written `"Cobalt Blue=0.7,Titanium White=0.3"` or `"7 Cobalt Blue, 3 Titanium White"`.

use std::fmt;
use std::str::FromStr;

use crate::limits::{PAINT_NAME_MAX, PARTS_MAX};
use crate::wire::define::wire_struct;

/// Largest difference from 1 of the sum of shares that counts as rounding.
const SUM_TOLERANCE: f64 = 1e-3;
/// Share from which a part is worth saying.
const LEAST_SAID: f64 = 5e-4;

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
    /// Paints and their shares by volume; the shares sum to 1 up to rounding.
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
    /// The share is not a number above 0.
    #[error("the share of '{paint}' is '{share}', not a number above 0")]
    Share {
        /// The paint.
        paint: String,
        /// Text of the share.
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
    #[error("a mixture has at most {PARTS_MAX} paints, not {0}")]
    Parts(usize),
    /// The name of a paint is too long.
    #[error("a paint's name has at most {PAINT_NAME_MAX} bytes, not {0}")]
    Name(usize),
    /// A paint twice.
    #[error("'{paint}' is in the mixture twice")]
    Twice {
        /// The paint.
        paint: String,
    },
}

impl Mixture {
    /// The mixture for a reader: without parts below half a thousandth.
    #[must_use]
    pub fn without_traces(&self) -> Self {
        let parts = self.parts.iter().filter(|part| part.share >= LEAST_SAID);
        Self {
            parts: parts.cloned().collect(),
        }
    }

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
            if !is_share(part.share) {
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
        if (sum - 1.0).abs() > SUM_TOLERANCE {
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

    /// Shares are numbers above 0; those that do not sum to 1 are parts by volume, and divided by their sum. A paint
    /// whose name begins with a number is written with its share: `400 White=1`.
    fn from_str(text: &str) -> Result<Self, MixtureError> {
        let mut parts = Vec::new();
        for part in text.split(',') {
            let (paint, share) = paint_and_share(part.trim());
            let share = match share {
                None if !text.contains(',') => 1.0,
                _ => {
                    let number = share.and_then(|share| share.parse().ok());
                    number
                        .filter(|share| is_share(*share))
                        .ok_or_else(|| MixtureError::Share {
                            paint: paint.to_owned(),
                            share: share.unwrap_or_default().to_owned(),
                        })?
                }
            };
            parts.push(Part {
                paint: paint.to_owned(),
                share,
            });
        }
        let sum: f64 = parts.iter().map(|part| part.share).sum();
        if (sum - 1.0).abs() > SUM_TOLERANCE {
            parts.iter_mut().for_each(|part| part.share /= sum);
        }
        let mixture = Self { parts };
        mixture.check()?;
        Ok(mixture)
    }
}

/// True for a share that a part can have.
fn is_share(share: f64) -> bool {
    share.is_finite() && share > 0.0
}

/// The paint of a part and its share: `Cobalt Blue=2`, `2 Cobalt Blue`, or the paint alone.
fn paint_and_share(part: &str) -> (&str, Option<&str>) {
    if let Some((paint, share)) = part.split_once('=') {
        return (paint.trim(), Some(share.trim()));
    }
    match part.split_once(char::is_whitespace) {
        Some((share, paint)) if share.parse().is_ok_and(f64::is_finite) => {
            (paint.trim(), Some(share))
        }
        _ => (part, None),
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
    fn parts_are_divided_by_their_sum() {
        let shares = |text: &str| {
            let mixture: Mixture = text.parse().expect(text);
            let share = |part: &Part| (part.paint.clone(), part.share);
            mixture.parts.iter().map(share).collect::<Vec<_>>()
        };
        let third = [
            ("Cobalt Blue".to_owned(), 2.0 / 3.0),
            ("White".to_owned(), 1.0 / 3.0),
        ];
        assert_eq!(shares("2 Cobalt Blue, 1 White"), third);
        assert_eq!(shares("Cobalt Blue=20,White=10"), third);
        assert_eq!(
            shares("A=0.3333,B=0.6666"),
            [("A".into(), 0.3333), ("B".into(), 0.6666)]
        );
        assert_eq!(shares("3 A"), [("A".into(), 1.0)]);
    }

    #[test]
    fn refuses_what_is_no_mixture() {
        let error = |text: &str| text.parse::<Mixture>().expect_err(text);
        assert_eq!(error(""), MixtureError::Empty);
        assert!(matches!(error("A=x,B=0.4"), MixtureError::Share { .. }));
        assert!(matches!(error("A=NaN"), MixtureError::Share { .. }));
        assert!(matches!(error("A=1.5,B=-0.5"), MixtureError::Share { .. }));
        assert!(matches!(error("A=0,B=1"), MixtureError::Share { .. }));
        assert!(matches!(
            error("A=1e308,B=1e308"),
            MixtureError::Share { .. }
        ));
        assert!(matches!(error("A,B=0.5"), MixtureError::Share { .. }));
        assert!(matches!(error("A=0.5,A=0.5"), MixtureError::Twice { .. }));
    }
}
