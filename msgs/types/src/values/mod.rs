//! Validated values of commands: what is built or decoded is in range.
//!
//! | module | holds |
//! | --- | --- |
//! | `quantity` | range, unit and help of a number |
//! | `numbers` | numbers with a range, written in a painter's units |
//! | `texts` | names, paths and file contents of bounded length |
//! | `ticks` | durations |

mod numbers;
mod quantity;
mod texts;
mod ticks;

pub use numbers::{
    CellSide, Distance, FilmLimit, FilmThickness, ForceShare, GuidanceShare, MarkerFlow,
    OpacityFactor, Share, StainThickness, Stiffness, ThinnerShare, Tilt, Turn, Wetness, Zoom,
};
pub use quantity::{OutOfRange, Quantity};
pub use texts::{
    BrushName, BrushToml, DeviceName, DeviceToml, LayerName, MaterialName, ModelName, SpectrumText,
    VersionName, WholePath,
};
pub use ticks::{TICKS_A_SECOND, Ticks, seconds_in, ticks_in};

use crate::limits::FARTHEST_M;

/// A value that a command cannot have.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ValueError {
    /// A number out of its range.
    #[error(transparent)]
    Range(#[from] OutOfRange),
    /// A text that is too long.
    #[error("{what} of {bytes} bytes is too long: it has at most {most}")]
    Length {
        /// Its purpose.
        what: &'static str,
        /// Its bytes.
        bytes: usize,
        /// The limit, bytes.
        most: usize,
    },
    /// A text that is no number.
    #[error("{what} must be a number, not '{text}'")]
    NoNumber {
        /// The quantity.
        what: &'static str,
        /// The text.
        text: String,
    },
    /// A blank name, or one with control characters.
    #[error("{what} must not be blank or contain line breaks")]
    Unreadable {
        /// Its purpose.
        what: &'static str,
    },
    /// A brush's name that no topic can carry.
    #[error("the brush's name {fault}")]
    Brush {
        /// The defect.
        fault: String,
    },
    /// A relative path, or one with a NUL.
    #[error("give the whole path from the root, for each program has a folder of its own")]
    NotWhole,
    /// A duration that cannot be read.
    #[error("'{0}' is not a time such as 90s, 20min or 2h, up to 365d")]
    Time(String),
    /// A region that is empty, not finite or cannot be read.
    #[error("the region {0} is not X,Y,WxH in mm such as 10,20,60x40, or is empty")]
    Region(String),
    /// A name that is not among those known.
    #[error("there is no {what} called '{name}': {choice}")]
    Unknown {
        /// The kind of thing.
        what: &'static str,
        /// The name.
        name: String,
        /// The nearest name, and all.
        choice: String,
    },
    /// A surface out of reach, or a pose that is none.
    #[error(
        "a surface's pose is finite, its quaternion a unit one, within {FARTHEST_M} m of the desk's origin"
    )]
    Pose,
    /// A palette of too many wells.
    #[error("a palette has at most 64 wells, not {0}")]
    Wells(usize),
    /// A well that is not round, or out of reach.
    #[error("a well of radius {0} mm: choose a radius above 0, and a middle within the surface")]
    Well(f64),
    /// A mixture that is none.
    #[error(transparent)]
    Mixture(#[from] crate::mixture::MixtureError),
    /// A canvas that is too small or too large for its cells.
    #[error(
        "a canvas of {}×{} cm: with cells of {} mm choose {:.3} to {:.0} cm either way",
        .size_m[0] * 100.0, .size_m[1] * 100.0, .cell_m * 1e3, .cell_m * 100.0, .cell_m * 6_553_600.0
    )]
    Canvas {
        /// Width and height, m.
        size_m: [f64; 2],
        /// Side of a cell, m.
        cell_m: f64,
    },
    /// A canvas of too many cells.
    #[error("a canvas of {:.0} million cells: choose a smaller one or larger cells, 1074 million are the most", .0 * 1e-6)]
    Cells(f64),
    /// A PNG of other bits than 8 or 16.
    #[error("a PNG of {0} bits per channel: choose 8 or 16")]
    Bits(u32),
    /// An option without effect.
    #[error("{option} has no effect with {with}: leave it out")]
    Idle {
        /// The option.
        option: &'static str,
        /// Option beside which it has no effect.
        with: String,
    },
    /// A light out of range.
    #[error(transparent)]
    Light(#[from] crate::scene::LightError),
}

/// Sees that a surface can lie so.
///
/// # Errors
/// [`ValueError::Pose`] where it is not finite, or out of reach.
pub fn check_reach(pose: &crate::Pose) -> Result<(), ValueError> {
    let near = |metres: &f64| metres.abs() <= FARTHEST_M;
    if pose.is_valid() && pose.position_m.iter().all(near) {
        Ok(())
    } else {
        Err(ValueError::Pose)
    }
}
