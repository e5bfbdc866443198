//! Appearance of paint in numbers: films, relief, streaks, colour that travels.
//!
//! | module | holds |
//! | --- | --- |
//! | [`convergence`] | one stroke on cells of three sizes: volumes and spectra of its relief |
//! | [`easel`] | a canvas, a brush, a hand, and the resulting films |
//! | [`map`] | a number a cell, cut and turned |
//! | [`marks`] | films, tooth, dry-brush, knife |
//! | [`reading`] | what a painter sees at reading distance, by the worst of several cases |

pub mod convergence;
pub mod easel;
#[cfg(test)]
mod extremes;
pub mod map;
pub mod marks;
pub mod reading;
#[cfg(test)]
mod tests;

use maulstick_rig::UserError;

use marks::{Painter, Trial};

/// Side of a cell, mm.
const CELL_MM: f64 = 0.125;

/// A measured number.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Its name.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// Unit of the value.
    pub unit: &'static str,
    /// The bound that it should keep.
    pub target: Option<f64>,
}

/// Measures everything, and gives each row to `row` as it is found.
///
/// # Errors
/// [`UserError`] if a stroke is refused.
pub fn measure(mut row: impl FnMut(Row)) -> Result<(), UserError> {
    let trial = Trial {
        cell_mm: CELL_MM,
        painter: Painter::Able,
    };
    for measure in marks::ALL {
        for (name, value, unit) in measure(trial)? {
            row(Row {
                name,
                value,
                unit,
                target: None,
            });
        }
    }
    for own in reading::ALL {
        for found in reading::worst(*own)? {
            row(found);
        }
    }
    convergence::run(row)
}
