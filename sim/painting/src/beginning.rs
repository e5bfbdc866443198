//! The beginning of a painting's record: the whole painting at the place of its journal from which it can be replayed.

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
    /// Messages accepted since the last checkpoint are added to it.
    Continues,
    /// A new record begins at the checkpoint.
    Begins(Arc<Beginning>),
    /// No record is kept.
    Ends,
}
