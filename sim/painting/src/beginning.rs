//! The beginning of a painting's record: the whole painting at the place of its journal from which it can be replayed.

use std::collections::BTreeMap;
use std::sync::Arc;

use maulstick_canvas::EditError;
use maulstick_canvas::assets::Assets;
use maulstick_canvas::page::{Page, Pager};
use maulstick_canvas::tile::Version;
use maulstick_model::brush::load::BrushLoad;
use maulstick_optics::PaintLibrary;

use crate::history::{Step, TilePlace, TileRef};
use crate::painting::{Named, Painting, Restored};
use crate::sequencer::Sequencer;
use crate::snapshot::{PaintingSnapshot, SequencerSnapshot};

/// Greatest size of a record, bytes, unless a painting sets another.
pub const RECORD_QUOTA: u64 = 512 << 20;

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

impl Beginning {
    /// The painting at the beginning, for replaying its records; `assets` are the pictures and spectra of the painting,
    /// including later ones.
    ///
    /// # Errors [`EditError`] if the stored parts do not fit together.
    pub fn sequencer(
        self: &Arc<Self>,
        assets: Assets,
        library: PaintLibrary,
        pager: Arc<Pager>,
    ) -> Result<Sequencer, EditError> {
        let number = self.painting.versions;
        let tiles = self.tiles.iter();
        let restored = Restored {
            tiles: tiles
                .map(|(place, tile)| {
                    let tile = tile.clone();
                    (*place, Version { number, tile })
                })
                .collect(),
            loads: self.loads.clone(),
            steps: self.open.clone(),
            named: self.named.clone(),
            embedded: assets,
            kept: PaintingSnapshot {
                undone: Vec::new(),
                ..self.painting.clone()
            },
            beginning: Some(Arc::clone(self)),
        };
        let painting = Painting::restore(restored, library, pager)?;
        Ok(Sequencer::restored(painting, self.sequencer.clone()))
    }
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
