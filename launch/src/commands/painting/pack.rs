//! `maulstick painting pack`: a painting's file made as small as possible.

use std::path::PathBuf;

use clap::Args;
use maulstick_document::pack::{History, pack};
use maulstick_rig::UserError;
use maulstick_rig::size::show_bytes;

use crate::commands::say;
use crate::document::wrong;

/// Options of `maulstick painting pack`.
#[derive(Args, Clone, Debug)]
pub struct PackOptions {
    /// Painting
    file: PathBuf,
    /// Discard all undo steps; versions stay
    #[arg(long)]
    forget_history: bool,
}

/// Packs a painting.
///
/// # Errors
/// A [`UserError`] where it cannot be read or written; it is as it was then.
pub(super) fn run(options: &PackOptions) -> Result<i32, UserError> {
    let path = &options.file;
    let history = match options.forget_history {
        true => History::Forgotten,
        false => History::Kept,
    };
    let bar = super::bar("packing");
    let packed = pack(path, history, &mut super::tell(&bar));
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
