//! `maulstick brush mode`: how a brush is used.

use clap::Args;
use maulstick_rig::UserError;
use maulstick_types::edits::Handle;

use crate::commands::client::Target;

/// Options of `maulstick brush mode`.
#[derive(Args, Clone, Debug)]
pub struct ModeOptions {
    #[command(flatten)]
    edit: Handle,
    #[command(flatten)]
    target: Target,
}

impl ModeOptions {
    /// The edit that is asked for.
    #[must_use]
    pub fn edit(&self) -> Handle {
        self.edit.clone()
    }
}

/// Uses a brush in another way.
///
/// # Errors
/// A [`UserError`] for an option that does nothing with the mode, an unknown brush, or where no rig runs.
pub fn mode(options: &ModeOptions) -> Result<i32, UserError> {
    super::edit::send(&options.target, options.edit().into())
}
