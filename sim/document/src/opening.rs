//! Reading of a painting from its file.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use maulstick_canvas::EditError;
use maulstick_canvas::assets::Assets;
use maulstick_canvas::dry::{DryLayer, DryStack};
use maulstick_canvas::page::{Page, Pager};
use maulstick_canvas::planes::Planes;
use maulstick_canvas::tile::{Tile, Version};
use maulstick_model::brush::load::BrushLoad;
use maulstick_optics::PaintLibrary;
use maulstick_painting::history::{Change, NonTileState, Step, StepEffects, TilePlace, TileRef};
use maulstick_painting::sequencer::Record;
use maulstick_painting::snapshot::{PaintingSnapshot, SequencerSnapshot};
use maulstick_painting::{Named, Painting, Restored, Sequencer};
use maulstick_types::paint::TILE;
use maulstick_types::scene::Scene;
use rusqlite::{OptionalExtension as _, params};

use crate::database::Database;
use crate::error::DocumentError;
use crate::journal;
use crate::rows::{KeptDeed, KeptRest, place_of, unpacked};
use crate::schema::Table;
use crate::sum::Sum;
use crate::writing::COPY;

/// Tile versions are numbered this much higher each time: after a crash no number that was ever shown
/// means another tile, though the newest of them are in no file.
const SKIP: u64 = 1 << 32;

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
    /// The journal entries below this index are in it.
    pub(crate) fn index(&self) -> u64 {
        let last = self.records.last().map(Record::next);
        last.unwrap_or(0).max(self.sequencer.next)
    }

    /// Number of journal records that the painting does not include yet: a second's worth at most, if it was not
    /// closed.
    #[must_use]
    pub fn pending(&self) -> usize {
        self.records.len()
    }

    /// The paints that it is painted with.
    #[must_use]
    pub fn library(&self) -> &PaintLibrary {
        &self.library
    }

    /// Its state besides tiles.
    #[must_use]
    pub fn kept(&self) -> &PaintingSnapshot {
        &self.restored.kept
    }

    /// Sees that as many tiles, steps and versions are there as were written.
    ///
    /// # Errors
    /// [`DocumentError::Damaged`] with what is missing.
    pub fn check(&self) -> Result<(), DocumentError> {
        let Restored {
            kept,
            tiles,
            steps,
            named,
            ..
        } = &self.restored;
        let Some(rows) = kept.rows else {
            return Ok(());
        };
        let there = |place: &TilePlace| {
            let mut surfaces = kept.scene.surfaces.iter();
            // Rows of a canvas before it got another size stay.
            surfaces.any(|surface| {
                let grid = surface.cells.map(|cells| cells.div_ceil(TILE as u32));
                surface.id == place.0 && place.1.x < grid[0] && place.1.y < grid[1]
            })
        };
        let tiles = tiles.iter().filter(|(place, _)| there(place)).count();
        for (what, found, kept) in [
            ("tiles", tiles, rows.tiles),
            ("steps of its history", steps.len(), rows.steps),
            ("versions", named.len(), rows.versions),
        ] {
            if found as u64 != kept {
                return Err(damaged(format!("{found} of its {kept} {what} are there")));
            }
        }
        Ok(())
    }

    /// The painting restored: its last checkpoint, and then the records accepted since, done again.
    ///
    /// # Errors
    /// [`EditError`] if the stored parts do not fit together.
    pub fn sequencer(self) -> Result<Sequencer, EditError> {
        let painting = Painting::restore(self.restored, self.library, self.pager)?;
        let mut sequencer = Sequencer::restored(painting, self.sequencer);
        for record in self.records {
            sequencer.replay(record);
        }
        let painting = sequencer.painting_mut();
        painting.skip_versions(painting.versions() + SKIP);
        sequencer.record();
        sequencer.go_on();
        Ok(sequencer)
    }
}

