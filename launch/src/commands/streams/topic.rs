//! `maulstick topic`: live streams of a running rig.

use clap::Subcommand;
use maulstick_rig::UserError;

use super::bridge::{self, BridgeOptions};
use super::echo::{self, EchoOptions};
use super::graph::{self, GraphOptions};
use super::measure::{self, Measure, MeasureOptions};

/// Commands of `maulstick topic`.
#[derive(Clone, Debug, Subcommand)]
pub enum TopicCommand {
    /// List what a rig sends
    List(MeasureOptions),
    /// Print the messages of a topic as they come
    Echo(EchoOptions),
    /// Measure how often messages come, and how many are missing
    Hz(MeasureOptions),
    /// Measure how long messages are on the way
    Latency(MeasureOptions),
    /// Draw the processes of a rig and what they send each other
    Graph(GraphOptions),
    /// Show a running rig in Foxglove
    Bridge(BridgeOptions),
}

/// Runs the command.
///
/// # Errors
/// A [`UserError`] if no rig runs, or for an option out of range.
pub fn run(command: &TopicCommand) -> Result<i32, UserError> {
    match command {
        TopicCommand::List(options) => measure::run(options, Measure::Topics),
        TopicCommand::Echo(options) => echo::run(options),
        TopicCommand::Hz(options) => measure::run(options, Measure::Rates),
        TopicCommand::Latency(options) => measure::run(options, Measure::Delays),
        TopicCommand::Graph(options) => graph::run(options),
        TopicCommand::Bridge(options) => bridge::run(options),
    }
}
