//! Kubelka-Munk optics: how true the colours of a few wavelengths are, and how fast films become
//! colour.
//!
//! | module | holds |
//! | --- | --- |
//! | [`mixtures`] | mixtures that no rule was fitted to |
//! | [`colours`] | rules beside all 101 samples |
//! | [`films`] | films of a set of tiles, and what the rates are measured with |
//! | [`rate`] | both backends, each beside a copy |

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
