//! Accepted records as bytes: messages as on the bus, each preceded by its index and its length.

use std::io::Read as _;
use std::ops::Range;

use maulstick_painting::edits;
use maulstick_painting::sequencer::{Accepted, Record};
use maulstick_types::brush::BrushState;
use maulstick_types::command::Command;
use maulstick_types::paint::{Entry, JournalEntry};
use maulstick_types::{Flags, Header, Message, Origin, decode, encode};

use rusqlite::params;

use crate::error::DocumentError;
use crate::file::database::Database;
use crate::tables::checksum::journal_checksum;

/// Greatest number of records in a row: many wait where the disk was full.
pub(crate) const ROW_RECORDS: usize = 64;
/// Largest size of a row's data, bytes: that of [`ROW_RECORDS`] of the longest records behind a row of the record, and of the 1024
/// longest states that earlier versions wrote in one.
const ROW_MAX: usize = 5 << 24;
const _: () = assert!(ROW_MAX > (ROW_RECORDS + 5) * (JournalEntry::MAX_BYTES + 64));
/// Origin of records that did not come from a brush.
const NO_ORIGIN: Origin = Origin {
    source: 0,
    epoch: 0,
};

/// A row of the journal.
pub(crate) struct JournalRow {
    /// Serial numbers of its first and last record.
    pub(crate) ends: [u64; 2],
    /// Compressed records.
    pub(crate) data: Vec<u8>,
    /// True if the records match their checksum.
    pub(crate) is_intact: bool,
}

/// Reads the rows whose last records have serial numbers in a range, in order, until `each` says false.
///
/// # Errors
/// The error of SQLite; that of `each`.
pub(crate) fn each_row(
    database: &Database,
    last: Range<u64>,
    mut each: impl FnMut(JournalRow) -> Result<bool, DocumentError>,
) -> Result<(), DocumentError> {
    let query =
        "SELECT id, last, data, sum FROM journal WHERE last >= ?1 AND last < ?2 ORDER BY id";
    let mut statement = database.connection.prepare_cached(query)?;
    let bounds = [last.start, last.end].map(|bound| i64::try_from(bound).unwrap_or(i64::MAX));
    let mut rows = statement.query(bounds)?;
    while let Some(row) = rows.next()? {
        let ends = [row.get::<_, i64>(0)?, row.get(1)?].map(|end| end as u64);
        let data: Vec<u8> = row.get(2)?;
        let is_intact = journal_checksum(ends, &data) == row.get::<_, i64>(3)?;
        let row = JournalRow {
            ends,
            data,
            is_intact,
        };
        if !each(row)? {
            break;
        }
    }
    Ok(())
}

fn damaged(what: impl ToString) -> DocumentError {
    DocumentError::Damaged(format!("its journal: {}", what.to_string()))
}

fn message(record: &Record) -> Result<Vec<u8>, DocumentError> {
    let bytes = match &record.what {
        Accepted::State { header, state } => encode(
            &header.origin(),
            header.flags,
            header.seq,
            header.event_ns,
            header.sent_ns,
            state,
        ),
        Accepted::Entry(entry) => {
            let entry = JournalEntry {
                index: record.index,
                entry: entry.clone(),
            };
            encode(&NO_ORIGIN, Flags::NONE, record.serial, 0, 0, &entry)
        }
    };
    // The sequencer rejects records that are too long.
    bytes.map_err(|error| DocumentError::Other(error.to_string()))
}

/// Records, in order, as bytes.
///
/// # Errors
/// The error of the codec or the compressor.
pub fn write(records: &[Record]) -> Result<Vec<u8>, DocumentError> {
    Ok(zstd::bulk::compress(&encoded(records)?, 1)?)
}

/// Records, in order, as bytes that are not compressed.
pub(crate) fn encoded(records: &[Record]) -> Result<Vec<u8>, DocumentError> {
    let mut bytes = Vec::new();
    for record in records {
        let message = message(record)?;
        bytes.extend(record.index.to_le_bytes());
        bytes.extend((message.len() as u32).to_le_bytes());
        bytes.extend(message);
    }
    Ok(bytes)
}

/// Writes at least one record as a row of the journal.
pub(crate) fn put(database: &Database, records: &[Record]) -> Result<(), DocumentError> {
    let (Some(first), Some(last)) = (records.first(), records.last()) else {
        return Ok(());
    };
    let data = write(records)?;
    let ends = [first.serial, last.serial];
    let sum = journal_checksum(ends, &data);
    let [first, last] = ends.map(|serial| serial as i64);
    database
        .connection
        .prepare_cached("INSERT OR REPLACE INTO journal VALUES(9, ?1, ?2, ?3, ?4)")?
        .execute(params![first, last, data, sum])?;
    Ok(())
}

/// Reads records; the first has the serial number `first`.
///
/// # Errors
/// [`DocumentError::Damaged`].
pub fn read(first: u64, bytes: &[u8]) -> Result<Vec<Record>, DocumentError> {
    decoded(first, &unpacked(bytes)?)
}

