//! Opening of a painting: its state, tiles, history and versions read from its file.

mod shown;
pub(crate) mod stored_files;
pub(crate) mod stored_pages;

use std::collections::{BTreeMap, HashMap};
use std::path::Path;
use std::sync::Arc;

use maulstick_canvas::assets::Assets;
use maulstick_canvas::page::{Page, Pager};
use maulstick_canvas::planes::Planes;
use maulstick_canvas::tile::{TileId, Version};
use maulstick_optics::PaintLibrary;
use maulstick_painting::history::{Step, TilePlace, TileRef};
use maulstick_painting::sequencer::Record;
use maulstick_painting::snapshot::{PaintingSnapshot, SequencerSnapshot};
use maulstick_painting::{Beginning, EditError, Named, Painting, Restored, Sequencer};
use maulstick_types::paint::TILE;
use maulstick_types::scene::Scene;
use rusqlite::{OptionalExtension as _, params};

use crate::error::{DocumentError, RowKind};
use crate::file::database::{Access, Database, is_new};
use crate::journal;
use crate::record::beginning;
use crate::tables::checksum::Checksum;
use crate::tables::rows::{COPY, StoredNonTileState, StoredStepEffects, place_of, step_name};
use crate::tables::schema::Table;
pub use shown::shown_tiles;
use stored_files::file;
pub use stored_files::text;
use stored_pages::StoredPages;

/// Increment of the tile version numbers at each opening: the newest versions before a crash are in no file, and a
/// displayed number must never refer to another tile.
const VERSION_SKIP: u64 = 1 << 32;

/// A saved painting.
#[derive(Debug)]
pub struct Opened {
    restored: Restored,
    sequencer: SequencerSnapshot,
    records: Vec<Record>,
    library: PaintLibrary,
    pager: Arc<Pager>,
}

impl Opened {
    /// Index of the next journal entry.
    pub(crate) fn next_index(&self) -> u64 {
        let last = self.records.last().map(Record::next);
        last.unwrap_or(0).max(self.sequencer.next)
    }

    /// Number of journal records to replay: at most those of a second, if it was not closed.
    #[must_use]
    pub fn pending(&self) -> usize {
        self.records.len()
    }

    /// Pages of its tiles, wet and dry.
    pub(crate) fn pages(&self) -> Vec<Page<Planes>> {
        let tiles = self.restored.tiles.iter();
        let tiles = tiles.filter_map(|(_, version)| version.tile.as_deref());
        tiles
            .flat_map(|tile| {
                let dry = tile.dry().into_iter().flat_map(|stack| stack.layers());
                let dry = dry.map(|layer| layer.planes.clone());
                tile.wet_page().cloned().into_iter().chain(dry)
            })
            .collect()
    }

    /// Library of its paints.
    #[must_use]
    pub fn library(&self) -> &PaintLibrary {
        &self.library
    }

    /// State of the painting besides its tiles.
    #[must_use]
    pub fn snapshot(&self) -> &PaintingSnapshot {
        &self.restored.kept
    }

    /// Checks that all tiles, steps and versions are present.
    ///
    /// # Errors
    /// [`DocumentError::Rows`].
    pub fn check(&self) -> Result<(), DocumentError> {
        let Restored {
            kept: snapshot,
            tiles,
            steps,
            named,
            ..
        } = &self.restored;
        let Some(rows) = snapshot.rows else {
            return Ok(());
        };
        let is_inside = |place: &TilePlace| {
            let mut surfaces = snapshot.scene.surfaces.iter();
            // Rows of an earlier, larger canvas stay in the table.
            surfaces.any(|surface| {
                let grid = surface.cells.map(|cells| cells.div_ceil(TILE as u32));
                surface.id == place.0 && place.1.x < grid[0] && place.1.y < grid[1]
            })
        };
        let tiles = tiles.iter().filter(|(place, _)| is_inside(place)).count();
        for (kind, found, written) in [
            (RowKind::Tiles, tiles, rows.tiles),
            (RowKind::Steps, steps.len(), rows.steps),
            (RowKind::Versions, named.len(), rows.versions),
        ] {
            let (rows, found) = (kind, found as u64);
            if found != written {
                return Err(DocumentError::Rows {
                    rows,
                    found,
                    written,
                });
            }
        }
        Ok(())
    }

