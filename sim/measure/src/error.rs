//! Errors of measurements: defect, place, advice.

use std::fmt;

/// A place in a table.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// The line of the file, from 1.
    pub line: Option<usize>,
    /// The column, from 1.
    pub column: Option<usize>,
    /// Heading of that column.
    pub heading: String,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, "line {line}")?;
        }
        if let Some(column) = self.column {
            let comma = if self.line.is_some() { ", " } else { "" };
            write!(f, "{comma}column {column}")?;
            if !self.heading.is_empty() {
                write!(f, " ({})", self.heading)?;
            }
        }
        Ok(())
    }
}

/// A fault of measurements.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}{}{what}", if place.line.is_some() { ": " } else { "" })]
pub struct MeasureError {
    /// Place in the table.
    pub place: Place,
    /// Description of the fault.
    pub what: String,
    /// Remedy.
    pub help: String,
}

impl MeasureError {
    /// Something that concerns the table as a whole.
    #[must_use]
    pub fn new(what: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            place: Place::default(),
            what: what.into(),
            help: help.into(),
        }
    }

    /// The error with its line.
    #[must_use]
    pub fn line(mut self, line: usize) -> Self {
        self.place.line = Some(line);
        self
    }

    /// In this column, counted from 0, under this heading.
    #[must_use]
    pub fn column(mut self, column: usize, heading: &str) -> Self {
        self.place.column = Some(column + 1);
        heading.clone_into(&mut self.place.heading);
        self
    }
}
