//! Faults of a motion, as data.

/// Error of a motion or its processing.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MotionError {
    /// A factor out of range.
    #[error("{what} {value} is not within {least} and {most}")]
    OutOfRange {
        /// The factor.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The least that it may be.
        least: f64,
        /// The most that it may be.
        most: f64,
    },
    /// A sample that no device may send.
    #[error("at {at_s:.3} s {fault}")]
    Sample {
        /// Time since the beginning, s.
        at_s: f64,
        /// Its fault.
        fault: &'static str,
    },
    /// Times that do not rise.
    #[error("time does not advance at {at_s:.3} s")]
    Times {
        /// Time since the beginning, s.
        at_s: f64,
    },
    /// A stroke with a gap that is too long to be painted across.
    #[error(
        "at {at_s:.3} s two samples of a stroke would lie {apart_s:.2} s apart, and nothing is painted over more than \
         {most_s:.1} s"
    )]
    Torn {
        /// Time since the beginning, s.
        at_s: f64,
        /// Time between the two samples, s.
        apart_s: f64,
        /// The most that is painted across, s.
        most_s: f64,
    },
    /// A cut without any sample.
    #[error(
        "no sample lies between {from_s:.3} s and {to_s:.3} s, and the motion is {length_s:.3} s long"
    )]
    NothingLeft {
        /// Start of the cut, s.
        from_s: f64,
        /// End of the cut, s.
        to_s: f64,
        /// Length of the motion, s.
        length_s: f64,
    },
    /// A stroke beyond the last.
    #[error("there is no stroke {asked}: the motion has {count}")]
    NoStroke {
        /// The number, from 1.
        asked: usize,
        /// Number of strokes.
        count: usize,
    },
    /// A motion without a single touch.
    #[error("the motion never touches the surface")]
    NoTouch,
    /// No motion at all.
    #[error("there is no motion to join")]
    NoMotion,
    /// An outline without an area.
    #[error("the outline encloses no area")]
    NoArea,
    /// An outline too narrow for the brush.
    #[error("the outline has no room for a brush that is {width_mm:.1} mm wide")]
    NoRoom {
        /// Width of the brush, mm.
        width_mm: f64,
    },
    /// Too much for one motion.
    #[error(
        "the outline would take {count} strokes {spacing_mm:.2} mm apart, and {most} is the most"
    )]
    TooMany {
        /// The strokes that it would take.
        count: usize,
        /// Their spacing, mm.
        spacing_mm: f64,
        /// The most that there may be.
        most: usize,
    },
    /// An example without a measurable spacing.
    #[error("the example is a single stroke, which has no spacing")]
    NoSpacing,
}

impl MotionError {
    /// Advice, of a few words.
    #[must_use]
    pub fn help(&self) -> &'static str {
        match self {
            Self::OutOfRange { .. } => "choose one within these bounds",
            Self::Sample { .. } => "keep it within 10 m of the middle of the desk",
            Self::Times { .. } => "choose a lower rate, or a longer duration",
            Self::Torn { .. } => "choose a higher rate, or a shorter duration",
            Self::NothingLeft { .. } | Self::NoStroke { .. } => {
                "`maulstick take strokes` lists its strokes and their times"
            }
            Self::NoTouch => {
                "choose one that paints; of a 6-DOF stylus the length of the head counts: --head-mm"
            }
            Self::NoMotion => "name at least one",
            Self::NoArea => "draw a closed line around an area",
            Self::NoRoom { .. } => {
                "scale it up, choose a narrower brush, or leave less room: --inset-mm"
            }
            Self::TooMany { .. } => "scale the outline down, or show an example with wider spacing",
            Self::NoSpacing => "show two strokes or more beside each other",
        }
    }
}

/// Sees that a factor is finite and within a range.
pub(crate) fn within(
    what: &'static str,
    value: f64,
    range: std::ops::RangeInclusive<f64>,
) -> Result<(), MotionError> {
    if range.contains(&value) {
        Ok(())
    } else {
        Err(MotionError::OutOfRange {
            what,
            value,
            least: *range.start(),
            most: *range.end(),
        })
    }
}
