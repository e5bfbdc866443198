//! Named versions: snapshots of the whole painting.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use maulstick_canvas::tile::Tile;
use maulstick_types::scene::NamedVersion;

use crate::error::VersionError;
use crate::history::{NonTileState, TilePlace, TileRef};

/// A painting as it was.
#[derive(Clone, Debug)]
pub struct Named {
    /// Its name.
    pub name: String,
    /// The version that it was painted from.
    pub parent: Option<String>,
    /// Its tiles, where something was painted.
    pub tiles: Arc<BTreeMap<TilePlace, TileRef>>,
    /// Its state besides tiles.
    pub rest: NonTileState,
}

/// Name of the current painting among its versions.
pub const NOW: &str = "now";

/// The versions of a painting.
#[derive(Clone, Default)]
pub(crate) struct Versions {
    named: BTreeMap<String, Named>,
    /// Versions that came, changed or went since the last checkpoint.
    touched: BTreeSet<String>,
    /// The version from which the painter goes on.
    pub(crate) line: Option<String>,
}

impl Versions {
    /// The versions of a document.
    pub(crate) fn restored(named: Vec<Named>, line: Option<String>) -> Self {
        let named = named.into_iter().map(|own| (own.name.clone(), own));
        Self {
            named: named.collect(),
            touched: BTreeSet::new(),
            line,
        }
    }

    /// All, by name.
    pub(crate) fn iter(&self) -> impl ExactSizeIterator<Item = &Named> {
        self.named.values()
    }

    /// Their tiles.
    pub(crate) fn tiles(&self) -> impl Iterator<Item = &Arc<Tile>> {
        let tiles = self.iter().flat_map(|version| version.tiles.values());
        tiles.flatten()
    }

    /// A version by its name.
    pub(crate) fn find(&self, name: &str) -> Result<&Named, VersionError> {
        self.named.get(name).ok_or_else(|| VersionError::Unknown {
            name: name.to_owned(),
            known: self.named.keys().cloned().collect(),
        })
    }

    /// Sees that a name is free.
    pub(crate) fn check_new(&self, name: &str) -> Result<(), VersionError> {
        if name == NOW {
            return Err(VersionError::Now(NOW));
        }
        if self.named.contains_key(name) {
            return Err(VersionError::Taken(name.to_owned()));
        }
        Ok(())
    }

    /// Adds a version, from which the painter goes on.
    pub(crate) fn add(&mut self, version: Named) {
        self.line = Some(version.name.clone());
        self.touched.insert(version.name.clone());
        self.named.insert(version.name.clone(), version);
    }

    /// Removes a version; those painted from it count as painted from what it was painted from.
    pub(crate) fn remove(&mut self, name: &str) -> Result<(), VersionError> {
        let parent = self.find(name)?.parent.clone();
        self.named.remove(name);
        self.touched.insert(name.to_owned());
        for other in self.named.values_mut() {
            if other.parent.as_deref() == Some(name) {
                other.parent.clone_from(&parent);
                self.touched.insert(other.name.clone());
            }
        }
        if self.line.as_deref() == Some(name) {
            self.line = parent;
        }
        Ok(())
    }

    /// The versions as the scene has them.
    pub(crate) fn entries(&self) -> Vec<NamedVersion> {
        let entries = self.iter().map(|version| NamedVersion {
            name: version.name.clone(),
            parent: version.parent.clone().unwrap_or_default(),
            here: self.line.as_ref() == Some(&version.name),
        });
        entries.collect()
    }

    /// Names the models of surfaces in versions that do not: those of a document from before they could change.
    pub(crate) fn name_models(&mut self, models: &BTreeMap<u32, &str>) {
        for (name, version) in &mut self.named {
            if crate::history::name_models(&mut version.rest.materials, models) {
                self.touched.insert(name.clone());
            }
        }
    }

    /// Counts all as changed.
    pub(crate) fn touch_all(&mut self) {
        self.touched.extend(self.named.keys().cloned());
    }

    /// The versions that came or changed since the last call, and the names of those that went.
    pub(crate) fn take_touched(&mut self) -> (Vec<Named>, Vec<String>) {
        let (mut there, mut gone) = (Vec::new(), Vec::new());
        for name in std::mem::take(&mut self.touched) {
            match self.named.get(&name) {
                Some(version) => there.push(version.clone()),
                None => gone.push(name),
            }
        }
        (there, gone)
    }
}
