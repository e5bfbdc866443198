//! `maulstick demo effects`: effects of the paint model.

use maulstick::commands::{progress_bar, write_picture};
use maulstick::say;
use maulstick_painting_setup::library;
use maulstick_painting_setup::outputs::{UsedFile, check_outputs};
use maulstick_rig::UserError;
use maulstick_rig::files::Kind;
use maulstick_tool_options::figures::EffectsOptions;

use crate::sheet::effects::effects;

pub(super) fn run(options: &EffectsOptions) -> Result<i32, UserError> {
    let path = &options.output;
    check_outputs(&[UsedFile::new("the sheet", path).of(Kind::Png)], &[])?;
    let bar = progress_bar(0).with_message("painting");
    let picture = effects(&library()?, options.board.board()?, |done, of| {
        bar.set_length(of as u64);
        bar.set_position(done as u64);
    })?;
    bar.finish_and_clear();
    write_picture(&picture, path)?;
    say!("{}", path.display());
    Ok(0)
}
