//! Accepted records as bytes: messages as on the bus, each preceded by its index and its length.

use std::io::Read as _;

use maulstick_painting::sequencer::{Accepted, NO_ZOOM, Record};
use maulstick_types::brush::{BrushDef, BrushState};
use maulstick_types::older::BrushStateV1;
use maulstick_types::paint::JournalEntry;
use maulstick_types::{Flags, HEADER_BYTES, Header, Message, Origin, decode, encode, name_hash};

use rusqlite::params;

use crate::error::DocumentError;
use crate::file::database::Database;
use crate::tables::checksum::journal_checksum;

/// Largest size of a row's data, bytes.
const ROW_MAX: usize = 1 << 28;
/// Origin of records that did not come from a brush.
const NO_ORIGIN: Origin = Origin {
    source: 0,
    epoch: 0,
};

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
        Accepted::Brush { brush, toml } => {
            let def = BrushDef {
                brush: brush.clone(),
                toml: toml.clone(),
                hash: name_hash(toml),
            };
            encode(&NO_ORIGIN, Flags::NONE, record.serial, 0, 0, &def)
        }
    };
    bytes.map_err(damaged)
}

/// Records, in order, as bytes.
///
/// # Errors
/// The error of the codec or the compressor.
pub fn write(records: &[Record]) -> Result<Vec<u8>, DocumentError> {
    let mut bytes = Vec::new();
    for record in records {
        let message = message(record)?;
        bytes.extend(record.index.to_le_bytes());
        bytes.extend((message.len() as u32).to_le_bytes());
        bytes.extend(message);
    }
    Ok(zstd::bulk::compress(&bytes, 1)?)
}

/// Writes records, of which there is at least one, as a row of the journal.
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
    let mut packed = zstd::stream::read::Decoder::new(bytes)?.take(ROW_MAX as u64 + 1);
    let mut bytes = Vec::new();
    packed.read_to_end(&mut bytes).map_err(damaged)?;
    if bytes.len() > ROW_MAX {
        return Err(damaged("a row is too long"));
    }
    let (mut records, mut rest) = (Vec::new(), bytes.as_slice());
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
    if header.schema == BrushStateV1::SCHEMA {
        let state = BrushStateV1::decode_body(&message[HEADER_BYTES..]).map_err(damaged)?;
        let state = state.at_zoom(NO_ZOOM);
        return Ok(Accepted::State { header, state });
    }
    if header.schema == BrushDef::schema().hash {
        let (_, def) = decode::<BrushDef>(message).map_err(damaged)?;
        return Ok(Accepted::Brush {
            brush: def.brush,
            toml: def.toml,
        });
    }
    if JournalEntry::OLDER.contains(&header.schema) {
        let entry = JournalEntry::decode_body(&message[HEADER_BYTES..]).map_err(damaged)?;
        return Ok(Accepted::Entry(entry.entry));
    }
    let (_, entry) = decode::<JournalEntry>(message).map_err(damaged)?;
    Ok(Accepted::Entry(entry.entry))
}

#[cfg(test)]
mod tests {
    use maulstick_types::command::Command;
    use maulstick_types::paint::Entry;

    use super::*;

    #[test]
    fn entries_of_an_older_version_are_read_and_unknown_ones_refused() {
        let entry = Entry::Command {
            client: 1,
            number: 2,
            command: Command::Undo { brush: None },
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
        let bytes = zstd::bulk::decompress(&written, ROW_MAX).expect("whole");
        let of_schema = |hash: u32| {
            let mut bytes = bytes.clone();
            // Index and length lie before the header, magic and version before its schema.
            bytes[16..20].copy_from_slice(&hash.to_le_bytes());
            zstd::bulk::compress(&bytes, 1).expect("packed")
        };
        for hash in JournalEntry::OLDER {
            assert_ne!(hash, JournalEntry::schema().hash, "that is this version's");
            let older = read(5, &of_schema(hash)).expect("read");
            assert_eq!(older, std::slice::from_ref(&record));
        }
        assert!(read(5, &of_schema(0x1234_5678)).is_err());
    }

    /// A state of the first version as `msgs/types/tests/golden.txt` had it, and one of today without its zoom.
    #[test]
    fn a_state_that_says_no_zoom_is_read_and_says_so() {
        let old = concat!(
            "4c4d0100974bf75d040302010807060503000000880000000b000000000000000c000000000000000d0000000000",
            "00000100000002000000030000000000000001000000000000000400000000000000050000000000000000000000",
            "010000009a9999999999b93f9a9999999999c9bf333333333333d33f0000000000000000333333333333e33f0000",
            "0000000000009a9999999999e93f01000000000000000000003f000000bf0100000000000000000003000000803e",
        );
        let byte = |at: usize| u8::from_str_radix(&old[2 * at..2 * at + 2], 16).expect("hex");
        let message: Vec<u8> = (0..old.len() / 2).map(byte).collect();
        let Accepted::State { header, state } = accepted(&message).expect("read") else {
            panic!("no state");
        };
        assert_eq!(
            (header.seq, state.device_seq, state.solves.len()),
            (11, 3, 1)
        );
        let solve = &state.solves[0];
        assert_eq!((solve.zoom, solve.contacts.len()), (NO_ZOOM, 1));
        assert!(accepted(&message[..message.len() - 1]).is_err());
    }
}
