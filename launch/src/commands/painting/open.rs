//! `maulstick painting open`: another painting in a running rig.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use maulstick_rig::{UserError, whole_path};
use maulstick_types::command::RigCommand;

use crate::commands::client::{Client, Target};
use crate::commands::say;

/// Longest wait for a painting to be open: its last journal records may have to be done again.
pub(crate) const LONGEST: Duration = Duration::from_secs(3600);

/// Options of `maulstick painting open`.
#[derive(Args, Clone, Debug)]
pub struct OpenOptions {
    /// Painting
    file: PathBuf,
    /// Discard the current painting if it is in memory only
    #[arg(long)]
    forget: bool,
    #[command(flatten)]
    target: Target,
}

/// Opens another painting in the running rig.
///
/// # Errors
/// A [`UserError`] where it cannot be opened, or where no rig runs.
pub fn run(options: &OpenOptions) -> Result<i32, UserError> {
    let command = RigCommand::Open {
        path: whole_path(&options.file)?,
        forget: options.forget,
    };
    let done = Client::open(&options.target)?.send_within(command, LONGEST)?;
    say!("{done}");
    Ok(0)
}
