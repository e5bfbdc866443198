//! `maulstick save-as`: the painting of a running rig in another file.

use std::path::PathBuf;

use clap::Args;
use maulstick_rig::UserError;
use maulstick_types::command::Command;

use super::open::{LONGEST, whole};
use crate::commands::say;
use crate::commands::session::{RIG, Session, Target};

/// Options of `maulstick save-as`.
#[derive(Args, Clone, Debug)]
pub struct SaveAsOptions {
    /// New file of the painting, with its history and versions
    file: PathBuf,
    /// Replace a painting that is already there
    #[arg(long)]
    replace: bool,
    #[command(flatten)]
    target: Target,
}

/// Puts the painting into another file, where it goes on.
///
/// # Errors
/// A [`UserError`] where it cannot be written there, or where no rig runs.
pub fn run(options: &SaveAsOptions) -> Result<i32, UserError> {
    let command = Command::SaveAs {
        path: whole(&options.file)?,
        replace: options.replace,
    };
    command.check().map_err(UserError::told)?;
    let done = Session::open(&options.target)?.send_within(RIG, command, LONGEST)?;
    say!("{done}");
    Ok(0)
}