fn damaged(what: impl ToString) -> DocumentError {
    DocumentError::Damaged(what.to_string())
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

/// The desk of the painting, if a moment of it was ever written.
pub(crate) fn scene(database: &Database) -> Result<Option<Scene>, DocumentError> {
    if !has_state(database)? {
        return Ok(None);
    }
    let kept: PaintingSnapshot = state(database, "painting")?;
    Ok(Some(kept.scene))
}

/// Reads a part of the state, from its second copy where the first is not whole.
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
    let expected = Sum::of(Table::State)
        .bytes(key.as_bytes())
        .bytes(value.as_bytes());
    if expected.done() != sum {
        return Err(damaged(format!("the {key} does not match its checksum")));
    }
    Ok(serde_json::from_str(&value)?)
}

/// The number of the next page.
pub(crate) fn next_page(database: &Database) -> Result<u64, DocumentError> {
    let kept: PaintingSnapshot = state(database, "painting")?;
    let newest: i64 = database
        .connection
        .query_row(NEWEST, params![], |row| row.get(0))?;
    Ok(kept.next_page.max(newest as u64 + 1))
}

/// The newest number that something has: pages are written before what refers to them.
const NEWEST: &str = "SELECT max((SELECT coalesce(max(id), 0) FROM page), \
     (SELECT coalesce(max(id), 0) FROM load), (SELECT coalesce(max(id), 0) FROM dry))";

/// A file by its hash.
pub(crate) fn file(database: &Database, hash: &str) -> Result<Vec<u8>, DocumentError> {
    let data: Vec<u8> = database.connection.query_row(
        "SELECT data FROM file WHERE hash = ?1",
        params![hash],
        |row| row.get(0),
    )?;
    match maulstick_canvas::assets::hash_of(&data) == hash {
        true => Ok(data),
        false => Err(damaged(format!("file {hash} is not what it was"))),
    }
}

/// The pictures and spectra of grounds and teeth.
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

/// A file that is a text, by its hash.
pub(crate) fn text(database: &Database, hash: &str) -> Result<String, DocumentError> {
    String::from_utf8(file(database, hash)?).map_err(damaged)
}

/// Records accepted since the last checkpoint.
fn records(database: &Database, from: u64) -> Result<Vec<Record>, DocumentError> {
    let query = "SELECT id, last, data, sum FROM journal ORDER BY id";
    let mut statement = database.connection.prepare(query)?;
    let mut rows = statement.query(params![])?;
    let mut records = Vec::new();
    while let Some(row) = rows.next()? {
        let (first, last): (i64, i64) = (row.get(0)?, row.get(1)?);
        let data: Vec<u8> = row.get(2)?;
        if journal::sum([first as u64, last as u64], &data) != row.get::<_, i64>(3)? {
            return Err(damaged("the journal does not match its checksum"));
        }
        let read = journal::read(first as u64, &data)?;
        records.extend(read.into_iter().filter(|record| record.serial >= from));
    }
    Ok(records)
}

/// The pages and dry layers of a painting, by number.
struct Shelves {
    pages: HashMap<i64, Page<Planes>>,
    stacks: HashMap<i64, Arc<DryStack>>,
    loads: HashMap<i64, Page<BrushLoad>>,
}

impl Shelves {
    fn read(database: &Database, pager: &Arc<Pager>) -> Result<Self, DocumentError> {
        let mut shelves = Self {
            pages: HashMap::new(),
            stacks: HashMap::new(),
            loads: HashMap::new(),
        };
        let connection = &database.connection;
        let sizes = |table: &str| -> Result<Vec<(i64, i64)>, DocumentError> {
            let mut statement =
                connection.prepare(&format!("SELECT id, length(data) FROM {table}"))?;
            let rows = statement.query_map(params![], |row| Ok((row.get(0)?, row.get(1)?)))?;
            Ok(rows.collect::<Result<_, _>>()?)
        };
        for (id, bytes) in sizes("page")? {
            let page = Page::stored(pager, id as u64, bytes as usize);
            shelves.pages.insert(id, page);
        }
        for (id, bytes) in sizes("load")? {
            let page = Page::stored(pager, id as u64, bytes as usize);
            shelves.loads.insert(id, page);
        }
        // Layers below have lower numbers.
        let query = "SELECT id, below, layer, page, sum FROM dry ORDER BY id";
        let mut statement = connection.prepare(query)?;
        let mut rows = statement.query(params![])?;
        while let Some(row) = rows.next()? {
            let ints: [i64; 4] = [row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?];
            let sum = ints.into_iter().fold(Sum::of(Table::Dry), Sum::int).done();
            if sum != row.get::<_, i64>(4)? {
                return Err(damaged("a dry layer does not match its checksum"));
            }
            let [id, below, layer, page] = ints;
            let below = match below {
                0 => None,
                below => Some(shelves.stack(below)?),
            };
            let layer = DryLayer {
                number: layer as u32,
                planes: shelves.page(page)?,
            };
            let stack = DryStack::known(id as u64, below, layer);
            stack.note_stored();
            shelves.stacks.insert(id, stack);
        }
        Ok(shelves)
    }

