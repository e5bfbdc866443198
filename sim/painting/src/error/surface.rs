//! Errors of surfaces and what they are made of.

use maulstick_types::Region;
use maulstick_types::command::advice::Advice;
use maulstick_types::limits::CELLS_MAX;
use maulstick_types::nearest::choice;
use maulstick_types::values::{CellSide, Quantity as _};

/// A surface, a place on it or a property of it that is rejected.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SurfaceError {
    /// An unknown surface.
    #[error("there is no surface {0}")]
    Unknown(u32),
    /// A region without a cell of its surface.
    #[error("the region {region} holds no cell of the surface")]
    NoCell {
        /// The region.
        region: Region,
        /// Width and height of the surface, mm.
        surface_mm: [f64; 2],
    },
    /// A place without paint.
    #[error("no paint lies {:.1} mm from the left edge and {:.1} mm from the lower edge", at_m[0] * 1e3, at_m[1] * 1e3)]
    NoPaintThere {
        /// The place, m.
        at_m: [f64; 2],
    },
    /// A well beyond the edge of its surface.
    #[error("well {place} is not wholly on its surface")]
    WellBeside {
        /// Its place, from 1.
        place: usize,
        /// Width and height of the surface, mm.
        surface_mm: [f64; 2],
    },
    /// A surface that has this paint model already.
    #[error("this surface has the paint model '{0}' already")]
    SameModel(&'static str),
    /// An unknown tooth.
    #[error("there is no tooth called '{name}'")]
    NoTooth {
        /// Its name.
        name: String,
        /// Those that there are.
        known: Vec<&'static str>,
    },
    /// A surface of too few or too many cells.
    #[error("a canvas cannot have {}×{} cells", .0[0], .0[1])]
    Cells([u32; 2]),
    /// Cells that are too small or too large, mm.
    #[error("cells cannot be {0} mm wide")]
    CellSize(f64),
}

impl SurfaceError {
    /// What to do about it.
    #[must_use]
    pub fn advice(&self) -> Advice {
        Advice::say(match self {
            Self::Unknown(_) => "the canvas is 0, the palette 1".to_owned(),
            Self::NoCell {
                surface_mm: [width, height],
                ..
            } => {
                format!("the surface measures {width:.1}×{height:.1} mm from its lower left corner")
            }
            Self::NoPaintThere { .. } => "choose a place with paint, wet or dry".to_owned(),
            Self::WellBeside {
                surface_mm: [width, height],
                ..
            } => format!(
                "the surface is {width:.0}×{height:.0} mm: give a middle and a radius within"
            ),
            Self::SameModel(_) => "choose another one".to_owned(),
            Self::NoTooth { name, known } => choice(name, known.iter().copied()),
            Self::Cells(_) => format!("choose 1 to {CELLS_MAX} cells across and up"),
            Self::CellSize(_) => format!("choose cells of {}", CellSide::range_text()),
        })
    }
}
