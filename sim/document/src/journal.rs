//! Accepted things as bytes: messages as on the bus, each with its index and its length before it.

use maulstick_paint::sequencer::{Accepted, Record};
use maulstick_types::brush::{BrushDef, BrushState};
use maulstick_types::paint::JournalEntry;
use maulstick_types::{Flags, Header, Message, Origin, decode, encode, name_hash};

use crate::error::DocumentError;

/// A row's data has at most this many bytes.
const MOST: usize = 1 << 28;
/// Who writes what no brush has sent.
const ME: Origin = Origin {
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
            encode(&ME, Flags::NONE, record.serial, 0, 0, &entry)
        }
        Accepted::Brush { brush, toml } => {
            let def = BrushDef {
                brush: brush.clone(),
                toml: toml.clone(),
                hash: name_hash(toml),
            };
            encode(&ME, Flags::NONE, record.serial, 0, 0, &def)
        }
    };
    bytes.map_err(damaged)
}

/// Records, in order, as bytes.
///
/// # Errors
/// What the codec or the compressor says.
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

/// Reads records; the first has the serial number `first`.
///
/// # Errors
/// [`DocumentError::Damaged`].
pub fn read(first: u64, bytes: &[u8]) -> Result<Vec<Record>, DocumentError> {
    let bytes = zstd::stream::decode_all(bytes).map_err(damaged)?;
    if bytes.len() > MOST {
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
    if header.schema == BrushDef::schema().hash {
        let (_, def) = decode::<BrushDef>(message).map_err(damaged)?;
        return Ok(Accepted::Brush {
            brush: def.brush,
            toml: def.toml,
        });
    }
    let (_, entry) = decode::<JournalEntry>(message).map_err(damaged)?;
    Ok(Accepted::Entry(entry.entry))
}
