//! `maulstick brush sheet`: the brushes of the library and their marks.

use maulstick::commands::progress_bar;
use maulstick_painting_setup::library;
use maulstick_rig::UserError;
use maulstick_rig::files::{Kind, check_writable};
use maulstick_tool_options::figures::SheetOptions;

use crate::sheet::sheet;

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
