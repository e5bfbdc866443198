//! `maulstick demo`: a performance from a seed, and a sheet of what paint can do.

use std::path::PathBuf;

use clap::Args;
use indicatif::ProgressBar;
use maulstick_device::demo::{Subject, performance};
use maulstick_rig::Fault;
use maulstick_rig::files::Kind;

use crate::cells::SheetCells;
use crate::commands::{say, write_picture, write_take};
use crate::outputs::{UsedFile, check_outputs};
use crate::performance::library;
use crate::sheet::effects::effects;

/// Options of `maulstick demo`.
#[derive(Args, Clone, Debug)]
pub struct DemoOptions {
    /// The take to write
    #[arg(short, long, value_name = "TAKE", required_unless_present = "sheet")]
    output: Option<PathBuf>,
    /// A sheet of marks instead of the flower
    #[arg(long)]
    marks: bool,
    /// Paints what the paint model is for, with words, into this PNG: transfer both ways, loading,
    /// drying, blending, glazing, impasto, scumbling
    #[arg(long, value_name = "PNG")]
    sheet: Option<PathBuf>,
    #[command(flatten)]
    cells: SheetCells,
    /// The same seed gives the same performance; 1 if absent
    #[arg(long)]
    seed: Option<u64>,
}

impl DemoOptions {
    /// Refuses options that would do nothing.
    fn check_idle(&self) -> Result<(), Fault> {
        for (option, given, help) in [
            (
                "--marks",
                self.marks,
                "these marks are a take: -o TAKE writes it",
            ),
            (
                "--seed",
                self.seed.is_some(),
                "it is for a performance: -o TAKE writes one; the sheet is always the same",
            ),
        ] {
            if given && self.output.is_none() {
                let what = format!("{option} does nothing beside --sheet alone");
                return Err(Fault::usage(what).help(help));
            }
        }
        if self.cells.cell_mm.is_some() && self.sheet.is_none() {
            return Err(Fault::usage("--cell-mm does nothing without --sheet PNG")
                .help("a take has no cells; `maulstick render --cell-mm` has"));
        }
        Ok(())
    }
}

/// Writes the performance and the sheet.
///
/// # Errors
/// A [`Fault`] where either cannot be written.
pub fn run(options: &DemoOptions) -> Result<i32, Fault> {
    options.check_idle()?;
    let take = UsedFile::written("the take", options.output.as_ref(), Kind::Take);
    let sheet = UsedFile::written("the sheet", options.sheet.as_ref(), Kind::Png);
    let outputs: Vec<_> = take.into_iter().chain(sheet).collect();
    check_outputs(&outputs, &[])?;
    if let Some(output) = &options.output {
        let subject = match options.marks {
            true => Subject::Marks,
            false => Subject::Flower,
        };
        write_take(&performance(subject, options.seed.unwrap_or(1)), output)?;
    }
    if let Some(path) = &options.sheet {
        let bar = ProgressBar::new(1);
        let picture = effects(&library()?, options.cells.side_mm(), |done, of| {
            bar.set_length(of as u64);
            bar.set_position(done as u64);
        })?;
        bar.finish_and_clear();
        write_picture(&picture, path)?;
        say!("{}", path.display());
    }
    Ok(0)
}
