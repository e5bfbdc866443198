//! The beginning of a record as rows: snapshots, tiles, versions and open steps, which refer to pages by their numbers.

use std::collections::BTreeMap;
use std::sync::Arc;

use maulstick_painting::history::Step;
use maulstick_painting::snapshot::PaintingSnapshot;
use maulstick_painting::{Beginning, Named};
use maulstick_types::Message as _;
use maulstick_types::brush::{BrushDef, BrushState};
use maulstick_types::paint::{JournalEntry, StepName};
use rusqlite::{OptionalExtension as _, params};
use serde::{Deserialize, Serialize};

use super::{checked, damaged};
use crate::error::DocumentError;
use crate::file::database::Database;
use crate::opening::stored_files::text;
use crate::opening::stored_pages::StoredPages;
use crate::tables::checksum::Checksum;
use crate::tables::rows::{StoredNonTileState, StoredStepEffects, packed_changes, packed_tiles};
use crate::tables::schema::{Table, has_record};
use crate::writing::Writer;

/// Time of the wall clock, ms since 1970.
const TIME: &str = "time";
/// Formats of the messages of the record.
const FORMAT: &str = "format";
const PAINTING: &str = "painting";
const SEQUENCER: &str = "sequencer";
const TILES: &str = "tiles";
/// Parts that are a version or a step, followed by its name or number.
const VERSION: &str = "version ";
const STEP: &str = "step ";

/// Step that was not finished, JSON.
#[derive(Serialize, Deserialize)]
struct StoredStep {
    id: u64,
    #[serde(deserialize_with = "maulstick_types::wire::worded::read")]
    what: StepName,
    brush: Option<String>,
    operations: u64,
    effects: StoredStepEffects,
}

/// Version, JSON.
#[derive(Serialize, Deserialize)]
struct StoredVersion {
    name: String,
    parent: Option<String>,
    state: StoredNonTileState,
}

/// Message formats that this program can replay, its own first.
fn formats() -> Vec<String> {
    let stored = JournalEntry::stored_hashes().into_iter();
    let format = stored.map(|entry| {
        let hashes = [BrushState::schema().hash, entry, BrushDef::schema().hash];
        hashes.map(|hash| format!("{hash:08x}")).join(" ")
    });
    format.collect()
}

fn checksum(part: &str, value: &str, tiles: &[u8]) -> i64 {
    let sum = Checksum::new(Table::Beginning).bytes(part.as_bytes());
    sum.bytes(value.as_bytes()).bytes(tiles).finish()
}

/// Writes a beginning, with its pages that are not in the file.
pub(super) fn write(
    writer: &mut Writer<'_, '_>,
    beginning: &Beginning,
) -> Result<(), DocumentError> {
    let database = writer.database;
    let put = |part: &str, value: &str, tiles: &[u8]| -> Result<(), DocumentError> {
        let sum = checksum(part, value, tiles);
        database
            .connection
            .prepare_cached("INSERT INTO beginning VALUES(11, ?1, ?2, ?3, ?4)")?
            .execute(params![part, value, tiles, sum])?;
        Ok(())
    };
    let own = beginning.tiles.values();
    let named = beginning.named.iter();
    let tiles = own.chain(named.flat_map(|named| named.tiles.values()));
    tiles
        .into_iter()
        .try_for_each(|tile| writer.write_tile(tile))?;
    let named = beginning.named.iter();
    let loads = named.flat_map(|named| named.rest.loads.values());
    let mut loads = beginning.loads.values().chain(loads);
    loads.try_for_each(|page| writer.write_load(page))?;
    let painting = writer.with_files(&beginning.painting)?;
    put(TIME, &beginning.time_ms.to_string(), &[])?;
    let own = formats().into_iter().next();
    put(FORMAT, &own.unwrap_or_default(), &[])?;
    put(PAINTING, &serde_json::to_string(&painting)?, &[])?;
    put(
        SEQUENCER,
        &serde_json::to_string(&beginning.sequencer)?,
        &[],
    )?;
    put(TILES, "", &packed_tiles(&beginning.tiles))?;
    for version in &beginning.named {
        let stored = StoredVersion {
            name: version.name.clone(),
            parent: version.parent.clone(),
            state: (&version.rest).into(),
        };
        let stored = serde_json::to_string(&stored)?;
        let part = format!("{VERSION}{}", version.name);
        put(&part, &stored, &packed_tiles(&version.tiles))?;
    }
    // The checkpoint has written their pages.
    for step in &beginning.open {
        let stored = StoredStep {
            id: step.id,
            what: step.what.clone(),
            brush: step.brush.clone(),
            operations: step.operations,
            effects: (&*step.effects).into(),
        };
        let stored = serde_json::to_string(&stored)?;
        let part = format!("{STEP}{}", step.id);
        put(&part, &stored, &packed_changes(&step.tiles))?;
    }
    Ok(())
}