    /// Beginning of its record, if this program can replay that.
    #[must_use]
    pub fn beginning(&self) -> Option<&Arc<Beginning>> {
        self.restored.beginning.as_ref()
    }

    /// The painting at the beginning of its record, for replaying it; `None` without a record.
    ///
    /// # Errors
    /// [`EditError`] if the stored parts do not fit together.
    pub fn first(self) -> Result<Option<Sequencer>, EditError> {
        let Restored {
            beginning,
            embedded,
            ..
        } = self.restored;
        let begun =
            beginning.map(|begun| Sequencer::begun(begun, embedded, self.library, self.pager));
        begun.transpose()
    }

    /// Restores the painting: its last checkpoint, then the records accepted since, replayed.
    ///
    /// # Errors
    /// [`EditError`] if the stored parts do not fit together.
    pub fn sequencer(self) -> Result<Sequencer, EditError> {
        let mut sequencer = self.in_its_midst()?;
        sequencer.record();
        sequencer.resume();
        Ok(sequencer)
    }

    /// [`sequencer`](Self::sequencer) for a rig: in a file that a player has prepared for its session, brushes keep
    /// their positions, and all wait for the player.
    ///
    /// # Errors
    /// As [`sequencer`](Self::sequencer).
    pub fn in_rig(self) -> Result<Sequencer, EditError> {
        if !self.sequencer.held {
            return self.sequencer();
        }
        let mut sequencer = self.in_its_midst()?;
        sequencer.record();
        sequencer.begin_repeating();
        Ok(sequencer)
    }

    /// [`sequencer`](Self::sequencer) for records that follow without a break: brushes keep their positions.
    ///
    /// # Errors
    /// As [`sequencer`](Self::sequencer).
    pub fn in_its_midst(self) -> Result<Sequencer, EditError> {
        let painting = Painting::restore(self.restored, self.library, self.pager)?;
        let mut sequencer = Sequencer::restored(painting, self.sequencer);
        for record in self.records {
            sequencer.replay(record);
        }
        let painting = sequencer.painting_mut();
        painting.skip_versions(painting.versions() + VERSION_SKIP);
        Ok(sequencer)
    }
}

fn damaged(what: impl ToString) -> DocumentError {
    DocumentError::Damaged(what.to_string())
}

/// True if there is a painting to continue; false if one is to be created.
///
/// # Errors
/// Any [`DocumentError`]; nothing is changed.
pub fn glance(path: &Path) -> Result<bool, DocumentError> {
    Ok(scene(path)?.is_some())
}

/// Scene of a painting; `None` if it is to be created.
///
/// # Errors
/// As [`glance`].
pub fn scene(path: &Path) -> Result<Option<Scene>, DocumentError> {
    if is_new(path)? {
        return Ok(None);
    }
    let (database, _) = Database::open(path, Access::Paint, None)?;
    let scene = read_scene(&database);
    database.close_unchanged()?;
    scene
}

/// True if a checkpoint was ever written.
pub(crate) fn has_state(database: &Database) -> Result<bool, DocumentError> {
    let found: Option<i64> = database
        .connection
        .query_row(
            "SELECT 1 FROM state WHERE key = 'painting'",
            params![],
            |row| row.get(0),
        )
        .optional()?;
    Ok(found.is_some())
}

/// Scene of an open painting, if a checkpoint was ever written.
fn read_scene(database: &Database) -> Result<Option<Scene>, DocumentError> {
    if !has_state(database)? {
        return Ok(None);
    }
    let snapshot: PaintingSnapshot = state(database, "painting")?;
    Ok(Some(snapshot.scene))
}

