//! Replay of a painting's record from its beginning: the same paint, and all its intermediate states.

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};

use maulstick_canvas::planes::Planes;
use maulstick_canvas::tile::Tile;
use maulstick_document::{Document, DocumentError, Opened};
use maulstick_painting::history::TilePlace;
use maulstick_painting::sequencer::Record;
use maulstick_painting::{EditError, Painting, Sequencer};

/// Bytes of pages in memory, beyond which the oldest steps are merged: an undo of more than the newest sixteen may then
/// take back more than it did.
const MEMORY: usize = 2 << 30;

/// Hashes of the contents of each painted tile.
pub type TilePrints = BTreeMap<TilePlace, u64>;

/// Hashes of the paint of a painting, tile by tile: equal where the same quanta are in the same layers.
pub fn tile_prints(painting: &mut Painting) -> TilePrints {
    painting.commit();
    let mut prints = TilePrints::new();
    for surface in &painting.scene().surfaces {
        let tiles = painting.store(surface.id).into_iter();
        for (id, version) in tiles.flat_map(|store| store.iter()) {
            if let Some(tile) = version.tile.as_deref().filter(|tile| !tile.is_bare()) {
                prints.insert((surface.id, id), tile_print(tile));
            }
        }
    }
    prints
}

fn tile_print(tile: &Tile) -> u64 {
    let mut hasher = DefaultHasher::new();
    let mut add = |planes: &Planes| {
        for (slot, plane) in planes {
            hasher.write_usize(*slot);
            plane
                .iter()
                .for_each(|count| hasher.write_u32(count.to_bits()));
        }
        for plane in planes.own() {
            (plane.shape, &plane.bytes).hash(&mut hasher);
        }
        hasher.write_u8(u8::MAX);
    };
    add(&tile.wet());
    let layers = tile.dry().into_iter().flat_map(|stack| stack.layers());
    let mut numbers = Vec::new();
    for layer in layers {
        add(&layer.planes.get());
        numbers.push(layer.number);
    }
    numbers.hash(&mut hasher);
    hasher.finish()
}

/// Passes on the records from a serial number on, in order, with the wall-clock time of writing, ms since 1970, if
/// known.
///
/// # Errors
/// The first of `each`, or of a record that is not intact.
pub fn each_record<E: From<DocumentError>>(
    document: &Document,
    from: u64,
    mut each: impl FnMut(Option<u64>, Record) -> Result<(), E>,
) -> Result<(), E> {
    let mut next = from;
    while let Some(row) = document.record_row(next)? {
        for record in row.records {
            next = record.serial + 1;
            each(row.time_ms, record)?;
        }
    }
    Ok(())
}

/// A painting at some place of its record.
#[derive(Debug)]
pub struct Reexecution {
    document: Document,
    sequencer: Sequencer,
}

impl Reexecution {
    /// A painting where its record begins; `None` if it has no record.
    ///
    /// # Errors
    /// [`EditError`] if the stored parts do not fit together.
    pub fn new(document: Document, opened: Opened) -> Result<Option<Self>, EditError> {
        let first = opened.first()?;
        Ok(first.map(|sequencer| Self {
            document,
            sequencer,
        }))
    }

    /// Its document.
    #[must_use]
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The sequencer, at its place of the record.
    pub fn sequencer_mut(&mut self) -> &mut Sequencer {
        &mut self.sequencer
    }

    /// Passes on the rest of the record without replaying it.
    ///
    /// # Errors
    /// As [`each_record`].
    pub fn look_ahead<E: From<DocumentError>>(
        &self,
        mut each: impl FnMut(&Record),
    ) -> Result<(), E> {
        each_record(&self.document, self.sequencer.serial(), |_, record| {
            each(&record);
            Ok(())
        })
    }

    /// Executes the rest of the record; `before` comes before each message.
    ///
    /// # Errors
    /// As [`each_record`].
    pub fn run<E: From<DocumentError>>(
        &mut self,
        mut before: impl FnMut(&mut Sequencer, &Record) -> Result<(), E>,
    ) -> Result<(), E> {
        let sequencer = &mut self.sequencer;
        each_record(&self.document, sequencer.serial(), |_, record| {
            before(sequencer, &record)?;
            sequencer.replay(record);
            sequencer.painting_mut().merge_history(MEMORY);
            Ok(())
        })
    }
}
