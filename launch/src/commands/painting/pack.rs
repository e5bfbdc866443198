//! `maulstick painting pack`: a painting's file made as small as possible.

use std::path::PathBuf;

use clap::Args;
use maulstick_document::pack::{Forget, pack};
use maulstick_rig::UserError;
use maulstick_rig::size::show_bytes;

use maulstick_painting_setup::document::wrong;

use crate::commands::{progress, progress_bar, say};

/// Options of `maulstick painting pack`.
#[derive(Args, Clone, Debug)]
pub struct PackOptions {
    /// Painting
    file: PathBuf,
    /// Discard all undo steps, and the record of what was painted; versions stay
    #[arg(long)]
    forget_history: bool,
    /// Discard the record of what was painted, of which time lapses are made; it begins anew
    #[arg(long)]
    forget_record: bool,
}

/// Packs a painting.
///
/// # Errors
/// A [`UserError`] where it cannot be read or written; it is then unchanged.
pub(super) fn run(options: &PackOptions) -> Result<i32, UserError> {
    let path = &options.file;
    let forget = match (options.forget_history, options.forget_record) {
        (true, _) => Forget::History,
        (false, true) => Forget::Record,
        (false, false) => Forget::Nothing,
    };
    let bar = progress_bar(0).with_message("packing");
    let packed = pack(path, forget, &mut progress(&bar));
    bar.finish_and_clear();
    let [before, after] = packed.map_err(|error| wrong(path, &error))?;
    say!(
        "{}: {} instead of {}",
        path.display(),
        show_bytes(after),
        show_bytes(before)
    );
    Ok(0)
}