/// Reads a part of the state, from its second copy if the first is damaged.
fn state<T: serde::de::DeserializeOwned>(
    database: &Database,
    key: &str,
) -> Result<T, DocumentError> {
    match state_row(database, key) {
        Err(DocumentError::Damaged(what)) => {
            let copy = state_row(database, &format!("{key}{COPY}"));
            copy.map_err(|_| DocumentError::Damaged(what))
        }
        read => read,
    }
}

fn state_row<T: serde::de::DeserializeOwned>(
    database: &Database,
    key: &str,
) -> Result<T, DocumentError> {
    let (value, sum): (String, i64) = database.connection.query_row(
        "SELECT value, sum FROM state WHERE key = ?1",
        params![key],
        |row| Ok((row.get(0)?, row.get(1)?)),
    )?;
    let expected = Checksum::new(Table::State)
        .bytes(key.as_bytes())
        .bytes(value.as_bytes());
    if expected.finish() != sum {
        return Err(damaged(format!("the {key} does not match its checksum")));
    }
    Ok(serde_json::from_str(&value)?)
}

/// Number of the next page.
pub(crate) fn next_page(database: &Database) -> Result<u64, DocumentError> {
    let snapshot: PaintingSnapshot = state(database, "painting")?;
    let highest: i64 = database
        .connection
        .query_row(HIGHEST_ID, params![], |row| row.get(0))?;
    Ok(snapshot.next_page.max(highest as u64 + 1))
}

/// Query for the highest number of any page, load or dry layer: pages are written before rows that refer to them.
const HIGHEST_ID: &str = "SELECT max((SELECT coalesce(max(id), 0) FROM page), \
     (SELECT coalesce(max(id), 0) FROM load), (SELECT coalesce(max(id), 0) FROM dry))";

/// Pictures and spectra of grounds and teeth.
fn pictures(database: &Database) -> Result<Assets, DocumentError> {
    let query = "SELECT hash FROM file WHERE kind IN ('picture', 'spectrum') ORDER BY hash";
    let mut statement = database.connection.prepare(query)?;
    let hashes = statement.query_map(params![], |row| row.get::<_, String>(0))?;
    let mut embedded = Assets::default();
    for hash in hashes {
        let hash = hash?;
        let bytes = file(database, &hash)?;
        embedded.know(hash, bytes.into());
    }
    Ok(embedded)
}

/// Records accepted since the last checkpoint.
fn records(database: &Database, from: u64) -> Result<Vec<Record>, DocumentError> {
    let mut records = Vec::new();
    journal::each_row(database, 0..u64::MAX, |row| {
        if !row.is_intact {
            return Err(damaged("the journal does not match its checksum"));
        }
        let read = journal::read(row.ends[0], &row.data)?;
        records.extend(read.into_iter().filter(|record| record.serial >= from));
        Ok(true)
    })?;
    Ok(records)
}

type Tiles = Vec<((u32, TileId), Version)>;

fn tiles(database: &Database, stored: &StoredPages) -> Result<Tiles, DocumentError> {
    let query = "SELECT place, version, page, dry, sum FROM tile";
    let mut statement = database.connection.prepare(query)?;
    let mut rows = statement.query(params![])?;
    let mut tiles = Tiles::new();
    while let Some(row) = rows.next()? {
        let ints: [i64; 4] = [row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?];
        if Checksum::of_ints(Table::Tile, &ints) != row.get::<_, i64>(4)? {
            return Err(damaged("a tile does not match its checksum"));
        }
        let version = Version {
            number: ints[1] as u64,
            tile: stored.tile([ints[2], ints[3]])?,
        };
        tiles.push((place_of(ints[0]), version));
    }
    Ok(tiles)
}

