//! Refusals of a painting as the user sees them.

use maulstick_painting::EditError;
use maulstick_rig::UserError;

/// A refusal of the painting as the user sees it.
#[must_use]
pub fn refused(refusal: impl Into<EditError>) -> UserError {
    let refusal = refusal.into();
    UserError::usage(refusal.to_string()).advise(refusal.advice())
}
