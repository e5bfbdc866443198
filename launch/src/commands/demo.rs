//! `maulstick demo`: a performance from a seed.

use std::path::PathBuf;

use clap::Args;
use maulstick_device::demo::performance;
use maulstick_rig::Fault;

use crate::commands::write_take;

/// Options of `maulstick demo`.
#[derive(Args, Clone, Debug)]
pub struct DemoOptions {
    /// The take to write
    #[arg(short, long, value_name = "TAKE")]
    output: PathBuf,
    /// The same seed gives the same performance
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Writes the performance.
///
/// # Errors
/// A [`Fault`] where the take cannot be written.
pub fn run(options: &DemoOptions) -> Result<i32, Fault> {
    write_take(&performance(options.seed), &options.output)?;
    Ok(0)
}
