//! Grounds and teeth that are made from pictures and spectra: a lost one is replaced by the default.

use std::collections::BTreeSet;

use maulstick_canvas::assets::{IMAGE, SPECTRUM};
use maulstick_document::DocumentError;
use maulstick_document::file::database::Database;
use maulstick_painting::PaintingSetup;
use maulstick_painting::history::SurfaceMaterial;
use maulstick_types::scene::Scene;
use rusqlite::params;

/// Hashes of the intact pictures and spectra.
pub(super) struct MaterialSources(BTreeSet<String>);

impl MaterialSources {
    /// Pictures and spectra in the new painting.
    ///
    /// # Errors
    /// The error of SQLite.
    pub(super) fn read(database: &Database) -> Result<Self, DocumentError> {
        let query = "SELECT hash FROM file WHERE kind IN ('picture', 'spectrum')";
        let mut statement = database.connection().prepare(query)?;
        let hashes = statement.query_map(params![], |row| row.get(0))?;
        Ok(Self(hashes.collect::<Result<_, _>>()?))
    }

    /// True if the source of a ground or a tooth of this name is present.
    fn has(&self, name: &str) -> bool {
        let file = name
            .strip_prefix(IMAGE)
            .or_else(|| name.strip_prefix(SPECTRUM));
        match file {
            Some(rest) => self.0.contains(rest.split('@').next().unwrap_or(rest)),
            None => true,
        }
    }

    /// True if the sources of all these surfaces are present.
    pub(super) fn has_all(&self, materials: &[SurfaceMaterial]) -> bool {
        let mut names = materials
            .iter()
            .flat_map(|material| [&material.ground, &material.tooth]);
        names.all(|name| self.has(name))
    }

    /// Replaces materials of a scene whose sources are lost; returns their names.
    pub(super) fn replace_lost(&self, scene: &mut Scene) -> Vec<String> {
        let names = scene
            .surfaces
            .iter_mut()
            .flat_map(|surface| self.replace(&mut surface.ground, &mut surface.tooth));
        names.collect()
    }

    /// [`replace_lost`](Self::replace_lost) in a version; true if any was lost.
    pub(super) fn replace_lost_in_version(&self, materials: &mut [SurfaceMaterial]) -> bool {
        let mut lost = false;
        for material in materials {
            let names = self.replace(&mut material.ground, &mut material.tooth);
            lost |= !names.is_empty();
        }
        lost
    }

    fn replace(&self, ground: &mut String, tooth: &mut String) -> Vec<String> {
        let default = PaintingSetup::default();
        let pairs = [(ground, default.ground), (tooth, default.tooth)];
        let lost = pairs.into_iter().filter(|(name, _)| !self.has(name));
        lost.map(|(name, default)| std::mem::replace(name, default))
            .collect()
    }
}
