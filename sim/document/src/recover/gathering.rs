//! All intact rows of a damaged painting: pages, loads and files go into the new one at once, the others are few and
//! stay in memory.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;

use maulstick_painting::snapshot::{PaintingSnapshot, SequencerSnapshot};
use rusqlite::{OptionalExtension as _, params};

use super::found::{Found, Read};
use crate::database::Database;
use crate::error::DocumentError;
use crate::scan::{Row, Scan};
use crate::schema::Table;
use crate::writing::COPY;

/// Rows that are written in one transaction.
const BATCH: u64 = 512;

/// Standing of the copy that a row comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Standing {
    /// In the copy that SQLite reads.
    Current,
    /// On a page that was free, or in an older copy of one.
    Older,
}

/// A tile's row: version, page, dry layer.
pub(super) type TileRow = [i64; 3];

/// The rows of one place.
#[derive(Debug, Default)]
pub(super) struct TileRows {
    pub(super) current: Option<TileRow>,
    pub(super) older: Vec<TileRow>,
}

/// Rows found.
#[derive(Debug, Default)]
pub(super) struct Gathered {
    pub(super) painting: Option<(PaintingSnapshot, Standing)>,
    pub(super) sequencer: Option<(SequencerSnapshot, Standing)>,
    /// Dry layers by number: layer below, layer's number in the painting, page.
    pub(super) dry: BTreeMap<i64, [i64; 3]>,
    /// Tiles by place number.
    pub(super) tiles: BTreeMap<i64, TileRows>,
    /// Rows of each step.
    pub(super) steps: BTreeMap<i64, Vec<Found>>,
    pub(super) versions: BTreeMap<String, (Found, Standing)>,
    /// Rows of the journal by their first serial number.
    pub(super) journal: BTreeMap<i64, Found>,
    /// Current rows that are not what was written.
    pub(super) torn: u64,
    /// Pages of tables that are gone, with all rows that they had.
    pub(super) pages_lost: u64,
    /// True if rows on free pages are known to be such.
    pub(super) knows_free: bool,
    /// Steps whose current row is torn.
    pub(super) torn_steps: BTreeSet<i64>,
    /// Rows of any kind.
    found: u64,
}

impl Gathered {
    /// Reads all rows; those of pages, loads and files go into `into`.
    ///
    /// # Errors
    /// The error of SQLite on the new painting. Damage is no error.
    pub(super) fn read(
        scan: &mut Scan<File>,
        into: &Database,
        tell: &mut dyn FnMut(u64, u64),
    ) -> Result<Self, DocumentError> {
        let mut gathered = Self {
            pages_lost: scan.lost_pages(),
            knows_free: scan.knows_free(),
            ..Self::default()
        };
        let pages = u64::from(scan.pages());
        for standing in [Standing::Current, Standing::Older] {
            let before = pages * u64::from(standing == Standing::Older);
            let (mut written, mut told) = (0, 0);
            into.connection.execute_batch("BEGIN IMMEDIATE")?;
            let of = |row: &Row| row.current == (standing == Standing::Current);
            for row in scan.rows().filter(of) {
                if row.page != told {
                    told = row.page;
                    tell(before + u64::from(told), 2 * pages);
                }
                written += gathered.take(row, standing, into)?;
                if written >= BATCH {
                    into.connection.execute_batch("COMMIT; BEGIN IMMEDIATE")?;
                    written = 0;
                }
            }
            into.connection.execute_batch("COMMIT")?;
            if standing == Standing::Current {
                gathered.torn += scan.tally().rows_lost;
            }
        }
        match gathered.found {
            0 if scan.has_header() => Err(DocumentError::Lost("every row".to_owned())),
            0 => Err(DocumentError::NoPainting),
            _ => Ok(gathered),
        }
    }

