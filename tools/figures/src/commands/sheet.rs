//! `maulstick brush sheet`: the brushes of the library and their marks.

use std::path::PathBuf;

use clap::Args;
use maulstick::commands::progress_bar;
use maulstick_painting_setup::cells::SheetCells;
use maulstick_painting_setup::library;
use maulstick_rig::UserError;
use maulstick_rig::files::{Kind, check_writable};

use crate::sheet::sheet;

/// Options of `maulstick brush sheet`.
#[derive(Args, Clone, Debug)]
pub(crate) struct SheetOptions {
    /// Picture to write, a PNG
    #[arg(short, long, value_name = "PNG")]
    output: PathBuf,
    #[command(flatten)]
    cells: SheetCells,
}

pub(super) fn run(options: &SheetOptions) -> Result<i32, UserError> {
    let path = &options.output;
    check_writable(path, Kind::Png).map_err(|error| UserError::writing(path, &error))?;
    let bar = progress_bar(0).with_message("painting");
    let picture = sheet(&library()?, options.cells.side_mm(), |done, of| {
        bar.set_length(of as u64);
        bar.set_position(done as u64);
    })?;
    bar.finish_and_clear();
    super::write(&picture, path)?;
    Ok(0)
}
