//! The beginning of a painting's record: the whole painting at the place of its journal from which what was accepted
//! since can be executed again.

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

/// Bytes of a record at most, unless a painting says otherwise.
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
    /// The painting as it was then, to accept its records again; `assets` are the pictures and spectra of the painting,
    /// later ones among them.
    ///
    /// # Errors
    /// [`EditError`] if the stored parts do not fit together.
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
    /// What was accepted since the last checkpoint is added to it.
    Continues,
    /// It begins anew at the checkpoint.
    Begins(Arc<Beginning>),
    /// None is kept.
    Ends,
}
