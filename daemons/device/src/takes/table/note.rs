//! Notes about a table: guesses, and parts that paint nothing.

use std::fmt;

use maulstick_brush::model::BRIDGED_NS;

use super::{PAUSE_NS, STEEPEST_TILT_DEG, TimeUnit};

/// A note about a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Note {
    /// Unit that the column t is taken to have.
    Unit {
        /// The unit.
        unit: TimeUnit,
        /// Median time between samples of a stroke, in it.
        median: f64,
    },
    /// Samples outside of the tablet's area.
    Outside {
        /// Their number.
        beyond: usize,
        /// Number of all samples.
        samples: usize,
        /// The area, table units.
        size: [f64; 2],
    },
    /// Nothing is painted.
    Unpainted,
    /// Pauses within strokes, over which nothing is painted.
    Torn {
        /// Line after the first.
        line: usize,
        /// Their number.
        places: usize,
    },
    /// Samples that have the time of the one before.
    Coarse {
        /// Their number.
        ties: usize,
        /// Number of all samples.
        samples: usize,
    },
    /// Number of strokes, where there are several.
    Strokes(usize),
    /// Number of pressures outside of 0 to 1 by rounding.
    Pressures(usize),
    /// Number of tilts that are steeper than a brush is held.
    Tilts(usize),
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unit { unit, median } => write!(
                f,
                "the unit of t is taken to be {}: samples of a stroke are {median} apart (to choose another: --time-unit s)",
                unit.name()
            ),
            Self::Outside {
                beyond,
                samples,
                size: [width, height],
            } => write!(
                f,
                "{beyond} of {samples} samples lie outside of {width}x{height} units: give the tablet's area by --size"
            ),
            Self::Unpainted => {
                f.write_str("no two samples in a row have pressure, so the take paints nothing")
            }
            Self::Torn { line, places } => write!(
                f,
                "line {line}: more than {:.1} s have passed since the sample before, as in {places} places: nothing is painted between them",
                BRIDGED_NS as f64 * 1e-9
            ),
            Self::Coarse { ties, samples } => write!(
                f,
                "t is coarse: {ties} of {samples} samples have the time of the one before, and are spread evenly up to the next"
            ),
            Self::Strokes(strokes) => write!(
                f,
                "{strokes} strokes: the pen is lifted between them for {} s at least",
                PAUSE_NS * 1e-9
            ),
            Self::Pressures(count) => write!(
                f,
                "{count} pressures lie outside of 0 to 1 by no more than rounding: taken as 0 and 1"
            ),
            Self::Tilts(count) => write!(
                f,
                "{count} tilts are steeper than {STEEPEST_TILT_DEG}°: taken as {STEEPEST_TILT_DEG}°"
            ),
        }
    }
}
