//! Numbers with a range. They are stored in SI; texts and scripts have them in a painter's units.

use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

use serde::de::{Deserialize, Deserializer, Error, Visitor};
use serde::ser::{Serialize, Serializer};

use super::{Quantity, ValueError};
use crate::quantity;
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

macro_rules! number {
    (
        $(#[$meta:meta])*
        $name:ident($inner:ty): $what:literal, $range:expr, $usual:expr, $scale:literal $unit:literal, $help:literal
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
        pub struct $name($inner);

        impl Quantity for $name {
            const NAME: &'static str = $what;
            const RANGE: RangeInclusive<f64> = $range;
            const USUAL: RangeInclusive<f64> = $usual;
            const UNIT: &'static str = $unit;
            const HELP: &'static str = $help;
        }

        impl $name {
            /// A number as it is stored.
            ///
            /// # Errors
            /// [`ValueError::Range`].
            pub fn new(value: $inner) -> Result<Self, ValueError> {
                if Self::stored_range().contains(&f64::from(value)) {
                    Ok(Self(value))
                } else {
                    Err(Self::out_of_range(f64::from(value) / $scale).into())
                }
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

            /// The range as it is stored.
            #[must_use]
            pub const fn stored_range() -> RangeInclusive<f64> {
                let range = Self::RANGE;
                *range.start() * $scale..=*range.end() * $scale
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
                if to.is_human_readable() {
                    to.serialize_f64(f64::from(self.0))
                } else {
                    self.0.serialize(to)
                }
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
    /// A share that dries.
    Share(f32): "share", f64::MIN_POSITIVE..=1.0, 0.01..=1.0, 1.0 "",
    "Share of the wet film that dries, from below"
}
number! {
    /// A factor on the optical thickness of a layer.
    OpacityFactor(f32): "opacity", 0.0..=1.0, Self::RANGE, 1.0 "",
    "How much the layer hides what lies below; its relief stays"
}
number! {
    /// Share of a load that is thinner; pure thinner is a paint by itself.
    ThinnerShare(f64): "thinner", 0.0..=0.95, Self::RANGE, 1.0 "",
    "Share of thinner in what the brush takes up: thin paint is transparent and runs"
}
number! {
    /// Thickness of a film of paint, m; µm in texts.
    FilmThickness(f64): "film", 1.0..=5000.0, 1.0..=500.0, 1e-6 " µm",
    "Thickness of the film: a thin toning has 20 µm, a couch of paint 100 µm"
}
number! {
    /// Thickness of wet paint to which a brush adds none, m; µm in texts.
    FilmLimit(f64): "limit", 1.0..=5000.0, 1.0..=2000.0, 1e-6 " µm",
    "On the canvas the brush adds no paint where as much lies wet already; in hollows up to twice as much"
}
number! {
    /// Thickness of paint that stays however hard it is brushed, m; µm in texts.
    StainThickness(f64): "stain", 0.0..=1000.0, 0.0..=50.0, 1e-6 " µm",
    "Thickness of the film that soaks in and cannot be wiped off; thin on a heavily sized canvas"
}
number! {
    /// Distance from an edge of a surface, m; mm in texts.
    Distance(f64): "distance", 0.0..=5000.0, Self::RANGE, 1e-3 " mm",
    "Distance from the edge of the surface"
}
number! {
    /// Flow of a marker, m of paint per m of its path; µm per mm in texts.
    MarkerFlow(f64): "flow", 0.001..=100.0, Self::RANGE, 1e-3 " µm/mm",
    "Thickness that the marker leaves along a millimetre of its path"
}
number! {
    /// Side of a cell, m; mm in texts.
    CellSide(f64): "cell", 0.01..=10.0, 0.02..=2.0, 1e-3 " mm",
    "Side of a cell: a finer one shows finer marks and takes longer"
}
number! {
    /// A factor on the stiffness of a brush file.
    Stiffness(f64): "stiffness", 0.05..=20.0, Self::RANGE, 1.0 " ×",
    "Factor on the stiffness that the brush was made with: 1 is as it was made"
}
number! {
    /// Wetness of a brush, from 0, as in its file, to 1, soaked.
    Wetness(f64): "wetness", 0.0..=1.0, Self::RANGE, 1.0 "",
    "How soaked the head is: a soaked one is half as stiff"
}
number! {
    /// Desk lengths per surface length.
    Zoom(f64): "zoom", 0.01..=100.0, 0.1..=10.0, 1.0 "",
    "How large it lies on the desk: 100 % is life size, and the brush stays as it is"
}

quantity! {
    /// Tilt of a surface about its lower edge, degrees.
    pub Tilt: "tilt", 0.0..=90.0, 0.0..=60.0, "°",
    "How far its upper edge is raised, as on an easel"
}
quantity! {
    /// Turn of a surface in its own plane, counter-clockwise, degrees.
    pub Turn: "turn", -180.0..=180.0, Self::RANGE, "°",
    "How far it is turned to the left"
}
quantity! {
    /// Share of a device's force.
    pub ForceShare: "share of the force", 0.0..=1.0, Self::RANGE, "",
    "Share of the force that the brush asks for"
}
quantity! {
    /// Share of the guides' force of a device.
    pub GuidanceShare: "share of the guides' force", 0.0..=1.0, Self::RANGE, "",
    "How strongly the recorded strokes hold your hand"
}

impl Share {
    /// All of it.
    pub const WHOLE: Self = Self(1.0);
}

impl ThinnerShare {
    /// No thinner.
    pub const NONE: Self = Self(0.0);
    /// As much as there may be.
    pub const MOST: Self = Self(*Self::RANGE.end());
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
    pub const DEFAULT: Self = Self(50.0 * 1e-6);
}

impl Default for FilmThickness {
    fn default() -> Self {
        Self::DEFAULT
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_in_range_or_rejected_with_it() {
        assert_eq!("40".parse(), FilmThickness::new(40.0 * 1e-6));
        for text in ["0", "5001", "NaN", "inf", "-1"] {
            let error = text.parse::<FilmThickness>().expect_err(text);
            assert!(
                matches!(&error, ValueError::Range(fault) if fault.range == FilmThickness::RANGE),
                "{error}"
            );
        }
        let error = "thick".parse::<FilmThickness>();
        assert!(matches!(error, Err(ValueError::NoNumber { .. })));
        assert!(Share::new(0.0).is_err() && Share::new(f32::MIN_POSITIVE).is_ok());
        assert!(Share::new(f32::NAN).is_err() && Share::new(1.0).is_ok());
        assert_eq!(
            FilmThickness::DEFAULT,
            FilmThickness::in_unit(50.0).expect("in range")
        );
    }

    #[test]
    fn the_ends_of_a_range_are_in_it_as_they_are_stored() {
        for um in [FilmThickness::RANGE.start(), FilmThickness::RANGE.end()] {
            assert!(FilmThickness::in_unit(*um).is_ok(), "{um}");
        }
        for flow in [1e-6, 0.1] {
            assert!(MarkerFlow::new(flow).is_ok(), "{flow}");
        }
        assert!(StainThickness::new(1e-3).is_ok() && StainThickness::new(1.0001e-3).is_err());
        assert!(Distance::new(5.0).is_ok() && Distance::new(5.000_001).is_err());
    }
}
