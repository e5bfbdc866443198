//! Errors of paints and mixtures as errors of edits.

use maulstick_canvas::EditError;
use maulstick_optics::PaintError;

/// A refusal because of a paint or a mixture.
#[must_use]
pub fn paint_error(error: PaintError) -> EditError {
    match error {
        PaintError::Unknown { name, nearest } => EditError::NoPaint { name, nearest },
        PaintError::Mixture(error) => error.into(),
        PaintError::File { line, fault } => EditError::PaintFile {
            line,
            what: fault.to_string(),
        },
    }
}