    fn page(&self, id: i64) -> Result<Page<Planes>, DocumentError> {
        let found = self.pages.get(&id).cloned();
        found.ok_or_else(|| damaged(format!("page {id} is missing")))
    }

    fn stack(&self, id: i64) -> Result<Arc<DryStack>, DocumentError> {
        let found = self.stacks.get(&id).cloned();
        found.ok_or_else(|| damaged(format!("dry layer {id} is missing")))
    }

    fn load(&self, id: u64) -> Result<Page<BrushLoad>, DocumentError> {
        let found = self.loads.get(&(id as i64)).cloned();
        found.ok_or_else(|| damaged(format!("load {id} is missing")))
    }

    fn held(&self, [page, dry]: [i64; 2]) -> Result<TileRef, DocumentError> {
        if page == 0 && dry == 0 {
            return Ok(None);
        }
        let wet = match page {
            0 => None,
            page => Some(self.page(page)?),
        };
        let dry = match dry {
            0 => None,
            dry => Some(self.stack(dry)?),
        };
        Ok(Some(Arc::new(Tile::of_pages(wet, dry))))
    }
}

type Tiles = Vec<((u32, maulstick_canvas::tile::TileId), Version)>;

fn tiles(database: &Database, shelves: &Shelves) -> Result<Tiles, DocumentError> {
    let query = "SELECT place, version, page, dry, sum FROM tile";
    let mut statement = database.connection.prepare(query)?;
    let mut rows = statement.query(params![])?;
    let mut tiles = Tiles::new();
    while let Some(row) = rows.next()? {
        let ints: [i64; 4] = [row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?];
        let sum = ints.into_iter().fold(Sum::of(Table::Tile), Sum::int).done();
        if sum != row.get::<_, i64>(4)? {
            return Err(damaged("a tile does not match its checksum"));
        }
        let version = Version {
            number: ints[1] as u64,
            tile: shelves.held([ints[2], ints[3]])?,
        };
        tiles.push((place_of(ints[0]), version));
    }
    Ok(tiles)
}

/// The steps, where neighbours share the tiles that one left to the other.
fn steps(database: &Database, shelves: &Shelves) -> Result<Vec<Step>, DocumentError> {
    let query = "SELECT id, what, brush, operations, done, deed, tiles, sum FROM step ORDER BY id";
    let mut statement = database.connection.prepare(query)?;
    let mut rows = statement.query(params![])?;
    let mut steps = Vec::new();
    let mut known: HashMap<[i64; 2], TileRef> = HashMap::new();
    while let Some(row) = rows.next()? {
        let (id, operations, done): (i64, i64, i64) = (row.get(0)?, row.get(3)?, row.get(4)?);
        let texts: [String; 3] = [row.get(1)?, row.get(2)?, row.get(5)?];
        let packed: Vec<u8> = row.get(6)?;
        let [what, brush, effects] = texts.each_ref().map(|text| text.as_bytes());
        let sum = Sum::of(Table::Step).int(id).bytes(what).bytes(brush);
        let sum = sum.int(operations).int(done).bytes(effects).bytes(&packed);
        if sum.done() != row.get::<_, i64>(7)? {
            return Err(damaged(format!("step {id} does not match its checksum")));
        }
        let mut held = |numbers: [i64; 2]| -> Result<TileRef, DocumentError> {
            if let Some(held) = known.get(&numbers) {
                return Ok(held.clone());
            }
            let held = shelves.held(numbers)?;
            known.insert(numbers, held.clone());
            Ok(held)
        };
        let mut tiles = BTreeMap::new();
        let groups = unpacked::<5>(&packed);
        for [place, a, b, c, d] in groups.ok_or_else(|| damaged("a step's tiles are torn"))? {
            let change = Change {
                before: held([a, b])?,
                after: held([c, d])?,
            };
            tiles.insert(place_of(place), change);
        }
        let kept: KeptDeed = serde_json::from_str(&texts[2])?;
        let mut loads = BTreeMap::new();
        for (name, [before, after]) in kept.loads {
            loads.insert(name, [shelves.load(before)?, shelves.load(after)?]);
        }
        let [what, brush, _] = texts;
        steps.push(Step {
            id: id as u64,
            what,
            brush: (!brush.is_empty()).then_some(brush),
            operations: operations as u64,
            done: done != 0,
            tiles: Arc::new(tiles),
            effects: Arc::new(StepEffects {
                loads,
                booked: kept.booked,
                layers: kept.layers,
                makes: kept.makes,
                tops: kept.tops,
            }),
        });
    }
    Ok(steps)
}

