//! How the paint looks, in numbers: films, relief, streaks.
//!
//! | module | holds |
//! | --- | --- |
//! | [`easel`] | a canvas, a brush, a hand, and the films that they leave |
//! | [`marks`] | the measurements |

mod easel;
mod marks;

use maulstick_rig::Fault;

use crate::report::Report;

/// Side of a cell, mm.
const CELL_MM: f64 = 0.125;

/// Measures and reports.
pub(crate) fn run(report: &mut Report) -> Result<(), Fault> {
    let cell_mm = std::env::var("LOOKS_CELL")
        .ok()
        .and_then(|v| v.parse().ok())
        .unwrap_or(CELL_MM);
    for measure in marks::ALL {
        for (name, value, unit) in measure(cell_mm)? {
            report.row(name, value, unit);
        }
    }
    Ok(())
}
