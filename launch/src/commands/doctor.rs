//! `maulstick doctor`: what of this machine keeps a rig from painting well, and the command that mends it.

use clap::Args;
use maulstick_doctor::{State, findings, in_words};
use maulstick_rig::UserError;
use serde_json::json;

use super::{print_json, print_text};

/// Options of `maulstick doctor`.
#[derive(Args, Clone, Debug)]
pub struct DoctorOptions {
    /// Print JSON
    #[arg(long)]
    json: bool,
}

/// Prints what is found; the exit code is 1 where something is wrong.
///
/// # Errors
/// A [`UserError`] where it cannot be printed.
pub fn run(options: &DoctorOptions) -> Result<i32, UserError> {
    let findings = findings();
    if options.json {
        print_json(&json!(findings))?;
    } else {
        print_text(&in_words(&findings))?;
    }
    let is_wrong = findings.iter().any(|finding| finding.state == State::Wrong);
    Ok(i32::from(is_wrong))
}
