//! Last displayed tiles of the canvas, read from a closed painting without locking or changing it.

use std::collections::BTreeMap;
use std::path::Path;

use maulstick_canvas::tile::TileId;
use maulstick_types::paint::TILE;
use maulstick_types::scene::{CANVAS, Surface};
use rusqlite::params;

use super::read_scene;
use crate::error::DocumentError;
use crate::file::database::{Database, is_new};
use crate::tables::checksum::Checksum;
use crate::tables::rows::{place_of, shown_number};
use crate::tables::schema::Table;

/// Greatest number of tiles to read.
const MOST_TILES: usize = 4096;
/// Greatest size of a displayed tile, bytes.
const TILE_BYTES: usize = 1 << 20;

/// Passes on the last displayed tiles of the canvas, at the coarsest level whose longer side has at least `side`
/// points: the canvas, level, place, and the planes of a frame. Bare tiles and later paint are left out.
///
/// # Errors
/// [`DocumentError`] if there is no such painting, if it is open or was not closed, or if it is of another version.
pub fn shown_tiles(
    path: &Path,
    side: u32,
    mut take: impl FnMut(&Surface, u32, TileId, &[u8]),
) -> Result<(), DocumentError> {
    if is_new(path)? {
        return Err(DocumentError::Missing);
    }
    let database = Database::open_immutable(path)?;
    database.is_of_this_version()?;
    let scene = read_scene(&database)?.ok_or(DocumentError::NoPainting)?;
    let mut surfaces = scene.surfaces.into_iter();
    let canvas = surfaces
        .find(|surface| surface.id == CANVAS)
        .ok_or(DocumentError::NoPainting)?;
    let grid = canvas.cells.map(|cells| cells.div_ceil(TILE as u32));
    let longer = canvas.cells[0].max(canvas.cells[1]);
    let level = (longer / side.max(1)).max(1).ilog2();
    let levels = Levels::of(&database, grid, level)?;
    let mut take = |level: u32, id: TileId, planes: &[u8]| take(&canvas, level, id, planes);
    let mut left = MOST_TILES;
    for (id, version) in levels.at(level) {
        levels.hand_on(&database, (level, *id, *version), &mut take, &mut left);
    }
    Ok(())
}

/// Versions of painted tiles, from full detail up to a level.
struct Levels(Vec<BTreeMap<TileId, i64>>);

impl Levels {
    fn of(database: &Database, grid: [u32; 2], coarsest: u32) -> Result<Self, DocumentError> {
        let query = "SELECT place, version, page, dry, sum FROM tile";
        let mut statement = database.connection.prepare(query)?;
        let mut rows = statement.query(params![])?;
        let mut finest = BTreeMap::new();
        while let Some(row) = rows.next()? {
            let ints: [i64; 4] = [row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?];
            if Checksum::of_ints(Table::Tile, &ints) != row.get::<_, i64>(4)? {
                return Err(DocumentError::Damaged("a tile".to_owned()));
            }
            let (surface, id) = place_of(ints[0]);
            // Rows of an earlier, larger canvas stay in the table.
            if surface == CANVAS && id.x < grid[0] && id.y < grid[1] {
                finest.insert(id, ints[1]);
            }
        }
        let mut levels = vec![finest];
        for level in 0..coarsest as usize {
            let mut coarser: BTreeMap<TileId, i64> = BTreeMap::new();
            for (id, version) in &levels[level] {
                let above = TileId {
                    x: id.x / 2,
                    y: id.y / 2,
                };
                let newest = coarser.entry(above).or_insert(*version);
                *newest = (*newest).max(*version);
            }
            levels.push(coarser);
        }
        Ok(Self(levels))
    }

    fn at(&self, level: u32) -> impl Iterator<Item = (&TileId, &i64)> {
        self.0.get(level as usize).into_iter().flatten()
    }

    /// Passes on a tile, or the finer ones that it consists of where it was not displayed itself.
    fn hand_on(
        &self,
        database: &Database,
        (level, id, version): (u32, TileId, i64),
        take: &mut impl FnMut(u32, TileId, &[u8]),
        left: &mut usize,
    ) {
        if *left == 0 {
            return;
        }
        let packed = database.shown_under_any_look(shown_number(CANVAS, level, id), version);
        let planes = packed.and_then(|packed| zstd::bulk::decompress(&packed, TILE_BYTES).ok());
        if let Some(planes) = planes {
            *left -= 1;
            return take(level, id, &planes);
        }
        let Some(finer) = level.checked_sub(1) else {
            return;
        };
        for quarter in 0..4 {
            let id = TileId {
                x: 2 * id.x + quarter % 2,
                y: 2 * id.y + quarter / 2,
            };
            if let Some(version) = self.0[finer as usize].get(&id) {
                self.hand_on(database, (finer, id, *version), take, left);
            }
        }
    }
}
