//! Command of `maulstick-bench`.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Args, Subcommand};
use maulstick_models::{MODELS, model_names};

/// Backend that computes where no other is asked for.
pub const BACKEND: &str = "cpu";

/// The command.
#[derive(Debug, Subcommand)]
pub enum BenchGroup {
    /// Run benchmarks against reference programs
    Bench(BenchOptions),
}

/// Options of `maulstick bench`.
#[derive(Args, Clone, Debug)]
pub struct BenchOptions {
    /// What to measure: brush, bus, document, frames, haptics, idle, latency, looks, optics, paint, pen,
    /// recording, render, view, window [default: everything]
    pub area: Option<String>,
    /// Paint model to measure
    #[arg(long, default_value = MODELS[0].name, value_parser = PossibleValuesParser::new(model_names()))]
    pub model: String,
    /// Where its steps are computed
    #[arg(long, default_value = BACKEND, value_parser = ["cpu", "gpu"])]
    pub backend: String,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Append the figures to a table of measurements (docs/measurements)
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// The far end of the bus benchmark
    #[arg(long, hide = true)]
    pub far_end: Option<String>,
    /// A process of the pen benchmark
    #[arg(long, hide = true)]
    pub pen: Option<String>,
}
