//! `maulstick demo`: a performance from a seed, and a sheet of what paint can do.

use std::path::PathBuf;

use clap::Args;
use indicatif::ProgressBar;
use maulstick_device::demo::{Subject, performance};
use maulstick_rig::Fault;
use maulstick_rig::files::check_writable;

use crate::commands::{say, write_picture, write_take};
use crate::performance::library;
use crate::sheet::effects::effects;

/// Options of `maulstick demo`.
#[derive(Args, Clone, Debug)]
pub struct DemoOptions {
    /// The take to write
    #[arg(short, long, value_name = "TAKE", required_unless_present = "sheet")]
    output: Option<PathBuf>,
    /// A sheet of marks instead of the flower
    #[arg(long, requires = "output")]
    marks: bool,
    /// Paints what the paint model is for, with words, into this PNG: transfer both ways, loading,
    /// drying, blending, glazing, impasto, scumbling
    #[arg(long, value_name = "PNG")]
    sheet: Option<PathBuf>,
    /// The same seed gives the same performance
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Writes the performance and the sheet.
///
/// # Errors
/// A [`Fault`] where either cannot be written.
pub fn run(options: &DemoOptions) -> Result<i32, Fault> {
    if let Some(output) = &options.output {
        let subject = match options.marks {
            true => Subject::Marks,
            false => Subject::Flower,
        };
        write_take(&performance(subject, options.seed), output)?;
    }
    if let Some(path) = &options.sheet {
        check_writable(path).map_err(|error| Fault::writing(path, &error))?;
        let bar = ProgressBar::new(1);
        let picture = effects(&library()?, |done, of| {
            bar.set_length(of as u64);
            bar.set_position(done as u64);
        })?;
        bar.finish_and_clear();
        write_picture(&picture, path)?;
        say!("{}", path.display());
    }
    Ok(0)
}