/// Steps of the history. Neighbouring steps share the tiles between them.
fn steps(database: &Database, stored: &StoredPages) -> Result<Vec<Step>, DocumentError> {
    let query = "SELECT id, what, brush, operations, done, deed, tiles, sum FROM step ORDER BY id";
    let mut statement = database.connection.prepare(query)?;
    let mut rows = statement.query(params![])?;
    let mut steps = Vec::new();
    let mut known: HashMap<[i64; 2], TileRef> = HashMap::new();
    while let Some(row) = rows.next()? {
        let (id, operations, done): (i64, i64, i64) = (row.get(0)?, row.get(3)?, row.get(4)?);
        let texts: [String; 3] = [row.get(1)?, row.get(2)?, row.get(5)?];
        let packed: Vec<u8> = row.get(6)?;
        let [what, brush, json] = texts.each_ref().map(|text| text.as_bytes());
        let sum = Checksum::new(Table::Step).int(id).bytes(what).bytes(brush);
        let sum = sum.int(operations).int(done).bytes(json).bytes(&packed);
        if sum.finish() != row.get::<_, i64>(7)? {
            return Err(damaged(format!("step {id} does not match its checksum")));
        }
        let effects: StoredStepEffects = serde_json::from_str(&texts[2])?;
        let (tiles, effects) = (
            stored.changes(&packed, &mut known)?,
            stored.step_effects(effects)?,
        );
        let [what, brush, _] = texts;
        steps.push(Step {
            id: id as u64,
            what: step_name(&what),
            brush: (!brush.is_empty()).then_some(brush),
            operations: operations as u64,
            done: done != 0,
            tiles: Arc::new(tiles),
            effects: Arc::new(effects),
        });
    }
    Ok(steps)
}

fn versions(database: &Database, stored: &StoredPages) -> Result<Vec<Named>, DocumentError> {
    let query = "SELECT name, parent, rest, tiles, sum FROM version ORDER BY name";
    let mut statement = database.connection.prepare(query)?;
    let mut rows = statement.query(params![])?;
    let mut versions = Vec::new();
    while let Some(row) = rows.next()? {
        let texts: [String; 3] = [row.get(0)?, row.get(1)?, row.get(2)?];
        let packed: Vec<u8> = row.get(3)?;
        let sum = texts
            .iter()
            .fold(Checksum::new(Table::Version), |sum, text| {
                sum.bytes(text.as_bytes())
            });
        if sum.bytes(&packed).finish() != row.get::<_, i64>(4)? {
            return Err(damaged(format!(
                "version '{}' does not match its checksum",
                texts[0]
            )));
        }
        let state: StoredNonTileState = serde_json::from_str(&texts[2])?;
        let [name, parent, _] = texts;
        versions.push(Named {
            name,
            parent: (!parent.is_empty()).then_some(parent),
            tiles: Arc::new(stored.tiles(&packed)?),
            rest: stored.non_tile_state(state)?,
        });
    }
    Ok(versions)
}

/// Reads a painting except for its pages.
pub(crate) fn opened(database: &Database, pager: &Arc<Pager>) -> Result<Opened, DocumentError> {
    let mut snapshot: PaintingSnapshot = state(database, "painting")?;
    let sequencer: SequencerSnapshot = state(database, "sequencer")?;
    let library = PaintLibrary::parse(&text(database, &snapshot.paints)?).map_err(damaged)?;
    for brush in snapshot.brushes.values_mut() {
        brush.file = text(database, &brush.file)?;
    }
    let stored = StoredPages::read(database, pager)?;
    let mut loads = BTreeMap::new();
    for (name, brush) in &snapshot.brushes {
        loads.insert(name.clone(), stored.load(brush.load)?);
    }
    let records = records(database, sequencer.serial)?;
    let restored = Restored {
        tiles: tiles(database, &stored)?,
        loads,
        steps: steps(database, &stored)?,
        named: versions(database, &stored)?,
        embedded: pictures(database)?,
        beginning: match beginning::read(database, &stored) {
            // The painting itself may be intact.
            Err(DocumentError::Damaged(what)) => {
                tracing::warn!("{what}: a new record begins");
                None
            }
            read => read?,
        },
        kept: snapshot,
    };
    // Rows without any other reference are deleted with the next checkpoint.
    drop(stored);
    Ok(Opened {
        restored,
        sequencer,
        records,
        library,
        pager: Arc::clone(pager),
    })
}