fn versions(database: &Database, shelves: &Shelves) -> Result<Vec<Named>, DocumentError> {
    let query = "SELECT name, parent, rest, tiles, sum FROM version ORDER BY name";
    let mut statement = database.connection.prepare(query)?;
    let mut rows = statement.query(params![])?;
    let mut versions = Vec::new();
    while let Some(row) = rows.next()? {
        let texts: [String; 3] = [row.get(0)?, row.get(1)?, row.get(2)?];
        let packed: Vec<u8> = row.get(3)?;
        let sum = texts.iter().fold(Sum::of(Table::Version), |sum, text| {
            sum.bytes(text.as_bytes())
        });
        if sum.bytes(&packed).done() != row.get::<_, i64>(4)? {
            return Err(damaged(format!(
                "version '{}' does not match its checksum",
                texts[0]
            )));
        }
        let mut tiles = BTreeMap::new();
        let groups = unpacked::<3>(&packed);
        for [place, page, dry] in groups.ok_or_else(|| damaged("a version's tiles are torn"))? {
            tiles.insert(place_of(place), shelves.held([page, dry])?);
        }
        let kept: KeptRest = serde_json::from_str(&texts[2])?;
        let mut loads = BTreeMap::new();
        for (name, id) in kept.loads {
            loads.insert(name, shelves.load(id)?);
        }
        let [name, parent, _] = texts;
        versions.push(Named {
            name,
            parent: (!parent.is_empty()).then_some(parent),
            tiles: Arc::new(tiles),
            rest: NonTileState {
                loads,
                ledger: kept.ledger,
                layers: kept.layers,
                makes: kept.makes,
                tops: kept.tops,
            },
        });
    }
    Ok(versions)
}

/// Reads a painting, but for its pages.
pub(crate) fn opened(database: &Database, pager: &Arc<Pager>) -> Result<Opened, DocumentError> {
    let mut kept: PaintingSnapshot = state(database, "painting")?;
    let sequencer: SequencerSnapshot = state(database, "sequencer")?;
    let library = PaintLibrary::parse(&text(database, &kept.paints)?).map_err(damaged)?;
    for brush in kept.brushes.values_mut() {
        brush.file = text(database, &brush.file)?;
    }
    let shelves = Shelves::read(database, pager)?;
    let mut loads = BTreeMap::new();
    for (name, brush) in &kept.brushes {
        loads.insert(name.clone(), shelves.load(brush.load)?);
    }
    let records = records(database, sequencer.serial)?;
    let restored = Restored {
        tiles: tiles(database, &shelves)?,
        loads,
        steps: steps(database, &shelves)?,
        named: versions(database, &shelves)?,
        embedded: pictures(database)?,
        kept,
    };
    // Unreferenced rows go with the next checkpoint: the shelves were their last reference.
    drop(shelves);
    Ok(Opened {
        restored,
        sequencer,
        records,
        library,
        pager: Arc::clone(pager),
    })
}
