//! `maulstick take`: what a take holds, and what of a damaged one is whole.

use std::path::PathBuf;

use clap::Subcommand;
use maulstick_device::Take;
use maulstick_rig::Fault;
use maulstick_types::stylus::StylusPose;
use serde_json::json;

use crate::commands::print_json;
use crate::commands::say;

/// Subcommands of `maulstick take`.
#[derive(Subcommand, Clone, Debug)]
pub enum TakeCommand {
    /// Shows what a take holds
    Info {
        /// The take
        take: PathBuf,
        /// As JSON
        #[arg(long)]
        json: bool,
    },
    /// Writes the whole samples of a damaged take to another file
    Recover {
        /// The damaged take, which stays as it is
        take: PathBuf,
        /// The take to write
        #[arg(short, long, value_name = "TAKE")]
        output: PathBuf,
    },
}

/// Runs the subcommand.
///
/// # Errors
/// A [`Fault`] where the take cannot be read or written.
pub fn run(command: &TakeCommand) -> Result<i32, Fault> {
    match command {
        TakeCommand::Info { take, json } => {
            let take = Take::read(take)?;
            let seconds = take.length_ns() as f64 * 1e-9;
            let rate = (take.samples.len() - 1) as f64 / seconds.max(1e-9);
            let pens = take
                .samples
                .iter()
                .any(|s| matches!(s.sample.pose, StylusPose::Contact { .. }));
            if *json {
                print_json(&json!({
                    "device": take.device,
                    "samples": take.samples.len(),
                    "seconds": seconds,
                    "rate_hz": rate,
                    "kind": if pens { "pen" } else { "6-DOF" },
                }))?;
            } else {
                let kind = if pens { "a pen" } else { "a 6-DOF stylus" };
                say!("device   {} ({kind})", take.device);
                say!(
                    "samples  {} over {seconds:.3} s, {rate:.1} a second",
                    take.samples.len()
                );
            }
            Ok(0)
        }
        TakeCommand::Recover { take, output } => {
            if take == output {
                return Err(Fault::usage("the damaged take would be overwritten")
                    .at(output.display().to_string())
                    .help("name another file after -o"));
            }
            let salvage = Take::salvage(take)?;
            salvage.take.write(output)?;
            let damage = salvage
                .damage
                .unwrap_or_else(|| "nothing was damaged".to_owned());
            say!(
                "{}: {} samples ({damage})",
                output.display(),
                salvage.take.samples.len()
            );
            Ok(0)
        }
    }
}
