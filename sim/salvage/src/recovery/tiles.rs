//! Content of each tile: the current state, or the newest older state that is intact.

use std::collections::{BTreeSet, HashMap};

use maulstick_document::DocumentError;
use maulstick_document::file::database::Database;
use maulstick_document::rows::place_of;
use maulstick_document::tables::schema::Table;
use maulstick_painting::snapshot::PaintingSnapshot;
use maulstick_types::paint::TILE;

use super::intact_rows::{IntactRows, TileRow};
use super::inventory::{Inventory, TileIds};
use super::painting_row::PaintingRow;
use super::report::SalvageReport;
use crate::sqlite::Value;

/// Tile without paint.
const BARE: TileIds = [0, 0];

/// Recovered content of a tile.
enum TileContent {
    Intact(TileIds),
    /// Newest older state that is intact.
    Older(TileIds),
    /// Without its wet paint, or without its dry layers.
    Part(TileIds),
    Missing,
}

/// True if a place is on one of the painting's surfaces.
fn is_inside(snapshot: &PaintingSnapshot, place: i64) -> bool {
    let (id, tile) = place_of(place);
    let mut surfaces = snapshot.scene.surfaces.iter();
    surfaces
        .find(|surface| surface.id == id)
        .is_some_and(|surface| {
            let grid = surface.cells.map(|cells| cells.div_ceil(TILE as u32));
            place >= 0 && tile.x < grid[0] && tile.y < grid[1]
        })
}

/// Writes all tiles; returns their contents by place number. `states` are the contents in the history, newest first.
///
/// # Errors
/// The error of SQLite.
pub(super) fn write(
    rows: &IntactRows,
    states: &HashMap<i64, Vec<TileIds>>,
    inventory: &Inventory,
    snapshot: &mut PaintingSnapshot,
    report: &mut SalvageReport,
    database: &Database,
) -> Result<HashMap<i64, TileIds>, DocumentError> {
    let places: BTreeSet<i64> = rows.tiles.keys().chain(states.keys()).copied().collect();
    let mut tiles = HashMap::new();
    let numbers = rows.tiles.values().flat_map(|rows| rows.current.iter());
    let newest = numbers.map(|[version, ..]| *version as u64).max();
    snapshot.versions = snapshot.versions.max(newest.unwrap_or(0));
    for place in places {
        if !is_inside(snapshot, place) {
            continue;
        }
        let copies = rows.tiles.get(&place);
        let current = copies.and_then(|copies| copies.current);
        let mut older: Vec<TileRow> = copies.map_or(Vec::new(), |copies| copies.older.clone());
        older.sort_by_key(|[version, ..]| std::cmp::Reverse(*version));
        let older = older.into_iter().map(|[_, page, dry]| [page, dry]);
        let known = states.get(&place).into_iter().flatten().copied();
        let content = content(current, known.chain(older), inventory);
        let (numbers, version) = match &content {
            TileContent::Intact(numbers) => (*numbers, current.map(|[version, ..]| version)),
            TileContent::Older(numbers) | TileContent::Part(numbers) => (*numbers, None),
            TileContent::Missing => (BARE, None),
        };
        match content {
            TileContent::Intact(_) if numbers == BARE => {}
            TileContent::Intact([_, dry]) | TileContent::Older([_, dry])
                if inventory.is_thinned(dry) =>
            {
                report.thinned.push(place_of(place));
            }
            TileContent::Intact(_) => report.tiles += 1,
            TileContent::Older(_) => report.older.push(place_of(place)),
            TileContent::Part(_) => report.thinned.push(place_of(place)),
            TileContent::Missing => report.missing.push(place_of(place)),
        }
        let version = version.unwrap_or_else(|| {
            snapshot.versions += 1;
            snapshot.versions as i64
        });
        let values = [place, version, numbers[0], numbers[1]].map(Value::Int);
        PaintingRow::new(Table::Tile, values.to_vec()).write(database)?;
        tiles.insert(place, numbers);
    }
    Ok(tiles)
}

fn content(
    current: Option<TileRow>,
    mut older: impl Iterator<Item = TileIds>,
    inventory: &Inventory,
) -> TileContent {
    let current = current.map(|[_, page, dry]| [page, dry]);
    let is_intact = |ids: &TileIds| inventory.tile(*ids).is_some();
    if let Some(numbers) = current.filter(is_intact) {
        return TileContent::Intact(numbers);
    }
    // The rest of the newest state, unless an older one loses no dry paint.
    let mut last = current;
    let mut found = None;
    while found.is_none()
        && let Some(numbers) = older.next()
    {
        let newest = *last.get_or_insert(numbers);
        let [_, dry] = inventory.parts(newest);
        let loses = dry.is_some() && newest[1] != 0 && newest[1] != numbers[1];
        found = Some(numbers).filter(is_intact).filter(|_| !loses);
    }
    match (current, found) {
        (None, Some(BARE)) => return TileContent::Intact(BARE),
        (_, Some(numbers)) if numbers != BARE => return TileContent::Older(numbers),
        _ => {}
    }
    let newest = last.unwrap_or(BARE);
    let [wet, dry] = inventory.parts(newest);
    let part = [wet.map_or(0, |_| newest[0]), dry.map_or(0, |_| newest[1])];
    match part {
        BARE => TileContent::Missing,
        part => TileContent::Part(part),
    }
}
