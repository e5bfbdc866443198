//! Undo and redo: steps as lists of tile versions that are swapped.

use std::collections::BTreeMap;

use maulstick_types::scene::Layer;

use crate::ledger::Ledger;
use crate::load::BrushLoad;
use crate::tile::{TileId, Version};

/// A surface's number and a tile of it.
pub type Place = (u32, TileId);

/// What a painting is besides its tiles.
#[derive(Clone, Debug, PartialEq)]
pub struct Rest {
    /// What the brushes carry, by name.
    pub loads: BTreeMap<String, BrushLoad>,
    /// The books.
    pub ledger: Ledger,
    /// The dry layers.
    pub layers: Vec<Layer>,
}

/// One operation of the painter: what it replaced.
#[derive(Clone, Debug)]
pub struct UndoStep {
    /// What it was, in words.
    pub what: String,
    /// The versions before it.
    pub tiles: BTreeMap<Place, Version>,
    /// The rest before it.
    pub rest: Rest,
}

/// Steps that can be undone and redone.
#[derive(Debug, Default)]
pub struct History {
    open: Option<UndoStep>,
    undo: Vec<UndoStep>,
    redo: Vec<UndoStep>,
}

impl History {
    /// Begins a step; what can be redone is gone.
    pub fn begin(&mut self, what: &str, rest: Rest) {
        self.end();
        self.redo.clear();
        self.open = Some(UndoStep {
            what: what.to_owned(),
            tiles: BTreeMap::new(),
            rest,
        });
    }

    /// Whether a step is open.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.open.is_some()
    }

    /// Remembers a version that was replaced, the first one of each tile in the open step.
    pub fn replaced(&mut self, place: Place, version: Version) {
        if let Some(open) = &mut self.open {
            open.tiles.entry(place).or_insert(version);
        }
    }

    /// Ends the open step.
    pub fn end(&mut self) {
        self.undo.extend(self.open.take());
    }

    /// The step to take back.
    pub fn take_undo(&mut self) -> Option<UndoStep> {
        self.end();
        self.undo.pop()
    }

    /// The step to do again.
    pub fn take_redo(&mut self) -> Option<UndoStep> {
        self.end();
        self.redo.pop()
    }

    /// Keeps a swapped step for redo.
    pub fn push_redo(&mut self, step: UndoStep) {
        self.redo.push(step);
    }

    /// Keeps a swapped step for undo.
    pub fn push_undo(&mut self, step: UndoStep) {
        self.undo.push(step);
    }

    /// How many steps can be undone and redone.
    #[must_use]
    pub fn depth(&self) -> (usize, usize) {
        (
            self.undo.len() + usize::from(self.open.is_some()),
            self.redo.len(),
        )
    }
}
