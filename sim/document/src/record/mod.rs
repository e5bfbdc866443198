//! The record of a painting: all messages accepted since its beginning, for replay.
//!
//! The entries that a checkpoint includes move from the journal to the record in the transaction that writes it.
//! Opening reads the journal and the beginning, and none of the record's messages, so a long record costs no time; a
//! replay reads it row by row.

pub(crate) mod beginning;
mod byte_transpose;
mod columns;
mod rewind;

use std::path::Path;

use maulstick_painting::RecordChange;
use maulstick_painting::sequencer::Record;
use rusqlite::{OptionalExtension as _, Row, params};

use crate::checkpoint::{Checkpoint, wall_ms};
use crate::error::DocumentError;
use crate::file::database::{Access, Database};
use crate::journal;
use crate::tables::checksum::record_checksum;
use crate::tables::schema::has_record;
use crate::writing::Writer;

pub use rewind::rewind;

/// zstd level of a row: a second of painting is some hundred kB, which takes a few ms.
const LEVEL: i32 = 6;
/// Size of a row before compression above which another begins, bytes.
const ROW_BYTES: usize = 4 << 20;

/// Messages that were accepted one after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordRow {
    /// Wall-clock time of writing, ms since 1970; `None` if they are in the journal alone.
    pub time_ms: Option<u64>,
    /// Messages in order.
    pub records: Vec<Record>,
}

/// Size and age of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RecordStats {
    /// Size of its rows, bytes.
    pub bytes: u64,
    /// Time of its beginning, ms since 1970.
    pub begun_ms: u64,
    /// Time of its newest row, ms since 1970.
    pub newest_ms: u64,
}

/// Advances the record to a checkpoint: `records` are the messages before it that are not in the journal. Messages
/// included in the checkpoint leave the journal.
///
/// # Errors
/// The error of SQLite or the compressor.
pub(crate) fn advance(
    writer: &mut Writer<'_, '_>,
    checkpoint: &Checkpoint,
    records: &[Record],
) -> Result<(), DocumentError> {
    let (database, serial) = (writer.database, checkpoint.sequencer.serial);
    match &checkpoint.record {
        RecordChange::Continues => append(database, serial, records)?,
        RecordChange::Begins(beginning) => {
            clear(database)?;
            beginning::write(writer, beginning)?;
        }
        RecordChange::Ends => clear(database)?,
    }
    database.connection.execute(
        "DELETE FROM journal WHERE last < ?1",
        params![serial as i64],
    )?;
    Ok(())
}

/// Size of the record after a checkpoint, bytes; `u64::MAX` where it was lost, so that a new one begins.
pub(crate) fn bytes_after(database: &Database, change: &RecordChange) -> u64 {
    let query = "SELECT EXISTS (SELECT 1 FROM beginning)";
    let begun = database.connection.query_row(query, [], |row| row.get(0));
    match (change, begun) {
        (RecordChange::Continues, Ok(false)) => u64::MAX,
        _ => bytes(database).unwrap_or_default(),
    }
}

/// Discards the record of a closed painting, and its displayed tiles: the next program that opens it begins another
/// record, and draws the tiles again.
///
/// # Errors
/// Any [`DocumentError`].
pub fn discard(path: &Path) -> Result<(), DocumentError> {
    let (database, _) = Database::open(path, Access::Paint, None)?;
    clear(&database)?;
    database
        .connection
        .execute_batch("DELETE FROM shown; VACUUM")?;
    database.close()
}

fn clear(database: &Database) -> Result<(), DocumentError> {
    let query = "DELETE FROM beginning; DELETE FROM record";
    Ok(database.connection.execute_batch(query)?)
}

/// Adds the rows of the journal before `serial`, and then `records`.
fn append(database: &Database, serial: u64, records: &[Record]) -> Result<(), DocumentError> {
    let mut open = OpenRow::new(database)?;
    let mut is_intact = true;
    journal::each_row(database, 0..serial, |row| {
        is_intact = row.is_intact;
        if is_intact {
            open.add(row.ends, &journal::unpacked(&row.data)?)?;
        }
        Ok(is_intact)
    })?;
    if !is_intact {
        // The painting is at a later state, so only its record is lost.
        tracing::warn!("a row of the journal is damaged: a new record begins");
        return clear(database);
    }
    for records in records.chunks(journal::ROW_RECORDS) {
        if let (Some(first), Some(last)) = (records.first(), records.last()) {
            open.add([first.serial, last.serial], &journal::encoded(records)?)?;
        }
    }
    open.end()
}

/// Row under construction.
struct OpenRow<'a> {
    database: &'a Database,
    ends: [u64; 2],
    data: Vec<u8>,
    /// Bytes of the record so far.
    bytes: u64,
}

impl<'a> OpenRow<'a> {
    fn new(database: &'a Database) -> Result<Self, DocumentError> {
        Ok(Self {
            database,
            ends: [0; 2],
            data: Vec::new(),
            bytes: bytes(database)?,
        })
    }

    /// Adds messages from one serial number to another.
    fn add(&mut self, [first, last]: [u64; 2], data: &[u8]) -> Result<(), DocumentError> {
        if self.data.len() > ROW_BYTES || first != self.ends[1] + 1 {
            self.end()?;
        }
        if self.data.is_empty() {
            self.ends[0] = first;
        }
        self.ends[1] = last;
        self.data.extend_from_slice(data);
        Ok(())
    }

