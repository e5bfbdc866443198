//! Errors of spectra from tables, and of lights.

use maulstick_tables::shown;

/// A spectrum covers this at least, nm: beyond its ends it is held.
pub(crate) const COVERED: [f64; 2] = [420.0, 680.0];

/// A light has power at this many of the samples or more: the most that a rule takes.
pub(crate) const NARROWEST: usize = 16;

/// A light by which no colours are seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DarkError {
    /// Too few wavelengths.
    #[error(
        "the light has power at {0} of the 101 wavelengths from 380 to 780 nm, 4 nm apart; colours take {NARROWEST}"
    )]
    Narrow(usize),
    /// A response that it does not excite.
    #[error("the light leaves one of X, Y and Z dark, so no colour is seen by it")]
    Response,
}

/// A defect of a table and its place.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("line {line}: {fault}")]
pub struct TableError {
    /// The line, from 1.
    pub line: usize,
    /// The defect.
    pub fault: SpectrumFault,
}

/// A defect of a table of a spectrum. Columns are counted from 1.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SpectrumFault {
    /// The text is no table of numbers.
    #[error("{}", .0.what())]
    Table(maulstick_tables::TableError),
    /// A note on the gloss that cannot be understood.
    #[error("'{}' is not `included` or `excluded`", shown(.0))]
    Specular(String),
    /// A value out of range.
    #[error("column {column}: {value} is not {}", .range.name())]
    Value {
        /// The column.
        column: usize,
        /// The value.
        value: f64,
        /// Allowed range.
        range: Range,
    },
    /// A number that is no wavelength.
    #[error("column {column}: {nm} is no wavelength in nm")]
    Wavelength {
        /// The column.
        column: usize,
        /// The number.
        nm: f64,
    },
    /// A wavelength that is not above the one before.
    #[error("column {column}: {nm} nm after {before} nm; they must rise")]
    Falling {
        /// The column.
        column: usize,
        /// The wavelength, nm.
        nm: f64,
        /// The one before, nm.
        before: f64,
    },
    /// Fewer than two rows.
    #[error("a spectrum takes two wavelengths or more")]
    Short,
    /// First and last wavelength of a spectrum that does not cover the visible, nm.
    #[error(
        "the spectrum goes from {0} to {1} nm; give it from {first} or less to {last} or more",
        first = COVERED[0],
        last = COVERED[1]
    )]
    Part(f64, f64),
    /// A light by which colours cannot be seen.
    #[error(transparent)]
    Dark(#[from] DarkError),
}

/// Range of the values of a spectrum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Range {
    /// 0 or more.
    Power,
    /// 0 to 1.
    Reflectance,
}

impl Range {
    const fn name(self) -> &'static str {
        match self {
            Self::Power => "0 or more",
            Self::Reflectance => "a reflectance of 0 to 1",
        }
    }
}

impl From<maulstick_tables::TableError> for TableError {
    fn from(error: maulstick_tables::TableError) -> Self {
        Self {
            line: error.line,
            fault: SpectrumFault::Table(error),
        }
    }
}
