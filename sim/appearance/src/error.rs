//! Errors of lights and grounds.

use maulstick_canvas::CanvasError;
use maulstick_optics::spectrum_error::{DarkError, TableError};
use maulstick_types::command::advice::Advice;
use maulstick_types::nearest::choice;
use maulstick_types::scene::LightError;

/// A light or a ground that is rejected.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LookError {
    /// A picture of a ground.
    #[error(transparent)]
    Canvas(#[from] CanvasError),
    /// A light out of range.
    #[error(transparent)]
    Light(#[from] LightError),
    /// A spectrum that does not reach the eye.
    #[error(transparent)]
    Dark(#[from] DarkError),
    /// An unknown illuminant.
    #[error("there is no illuminant called '{name}'")]
    NoIlluminant {
        /// Its name.
        name: String,
        /// Those that there are.
        known: Vec<&'static str>,
    },
    /// An unknown ground.
    #[error("there is no ground called '{name}'")]
    NoGround {
        /// Its name.
        name: String,
        /// Those that there are.
        known: Vec<&'static str>,
    },
    /// A text that is not a table of reflectances.
    #[error("not a spectrum of a ground: {0}")]
    Spectrum(#[from] TableError),
}

impl LookError {
    /// What to do about it.
    #[must_use]
    pub fn advice(&self) -> Advice {
        match self {
            Self::Canvas(error) => error.advice(),
            Self::Light(_) => Advice::say("choose a value in range"),
            Self::Dark(_) => Advice::say("give a spectrum with more of the visible wavelengths"),
            Self::NoIlluminant { name, known } => Advice::say(format!(
                "{}, and any spectrum from a CSV file",
                choice(name, known.iter().copied())
            )),
            Self::NoGround { name, known } => Advice::say(choice(name, known.iter().copied())),
            Self::Spectrum(_) => Advice::say(
                "write one row for each wavelength: nm,reflectance, wavelengths rising, reflectances 0 to 1",
            ),
        }
    }
}
