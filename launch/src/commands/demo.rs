//! `maulstick demo`: a performance from a seed.

use std::path::PathBuf;

use clap::Args;
use maulstick_device::demo::{Subject, performance};
use maulstick_rig::Fault;

use crate::commands::write_take;

/// Options of `maulstick demo`.
#[derive(Args, Clone, Debug)]
pub struct DemoOptions {
    /// The take to write
    #[arg(short, long, value_name = "TAKE")]
    output: PathBuf,
    /// A sheet of marks instead of the flower
    #[arg(long)]
    sheet: bool,
    /// The same seed gives the same performance
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Writes the performance.
///
/// # Errors
/// A [`Fault`] where the take cannot be written.
pub fn run(options: &DemoOptions) -> Result<i32, Fault> {
    let subject = if options.sheet {
        Subject::Sheet
    } else {
        Subject::Flower
    };
    write_take(&performance(subject, options.seed), &options.output)?;
    Ok(0)
}
