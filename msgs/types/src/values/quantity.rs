//! What there is to say of a number that a painter sets, said once: panels, command line, scripts and errors read it here.

use std::ops::RangeInclusive;

/// A number that a painter sets.
///
/// ```
/// use maulstick_types::values::{FilmThickness, Quantity};
///
/// assert_eq!(FilmThickness::RANGE, 1.0..=5000.0);
/// assert_eq!(FilmThickness::range_text(), "1 to 5000 µm");
/// assert!(FilmThickness::check(6000.0).is_err());
/// ```
pub trait Quantity {
    /// Its name in errors.
    const NAME: &'static str;
    /// Its values, in a painter's unit; from the least number above 0 where 0 is excluded.
    const RANGE: RangeInclusive<f64>;
    /// The part of the range that is painted with: a slider spans it.
    const USUAL: RangeInclusive<f64> = Self::RANGE;
    /// The unit as it stands behind a number; empty for none.
    const UNIT: &'static str = "";
    /// What it does to the painting, in a painter's words.
    const HELP: &'static str;

    /// The range in words, with the unit.
    #[must_use]
    fn range_text() -> String {
        range_text(&Self::RANGE, Self::UNIT)
    }

    /// Help of an option of the command line: what it does, and its range.
    #[must_use]
    fn option_help() -> String {
        format!("{} ({})", Self::HELP, Self::range_text())
    }

    /// Checks a number in a painter's unit.
    ///
    /// # Errors
    /// [`OutOfRange`].
    fn check(value: f64) -> Result<(), OutOfRange> {
        if Self::RANGE.contains(&value) {
            Ok(())
        } else {
            Err(Self::out_of_range(value))
        }
    }

    /// The rejection of a number in a painter's unit.
    #[must_use]
    fn out_of_range(value: f64) -> OutOfRange {
        OutOfRange {
            name: Self::NAME,
            // Without the noise of the last digits.
            value: (value * 1e6).round() * 1e-6,
            unit: Self::UNIT,
            range: Self::RANGE,
        }
    }
}

/// A number out of its range, in a painter's unit.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{name} of {value}{unit} is out of range: choose {}", range_text(.range, .unit))]
pub struct OutOfRange {
    /// The quantity.
    pub name: &'static str,
    /// The number.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// Numbers that it can be.
    pub range: RangeInclusive<f64>,
}

fn range_text(range: &RangeInclusive<f64>, unit: &str) -> String {
    let (least, most) = (range.start(), range.end());
    if *least == f64::MIN_POSITIVE {
        format!("above 0, at most {most}{unit}")
    } else {
        format!("{least} to {most}{unit}")
    }
}

/// Quantities that are not stored by themselves: fields of a message, and what a front end has of its own.
#[macro_export]
macro_rules! quantity {
    (
        $(#[$meta:meta])*
        $visibility:vis $name:ident: $what:literal, $range:expr, $usual:expr, $unit:literal, $help:expr
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug)]
        $visibility enum $name {}

        impl $crate::values::Quantity for $name {
            const NAME: &'static str = $what;
            const RANGE: std::ops::RangeInclusive<f64> = $range;
            const USUAL: std::ops::RangeInclusive<f64> = $usual;
            const UNIT: &'static str = $unit;
            const HELP: &'static str = $help;
        }
    };
}
