//! Intact rows of a damaged painting: pages, loads and files are written to the new one at once, the few others stay in
//! memory.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;

use maulstick_document::DocumentError;
use maulstick_document::file::database::Database;
use maulstick_document::rows::COPY;
use maulstick_document::tables::schema::Table;
use maulstick_painting::snapshot::{PaintingSnapshot, SequencerSnapshot};
use rusqlite::{OptionalExtension as _, params};

use super::error::SalvageError;
use super::painting_row::{PaintingRow, RowKind};
use crate::sqlite::{Row, Scan};

/// Number of rows written in one transaction.
const BATCH: u64 = 512;

/// Age of the copy of a page that a row comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RowAge {
    /// The copy that SQLite reads.
    Current,
    /// A free page, or an older copy of one.
    Older,
}

/// Columns of a tile: version, page, dry layer.
pub(super) type TileRow = [i64; 3];

/// Rows of one tile.
#[derive(Debug, Default)]
pub(super) struct TileRows {
    pub(super) current: Option<TileRow>,
    pub(super) older: Vec<TileRow>,
}

/// Intact rows by table.
#[derive(Debug, Default)]
pub(super) struct IntactRows {
    pub(super) painting: Option<(PaintingSnapshot, RowAge)>,
    pub(super) sequencer: Option<(SequencerSnapshot, RowAge)>,
    /// Dry layers by number: layer below, layer's number in the painting, page.
    pub(super) dry: BTreeMap<i64, [i64; 3]>,
    /// Tiles by place number.
    pub(super) tiles: BTreeMap<i64, TileRows>,
    /// Copies of the row of each step.
    pub(super) steps: BTreeMap<i64, Vec<PaintingRow>>,
    pub(super) versions: BTreeMap<String, (PaintingRow, RowAge)>,
    /// Rows of the journal by their first serial number.
    pub(super) journal: BTreeMap<i64, PaintingRow>,
    /// Number of damaged current rows.
    pub(super) damaged: u64,
    /// Number of lost pages of tables, with all rows that they had.
    pub(super) pages_lost: u64,
    /// True if rows on free pages are recognised.
    pub(super) knows_free: bool,
    /// Steps whose current row is damaged.
    pub(super) damaged_steps: BTreeSet<i64>,
    /// Number of intact rows.
    count: u64,
}

