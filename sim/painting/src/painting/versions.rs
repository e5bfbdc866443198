//! Named versions: snapshots of the whole painting.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::Painting;
use crate::apply::{Applied, Apply};
use crate::history::{NonTileState, TilePlace, TileRef, same};
use maulstick_canvas::EditError;
use maulstick_model::brush::load::BrushLoad;
use maulstick_types::edits::{Branch, Forget, Keep, ReturnTo};
use maulstick_types::scene::NamedVersion;

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

impl Apply for Keep {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting.keep(&self.name).map(|()| Applied::Done)
    }
}

impl Apply for ReturnTo {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting.return_to(&self.name).map(|()| Applied::Done)
    }
}

impl Apply for Branch {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting
            .branch(&self.from, &self.name)
            .map(|()| Applied::Done)
    }
}

impl Apply for Forget {
    fn apply(&self, painting: &mut Painting) -> Result<Applied, EditError> {
        painting.forget(&self.name).map(|()| Applied::Done)
    }
}

impl Painting {
    /// The versions, by name.
    pub fn named(&self) -> impl Iterator<Item = &Named> {
        self.named.values()
    }

    /// The version from which the painter goes on.
    #[must_use]
    pub fn line(&self) -> Option<&str> {
        self.line.as_deref()
    }

    pub(super) fn version(&self, name: &str) -> Result<&Named, EditError> {
        self.named.get(name).ok_or_else(|| EditError::NoVersion {
            name: name.to_owned(),
            known: self.named.keys().cloned().collect(),
        })
    }

    fn check_new(&self, name: &str) -> Result<(), EditError> {
        match self.named.contains_key(name) {
            _ if name == NOW => Err(EditError::VersionNow(NOW)),
            true => Err(EditError::VersionTaken(name.to_owned())),
            false => Ok(()),
        }
    }

    /// Tells all who follow the scene.
    fn versions_changed(&mut self) {
        let versions = self.named.values().map(|version| NamedVersion {
            name: version.name.clone(),
            parent: version.parent.clone().unwrap_or_default(),
            here: self.line.as_ref() == Some(&version.name),
        });
        self.scene.versions = versions.collect();
        self.scene.version += 1;
    }

    /// All tiles where something was painted.
    fn painted(&self) -> BTreeMap<TilePlace, TileRef> {
        let mut tiles = BTreeMap::new();
        for sheet in &self.sheets {
            let versions = sheet.store.iter();
            let bare = |held: &TileRef| {
                held.as_deref()
                    .is_none_or(maulstick_canvas::tile::Tile::is_bare)
            };
            let painted = versions.filter(|(_, version)| !bare(&version.tile));
            tiles.extend(painted.map(|(id, version)| ((sheet.id, id), version.tile.clone())));
        }
        tiles
    }

    /// Keeps the painting as it is.
    ///
    /// # Errors
    /// [`EditError`] where there is a version of that name.
    pub fn keep(&mut self, name: &str) -> Result<(), EditError> {
        self.check_new(name)?;
        self.end_step(|_| true);
        let named = Named {
            name: name.to_owned(),
            parent: self.line.clone(),
            tiles: Arc::new(self.painted()),
            rest: self.rest(),
        };
        self.line = Some(name.to_owned());
        self.named_touched.insert(name.to_owned());
        self.named.insert(name.to_owned(), named);
        self.versions_changed();
        Ok(())
    }

    /// Makes the painting as it was in a version: a step that can be undone.
    ///
    /// # Errors
    /// [`EditError`] for an unknown version.
    pub fn return_to(&mut self, name: &str) -> Result<(), EditError> {
        let to = self.version(name)?.clone();
        self.let_stay_wet(None);
        self.begin_step(&format!("return to '{name}'"), None);
        let before = self.rest();
        let now = self.painted();
        let nowhere = now.keys().filter(|place| !to.tiles.contains_key(place));
        let cleared: Vec<TilePlace> = nowhere.copied().collect();
        let kept = to.tiles.iter().map(|(place, held)| (*place, held.clone()));
        for (place, held) in kept.chain(cleared.into_iter().map(|place| (place, None))) {
            if !same(&self.held(place), &held) {
                let before = self.put(place, held);
                self.history.replaced(None, place, before);
            }
        }
        // Its books know nothing of brushes that came later.
        for (name, track) in &mut self.brushes {
            if !to.rest.loads.contains_key(name) {
                track.load = Arc::new(BrushLoad::clean(track.head.strips()));
            }
        }
        for (name, page) in &to.rest.loads {
            self.carry(name, page);
        }
        for sheet in &mut self.sheets {
            let top = to.rest.tops.get(&sheet.id).copied().unwrap_or(0.0);
            sheet.top = sheet.top.max(top);
        }
        self.ledger.clone_from(&to.rest.ledger);
        self.book(None);
        let layers = (before.layers != to.rest.layers).then_some(&to.rest.layers);
        let makes = (before.makes != to.rest.makes).then_some(&to.rest.makes);
        self.turn_rest(layers, makes);
        self.end_own_step();
        self.line = Some(name.to_owned());
        self.versions_changed();
        Ok(())
    }

    /// Begins a version from another one: the painting becomes as it was there.
    ///
    /// # Errors
    /// [`EditError`] where there is no such version, or one of the new name.
    pub fn branch(&mut self, from: &str, name: &str) -> Result<(), EditError> {
        self.check_new(name)?;
        let begun = Named {
            name: name.to_owned(),
            parent: Some(from.to_owned()),
            ..self.version(from)?.clone()
        };
        self.return_to(from)?;
        self.line = Some(name.to_owned());
        self.named_touched.insert(name.to_owned());
        self.named.insert(name.to_owned(), begun);
        self.versions_changed();
        Ok(())
    }

    /// Forgets a version; those painted from it count as painted from what it was painted from.
    ///
    /// # Errors
    /// [`EditError`] for an unknown version.
    pub fn forget(&mut self, name: &str) -> Result<(), EditError> {
        let parent = self.version(name)?.parent.clone();
        self.named.remove(name);
        self.named_touched.insert(name.to_owned());
        for other in self.named.values_mut() {
            if other.parent.as_deref() == Some(name) {
                other.parent.clone_from(&parent);
                self.named_touched.insert(other.name.clone());
            }
        }
        if self.line.as_deref() == Some(name) {
            self.line = parent;
        }
        self.versions_changed();
        Ok(())
    }
}
