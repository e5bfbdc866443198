//! Undo and redo.

use std::collections::BTreeMap;

use super::{PaintRefusal, Painting};
use crate::history::{Rest, UndoStep};
use crate::tile::Version;

impl Painting {
    pub(super) fn rest(&self) -> Rest {
        let loads = self
            .brushes
            .iter()
            .map(|(name, track)| (name.clone(), track.load.clone()));
        Rest {
            loads: loads.collect(),
            ledger: self.ledger.clone(),
            layers: self.scene.layers.clone(),
        }
    }

    pub(super) fn begin_step(&mut self, what: &str) {
        self.close_windows();
        let rest = self.rest();
        self.history.begin(what, rest);
    }

    /// Takes the newest step back and says what it was.
    ///
    /// # Errors
    /// [`PaintRefusal`] where there is none.
    pub fn undo(&mut self) -> Result<String, PaintRefusal> {
        self.close_windows();
        let step = self.history.take_undo().ok_or_else(|| {
            PaintRefusal::new("there is nothing to undo".into(), "paint something first")
        })?;
        let what = step.what.clone();
        let swapped = self.swap(step);
        self.history.push_redo(swapped);
        Ok(what)
    }

    /// Does the newest undone step again and says what it was.
    ///
    /// # Errors
    /// [`PaintRefusal`] where there is none.
    pub fn redo(&mut self) -> Result<String, PaintRefusal> {
        self.close_windows();
        let step = self.history.take_redo().ok_or_else(|| {
            PaintRefusal::new(
                "there is nothing to redo".into(),
                "only what was undone and not painted over can be redone",
            )
        })?;
        let what = step.what.clone();
        let swapped = self.swap(step);
        self.history.push_undo(swapped);
        Ok(what)
    }

    /// Exchanges a step's versions and loads with those of now.
    pub(super) fn swap(&mut self, step: UndoStep) -> UndoStep {
        let rest = self.rest();
        let mut tiles = BTreeMap::new();
        for ((surface, id), version) in step.tiles {
            let Some(sheet) = self.sheets.iter_mut().find(|sheet| sheet.id == surface) else {
                continue;
            };
            self.versions += 1;
            let restored = Version {
                number: self.versions,
                tile: version.tile,
            };
            tiles.insert((surface, id), sheet.store.replace(id, restored));
        }
        for (name, load) in step.rest.loads {
            if let Some(track) = self.brushes.get_mut(&name) {
                track.load = load.onto(track.head.strips());
                track.path = None;
            }
        }
        self.ledger = step.rest.ledger;
        if self.scene.layers != step.rest.layers {
            self.scene.layers = step.rest.layers;
            self.layers_changed();
        }
        UndoStep {
            what: step.what,
            tiles,
            rest,
        }
    }

    /// How many steps can be undone and redone.
    #[must_use]
    pub fn history_depth(&self) -> (usize, usize) {
        self.history.depth()
    }
}
