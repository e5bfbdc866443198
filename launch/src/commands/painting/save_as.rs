//! `maulstick painting save-as`: the painting of a running rig in another file.

use std::path::PathBuf;

use clap::Args;
use maulstick_rig::{UserError, whole_path};
use maulstick_types::command::{RigCommand, SaveAs};

use crate::commands::client::{Client, Target};
use crate::commands::open::LONGEST;
use crate::commands::say;

/// Options of `maulstick painting save-as`.
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

/// Moves the painting to another file, where it continues.
///
/// # Errors
/// A [`UserError`] where it cannot be written there, or where no rig runs.
pub fn run(options: &SaveAsOptions) -> Result<i32, UserError> {
    let command = RigCommand::SaveAs(SaveAs {
        path: whole_path(&options.file)?,
        replace: options.replace,
    });
    let done = Client::open(&options.target)?.send_within(command, LONGEST)?;
    say!("{done}");
    Ok(0)
}
