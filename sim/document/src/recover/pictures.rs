//! Grounds and teeth that are made from pictures and spectra: a lost one is replaced by the plain one.

use std::collections::BTreeSet;

use maulstick_canvas::assets::{IMAGE, SPECTRUM};
use maulstick_painting::PaintingSetup;
use maulstick_painting::history::SurfaceMaterial;
use maulstick_types::scene::Scene;
use rusqlite::params;

use crate::database::Database;
use crate::error::DocumentError;

/// The pictures and spectra that are whole, by their hash.
pub(super) struct Pictures(BTreeSet<String>);

impl Pictures {
    /// Those in the new painting.
    ///
    /// # Errors
    /// The error of SQLite.
    pub(super) fn read(database: &Database) -> Result<Self, DocumentError> {
        let query = "SELECT hash FROM file WHERE kind IN ('picture', 'spectrum')";
        let mut statement = database.connection.prepare(query)?;
        let hashes = statement.query_map(params![], |row| row.get(0))?;
        Ok(Self(hashes.collect::<Result<_, _>>()?))
    }

    /// True if the source of a ground or a tooth of this name is there.
    fn has(&self, name: &str) -> bool {
        let file = name
            .strip_prefix(IMAGE)
            .or_else(|| name.strip_prefix(SPECTRUM));
        match file {
            Some(rest) => self.0.contains(rest.split('@').next().unwrap_or(rest)),
            None => true,
        }
    }

    /// True if the sources of all these surfaces are there.
    pub(super) fn has_all(&self, makes: &[SurfaceMaterial]) -> bool {
        let mut names = makes.iter().flat_map(|make| [&make.ground, &make.tooth]);
        names.all(|name| self.has(name))
    }

    /// Makes surfaces plain that were made of lost pictures; returns the names of these.
    pub(super) fn mend(&self, scene: &mut Scene) -> Vec<String> {
        let names = scene
            .surfaces
            .iter_mut()
            .flat_map(|surface| self.plain(&mut surface.ground, &mut surface.tooth));
        names.collect()
    }

    /// As [`mend`](Self::mend), in a version; true where something was lost.
    pub(super) fn mend_makes(&self, makes: &mut [SurfaceMaterial]) -> bool {
        let mut lost = false;
        for make in makes {
            lost |= !self.plain(&mut make.ground, &mut make.tooth).is_empty();
        }
        lost
    }

    fn plain(&self, ground: &mut String, tooth: &mut String) -> Vec<String> {
        let plain = PaintingSetup::default();
        let pairs = [(ground, plain.ground), (tooth, plain.tooth)];
        let lost = pairs.into_iter().filter(|(name, _)| !self.has(name));
        lost.map(|(name, plain)| std::mem::replace(name, plain))
            .collect()
    }
}
