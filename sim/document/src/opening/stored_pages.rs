//! Pages, dry layers and loads of a file as references, by number; their paint is read on demand.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use maulstick_canvas::dry::{DRY_LAYERS_MOST, DryLayer, DryStack};
use maulstick_canvas::page::{Page, Pager};
use maulstick_canvas::planes::Planes;
use maulstick_canvas::tile::Tile;
use maulstick_model::brush::load::BrushLoad;
use maulstick_painting::history::{Change, NonTileState, StepEffects, TilePlace, TileRef};
use rusqlite::params;

use super::damaged;
use crate::error::DocumentError;
use crate::file::database::Database;
use crate::tables::checksum::Checksum;
use crate::tables::rows::{StoredNonTileState, StoredStepEffects, place_of, unpacked};
use crate::tables::schema::Table;

/// Pages, dry layers and loads of a file, by number.
pub(crate) struct StoredPages {
    pages: HashMap<i64, Page<Planes>>,
    stacks: HashMap<i64, Arc<DryStack>>,
    loads: HashMap<i64, Page<BrushLoad>>,
}

impl StoredPages {
    /// Reads the numbers and sizes of all pages, and the dry layers.
    ///
    /// # Errors
    /// [`DocumentError::Damaged`] for a dry layer, or the error of SQLite.
    pub(super) fn read(database: &Database, pager: &Arc<Pager>) -> Result<Self, DocumentError> {
        let mut stored = Self {
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
            stored.pages.insert(id, page);
        }
        for (id, bytes) in sizes("load")? {
            let page = Page::stored(pager, id as u64, bytes as usize);
            stored.loads.insert(id, page);
        }
        // Layers below have lower numbers.
        let query = "SELECT id, below, layer, page, sum FROM dry ORDER BY id";
        let mut statement = connection.prepare(query)?;
        let mut rows = statement.query(params![])?;
        while let Some(row) = rows.next()? {
            let ints: [i64; 4] = [row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?];
            if Checksum::of_ints(Table::Dry, &ints) != row.get::<_, i64>(4)? {
                return Err(damaged("a dry layer does not match its checksum"));
            }
            let [id, below, layer, page] = ints;
            let below = match below {
                0 => None,
                below => Some(stored.stack(below)?),
            };
            let layer = DryLayer {
                number: layer as u32,
                planes: stored.page(page)?,
            };
            let stack = DryStack::known(id as u64, below, layer);
            if stack.depth() > DRY_LAYERS_MOST {
                let most = DRY_LAYERS_MOST;
                return Err(damaged(format!("a tile has more than {most} dry layers")));
            }
            stack.note_stored();
            stored.stacks.insert(id, stack);
        }
        Ok(stored)
    }

    fn page(&self, id: i64) -> Result<Page<Planes>, DocumentError> {
        let found = self.pages.get(&id).cloned();
        found.ok_or_else(|| damaged(format!("page {id} is missing")))
    }

    fn stack(&self, id: i64) -> Result<Arc<DryStack>, DocumentError> {
        let found = self.stacks.get(&id).cloned();
        found.ok_or_else(|| damaged(format!("dry layer {id} is missing")))
    }

    /// Load of a brush.
    ///
    /// # Errors
    /// [`DocumentError::Damaged`] if it is missing.
    pub(crate) fn load(&self, id: u64) -> Result<Page<BrushLoad>, DocumentError> {
        let found = self.loads.get(&(id as i64)).cloned();
        found.ok_or_else(|| damaged(format!("load {id} is missing")))
    }

    /// Tile of a wet page and its newest dry layer, 0 if absent.
    ///
    /// # Errors
    /// [`DocumentError::Damaged`] if either is missing.
    pub(super) fn tile(&self, [page, dry]: [i64; 2]) -> Result<TileRef, DocumentError> {
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

    /// Tiles of a version.
    ///
    /// # Errors
    /// [`DocumentError::Damaged`] if a page is missing.
    pub(crate) fn tiles(
        &self,
        packed: &[u8],
    ) -> Result<BTreeMap<TilePlace, TileRef>, DocumentError> {
        let groups = unpacked::<3>(packed);
        let groups = groups.ok_or_else(|| damaged("the tiles of a version are cut short"))?;
        let tiles = groups.into_iter();
        tiles
            .map(|[place, page, dry]| Ok((place_of(place), self.tile([page, dry])?)))
            .collect()
    }

    /// Changes of a step. Neighbouring steps share tiles, which are in `known`.
    ///
    /// # Errors
    /// [`DocumentError::Damaged`] if a page is missing.
    pub(crate) fn changes(
        &self,
        packed: &[u8],
        known: &mut HashMap<[i64; 2], TileRef>,
    ) -> Result<BTreeMap<TilePlace, Change>, DocumentError> {
        let mut tile = |ids: [i64; 2]| -> Result<TileRef, DocumentError> {
            if let Some(tile) = known.get(&ids) {
                return Ok(tile.clone());
            }
            let tile = self.tile(ids)?;
            known.insert(ids, tile.clone());
            Ok(tile)
        };
        let groups = unpacked::<5>(packed);
        let groups = groups.ok_or_else(|| damaged("the tiles of a step are cut short"))?;
        let mut changes = BTreeMap::new();
        for [place, a, b, c, d] in groups {
            let change = Change {
                before: tile([a, b])?,
                after: tile([c, d])?,
            };
            changes.insert(place_of(place), change);
        }
        Ok(changes)
    }

    /// Effects of a step besides tiles.
    ///
    /// # Errors
    /// [`DocumentError::Damaged`] if a load is missing.
    pub(crate) fn step_effects(
        &self,
        stored: StoredStepEffects,
    ) -> Result<StepEffects, DocumentError> {
        let mut loads = BTreeMap::new();
        for (name, [before, after]) in stored.loads {
            loads.insert(name, [self.load(before)?, self.load(after)?]);
        }
        Ok(StepEffects {
            loads,
            booked: stored.booked,
            layers: stored.layers,
            materials: stored.materials,
            tops: stored.tops,
        })
    }

    /// State of a version besides tiles.
    ///
    /// # Errors
    /// [`DocumentError::Damaged`] if a load is missing.
    pub(crate) fn non_tile_state(
        &self,
        stored: StoredNonTileState,
    ) -> Result<NonTileState, DocumentError> {
        let mut loads = BTreeMap::new();
        for (name, id) in stored.loads {
            loads.insert(name, self.load(id)?);
        }
        Ok(NonTileState {
            loads,
            ledger: stored.ledger,
            layers: stored.layers,
            materials: stored.materials,
            tops: stored.tops,
        })
    }
}
