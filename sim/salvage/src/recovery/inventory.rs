//! Inventory of intact pages, loads and dry layers: the amount of paint in each.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use maulstick_canvas::planes::{Planes, plane_counts};
use maulstick_canvas::quantum::{Counts, SLOTS, add};
use maulstick_document::DocumentError;
use maulstick_document::file::database::Database;
use maulstick_document::tables::planes;
use maulstick_document::tables::schema::Table;
use rusqlite::params;

use super::painting_row::PaintingRow;
use crate::sqlite::Value;

/// Paint in intact pages, loads and dry layers, by number.
#[derive(Debug, Default)]
pub(super) struct Inventory {
    pages: HashMap<i64, Counts>,
    loads: HashMap<i64, Counts>,
    /// Dry layers, each with the paint of all layers below it.
    stacks: HashMap<i64, Counts>,
    /// Dry layers that lost paint, or are above one that did.
    thinned: BTreeSet<i64>,
    /// Number of dry layers whose own page is damaged: they stay, without paint.
    pub(super) emptied: u64,
    /// Number of dry layers that lost all layers below.
    pub(super) cut_off: u64,
    /// Number of the next page.
    pub(super) next: u64,
}

/// Content of a tile: numbers of its page and of its newest dry layer.
pub(super) type TileIds = [i64; 2];

impl Inventory {
    /// Reads every page and load of the new painting and deletes damaged ones. New pages are numbered from `next` on, or
    /// from the first free number.
    ///
    /// # Errors
    /// The error of SQLite.
    pub(super) fn read(
        database: &Database,
        next: u64,
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<Self, DocumentError> {
        let mut inventory = Self {
            next,
            ..Self::default()
        };
        let [pages, loads] = [ids(database, Table::Page)?, ids(database, Table::Load)?];
        let all = (pages.len() + loads.len()) as u64;
        for (done, id) in pages.iter().enumerate() {
            progress(done as u64, all);
            if let Some(planes) = intact(database.planes(*id as u64))? {
                inventory.pages.insert(*id, plane_counts(&planes));
            }
        }
        for id in &loads {
            if let Some(load) = intact(database.load(*id as u64))? {
                inventory.loads.insert(*id, load.counts());
            }
        }
        let connection = database.connection();
        connection.execute_batch("BEGIN IMMEDIATE")?;
        let damaged = pages.iter().filter(|id| !inventory.pages.contains_key(id));
        for id in damaged {
            connection.execute("DELETE FROM page WHERE id = ?1", params![*id])?;
        }
        let damaged = loads.iter().filter(|id| !inventory.loads.contains_key(id));
        for id in damaged {
            connection.execute("DELETE FROM load WHERE id = ?1", params![*id])?;
        }
        connection.execute_batch("COMMIT")?;
        let newest = pages.iter().chain(&loads).copied().max().unwrap_or(0);
        inventory.next = inventory.next.max(newest.max(0) as u64 + 1);
        Ok(inventory)
    }

    /// Number that no page, load or layer has.
    pub(super) fn new_number(&mut self) -> i64 {
        self.next += 1;
        (self.next - 1) as i64
    }

    /// Writes the dry layers. One whose page is damaged stays without paint, for the layers above it and the steps that
    /// refer to it; one whose lower neighbour is lost becomes the lowest of its stack.
    ///
    /// # Errors
    /// The error of SQLite.
    pub(super) fn write_dry_layers(
        &mut self,
        database: &Database,
        dry: &BTreeMap<i64, [i64; 3]>,
    ) -> Result<(), DocumentError> {
        let newest = dry.keys().copied().max().unwrap_or(0);
        self.next = self.next.max(newest.max(0) as u64 + 1);
        for (id, [below, layer, page]) in dry {
            let (mut below, mut page) = (*below, *page);
            let mut counts = [0; SLOTS];
            let mut is_thinned = self.thinned.contains(&below);
            if below != 0 {
                match self.stacks.get(&below) {
                    Some(under) => add(&mut counts, under),
                    None => {
                        (below, is_thinned) = (0, true);
                        self.cut_off += 1;
                    }
                }
            }
            match self.pages.get(&page) {
                Some(own) => add(&mut counts, own),
                None => {
                    page = self.empty_page(database)?;
                    is_thinned = true;
                    self.emptied += 1;
                }
            }
            if is_thinned {
                self.thinned.insert(*id);
            }
            self.stacks.insert(*id, counts);
            let values = [*id, below, *layer, page].map(Value::Int);
            PaintingRow::new(Table::Dry, values.to_vec()).write(database)?;
        }
        Ok(())
    }

    fn empty_page(&mut self, database: &Database) -> Result<i64, DocumentError> {
        let id = self.new_number();
        let data = planes::encode(&Planes::new(), None, database.level())?;
        let ints = [id, 0, 0, 0].map(Value::Int);
        let values = ints.into_iter().chain([Value::Blob(data)]);
        PaintingRow::new(Table::Page, values.collect()).write(database)?;
        self.pages.insert(id, [0; SLOTS]);
        Ok(id)
    }

    /// Adds an empty load that was written.
    pub(super) fn add_empty_load(&mut self, id: i64) {
        self.loads.insert(id, [0; SLOTS]);
    }

    /// Paint of a tile; `None` if its page or its newest dry layer is lost.
    pub(super) fn tile(&self, ids: TileIds) -> Option<Counts> {
        let [page, dry] = self.parts(ids);
        let (mut counts, dry) = (page?, dry?);
        add(&mut counts, &dry);
        Some(counts)
    }

    /// Wet and dry paint of a tile; `None` for a part that is lost.
    pub(super) fn parts(&self, [page, dry]: TileIds) -> [Option<Counts>; 2] {
        let of = |counts: &HashMap<i64, Counts>, id: i64| match id {
            0 => Some([0; SLOTS]),
            id => counts.get(&id).copied(),
        };
        [of(&self.pages, page), of(&self.stacks, dry)]
    }

    /// True if a dry layer, or one below it, lost paint.
    pub(super) fn is_thinned(&self, dry: i64) -> bool {
        self.thinned.contains(&dry)
    }

    /// Paint of a load; `None` if it is lost.
    pub(super) fn load(&self, id: u64) -> Option<Counts> {
        self.loads.get(&(id as i64)).copied()
    }
}

fn ids(database: &Database, table: Table) -> Result<Vec<i64>, DocumentError> {
    let query = format!("SELECT id FROM {} ORDER BY id", table.name());
    let mut statement = database.connection().prepare(&query)?;
    let rows = statement.query_map(params![], |row| row.get(0))?;
    Ok(rows.collect::<Result<_, _>>()?)
}

/// Value that was read; `None` if it is damaged.
fn intact<T>(read: Result<T, DocumentError>) -> Result<Option<T>, DocumentError> {
    match read {
        Ok(read) => Ok(Some(read)),
        Err(DocumentError::Damaged(_)) => Ok(None),
        Err(error) => Err(error),
    }
}