    /// Takes a row; returns how many were written for it.
    fn take(
        &mut self,
        row: Row,
        standing: Standing,
        into: &Database,
    ) -> Result<u64, DocumentError> {
        let is_current = standing == Standing::Current;
        let found = match Found::read(row) {
            Read::Whole(found) => found,
            Read::Schema => return Ok(0),
            Read::Torn(what) => {
                self.torn += u64::from(is_current);
                if let (Some((Table::Step, id)), true) = (what, is_current) {
                    self.torn_steps.insert(id);
                }
                return Ok(0);
            }
        };
        self.found += 1;
        let key = found.int(0);
        match found.table {
            Table::Page if is_current => return put_page(&found, into),
            Table::Page | Table::Load | Table::File => return put_new(&found, into),
            Table::State => self.state(&found, standing),
            Table::Dry => {
                let row = [found.int(1), found.int(2), found.int(3)];
                self.dry.entry(key).or_insert(row);
            }
            Table::Tile => {
                let rows = self.tiles.entry(key).or_default();
                let row = [found.int(1), found.int(2), found.int(3)];
                let newest = rows.current.is_none_or(|[version, ..]| version < row[0]);
                match is_current && newest {
                    true => rows.older.extend(rows.current.replace(row)),
                    false => rows.older.push(row),
                }
            }
            Table::Step if is_current || self.torn_steps.contains(&key) => {
                self.steps.entry(key).or_default().push(found);
            }
            Table::Version => {
                let name = found.text(0).to_owned();
                self.versions.entry(name).or_insert((found, standing));
            }
            Table::Journal => {
                self.journal.entry(key).or_insert(found);
            }
            // Deleted steps are not to come back, and shown tiles are soon made again.
            Table::Step | Table::Shown => {}
        }
        Ok(0)
    }

    fn state(&mut self, found: &Found, standing: Standing) {
        match found.text(0).trim_end_matches(COPY) {
            "painting" => {
                let state = |kept: &PaintingSnapshot| (kept.versions, kept.next_page, kept.step);
                newest(&mut self.painting, found.text(1), standing, state);
            }
            "sequencer" => {
                let state = |kept: &SequencerSnapshot| (kept.serial, kept.next, 0);
                newest(&mut self.sequencer, found.text(1), standing, state);
            }
            _ => {}
        }
    }
}

/// Replaces an older state by this one; a current one is replaced only by a current one.
fn newest<T: serde::de::DeserializeOwned>(
    place: &mut Option<(T, Standing)>,
    json: &str,
    standing: Standing,
    age: impl Fn(&T) -> (u64, u64, u64),
) {
    let Ok(state) = serde_json::from_str::<T>(json) else {
        return;
    };
    let goes = place.as_ref().is_some_and(|(there, of_there)| {
        (standing == Standing::Older && *of_there == Standing::Current) || age(there) >= age(&state)
    });
    if !goes {
        *place = Some((state, standing));
    }
}

/// Writes a page. Of two, where free pages pass for current ones, that with the shorter chain below it
/// is the newer: what it was a difference to was deleted.
fn put_page(found: &Found, into: &Database) -> Result<u64, DocumentError> {
    let depth: Option<i64> = into
        .connection
        .prepare_cached("SELECT depth FROM page WHERE id = ?1")?
        .query_row(params![found.int(0)], |row| row.get(0))
        .optional()?;
    let is_newer = depth.is_none_or(|depth| found.int(2) < depth);
    if is_newer {
        found.write(into)?;
    }
    Ok(u64::from(is_newer))
}

/// Writes a row unless there is one with its key; returns the number written.
fn put_new(found: &Found, into: &Database) -> Result<u64, DocumentError> {
    let connection = &into.connection;
    let is_there = match found.table {
        Table::File => connection
            .prepare_cached("SELECT 1 FROM file WHERE hash = ?1")?
            .exists(params![found.text(0)])?,
        table => connection
            .prepare_cached(&format!("SELECT 1 FROM {} WHERE id = ?1", table.name()))?
            .exists(params![found.int(0)])?,
    };
    if !is_there {
        found.write(into)?;
    }
    Ok(u64::from(!is_there))
}
