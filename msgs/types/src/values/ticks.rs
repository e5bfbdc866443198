//! Durations, counted in ticks of the painting's clock.

use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

use serde::de::{Deserialize, Deserializer, Error, Visitor};

use super::{Quantity, ValueError};
use crate::wire::schema::{TypeTable, Wire};

/// Ticks of the painting's clock in a second.
pub const TICKS_A_SECOND: u32 = 60;

/// Units and their seconds.
const UNITS: [(&str, f64); 6] = [
    ("ms", 1e-3),
    ("s", 1.0),
    ("min", 60.0),
    ("m", 60.0),
    ("h", 3600.0),
    ("d", 86_400.0),
];

/// Ticks of the longest duration, a year.
const MOST_TICKS: u32 = TICKS_A_SECOND * 60 * 60 * 24 * 365;

/// A duration of 1 tick to a year; `90s`, `20min` or `2h` in texts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Ticks(u32);

impl Quantity for Ticks {
    const NAME: &'static str = "time";
    const RANGE: RangeInclusive<f64> =
        1.0 / TICKS_A_SECOND as f64..=(MOST_TICKS / TICKS_A_SECOND) as f64;
    const USUAL: RangeInclusive<f64> = 1.0..=*Self::RANGE.end();
    const UNIT: &'static str = " s";
    const HELP: &'static str = "Time in which all that is wet dries";
}

impl Ticks {
    /// A number of ticks.
    ///
    /// # Errors
    /// [`ValueError::Time`].
    pub fn new(ticks: u32) -> Result<Self, ValueError> {
        if (1..=MOST_TICKS).contains(&ticks) {
            Ok(Self(ticks))
        } else {
            Err(ValueError::Time(format!("{ticks}/{TICKS_A_SECOND}s")))
        }
    }

    /// The number of ticks.
    #[must_use]
    pub const fn get(self) -> u32 {
        self.0
    }
}

/// Reads a duration such as `90s`, `20min`, `2h`, in seconds, whatever their number; `None` for another text.
#[must_use]
pub fn seconds_in(text: &str) -> Option<f64> {
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let unit = &text[digits.len()..];
    let (_, seconds) = UNITS.iter().find(|(name, _)| *name == unit)?;
    let count: f64 = digits.trim().parse().ok()?;
    Some(count * seconds)
}

/// Reads a duration such as `90s`, `20min`, `2h`, in ticks: one at least, a year at most.
///
/// # Errors
/// [`ValueError::Time`].
pub fn ticks_in(text: &str) -> Result<u32, ValueError> {
    let wrong = || ValueError::Time(text.chars().take(40).collect());
    let seconds = seconds_in(text).ok_or_else(wrong)?;
    let ticks = (seconds * f64::from(TICKS_A_SECOND)).round();
    if (1.0..=f64::from(MOST_TICKS)).contains(&ticks) {
        Ok(ticks as u32)
    } else {
        Err(wrong())
    }
}

impl FromStr for Ticks {
    type Err = ValueError;

    fn from_str(text: &str) -> Result<Self, ValueError> {
        ticks_in(text).map(Self)
    }
}

/// Reads a duration as a text.
struct Time;

impl Visitor<'_> for Time {
    type Value = Ticks;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a time such as \"90s\"")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Ticks, E> {
        text.parse().map_err(E::custom)
    }
}

impl<'de> Deserialize<'de> for Ticks {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        if from.is_human_readable() {
            from.deserialize_any(Time)
        } else {
            Self::new(u32::deserialize(from)?).map_err(D::Error::custom)
        }
    }
}

impl Wire for Ticks {
    fn type_name() -> String {
        u32::type_name()
    }

    fn describe(_: &mut TypeTable) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_read_or_rejected() {
        let good = [
            ("90s", 5400),
            ("1.5 min", 5400),
            ("2h", 432_000),
            ("50ms", 3),
            ("1m", 3600),
        ];
        for (text, ticks) in good {
            assert_eq!(ticks_in(text), Ok(ticks), "{text}");
        }
        for text in [
            "", "90", "s", "-1s", "0s", "NaNs", "infs", "2y", "366d", "1e99d",
        ] {
            let error = ticks_in(text).expect_err(text).to_string();
            assert!(error.contains("90s"), "{error}");
        }
        assert!(Ticks::new(0).is_err() && Ticks::new(1).is_ok());
    }
}
