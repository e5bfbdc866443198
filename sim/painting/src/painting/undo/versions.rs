//! Named versions: snapshots of the whole painting.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use maulstick_canvas::EditError;
use maulstick_canvas::tile::Tile;
use maulstick_model::brush::load::BrushLoad;
use maulstick_types::paint::StepName;
use maulstick_types::scene::NamedVersion;

use crate::history::{NonTileState, TilePlace, TileRef, same};
use crate::painting::Painting;

/// A version of a painting.
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
    /// The version on which the painter continues.
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
    pub(crate) fn find(&self, name: &str) -> Result<&Named, EditError> {
        self.named.get(name).ok_or_else(|| EditError::NoVersion {
            name: name.to_owned(),
            known: self.named.keys().cloned().collect(),
        })
    }

    /// Sees that a name is free.
    fn check_new(&self, name: &str) -> Result<(), EditError> {
        match self.named.contains_key(name) {
            _ if name == NOW => Err(EditError::VersionNow(NOW)),
            true => Err(EditError::VersionTaken(name.to_owned())),
            false => Ok(()),
        }
    }

    /// Adds a version, on which the painter continues.
    fn add(&mut self, version: Named) {
        self.line = Some(version.name.clone());
        self.touched.insert(version.name.clone());
        self.named.insert(version.name.clone(), version);
    }

    /// Removes a version; its descendants become those of its parent.
    fn remove(&mut self, name: &str) -> Result<(), EditError> {
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
    fn entries(&self) -> Vec<NamedVersion> {
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

impl Painting {
    /// The versions, by name.
    pub fn named(&self) -> impl Iterator<Item = &Named> {
        self.versions.iter()
    }

    /// The version on which the painter continues.
    #[must_use]
    pub fn line(&self) -> Option<&str> {
        self.versions.line.as_deref()
    }

    /// Publishes the changed scene.
    fn versions_changed(&mut self) {
        self.scene.versions = self.versions.entries();
        self.scene.version += 1;
    }

    /// Saves the current painting as a version.
    ///
    /// # Errors [`EditError`] where there is a version of that name.
    pub fn keep(&mut self, name: &str) -> Result<(), EditError> {
        self.versions.check_new(name)?;
        self.end_step(|_| true);
        let named = Named {
            name: name.to_owned(),
            parent: self.versions.line.clone(),
            tiles: Arc::new(self.surfaces.painted()),
            rest: self.non_tile_state(),
        };
        self.versions.add(named);
        self.versions_changed();
        Ok(())
    }

    /// Restores the painting of a version, as a step that can be undone.
    ///
    /// # Errors [`EditError`] for an unknown version.
    pub fn return_to(&mut self, name: &str) -> Result<(), EditError> {
        let to = self.versions.find(name)?.clone();
        self.clock.stop(None);
        let version = name.to_owned();
        self.begin_step(StepName::Return { version }, None);
        let before = self.non_tile_state();
        let now = self.surfaces.painted();
        let nowhere = now.keys().filter(|place| !to.tiles.contains_key(place));
        let cleared: Vec<TilePlace> = nowhere.copied().collect();
        let kept = to.tiles.iter().map(|(place, held)| (*place, held.clone()));
        for (place, held) in kept.chain(cleared.into_iter().map(|place| (place, None))) {
            if !same(&self.surfaces.tile(place), &held) {
                self.replace(place, held);
            }
        }
        // Its ledger lacks brushes that came later.
        for brush in self.brushes.iter_mut() {
            match to.rest.loads.get(&brush.name) {
                Some(page) => brush.carry(page),
                None => brush.load = Arc::new(BrushLoad::clean(brush.head.strips())),
            }
        }
        for surface in self.surfaces.iter_mut() {
            let top = to.rest.tops.get(&surface.id).copied().unwrap_or(0.0);
            surface.top = surface.top.max(top);
        }
        self.accounts.ledger.clone_from(&to.rest.ledger);
        self.book(None);
        let layers = (before.layers != to.rest.layers).then_some(&to.rest.layers);
        let materials = (before.materials != to.rest.materials).then_some(&to.rest.materials);
        self.turn_non_tile_state(layers, materials);
        self.end_own_step();
        self.versions.line = Some(name.to_owned());
        self.versions_changed();
        Ok(())
    }

    /// Begins a version from another one, whose painting is restored.
    ///
    /// # Errors [`EditError`] where there is no such version, or one of the new name.
    pub fn branch(&mut self, from: &str, name: &str) -> Result<(), EditError> {
        self.versions.check_new(name)?;
        let begun = Named {
            name: name.to_owned(),
            parent: Some(from.to_owned()),
            ..self.versions.find(from)?.clone()
        };
        self.return_to(from)?;
        self.versions.add(begun);
        self.versions_changed();
        Ok(())
    }

    /// Deletes a version; its descendants become those of its parent.
    ///
    /// # Errors [`EditError`] for an unknown version.
    pub fn forget(&mut self, name: &str) -> Result<(), EditError> {
        self.versions.remove(name)?;
        self.versions_changed();
        Ok(())
    }
}
