//! Errors of lists of poses.

use maulstick_tables::{Fault, TableError};

/// Largest number that floating point is to square.
pub(super) const LARGEST_VALUE: f64 = 1e9;

/// Error in a list of poses.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{fault}")]
pub struct PoseError {
    /// Line in the text, from 1.
    pub line: usize,
    /// The error.
    pub fault: PoseFault,
}

/// A fault of a line.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PoseFault {
    /// The table has no line.
    #[error("the file is empty")]
    Empty,
    /// The headings are no table's.
    #[error("{}", .0.what())]
    Headings(TableError),
    /// A column is missing.
    #[error("the column '{0}' is missing")]
    Missing(&'static str),
    /// The row is no table's.
    #[error("{}", .0.what())]
    Row(TableError),
    /// The time of a pose and of the one before, s.
    #[error("time does not rise: {0} s after {1} s")]
    Time(f64, f64),
    /// There are only headings.
    #[error("there are no poses")]
    NoPoses,
    /// Length of a quaternion.
    #[error("qx,qy,qz,qw has the length {0}, not 1")]
    Length(f64),
    /// A coordinate that floating point cannot square, m.
    #[error("x,y,z: {0} m is farther than {LARGEST_VALUE} m")]
    Far(f64),
}

impl PoseError {
    /// Advice.
    #[must_use]
    pub fn help(&self) -> &'static str {
        match &self.fault {
            PoseFault::Empty | PoseFault::Headings(_) | PoseFault::Missing(_) => {
                "the first line is: t,x,y,z,qx,qy,qz,qw"
            }
            PoseFault::Row(error) => match error.fault {
                Fault::Narrow { .. } | Fault::Wide { .. } => ROWS,
                Fault::NotFinite { .. } => "leave out poses that are not known",
                ref other => other.help(),
            },
            PoseFault::Time(..) => "sort the poses by time",
            PoseFault::NoPoses => ROWS,
            PoseFault::Length(_) => "a rotation is a unit quaternion, w last",
            PoseFault::Far(_) => "lengths are in metres",
        }
    }
}

const ROWS: &str = "each line after the headings is a pose: t,x,y,z,qx,qy,qz,qw";

impl From<TableError> for PoseError {
    fn from(error: TableError) -> Self {
        Self {
            line: error.line,
            fault: PoseFault::Row(error),
        }
    }
}