impl IntactRows {
    /// Reads all rows; those of pages, loads and files are written to `into`.
    ///
    /// # Errors
    /// The error of SQLite on the new painting, or [`SalvageError::Lost`] if no row is intact.
    pub(super) fn read(
        scan: &mut Scan<File>,
        into: &Database,
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<Self, SalvageError> {
        let mut rows = Self {
            pages_lost: scan.lost_pages(),
            knows_free: scan.knows_free(),
            ..Self::default()
        };
        let pages = u64::from(scan.pages());
        for age in [RowAge::Current, RowAge::Older] {
            let before = pages * u64::from(age == RowAge::Older);
            let (mut written, mut page) = (0, 0);
            into.connection().execute_batch("BEGIN IMMEDIATE")?;
            let of = |row: &Row| row.current == (age == RowAge::Current);
            for row in scan.rows().filter(of) {
                if row.page != page {
                    page = row.page;
                    progress(before + u64::from(page), 2 * pages);
                }
                written += rows.take(row, age, into)?;
                if written >= BATCH {
                    into.connection().execute_batch("COMMIT; BEGIN IMMEDIATE")?;
                    written = 0;
                }
            }
            into.connection().execute_batch("COMMIT")?;
            if age == RowAge::Current {
                rows.damaged += scan.tally().rows_lost;
            }
        }
        match rows.count {
            0 if scan.has_header() => Err(SalvageError::Lost("every row".to_owned())),
            0 => Err(DocumentError::NoPainting.into()),
            _ => Ok(rows),
        }
    }

    /// Handles a row; returns the number of rows written to the new painting.
    fn take(&mut self, row: Row, age: RowAge, into: &Database) -> Result<u64, DocumentError> {
        let is_current = age == RowAge::Current;
        let row = match PaintingRow::read(row) {
            RowKind::Intact(row) => row,
            RowKind::Schema => return Ok(0),
            RowKind::Damaged(what) => {
                self.damaged += u64::from(is_current);
                if let (Some((Table::Step, id)), true) = (what, is_current) {
                    self.damaged_steps.insert(id);
                }
                return Ok(0);
            }
        };
        self.count += 1;
        let key = row.int(0);
        match row.table {
            Table::Page if is_current => return put_page(&row, into),
            Table::Page | Table::Load | Table::File => return put_new(&row, into),
            Table::State => self.state(&row, age),
            Table::Dry => {
                let layer = [row.int(1), row.int(2), row.int(3)];
                self.dry.entry(key).or_insert(layer);
            }
            Table::Tile => {
                let rows = self.tiles.entry(key).or_default();
                let tile = [row.int(1), row.int(2), row.int(3)];
                let newest = rows.current.is_none_or(|[version, ..]| version < tile[0]);
                if is_current && newest {
                    rows.older.extend(rows.current.replace(tile))
                } else {
                    rows.older.push(tile)
                }
            }
            Table::Step if is_current || self.damaged_steps.contains(&key) => {
                self.steps.entry(key).or_default().push(row);
            }
            Table::Version => {
                let name = row.text(0).to_owned();
                self.versions.entry(name).or_insert((row, age));
            }
            Table::Journal => {
                self.journal.entry(key).or_insert(row);
            }
            // Deleted steps must not return, displayed tiles are drawn again, and a new record begins.
            Table::Step | Table::Shown | Table::Beginning | Table::Record => {}
        }
        Ok(0)
    }

    fn state(&mut self, row: &PaintingRow, age: RowAge) {
        match row.text(0).trim_end_matches(COPY) {
            "painting" => {
                let number =
                    |state: &PaintingSnapshot| (state.versions, state.next_page, state.step);
                put_newest(&mut self.painting, row.text(1), age, number);
            }
            "sequencer" => {
                let number = |state: &SequencerSnapshot| (state.serial, state.next, 0);
                put_newest(&mut self.sequencer, row.text(1), age, number);
            }
            _ => {}
        }
    }
}

/// Replaces an older state; a current one is replaced only by a current one.
fn put_newest<T: serde::de::DeserializeOwned>(
    place: &mut Option<(T, RowAge)>,
    json: &str,
    age: RowAge,
    number: impl Fn(&T) -> (u64, u64, u64),
) {
    let Ok(state) = serde_json::from_str::<T>(json) else {
        return;
    };
    let stays = place.as_ref().is_some_and(|(other, age_of_other)| {
        (age == RowAge::Older && *age_of_other == RowAge::Current)
            || number(other) >= number(&state)
    });
    if !stays {
        *place = Some((state, age));
    }
}

/// Writes a page. Of two with the same number, if free pages count as current, the one with the shorter chain is newer:
/// its former base was deleted.
fn put_page(row: &PaintingRow, into: &Database) -> Result<u64, DocumentError> {
    let depth: Option<i64> = into
        .connection()
        .prepare_cached("SELECT depth FROM page WHERE id = ?1")?
        .query_row(params![row.int(0)], |row| row.get(0))
        .optional()?;
    let is_newer = depth.is_none_or(|depth| row.int(2) < depth);
    if is_newer {
        row.write(into)?;
    }
    Ok(u64::from(is_newer))
}

/// Writes a row unless there is one with its key; returns the number written.
fn put_new(row: &PaintingRow, into: &Database) -> Result<u64, DocumentError> {
    let connection = into.connection();
    let is_there = match row.table {
        Table::File => connection
            .prepare_cached("SELECT 1 FROM file WHERE hash = ?1")?
            .exists(params![row.text(0)])?,
        table => connection
            .prepare_cached(&format!("SELECT 1 FROM {} WHERE id = ?1", table.name()))?
            .exists(params![row.int(0)])?,
    };
    if !is_there {
        row.write(into)?;
    }
    Ok(u64::from(!is_there))
}
