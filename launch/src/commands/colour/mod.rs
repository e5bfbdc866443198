//! Commands of colour: paints, mixtures, matches.

pub mod matching;
pub mod mix;
pub mod paints;

use clap::Subcommand;
use maulstick_rig::UserError;

/// Commands of `maulstick colour`.
#[derive(Clone, Debug, Subcommand)]
pub enum ColourCommand {
    /// List the paints
    Paints(paints::PaintsOptions),
    /// Mix paints and show their colour
    Mix(mix::MixOptions),
    /// Propose mixtures for a colour
    Match(matching::MatchOptions),
}

/// Runs the command.
///
/// # Errors
/// A [`UserError`] of the command.
pub fn run(command: &ColourCommand) -> Result<i32, UserError> {
    match command {
        ColourCommand::Paints(options) => paints::run(options),
        ColourCommand::Mix(options) => mix::run(options),
        ColourCommand::Match(options) => matching::run(options),
    }
}
