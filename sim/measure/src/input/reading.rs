//! Rows of a table of measurements, as numbers.

/// The thing that a row measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Paint.
    Sample,
    /// A bare ground of drawdowns.
    Ground,
    /// The reflectance standard.
    Standard,
    /// The standard, seen through the neutral-density filter.
    FilteredStandard,
    /// A darker sample, for the filter's attenuation.
    Dark,
    /// The same through the filter.
    FilteredDark,
}

/// A row whose numbers have been read.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Reading {
    pub(crate) kind: Kind,
    pub(crate) line: usize,
    pub(crate) values: Vec<f64>,
}
