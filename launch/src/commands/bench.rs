//! `maulstick bench`: starts the benchmarks, which live in a program of their own with their peers.

use std::path::PathBuf;
use std::process::Command;

use clap::Args;
use clap::builder::PossibleValuesParser;
use maulstick_models::model_names;
use maulstick_rig::UserError;

/// Options of `maulstick bench`.
#[derive(Args, Clone, Debug)]
pub struct BenchOptions {
    /// What to measure: brush, bus, document, frames, haptics, idle, latency, looks, optics, paint, pen,
    /// recording, render, view, window [default: everything]
    area: Option<String>,
    /// Paint model to measure in `paint` and `render` [default: impasto]
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(model_names()))]
    model: Option<String>,
    /// Where `paint` computes its steps [default: cpu]
    #[arg(long, value_name = "NAME", value_parser = ["cpu", "gpu"])]
    backend: Option<String>,
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Append the figures to a table of measurements (docs/measurements)
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
}

/// Runs the benchmarks.
///
/// # Errors
/// A [`UserError`] where they are not built.
pub fn run(options: &BenchOptions) -> Result<i32, UserError> {
    let program = beside("maulstick-bench")?;
    let mut command = Command::new(&program);
    command.args(&options.area);
    for (option, value) in [("--model", &options.model), ("--backend", &options.backend)] {
        if let Some(value) = value {
            command.args([option, value]);
        }
    }
    if options.json {
        command.arg("--json");
    }
    if let Some(file) = &options.csv {
        command.arg("--csv").arg(file);
    }
    let status = command.status().map_err(|error| {
        UserError::failure(format!("the benchmarks cannot be started: {error}"))
            .at(program.display().to_string())
            .help("build them: cargo build --release -p maulstick-bench")
    })?;
    Ok(status
        .code()
        .unwrap_or(maulstick_rig::user_error::EXIT_FAILURE))
}

/// The program called `name` beside this one.
///
/// # Errors
/// A [`UserError`] where this program does not know its own path.
pub fn beside(name: &str) -> Result<PathBuf, UserError> {
    let own = std::env::current_exe().map_err(|error| UserError::failure(error.to_string()))?;
    Ok(own.with_file_name(name))
}
