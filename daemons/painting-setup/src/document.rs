//! Paintings in files, as the command line speaks of them.

use std::fs::File;
use std::path::Path;

use maulstick_document::{Access, Document, DocumentError, DocumentSettings, Opened, glance};
use maulstick_painting::{EditError, Painting, Sequencer};
pub use maulstick_recorder::paintings::wrong;
use maulstick_rig::UserError;
use maulstick_rig::config::{CanvasSection, RigConfig};
use maulstick_rig::files::{Kind, check_writable, companion};
use maulstick_types::paint::Decision;
use maulstick_types::scene::{CANVAS, Scene};

use crate::options::PaintingOptions;
use crate::painting::painting_setup;
use crate::paints::library_from;
use crate::refusal::refused;

/// A painting for reading only.
///
/// # Errors
/// A [`UserError`] if it does not exist, or cannot be read.
pub fn read(path: &Path) -> Result<(Document, Opened), UserError> {
    let settings = DocumentSettings::new(path, Access::Read);
    let (document, opened) = Document::open(&settings).map_err(|error| wrong(path, &error))?;
    let opened = opened.ok_or_else(|| wrong(path, &DocumentError::NoPainting))?;
    Ok((document, opened))
}

/// Copies a painting that is not open, including the files left by a crash.
///
/// # Errors
/// A [`UserError`] where it cannot be read, or the copy not be written.
pub fn copy_closed(from: &Path, to: &Path) -> Result<(), UserError> {
    for suffix in ["", "-wal"] {
        let [from, to] = [from, to].map(|path| companion(path, suffix));
        if suffix.is_empty() || from.exists() {
            let mut source =
                File::open(&from).map_err(|error| UserError::reading(&from, &error))?;
            let copied =
                File::create(&to).and_then(|mut copy| std::io::copy(&mut source, &mut copy));
            copied.map_err(|error| UserError::writing(&to, &error))?;
        }
    }
    Ok(())
}

/// A painting from its file, or a new one by the settings. Also the newest tile version in the file.
///
/// # Errors
/// A [`UserError`] where the file cannot be used, or the settings are invalid.
pub fn go_on(config: &RigConfig, path: &Path) -> Result<(Document, Sequencer, u64), UserError> {
    go_on_by(config, path, Opened::sequencer)
}

/// As [`go_on`], for a rig.
///
/// # Errors
/// As [`go_on`].
pub fn go_on_in_rig(
    config: &RigConfig,
    path: &Path,
) -> Result<(Document, Sequencer, u64), UserError> {
    go_on_by(config, path, Opened::in_rig)
}

fn go_on_by(
    config: &RigConfig,
    path: &Path,
    restore: fn(Opened) -> Result<Sequencer, EditError>,
) -> Result<(Document, Sequencer, u64), UserError> {
    let room = config.paint.room().map_err(|error| {
        UserError::usage(error.to_string())
            .at("[paint]")
            .help("write sizes as 512M or 2G")
    })?;
    let settings = DocumentSettings {
        memory: usize::try_from(room.memory).unwrap_or(usize::MAX),
        ..DocumentSettings::new(path, Access::Paint)
    };
    let (document, opened) = Document::open(&settings).map_err(|error| wrong(path, &error))?;
    let (mut sequencer, since) = match opened {
        Some(opened) => {
            let since = opened.snapshot().versions;
            (restore(opened).map_err(refused)?, since)
        }
        None => {
            let library = library_from(config.paint.paints.as_deref())?;
            let setup = painting_setup(config, &library)?;
            let pager = document.pager().clone();
            let painting = Painting::paged(&setup, library, pager).map_err(refused)?;
            let mut sequencer = Sequencer::new(painting);
            sequencer.decide(Decision::Backend { name: "cpu".into() });
            (sequencer, 0)
        }
    };
    let painting = sequencer.painting_mut();
    if let Some(history) = room.history {
        painting.set_quota(history);
    }
    if let Some(record) = room.record {
        painting.set_record_quota(record);
    }
    if let Some(what) = document.pager().fault() {
        return Err(wrong(path, &DocumentError::Damaged(what.to_owned())));
    }
    Ok((document, sequencer, since))
}

/// File at the path of a painting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presence {
    /// Absent: it is to be created there.
    New,
    /// A painting exists.
    There,
}

/// Checks, before anything is started, whether a painting can be continued in a file, or created there.
///
/// # Errors
/// A [`UserError`] where it cannot, or for an option that only a new painting takes.
pub fn presence(path: &Path, options: &PaintingOptions) -> Result<Presence, UserError> {
    if !glance(path).map_err(|error| wrong(path, &error))? {
        check_writable(path, Kind::Own).map_err(|error| UserError::writing(path, &error))?;
        return Ok(Presence::New);
    }
    match options.for_a_new_one() {
        Some(option) => Err(UserError::usage(format!("{option} is for a new painting"))
            .at(path.display().to_string())
            .help(
                "this one has its paint model, size, cells, paints, ground and light; `maulstick canvas light` and `canvas ground` change these",
            )),
        None => Ok(Presence::There),
    }
}

/// Checks that a painting exists, where none is to be created.
///
/// # Errors
/// A [`UserError`] if it does not exist.
pub fn there(path: &Path) -> Result<(), UserError> {
    let found = if path.exists() {
        glance(path)
    } else {
        Err(DocumentError::Missing)
    };
    if found.map_err(|error| wrong(path, &error))? {
        Ok(())
    } else {
        Err(wrong(path, &DocumentError::NoPainting))
    }
}

/// Copies the size of a painting's canvas into the settings, because devices are fitted to it.
pub fn measure(section: &mut CanvasSection, scene: &Scene) {
    let mut surfaces = scene.surfaces.iter();
    if let Some(canvas) = surfaces.find(|surface| surface.id == CANVAS) {
        section.cell_mm = round(canvas.cell_m * 1e3);
        [section.width_mm, section.height_mm] = canvas
            .cells
            .map(|cells| round(f64::from(cells) * section.cell_mm));
    }
}

/// A length without the noise of its last digits.
#[must_use]
pub fn round(value: f64) -> f64 {
    (value * 1e9).round() / 1e9
}

#[cfg(test)]
mod tests {
    use maulstick_painting::PaintingSetup;

    use super::*;

    #[test]
    fn a_canvas_is_measured_to_its_cells() {
        let setup = PaintingSetup {
            cells: [1000, 333],
            cell_m: 1e-4,
            ..PaintingSetup::default()
        };
        let mut section = CanvasSection::default();
        measure(&mut section, &setup.scene());
        assert_eq!((section.width_mm, section.cell_mm), (100.0, 0.1));
        assert_eq!(section.cells(), [1000, 333]);
    }
}
