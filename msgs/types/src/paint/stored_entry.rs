//! Journal entries of files, also those of earlier versions, by the field tables that these had.

use std::sync::LazyLock;

use super::JournalEntry;
use crate::wire::codec::{Message as _, decode, decode_limited};
use crate::wire::field_table::{FieldTable, TableError};
use crate::wire::header::{DecodeError, HEADER_BYTES, Header};

/// Largest translated body, bytes: a number takes up to six times as much as text, and so does a control character.
const TRANSLATED_MAX: usize = 8 * JournalEntry::MAX_BYTES;

/// The table of the present version.
static PRESENT: LazyLock<Result<FieldTable, TableError>> =
    LazyLock::new(|| FieldTable::of(JournalEntry::schema()));

/// Tables of version 12, whose edits are an enum, and of version 11, whose decisions are words as well.
static EARLIER: LazyLock<[Result<FieldTable, TableError>; 2]> = LazyLock::new(|| {
    [
        &include_bytes!("journal_12.json")[..],
        include_bytes!("journal_11.json"),
    ]
    .map(FieldTable::parse)
});

impl JournalEntry {
    /// Hashes of the schemas that [`decode_stored`](Self::decode_stored) reads, its own first.
    #[must_use]
    pub fn stored_hashes() -> Vec<u32> {
        let earlier = EARLIER.iter().flatten().map(FieldTable::hash);
        std::iter::once(Self::schema().hash)
            .chain(earlier)
            .collect()
    }

    /// Decodes an entry of a file, which may be of an earlier version.
    ///
    /// # Errors
    /// As [`decode`].
    pub fn decode_stored(bytes: &[u8]) -> Result<(Header, Self), DecodeError> {
        let header = Header::from_bytes(bytes)?;
        let mut earlier = EARLIER.iter().flatten();
        let Some(table) = earlier.find(|table| table.hash() == header.schema) else {
            return decode(bytes);
        };
        let body =
            translated(table, &bytes[HEADER_BYTES..]).map_err(|error| DecodeError::Body {
                name: Self::NAME,
                reason: error.to_string(),
            })?;
        let entry = decode_limited::<Self, TRANSLATED_MAX>(Self::NAME, &body)?;
        Ok((header, entry))
    }
}

fn translated(table: &FieldTable, body: &[u8]) -> Result<Vec<u8>, TableError> {
    let value = table.decode(body)?;
    let present = PRESENT.as_ref().map_err(Clone::clone)?;
    present.encode(&value)
}
