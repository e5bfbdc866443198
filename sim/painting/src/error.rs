//! Errors of paints and mixtures as errors of edits.

use maulstick_canvas::EditError;
use maulstick_optics::PaintError;

/// A refusal because of a paint or a mixture.
#[must_use]
pub fn paint_error(error: PaintError) -> EditError {
    let help = match &error {
        PaintError::Unknown { .. } => "`maulstick paints` lists them all",
        _ => "write mixtures as \"Cobalt Blue=0.7,Titanium White=0.3\"",
    };
    EditError::new(error.to_string(), help)
}
