//! `maulstick painting`: paintings in files and in a running rig.

pub mod begin;
mod compare;
mod convert;
mod export;
mod import;
mod info;
mod log;
mod log_words;
pub mod open;
mod pack;
pub mod save_as;
pub mod snapshot;
mod timelapse;
mod versions;
mod wall_time;

pub(super) use timelapse::no_record;

use clap::Subcommand;
use maulstick_rig::UserError;

use crate::commands::edit::{self, PaintingEdit};

/// Subcommands of `maulstick painting`.
#[derive(Subcommand, Clone, Debug)]
pub enum PaintingCommand {
    /// Begin a new painting in the running rig
    New(begin::NewOptions),
    /// Open another painting in the running rig
    Open(open::OpenOptions),
    /// Save the painting under another name and go on there
    SaveAs(save_as::SaveAsOptions),
    /// Write the picture as a file
    Snapshot(snapshot::SnapshotOptions),
    /// An edit
    #[command(flatten)]
    Edit(PaintingEdit),
    /// Show what a painting holds
    Info(info::InfoOptions),
    /// Export a painting: PNG, OpenEXR, OpenRaster, height, gloss, STL, glTF
    Export(export::ExportOptions),
    /// Import a picture as underpainting, ground or tooth
    Import(import::ImportOptions),
    /// Write a copy with another paint model
    Convert(convert::ConvertOptions),
    /// List, keep, compare versions of a painting, or return to one
    Versions(versions::VersionsOptions),
    /// Make a painting's file as small as possible
    Pack(pack::PackOptions),
    /// Make a film of how a painting was painted
    Timelapse(timelapse::TimelapseOptions),
    /// List who did what in a painting, and when
    Log(log::LogOptions),
}

/// Runs the subcommand.
///
/// # Errors
/// A [`UserError`] where the painting cannot be read, or something cannot be written.
pub fn run(command: &PaintingCommand) -> Result<i32, UserError> {
    match command {
        PaintingCommand::New(options) => begin::run(options),
        PaintingCommand::Open(options) => open::run(options),
        PaintingCommand::SaveAs(options) => save_as::run(options),
        PaintingCommand::Snapshot(options) => snapshot::snapshot(options),
        PaintingCommand::Edit(edit) => edit::run(edit),
        PaintingCommand::Info(options) => info::run(options),
        PaintingCommand::Export(options) => export::run(options),
        PaintingCommand::Import(options) => import::run(options),
        PaintingCommand::Convert(options) => convert::run(options),
        PaintingCommand::Versions(options) => versions::run(options),
        PaintingCommand::Pack(options) => pack::run(options),
        PaintingCommand::Timelapse(options) => timelapse::run(options),
        PaintingCommand::Log(options) => log::run(options),
    }
}