/// Reads the beginning of a painting's record; `None` without one, or if its messages have another format.
///
/// # Errors
/// [`DocumentError::Damaged`] if it is not intact.
pub(crate) fn read(
    database: &Database,
    pages: &StoredPages,
) -> Result<Option<Arc<Beginning>>, DocumentError> {
    let mut parts = parts(database)?;
    let Some((found, _)) = parts.remove(FORMAT) else {
        return Ok(None);
    };
    if !formats().contains(&found) {
        tracing::info!("the record is of another version of this program: a new one begins");
        return Ok(None);
    }
    let mut part = |name: &str| {
        let part = parts.remove(name);
        part.ok_or_else(|| damaged(&format!("lacks its {name}")))
    };
    let (time, _) = part(TIME)?;
    let mut painting: PaintingSnapshot = serde_json::from_str(&part(PAINTING)?.0)?;
    for brush in painting.brushes.values_mut() {
        brush.file = text(database, &brush.file)?;
    }
    let sequencer = serde_json::from_str(&part(SEQUENCER)?.0)?;
    let tiles = pages.tiles(&part(TILES)?.1)?;
    let mut loads = BTreeMap::new();
    for (name, brush) in &painting.brushes {
        loads.insert(name.clone(), pages.load(brush.load)?);
    }
    let (mut open, mut named) = (Vec::new(), Vec::new());
    for (name, (value, tiles)) in parts {
        if name.starts_with(VERSION) {
            let stored: StoredVersion = serde_json::from_str(&value)?;
            named.push(Named {
                name: stored.name,
                parent: stored.parent,
                tiles: Arc::new(pages.tiles(&tiles)?),
                rest: pages.non_tile_state(stored.state)?,
            });
        } else if name.starts_with(STEP) {
            let stored: StoredStep = serde_json::from_str(&value)?;
            open.push(Step {
                id: stored.id,
                what: stored.what,
                brush: stored.brush,
                operations: stored.operations,
                done: true,
                tiles: Arc::new(pages.changes(&tiles, &mut Default::default())?),
                effects: Arc::new(pages.step_effects(stored.effects)?),
            });
        }
    }
    Ok(Some(Arc::new(Beginning {
        time_ms: time.parse().unwrap_or(0),
        painting,
        sequencer,
        tiles,
        loads,
        open,
        named,
    })))
}

/// Value and tiles of each part.
type Parts = BTreeMap<String, (String, Vec<u8>)>;

fn parts(database: &Database) -> Result<Parts, DocumentError> {
    let mut parts = Parts::new();
    if !has_record(&database.connection)? {
        return Ok(parts);
    }
    let query = "SELECT part, value, tiles, sum FROM beginning";
    let mut statement = database.connection.prepare(query)?;
    let mut rows = statement.query(params![])?;
    while let Some(row) = rows.next()? {
        let (part, value): (String, String) = (row.get(0)?, row.get(1)?);
        let tiles: Vec<u8> = row.get(2)?;
        checked(checksum(&part, &value, &tiles), row.get(3)?)?;
        parts.insert(part, (value, tiles));
    }
    Ok(parts)
}

/// Checks that every part is intact.
pub(super) fn check(database: &Database) -> Result<(), DocumentError> {
    parts(database).map(drop)
}

/// Time of the wall clock at the beginning, ms since 1970; `None` if there is no record.
pub(super) fn time_ms(database: &Database) -> Result<Option<u64>, DocumentError> {
    if !has_record(&database.connection)? {
        return Ok(None);
    }
    let query = "SELECT value FROM beginning WHERE part = ?1";
    let found: Option<String> = database
        .connection
        .query_row(query, params![TIME], |row| row.get(0))
        .optional()?;
    Ok(found.map(|time| time.parse().unwrap_or(0)))
}
