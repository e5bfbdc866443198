//! Grounds by name, and from files: measured reflectances and pictures.

use std::path::Path;
use std::sync::Arc;

use maulstick_appearance::ground::add_spectrum;
use maulstick_canvas::assets::{IMAGE, SPECTRUM};
use maulstick_canvas::store::TileStore;
use maulstick_exchange::{Image, PictureKind, embed};
use maulstick_optics::Reflectance;
use maulstick_painting::edits::common;
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_rig::UserError;
use maulstick_rig::config::is_path;
use maulstick_rig::log::say;
use maulstick_rig::table_file::read_table;
use maulstick_types::Edit;
use maulstick_types::scene::CANVAS;
use maulstick_types::values::ValueError;

use crate::refusal::refused;
use crate::surface::picture::{no_picture, open_picture};

/// Greatest size of a spectrum file, bytes.
const SPECTRUM_MAX: usize = maulstick_types::limits::SPECTRUM_MAX;

/// Source of a ground.
#[derive(Clone, Debug)]
pub enum GroundFile {
    /// Ground of a library, by name.
    Named(String),
    /// A file of reflectances: its text.
    Spectrum(String),
    /// A picture, and its file.
    Picture(Arc<Image>, String),
}

impl GroundFile {
    /// Reads a name, a CSV file of nm,reflectance, or a picture.
    ///
    /// # Errors
    /// A [`UserError`] where a file cannot be read or is neither, with file and line.
    pub fn read(name: &str) -> Result<Self, UserError> {
        let path = Path::new(name);
        if !is_path(name) {
            return Ok(Self::Named(name.to_owned()));
        }
        if PictureKind::is_named(path) {
            let image = open_picture(path)?;
            return Ok(Self::Picture(Arc::new(image), name.to_owned()));
        }
        let text = read_table(path, SPECTRUM_MAX as u64)?;
        let read = Reflectance::parse(&text).map_err(|error| {
            UserError::usage(error.fault.to_string())
                .at(format!("{name}:{}", error.line))
                .help("a row a wavelength: nm,reflectance, rising, 0 to 1")
        })?;
        if read.limited > 0 {
            say(&format!(
                "note: {name}: {} reflectances lie a little outside of 0 to 1: taken as 0 and 1\n",
                read.limited
            ));
        }
        Ok(Self::Spectrum(text))
    }

    /// The edit that makes it the ground of the canvas; none for a picture, which the painting has to hold.
    ///
    /// # Errors
    /// [`ValueError`] for a name or a text that is too long.
    pub fn edit(&self) -> Result<Option<Edit>, ValueError> {
        Ok(match self {
            Self::Named(name) => Some(common::ground(name)?.into()),
            Self::Spectrum(text) => Some(common::measured_ground(text)?.into()),
            Self::Picture(..) => None,
        })
    }

    /// Adds a picture to a painting, and returns the edit that makes it the ground of the canvas.
    ///
    /// # Errors
    /// A [`UserError`] if the canvas is too large for it.
    pub fn embed(&self, painting: &mut Painting) -> Result<Edit, UserError> {
        let cells = painting.store(CANVAS).map_or([1, 1], TileStore::cells);
        let bytes = self.picture(cells)?.unwrap_or_default();
        let hash = painting.embed(bytes).map_err(refused)?;
        Ok(common::ground(&format!("{IMAGE}{hash}"))?.into())
    }

    /// A picture for surfaces with this number of cells, a PNG; `None` if it is no picture.
    ///
    /// # Errors
    /// A [`UserError`] if the surface is too large for it.
    fn picture(&self, cells: [u32; 2]) -> Result<Option<Arc<[u8]>>, UserError> {
        let Self::Picture(image, name) = self else {
            return Ok(None);
        };
        let bytes =
            embed::ground(image, cells).map_err(|error| no_picture(name.as_ref(), &error))?;
        Ok(Some(bytes))
    }

    /// Makes it the ground of a new painting.
    ///
    /// # Errors
    /// A [`UserError`] if it is invalid.
    pub fn prime(&self, setup: &mut PaintingSetup) -> Result<(), UserError> {
        setup.ground = match self {
            Self::Named(name) => name.clone(),
            Self::Spectrum(text) => {
                let hash = add_spectrum(&mut setup.embedded, text).map_err(refused)?;
                format!("{SPECTRUM}{hash}")
            }
            Self::Picture(..) => {
                let bytes = self.picture(setup.cells)?.unwrap_or_default();
                let hash = setup.embedded.add(bytes).map_err(refused)?;
                format!("{IMAGE}{hash}")
            }
        };
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ground_is_a_name_or_a_file_that_is_right() {
        assert!(
            matches!(GroundFile::read("gesso"), Ok(GroundFile::Named(name)) if name == "gesso")
        );
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("linen.csv");
        let name = path.display().to_string();
        let read = |text: &str| {
            std::fs::write(&path, text).expect("written");
            GroundFile::read(&name)
        };
        let good = read("\u{feff}nm,reflectance\n400,0.4\n700,0.6\n").expect("good");
        let mut setup = PaintingSetup::default();
        good.prime(&mut setup).expect("a ground");
        assert!(setup.ground.starts_with(SPECTRUM));
        for (text, place) in [
            ("400,0.4\n700,1.6\n", ":2"),
            ("400,0.4\n300,0.6", ":2"),
            ("400,1", ":1"),
        ] {
            let fault = read(text).expect_err(text);
            assert!(
                fault.place.as_deref().is_some_and(|at| at.ends_with(place)),
                "{fault}"
            );
        }
        std::fs::remove_file(&path).expect("removed");
        assert!(GroundFile::read(&name).is_err());
    }
}
