//! `maulstick painting`: paintings in files.

mod compare;
mod export;
mod import;
mod info;
mod pack;
mod recover;
mod versions;

pub(super) use export::formats;

use clap::Subcommand;
use indicatif::{ProgressBar, ProgressStyle};
use maulstick_rig::Fault;

/// Subcommands of `maulstick painting`.
#[derive(Subcommand, Clone, Debug)]
pub enum PaintingCommand {
    /// Shows what a painting holds
    Info(info::InfoOptions),
    /// Writes a painting for other programs: PNG, OpenEXR, OpenRaster, a height map, STL
    Export(export::ExportOptions),
    /// Takes a picture into a painting: as underpainting, as ground or as tooth
    Import(import::ImportOptions),
    /// Takes what is whole out of a damaged painting
    Recover(recover::RecoverOptions),
    /// Lists the versions of a painting; keeps, compares and returns to them
    Versions(versions::VersionsOptions),
    /// Makes a painting's file as small as it gets
    Pack(pack::PackOptions),
}

/// Runs the subcommand.
///
/// # Errors
/// A [`Fault`] where the painting cannot be read, or something cannot be written.
pub fn run(command: &PaintingCommand) -> Result<i32, Fault> {
    match command {
        PaintingCommand::Info(options) => info::run(options),
        PaintingCommand::Export(options) => export::run(options),
        PaintingCommand::Import(options) => import::run(options),
        PaintingCommand::Recover(options) => recover::run(options),
        PaintingCommand::Versions(options) => versions::run(options),
        PaintingCommand::Pack(options) => pack::run(options),
    }
}

/// A bar for work of so many parts, with the time left; drawn only on a terminal.
fn bar(what: &'static str) -> ProgressBar {
    let bar = ProgressBar::new(0).with_message(what);
    if let Ok(style) = ProgressStyle::with_template("{msg} {bar:40} {percent:>3} %, {eta} left") {
        bar.set_style(style);
    }
    bar
}

/// What tells a bar how far the work is.
fn tell(bar: &ProgressBar) -> impl FnMut(u64, u64) {
    |done, all| {
        bar.set_length(all);
        bar.set_position(done);
    }
}
