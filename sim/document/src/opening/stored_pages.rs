//! Pages, dry layers and loads of a file as references, by number; their paint is read when it is needed.

use std::collections::HashMap;
use std::sync::Arc;

use maulstick_canvas::dry::{DryLayer, DryStack};
use maulstick_canvas::page::{Page, Pager};
use maulstick_canvas::planes::Planes;
use maulstick_canvas::tile::Tile;
use maulstick_model::brush::load::BrushLoad;
use maulstick_painting::history::TileRef;
use rusqlite::params;

use super::damaged;
use crate::error::DocumentError;
use crate::file::database::Database;
use crate::tables::checksum::Checksum;
use crate::tables::schema::Table;

/// Pages, dry layers and loads of a file, by number.
pub(super) struct StoredPages {
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
    pub(super) fn load(&self, id: u64) -> Result<Page<BrushLoad>, DocumentError> {
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
}
