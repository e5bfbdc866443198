//! `maulstick painting convert`: a copy of a painting with another paint model.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;
use maulstick_document::DocumentError;
use maulstick_models::{model_called, model_names};
use maulstick_num::fork_join::with_cores_beyond;
use maulstick_painting::edits::common;
use maulstick_painting::{Applied, EditError, SurfaceError};
use maulstick_rig::files::{Kind, check_writable};
use maulstick_rig::{RigConfig, UserError};
use maulstick_session::Autosave;
use maulstick_types::Edit;
use maulstick_types::scene::{CANVAS, PALETTE};
use maulstick_types::values::ModelName;

use maulstick_painting_setup::document::{copy_closed, go_on, read, wrong};
use maulstick_painting_setup::refused;

use crate::commands::say;

/// Options of `maulstick painting convert`.
#[derive(Args, Clone, Debug)]
pub struct ConvertOptions {
    /// Painting, which is not changed
    file: PathBuf,
    /// Paint model of the copy
    #[arg(long, value_name = "NAME", value_parser = PossibleValuesParser::new(model_names()))]
    model: String,
    /// Convert the palette instead of the canvas
    #[arg(long)]
    palette: bool,
    /// Painting to write
    #[arg(short, long, value_name = "NEW.maul")]
    output: PathBuf,
}

/// Writes the converted copy, whole or not at all.
///
/// # Errors
/// A [`UserError`] where the painting cannot be read or has the model already, or the new one cannot be written.
pub(super) fn run(options: &ConvertOptions) -> Result<i32, UserError> {
    let (path, output) = (&options.file, &options.output);
    if output.symlink_metadata().is_ok() {
        return Err(wrong(output, &DocumentError::Taken));
    }
    let surface = if options.palette { PALETTE } else { CANVAS };
    let refuse = |error: EditError| refused(error).at(path.display().to_string());
    let model = model_called(&options.model).map_err(|unknown| refuse(unknown.into()))?;
    // Says so where it is open in another program.
    let (document, opened) = read(path)?;
    let mut surfaces = opened.snapshot().scene.surfaces.iter();
    let has_it = surfaces.any(|own| own.id == surface && own.model == model.name);
    drop(opened);
    document.close().map_err(|error| wrong(path, &error))?;
    if has_it {
        return Err(refuse(SurfaceError::SameModel(model.name).into()));
    }
    check_writable(output, Kind::Own).map_err(|error| UserError::writing(output, &error))?;
    let beside = output.parent().filter(|own| !own.as_os_str().is_empty());
    let folder = tempfile::tempdir_in(beside.unwrap_or(Path::new(".")))
        .map_err(|error| UserError::writing(output, &error))?;
    let part = folder.path().join("converted.maul");
    copy_closed(path, &part)?;
    let name = ModelName::new(model.name).map_err(|error| refuse(error.into()))?;
    let edit = common::convert(surface, name);
    let applied = converted(&part, edit.into(), output)?.map_err(refuse)?;
    place(&part, output)?;
    say!("written   {}", output.display());
    say!("          {applied}");
    Ok(0)
}

/// Converts a painting in its file, unless the painting refuses it.
fn converted(
    part: &Path,
    edit: Edit,
    output: &Path,
) -> Result<Result<Applied, EditError>, UserError> {
    let (document, mut sequencer, since) = go_on(&RigConfig::default(), part)?;
    let autosave = Autosave::new(document, &mut sequencer, since);
    let applied = with_cores_beyond(0, || sequencer.edit(edit));
    let closed = autosave.close(&mut sequencer);
    closed.map_err(|error| wrong(output, &error))?;
    Ok(applied)
}

/// Gives a file its name, unless that exists.
fn place(part: &Path, output: &Path) -> Result<(), UserError> {
    let placed = match std::fs::hard_link(part, output) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            return Err(wrong(output, &DocumentError::Taken));
        }
        // Some file systems have no links.
        Err(_) => std::fs::rename(part, output),
        Ok(()) => Ok(()),
    };
    placed.map_err(|error| UserError::writing(output, &error))
}