/// Bytes of a row before compression.
pub(crate) fn unpacked(bytes: &[u8]) -> Result<Vec<u8>, DocumentError> {
    let mut packed = zstd::stream::read::Decoder::new(bytes)?.take(ROW_MAX as u64 + 1);
    let mut bytes = Vec::new();
    packed.read_to_end(&mut bytes).map_err(damaged)?;
    if bytes.len() > ROW_MAX {
        return Err(damaged("a row is too long"));
    }
    Ok(bytes)
}

/// Reads records of [`encoded`]; the first has the serial number `first`.
pub(crate) fn decoded(first: u64, bytes: &[u8]) -> Result<Vec<Record>, DocumentError> {
    let (mut records, mut rest) = (Vec::new(), bytes);
    while !rest.is_empty() {
        let (index, after) = rest
            .split_first_chunk::<8>()
            .ok_or_else(|| damaged("torn"))?;
        let (length, after) = after
            .split_first_chunk::<4>()
            .ok_or_else(|| damaged("torn"))?;
        let length = u32::from_le_bytes(*length) as usize;
        let (message, after) = after
            .split_at_checked(length)
            .ok_or_else(|| damaged("torn"))?;
        rest = after;
        records.push(Record {
            serial: first + records.len() as u64,
            index: u64::from_le_bytes(*index),
            what: accepted(message)?,
        });
    }
    Ok(records)
}

fn accepted(message: &[u8]) -> Result<Accepted, DocumentError> {
    let header = Header::from_bytes(message).map_err(damaged)?;
    if header.schema == BrushState::schema().hash {
        let (header, state) = decode::<BrushState>(message).map_err(damaged)?;
        return Ok(Accepted::State { header, state });
    }
    let (_, entry) = JournalEntry::decode_stored(message).map_err(damaged)?;
    if let Entry::Command { command, .. } = &entry.entry
        && let Command::Edit(edit) = command
    {
        edits::read(edit).map_err(damaged)?;
    }
    Ok(Accepted::Entry(entry.entry))
}

#[cfg(test)]
mod tests {
    use maulstick_painting::edits::Undo;
    use maulstick_types::Edit;
    use maulstick_types::paint::{Decision, Entry};

    use super::*;

    /// A decision in words, in version 11 of the entry.
    const WORDED: [u8; 79] = [
        0x4c, 0x4d, 0x0b, 0x00, 0xc8, 0x91, 0xb9, 0xa5, 0x04, 0x03, 0x02, 0x01, 0x08, 0x07, 0x06,
        0x05, 0x03, 0x00, 0x00, 0x00, 0x1f, 0x00, 0x00, 0x00, 0x0b, 0x00, 0x00, 0x00, 0x00, 0x00,
        0x00, 0x00, 0x0c, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x0d, 0x00, 0x00, 0x00, 0x00,
        0x00, 0x00, 0x00, 0x03, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x04, 0x00, 0x00, 0x00,
        0x0b, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x62, 0x61, 0x63, 0x6b, 0x65, 0x6e, 0x64,
        0x20, 0x63, 0x70, 0x75,
    ];

    #[test]
    fn an_entry_of_the_version_before_is_read() {
        let bytes = [
            &3u64.to_le_bytes()[..],
            &(WORDED.len() as u32).to_le_bytes(),
            &WORDED,
        ];
        let records = decoded(5, &bytes.concat()).expect("read");
        let name = "cpu".to_owned();
        let what = Decision::Backend { name };
        let decision = Accepted::Entry(Entry::Decision { what });
        assert_eq!(records.len(), 1);
        assert_eq!(records[0].what, decision);
    }

    #[test]
    fn entries_come_back_and_those_of_another_schema_are_rejected() {
        let entry = Entry::Command {
            client: 1,
            number: 2,
            command: Undo { brush: None }.into(),
        };
        let record = Record {
            serial: 5,
            index: 7,
            what: Accepted::Entry(entry),
        };
        let written = write(std::slice::from_ref(&record)).expect("written");
        assert_eq!(
            read(5, &written).expect("read"),
            std::slice::from_ref(&record)
        );
        let mut bytes = zstd::bulk::decompress(&written, ROW_MAX).expect("whole");
        // Index and length lie before the header, magic and version before its schema.
        bytes[16..20].copy_from_slice(&0x1234_5678u32.to_le_bytes());
        let other = zstd::bulk::compress(&bytes, 1).expect("packed");
        assert!(read(5, &other).is_err());
    }

    #[test]
    fn an_edit_of_a_newer_program_is_damage_as_an_unknown_entry_is() {
        for (name, is_known) in [("redo", true), ("varnish", false)] {
            let edit = Edit::named(name, &serde_json::json!({}));
            let record = Record {
                serial: 5,
                index: 7,
                what: Accepted::Entry(Entry::Command {
                    client: 1,
                    number: 2,
                    command: edit.into(),
                }),
            };
            let written = write(&[record]).expect("written");
            assert_eq!(read(5, &written).is_ok(), is_known, "{name}");
        }
    }
}
