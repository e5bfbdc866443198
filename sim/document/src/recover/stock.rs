//! Intact pages, loads and dry layers, and the amount of their paint.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use maulstick_canvas::planes::{Planes, plane_counts};
use maulstick_canvas::quantum::{Counts, SLOTS, add};
use rusqlite::params;

use super::found::Found;
use crate::database::Database;
use crate::error::DocumentError;
use crate::planes;
use crate::scan::Value;
use crate::schema::Table;

/// Intact rows, with their paint.
#[derive(Debug, Default)]
pub(super) struct Stock {
    pages: HashMap<i64, Counts>,
    loads: HashMap<i64, Counts>,
    /// Dry layers, with the paint of all layers below.
    stacks: HashMap<i64, Counts>,
    /// Dry layers that lost paint, or are over such.
    thin: BTreeSet<i64>,
    /// Dry layers whose own page is not whole: they stay, without paint.
    pub(super) hollow: u64,
    /// Dry layers under which nothing is known any more.
    pub(super) cut: u64,
    /// The number of the next page.
    pub(super) next: u64,
}

/// Content of a tile: its page and its newest dry layer.
pub(super) type Numbers = [i64; 2];

impl Stock {
    /// Reads every page and load of the new painting; damaged ones are deleted from it. Pages are numbered from `next`
    /// on, or from the first free number.
    ///
    /// # Errors
    /// The error of SQLite.
    pub(super) fn read(
        database: &Database,
        next: u64,
        tell: &mut dyn FnMut(u64, u64),
    ) -> Result<Self, DocumentError> {
        let mut stock = Self {
            next,
            ..Self::default()
        };
        let [pages, loads] = [ids(database, Table::Page)?, ids(database, Table::Load)?];
        let all = (pages.len() + loads.len()) as u64;
        for (done, id) in pages.iter().enumerate() {
            tell(done as u64, all);
            if let Some(planes) = whole(database.planes(*id as u64))? {
                stock.pages.insert(*id, plane_counts(&planes));
            }
        }
        for id in &loads {
            if let Some(load) = whole(database.load(*id as u64))? {
                stock.loads.insert(*id, load.counts());
            }
        }
        let connection = &database.connection;
        connection.execute_batch("BEGIN IMMEDIATE")?;
        let torn = pages.iter().filter(|id| !stock.pages.contains_key(id));
        for id in torn {
            connection.execute("DELETE FROM page WHERE id = ?1", params![*id])?;
        }
        let torn = loads.iter().filter(|id| !stock.loads.contains_key(id));
        for id in torn {
            connection.execute("DELETE FROM load WHERE id = ?1", params![*id])?;
        }
        connection.execute_batch("COMMIT")?;
        let newest = pages.iter().chain(&loads).copied().max().unwrap_or(0);
        stock.next = stock.next.max(newest.max(0) as u64 + 1);
        Ok(stock)
    }

    /// A number that no page, load or layer has.
    pub(super) fn number(&mut self) -> i64 {
        self.next += 1;
        (self.next - 1) as i64
    }

    /// Writes the dry layers. One whose page is not whole stays without paint, so that what lies over
    /// it and what remembers it stays; below one whose lower neighbour is gone there is nothing.
    ///
    /// # Errors
    /// What SQLite says.
    pub(super) fn lay(
        &mut self,
        database: &Database,
        dry: &BTreeMap<i64, [i64; 3]>,
    ) -> Result<(), DocumentError> {
        let newest = dry.keys().copied().max().unwrap_or(0);
        self.next = self.next.max(newest.max(0) as u64 + 1);
        for (id, [below, layer, page]) in dry {
            let (mut below, mut page) = (*below, *page);
            let mut counts = [0; SLOTS];
            let mut is_thin = self.thin.contains(&below);
            if below != 0 {
                match self.stacks.get(&below) {
                    Some(under) => add(&mut counts, under),
                    None => {
                        (below, is_thin) = (0, true);
                        self.cut += 1;
                    }
                }
            }
            match self.pages.get(&page) {
                Some(own) => add(&mut counts, own),
                None => {
                    page = self.empty_page(database)?;
                    is_thin = true;
                    self.hollow += 1;
                }
            }
            if is_thin {
                self.thin.insert(*id);
            }
            self.stacks.insert(*id, counts);
            let values = [*id, below, *layer, page].map(Value::Int);
            Found::of(Table::Dry, values.to_vec()).write(database)?;
        }
        Ok(())
    }

    fn empty_page(&mut self, database: &Database) -> Result<i64, DocumentError> {
        let id = self.number();
        let data = planes::encode(&Planes::new(), None, database.level)?;
        let ints = [id, 0, 0, 0].map(Value::Int);
        let values = ints.into_iter().chain([Value::Blob(data)]);
        Found::of(Table::Page, values.collect()).write(database)?;
        self.pages.insert(id, [0; SLOTS]);
        Ok(id)
    }

    /// Notes a load that was written.
    pub(super) fn note_load(&mut self, id: i64) {
        self.loads.insert(id, [0; SLOTS]);
    }

    /// The paint of a tile; `None` if its page or its newest dry layer is gone.
    pub(super) fn held(&self, numbers: Numbers) -> Option<Counts> {
        let [page, dry] = self.parts(numbers);
        let (mut counts, dry) = (page?, dry?);
        add(&mut counts, &dry);
        Some(counts)
    }

    /// The wet and the dry paint of a tile; `None` for a part that is gone.
    pub(super) fn parts(&self, [page, dry]: Numbers) -> [Option<Counts>; 2] {
        let of = |shelf: &HashMap<i64, Counts>, id: i64| match id {
            0 => Some([0; SLOTS]),
            id => shelf.get(&id).copied(),
        };
        [of(&self.pages, page), of(&self.stacks, dry)]
    }

    /// True if a dry layer, or one below it, lost paint.
    pub(super) fn is_thin(&self, dry: i64) -> bool {
        self.thin.contains(&dry)
    }

    /// The paint of a load; `None` if it is gone.
    pub(super) fn load(&self, id: u64) -> Option<Counts> {
        self.loads.get(&(id as i64)).copied()
    }
}

fn ids(database: &Database, table: Table) -> Result<Vec<i64>, DocumentError> {
    let query = format!("SELECT id FROM {} ORDER BY id", table.name());
    let mut statement = database.connection.prepare(&query)?;
    let rows = statement.query_map(params![], |row| row.get(0))?;
    Ok(rows.collect::<Result<_, _>>()?)
}

/// The value read; `None` if it is damaged.
fn whole<T>(read: Result<T, DocumentError>) -> Result<Option<T>, DocumentError> {
    match read {
        Ok(read) => Ok(Some(read)),
        Err(DocumentError::Damaged(_)) => Ok(None),
        Err(error) => Err(error),
    }
}
