//! Appearance of paint in numbers: films, relief, streaks.
//!
//! | module | holds |
//! | --- | --- |
//! | [`convergence`] | one stroke on cells of three sizes: volumes and spectra of its relief |
//! | [`easel`] | a canvas, a brush, a hand, and the resulting films |
//! | [`marks`] | the measurements |

mod convergence;
mod easel;
#[cfg(test)]
mod extremes;
mod marks;
#[cfg(test)]
mod tests;

use maulstick_rig::UserError;

use marks::{Painter, Trial};

use crate::report::Report;

/// Side of a cell, mm.
const CELL_MM: f64 = 0.125;

/// Measures and reports.
pub(crate) fn run(report: &mut Report) -> Result<(), UserError> {
    let trial = Trial {
        cell_mm: CELL_MM,
        painter: Painter::Able,
    };
    for measure in marks::ALL {
        for (name, value, unit) in measure(trial)? {
            report.row(name, value, unit);
        }
    }
    convergence::run(report)
}
