//! Refusals of a painting as the user sees them.

use maulstick_canvas::EditError;
use maulstick_rig::UserError;

/// A refusal of the painting as the user sees it.
#[must_use]
pub fn refused(refusal: EditError) -> UserError {
    UserError::usage(refusal.to_string()).advise(refusal.advice())
}
