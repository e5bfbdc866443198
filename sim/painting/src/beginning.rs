//! The beginning of a painting's record: the whole painting at the place of its journal from which what was accepted
//! since can be executed again.

use std::collections::BTreeMap;
use std::sync::Arc;

use maulstick_canvas::page::Page;
use maulstick_model::brush::load::BrushLoad;

use crate::history::{Step, TilePlace, TileRef};
use crate::painting::Named;
use crate::snapshot::{PaintingSnapshot, SequencerSnapshot};

/// A whole painting at a place of its journal, without the steps that were finished before.
#[derive(Clone, Debug)]
pub struct Beginning {
    /// Time of the wall clock, ms since 1970.
    pub time_ms: u64,
    /// The painting besides its tiles, with the files of its brushes.
    pub painting: PaintingSnapshot,
    /// The sequencer.
    pub sequencer: SequencerSnapshot,
    /// Its tiles, where something was painted.
    pub tiles: BTreeMap<TilePlace, TileRef>,
    /// Loads of the brushes, by name.
    pub loads: BTreeMap<String, Page<BrushLoad>>,
    /// The steps that were not finished.
    pub open: Vec<Step>,
    /// Its versions.
    pub named: Vec<Named>,
}

/// Change of a record at a checkpoint.
#[derive(Clone, Debug)]
pub enum RecordChange {
    /// What was accepted since the last checkpoint is added to it.
    Continues,
    /// It begins anew at the checkpoint.
    Begins(Arc<Beginning>),
    /// None is kept.
    Ends,
}