    /// Writes the row, unless it is empty.
    fn end(&mut self) -> Result<(), DocumentError> {
        if self.data.is_empty() {
            return Ok(());
        }
        let data = zstd::bulk::compress(&columns::columns(&self.data)?, LEVEL)?;
        self.data.clear();
        self.bytes += data.len() as u64;
        let [first, last] = self.ends;
        let ints = [first, last, wall_ms(), self.bytes].map(|number| number as i64);
        let sum = record_checksum(ints, &data);
        let [first, last, time, bytes] = ints;
        self.database
            .connection
            .prepare_cached("INSERT OR REPLACE INTO record VALUES(12, ?1, ?2, ?3, ?4, ?5, ?6)")?
            .execute(params![first, last, time, bytes, data, sum])?;
        Ok(())
    }
}

/// Bytes of the rows of a record.
///
/// # Errors
/// The error of SQLite.
pub(crate) fn bytes(database: &Database) -> Result<u64, DocumentError> {
    Ok(newest(database)?.map_or(0, |[_, bytes]| bytes))
}

/// Time of the newest row, ms since 1970, and bytes of all rows up to it.
fn newest(database: &Database) -> Result<Option<[u64; 2]>, DocumentError> {
    if !has_record(&database.connection)? {
        return Ok(None);
    }
    let query = "SELECT time, bytes FROM record ORDER BY id DESC LIMIT 1";
    let numbers = |row: &Row<'_>| Ok([row.get::<_, i64>(0)?, row.get(1)?]);
    let found = database
        .connection
        .query_row(query, params![], numbers)
        .optional()?;
    Ok(found.map(|numbers| numbers.map(|number| number as u64)))
}

impl RecordStats {
    /// Size and age of a record, if there is one.
    pub(crate) fn read(database: &Database) -> Result<Option<Self>, DocumentError> {
        let Some(begun_ms) = beginning::time_ms(database)? else {
            return Ok(None);
        };
        let [newest_ms, bytes] = newest(database)?.unwrap_or([begun_ms, 0]);
        Ok(Some(Self {
            bytes,
            begun_ms,
            newest_ms,
        }))
    }
}

/// Checks that every row of a record is intact.
///
/// # Errors
/// [`DocumentError::Damaged`] with the first that is not.
pub(crate) fn check(database: &Database) -> Result<(), DocumentError> {
    if !has_record(&database.connection)? {
        return Ok(());
    }
    beginning::check(database)?;
    let query = "SELECT id, last, time, data, sum, bytes FROM record ORDER BY id";
    let mut statement = database.connection.prepare(query)?;
    let mut rows = statement.query(params![])?;
    while let Some(row) = rows.next()? {
        let ints = [row.get(0)?, row.get(1)?, row.get(2)?, row.get(5)?];
        let data: Vec<u8> = row.get(3)?;
        checked(record_checksum(ints, &data), row.get(4)?)?;
    }
    Ok(())
}

fn checked(expected: i64, sum: i64) -> Result<(), DocumentError> {
    if expected == sum {
        Ok(())
    } else {
        Err(damaged("does not match its checksum"))
    }
}

fn damaged(what: &str) -> DocumentError {
    DocumentError::Damaged(format!("the record of what was painted {what}"))
}

/// Messages from one serial number on, up to the end of a row; `None` if there are none.
///
/// # Errors
/// [`DocumentError::Damaged`] if they are not intact, or earlier ones are missing.
pub(crate) fn row_from(
    database: &Database,
    serial: u64,
) -> Result<Option<RecordRow>, DocumentError> {
    let connection = &database.connection;
    let mut found = None;
    if has_record(connection)? {
        let query = "SELECT id, last, time, bytes, data, sum FROM record \
             WHERE id >= coalesce((SELECT max(id) FROM record WHERE id <= ?1), 0) AND last >= ?1 \
             ORDER BY id LIMIT 1";
        let read = |row: &Row<'_>| {
            let ints: [i64; 4] = [row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?];
            Ok((ints, row.get::<_, Vec<u8>>(4)?, row.get(5)?))
        };
        let row = connection
            .prepare_cached(query)?
            .query_row(params![serial as i64], read)
            .optional()?;
        if let Some((ints, data, sum)) = row {
            checked(record_checksum(ints, &data), sum)?;
            let row = journal::unpacked(&data)?;
            let messages = match columns::in_order(&row)? {
                Some(messages) => messages,
                None => byte_transpose::in_order(&row)?,
            };
            found = Some((ints[0] as u64, Some(ints[2] as u64), messages));
        }
    }
    if found.is_none() {
        journal::each_row(database, serial..u64::MAX, |row| {
            if !row.is_intact {
                return Err(damaged("does not match its checksum"));
            }
            found = Some((row.ends[0], None, journal::unpacked(&row.data)?));
            Ok(false)
        })?;
    }
    let Some((first, time_ms, messages)) = found else {
        return Ok(None);
    };
    let mut records = journal::decoded(first, &messages)?;
    records.retain(|record| record.serial >= serial);
    match records.first() {
        Some(first) if first.serial == serial => Ok(Some(RecordRow { time_ms, records })),
        _ => Err(damaged("has a gap")),
    }
}
