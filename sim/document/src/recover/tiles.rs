//! Content of each tile: as it was, or the newest older state that is intact.

use std::collections::{BTreeSet, HashMap};

use maulstick_painting::snapshot::PaintingSnapshot;
use maulstick_types::paint::TILE;

use super::Salvage;
use super::found::Found;
use super::gathering::{Gathered, TileRow};
use super::stock::{Numbers, Stock};
use crate::database::Database;
use crate::error::DocumentError;
use crate::rows::place_of;
use crate::scan::Value;
use crate::schema::Table;

const BARE: Numbers = [0, 0];

/// Result for a tile.
enum Fate {
    Whole(Numbers),
    /// The newest older state that is whole.
    Older(Numbers),
    /// Without its wet paint, or without what had dried.
    Part(Numbers),
    Missing,
}

/// True if a place is on one of the painting's surfaces.
fn is_inside(kept: &PaintingSnapshot, place: i64) -> bool {
    let (id, tile) = place_of(place);
    let mut surfaces = kept.scene.surfaces.iter();
    surfaces
        .find(|surface| surface.id == id)
        .is_some_and(|surface| {
            let grid = surface.cells.map(|cells| cells.div_ceil(TILE as u32));
            place >= 0 && tile.x < grid[0] && tile.y < grid[1]
        })
}

/// Writes all tiles; returns their contents, by place number. `states` are those that the history has of them, the
/// newest first.
///
/// # Errors
/// The error of SQLite.
pub(super) fn write(
    gathered: &Gathered,
    states: &HashMap<i64, Vec<Numbers>>,
    stock: &Stock,
    kept: &mut PaintingSnapshot,
    salvage: &mut Salvage,
    database: &Database,
) -> Result<HashMap<i64, Numbers>, DocumentError> {
    let places: BTreeSet<i64> = gathered
        .tiles
        .keys()
        .chain(states.keys())
        .copied()
        .collect();
    let mut tiles = HashMap::new();
    let numbers = gathered.tiles.values().flat_map(|rows| rows.current.iter());
    let newest = numbers.map(|[version, ..]| *version as u64).max();
    kept.versions = kept.versions.max(newest.unwrap_or(0));
    for place in places {
        if !is_inside(kept, place) {
            continue;
        }
        let rows = gathered.tiles.get(&place);
        let current = rows.and_then(|rows| rows.current);
        let mut older: Vec<TileRow> = rows.map_or(Vec::new(), |rows| rows.older.clone());
        older.sort_by_key(|[version, ..]| std::cmp::Reverse(*version));
        let older = older.into_iter().map(|[_, page, dry]| [page, dry]);
        let known = states.get(&place).into_iter().flatten().copied();
        let fate = fate(current, known.chain(older), stock);
        let (numbers, version) = match &fate {
            Fate::Whole(numbers) => (*numbers, current.map(|[version, ..]| version)),
            Fate::Older(numbers) | Fate::Part(numbers) => (*numbers, None),
            Fate::Missing => (BARE, None),
        };
        match fate {
            Fate::Whole(_) if numbers == BARE => {}
            Fate::Whole([_, dry]) | Fate::Older([_, dry]) if stock.is_thin(dry) => {
                salvage.thinned.push(place_of(place));
            }
            Fate::Whole(_) => salvage.tiles += 1,
            Fate::Older(_) => salvage.older.push(place_of(place)),
            Fate::Part(_) => salvage.thinned.push(place_of(place)),
            Fate::Missing => salvage.missing.push(place_of(place)),
        }
        let version = version.unwrap_or_else(|| {
            kept.versions += 1;
            kept.versions as i64
        });
        let values = [place, version, numbers[0], numbers[1]].map(Value::Int);
        Found::of(Table::Tile, values.to_vec()).write(database)?;
        tiles.insert(place, numbers);
    }
    Ok(tiles)
}

fn fate(current: Option<TileRow>, mut older: impl Iterator<Item = Numbers>, stock: &Stock) -> Fate {
    let current = current.map(|[_, page, dry]| [page, dry]);
    let is_whole = |numbers: &Numbers| stock.held(*numbers).is_some();
    if let Some(numbers) = current.filter(is_whole) {
        return Fate::Whole(numbers);
    }
    // The rest of the newest state, unless an older one loses no dry paint.
    let mut last = current;
    let mut found = None;
    while found.is_none()
        && let Some(numbers) = older.next()
    {
        let newest = *last.get_or_insert(numbers);
        let [_, dry] = stock.parts(newest);
        let loses = dry.is_some() && newest[1] != 0 && newest[1] != numbers[1];
        found = Some(numbers).filter(is_whole).filter(|_| !loses);
    }
    match (current, found) {
        (None, Some(BARE)) => return Fate::Whole(BARE),
        (_, Some(numbers)) if numbers != BARE => return Fate::Older(numbers),
        _ => {}
    }
    let newest = last.unwrap_or(BARE);
    let [wet, dry] = stock.parts(newest);
    let part = [wet.map_or(0, |_| newest[0]), dry.map_or(0, |_| newest[1])];
    match part {
        BARE => Fate::Missing,
        part => Fate::Part(part),
    }
}
