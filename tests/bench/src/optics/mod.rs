//! Kubelka-Munk optics: accuracy of the colours of a few wavelengths, and speed of shading films.
//!
//! | module | holds |
//! | --- | --- |
//! | [`mixtures`] | mixtures outside of all fits |
//! | [`colours`] | rules compared with all 101 samples |
//! | [`films`] | films of a set of tiles, for measuring rates |
//! | [`rate`] | both backends, each compared with a copy |

mod colours;
mod films;
mod mixtures;
mod rate;

use maulstick_rig::UserError;

use crate::report::Report;

/// Measures and reports.
pub(crate) fn run(report: &mut Report) -> Result<(), UserError> {
    colours::run(report)?;
    rate::run(report)
}
