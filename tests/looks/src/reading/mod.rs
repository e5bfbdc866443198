//! Looks at reading distance, in numbers: each row by the worst of several headings, brushes, paints and cells, and
//! beside it the row that would become worse by making it better the wrong way.
//!
//! | module | holds |
//! | --- | --- |
//! | [`case`] | conditions of a measurement, and its strokes |
//! | [`colour`] | colour that travels between wet paints |
//! | [`film`] | glazes, beads, brushes painted out |
//! | [`overlay`] | strokes over wet strokes |
//! | [`skin`] | relief of bristles, ends, edges, lattices |
//! | [`spectrum`] | power of a relief by wavelength |

pub mod case;
pub mod colour;
pub mod film;
pub mod overlay;
pub mod skin;
pub mod spectrum;

use maulstick_rig::UserError;

use crate::Row;
use crate::marks::Painter;
use case::{CASES, Case};

/// Name and value.
pub type Found = (&'static str, f64);
/// A measurement of one case.
pub type Reading = fn(Case, Painter) -> Result<Vec<Found>, UserError>;

/// A bound of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// The least value.
    Least(f64),
    /// The greatest value.
    Most(f64),
}

impl Bound {
    /// The worse of two values.
    fn worse(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Least(_) => a.min(b),
            Self::Most(_) => a.max(b),
        }
    }

    /// The bound itself.
    fn value(self) -> f64 {
        match self {
            Self::Least(value) | Self::Most(value) => value,
        }
    }

    /// True if a value keeps it.
    #[must_use]
    pub fn keeps(self, value: f64) -> bool {
        !value.is_nan() && self.worse(value, self.value()) == self.value()
    }
}

/// Rows that are measured together, with their units and bounds.
#[derive(Clone, Copy, Debug)]
pub struct Readings {
    /// Measures one case.
    pub read: Reading,
    /// Names, units, bounds.
    pub rows: &'static [(&'static str, &'static str, Bound)],
    /// True for cases that show these rows.
    pub shows: fn(&Case) -> bool,
}

/// All of them.
pub const ALL: &[Readings] = &[
    skin::VARIETY,
    skin::BRISTLES,
    skin::OUTLINE,
    skin::LATTICE,
    colour::CARRY,
    colour::SMEAR,
    colour::SOFTEN,
    overlay::OVER_WET,
    film::GLAZE,
    film::DRY_BRUSH,
];

/// The worst value of each row over all cases.
///
/// # Errors
/// [`UserError`] if a stroke is refused.
pub fn worst(own: Readings) -> Result<Vec<Row>, UserError> {
    let mut rows: Vec<Row> = Vec::new();
    for case in CASES.iter().filter(|case| (own.shows)(case)) {
        for (name, value) in (own.read)(*case, Painter::Able)? {
            let Some((_, unit, bound)) = own.rows.iter().find(|(own, ..)| *own == name) else {
                continue;
            };
            match rows.iter_mut().find(|row| row.name == name) {
                Some(row) => row.value = bound.worse(row.value, value),
                None => rows.push(Row {
                    name,
                    value,
                    unit,
                    target: Some(bound.value()),
                }),
            }
        }
    }
    Ok(rows)
}
