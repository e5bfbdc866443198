//! `maulstick canvas`: the canvas of a running rig and the light over it.

mod light;

use clap::Subcommand;
use maulstick_rig::UserError;

use crate::commands::edit::{self, CanvasEdit};

/// Commands of `maulstick canvas`.
#[derive(Clone, Debug, Subcommand)]
pub enum CanvasCommand {
    /// An edit
    #[command(flatten)]
    Edit(CanvasEdit),
    /// Show or change the light
    Light(light::LightOptions),
}

/// Runs the command.
///
/// # Errors
/// A [`UserError`] with the refusal of the painting, or where no rig runs.
pub fn run(command: &CanvasCommand) -> Result<i32, UserError> {
    match command {
        CanvasCommand::Edit(edit) => edit::run(edit),
        CanvasCommand::Light(options) => light::run(options),
    }
}
