//! A painting's document: vast canvases, long histories, opening, packing.
//!
//! | module | holds |
//! | --- | --- |
//! | [`hand`] | a hand that paints strokes anywhere, from a seed |
//! | [`vast`] | a canvas larger than memory, compared with a small one |
//! | [`undoing`] | ten thousand steps undone |
//! | [`opening`] | time until a painting is displayed and can be painted on |
//! | [`packing`] | a packed painting compared with an OpenEXR file |

mod hand;
mod opening;
mod packing;
mod undoing;
mod vast;

use maulstick_rig::UserError;

use crate::report::Report;

/// Measures and reports.
pub(crate) fn run(report: &mut Report) -> Result<(), UserError> {
    vast::run(report)?;
    undoing::run(report)?;
    opening::run(report)?;
    packing::run(report)
}

/// The error in the user's words.
fn fault(error: impl ToString) -> UserError {
    UserError::failure(error.to_string())
}
