//! Numbers with a range. They are stored in SI; texts and scripts have them in a painter's units.

use std::fmt;
use std::str::FromStr;

use serde::de::{Deserialize, Deserializer, Error, Visitor};
use serde::ser::{Serialize, Serializer};

use super::ValueError;
use crate::brush::ZOOMS;
use crate::limits::{FILM_M, FLOWS, STAINS_M, STIFFNESS};
use crate::wire::schema::{TypeTable, Wire};

/// Reads a number, whole or not.
struct Number;

impl Visitor<'_> for Number {
    type Value = f64;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<f64, E> {
        Ok(value)
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<f64, E> {
        Ok(value as f64)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<f64, E> {
        Ok(value as f64)
    }
}

/// Largest share of thinner in a load.
const MOST_THINNER: f64 = 0.95;

macro_rules! number {
    (
        $(#[$meta:meta])*
        $name:ident($inner:ty) $what:literal, $scale:literal $unit:literal, $range:literal if $good:expr
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
        pub struct $name($inner);

        impl $name {
            /// A number as it is stored.
            ///
            /// # Errors
            /// [`ValueError::Range`].
            pub fn new(value: $inner) -> Result<Self, ValueError> {
                let good: fn(&$inner) -> bool = $good;
                if good(&value) { Ok(Self(value)) } else { Err(ValueError::Range {
                        what: $what,
                        // Without the noise of the last digits.
                        value: (f64::from(value) / $scale * 1e6).round() * 1e-6,
                        unit: $unit,
                        range: $range,
                    }) }
            }

            /// A number in a painter's unit.
            ///
            /// # Errors
            /// [`ValueError::Range`].
            pub fn in_unit(value: f64) -> Result<Self, ValueError> {
                Self::new((value * $scale) as $inner)
            }

            /// The number as it is stored.
            #[must_use]
            pub const fn get(self) -> $inner {
                self.0
            }
        }

        impl FromStr for $name {
            type Err = ValueError;

            fn from_str(text: &str) -> Result<Self, ValueError> {
                let number = text.trim().parse().map_err(|_| ValueError::NoNumber {
                    what: $what,
                    text: text.chars().take(40).collect(),
                })?;
                Self::in_unit(number)
            }
        }

        impl Serialize for $name {
            fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
                // The digits of an f32 that are fewest are no f64's.
                if to.is_human_readable() { to.serialize_f64(f64::from(self.0)) } else { self.0.serialize(to) }
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                let value = if from.is_human_readable() { Self::in_unit(from.deserialize_any(Number)?) } else { Self::new(<$inner>::deserialize(from)?) };
                value.map_err(D::Error::custom)
            }
        }

        impl Wire for $name {
            fn type_name() -> String {
                <$inner>::type_name()
            }

            fn describe(_: &mut TypeTable) {}
        }
    };
}

number! {
    /// A share that dries, above 0 to 1.
    Share(f32) "share", 1.0 "", "above 0, at most 1" if |share| *share > 0.0 && *share <= 1.0
}
number! {
    /// A factor on the optical thickness of a layer, 0 to 1.
    OpacityFactor(f32) "opacity", 1.0 "", "0 to 1" if |factor| (0.0..=1.0).contains(factor)
}
number! {
    /// Share of a load that is thinner, 0 to .95; pure thinner is a paint by itself.
    ThinnerShare(f64) "thinner", 1.0 "", "0 to .95" if |share| (0.0..=MOST_THINNER).contains(share)
}
number! {
    /// Thickness of a film of paint, m; µm in texts.
    FilmThickness(f64) "film", 1e-6 " µm", "1 to 5000" if |m| FILM_M.contains(m)
}
number! {
    /// Thickness of paint that stays however hard it is brushed, m; µm in texts.
    StainThickness(f64) "stain", 1e-6 " µm", "0 to 1000" if |m| STAINS_M.contains(m)
}
number! {
    /// Distance from an edge of a surface, m; mm in texts.
    Distance(f64) "distance", 1e-3 " mm", "0 to 5000" if |m| (0.0..=5.0).contains(m)
}
number! {
    /// Flow of a marker, m of paint per m of its path; µm per mm in texts.
    MarkerFlow(f64) "flow", 1e-3 " µm/mm", ".001 to 100" if |flow| FLOWS.contains(flow)
}
number! {
    /// A factor on the stiffness of a brush file.
    Stiffness(f64) "stiffness", 1.0 "", "0.05 to 20" if |factor| STIFFNESS.contains(factor)
}
number! {
    /// Wetness of a brush, from 0, as in its file, to 1, soaked.
    Wetness(f64) "wetness", 1.0 "", "0 to 1" if |wetness| (0.0..=1.0).contains(wetness)
}
number! {
    /// Desk lengths per surface length.
    Zoom(f64) "zoom", 1.0 "", ".01 to 100" if |zoom| ZOOMS.contains(zoom)
}

impl Share {
    /// All of it.
    pub const WHOLE: Self = Self(1.0);
}

impl ThinnerShare {
    /// No thinner.
    pub const NONE: Self = Self(0.0);
    /// As much as there may be.
    pub const MOST: Self = Self(MOST_THINNER);
}

impl Default for ThinnerShare {
    fn default() -> Self {
        Self::NONE
    }
}

impl std::fmt::Display for ThinnerShare {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

impl Default for Share {
    fn default() -> Self {
        Self::WHOLE
    }
}

impl FilmThickness {
    /// Default thickness of a film, 50 µm.
    pub const USUAL: Self = Self(50.0 * 1e-6);
}

impl Default for FilmThickness {
    fn default() -> Self {
        Self::USUAL
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_in_range_or_rejected_with_it() {
        assert_eq!("40".parse(), FilmThickness::new(40.0 * 1e-6));
        for text in ["0", "5001", "NaN", "inf", "-1", "thick"] {
            let error = text.parse::<FilmThickness>().expect_err(text).to_string();
            assert!(error.contains("µm") || error.contains("number"), "{error}");
        }
        let error = Share::new(0.0).expect_err("nothing dries").to_string();
        assert_eq!(error, "share 0 is out of range: choose above 0, at most 1");
        assert!(Share::new(f32::NAN).is_err() && Share::new(1.0).is_ok());
        assert_eq!(
            FilmThickness::USUAL,
            FilmThickness::in_unit(50.0).expect("usual")
        );
    }
}
