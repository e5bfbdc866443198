//! Checksums of rows: CRC-32 of the columns' values after the tag, in order: integers as 8 bytes little endian, texts
//! and blobs as their bytes preceded by their length.

use super::schema::Table;

/// Checksum of a row, column by column.
#[derive(Clone, Debug)]
pub struct Checksum(crc32fast::Hasher);

impl Checksum {
    /// Checksum of a row of this table, without any column yet.
    #[must_use]
    pub fn new(table: Table) -> Self {
        let mut hasher = crc32fast::Hasher::new();
        hasher.update(&(table as i64).to_le_bytes());
        Self(hasher)
    }

    /// Checksum of a row of integers alone.
    #[must_use]
    pub fn of_ints(table: Table, ints: &[i64]) -> i64 {
        let row = ints.iter().copied();
        row.fold(Self::new(table), Self::int).finish()
    }

    /// Adds an integer.
    #[must_use]
    pub fn int(mut self, value: i64) -> Self {
        self.0.update(&value.to_le_bytes());
        self
    }

    /// Adds a text or a blob.
    #[must_use]
    pub fn bytes(mut self, value: &[u8]) -> Self {
        self.0.update(&(value.len() as u64).to_le_bytes());
        self.0.update(value);
        self
    }

    /// The checksum as the value of its column.
    #[must_use]
    pub fn finish(self) -> i64 {
        i64::from(self.0.finalize())
    }
}

/// Checksum of a page: `ints` are base, depth and slots.
pub(crate) fn page_checksum(id: u64, ints: [i64; 3], data: &[u8]) -> i64 {
    let sum = Checksum::new(Table::Page).int(id as i64);
    let sum = ints.into_iter().fold(sum, Checksum::int);
    sum.bytes(data).finish()
}

/// Checksum of the load of a brush.
pub(crate) fn load_checksum(id: u64, data: &[u8]) -> i64 {
    Checksum::new(Table::Load)
        .int(id as i64)
        .bytes(data)
        .finish()
}

/// Checksum of a tile as it is displayed.
pub(crate) fn shown_checksum(place: i64, version: i64, look: i64, data: &[u8]) -> i64 {
    let sum = Checksum::new(Table::Shown);
    let sum = [place, version, look].into_iter().fold(sum, Checksum::int);
    sum.bytes(data).finish()
}

/// Checksum of a row of the record: `ints` are the serial numbers of its first and last message, its time, and the
/// bytes of the record up to and with it.
pub(crate) fn record_checksum(ints: [i64; 4], data: &[u8]) -> i64 {
    let sum = ints
        .into_iter()
        .fold(Checksum::new(Table::Record), Checksum::int);
    sum.bytes(data).finish()
}

/// Checksum of a row of the journal: `ends` are the serial numbers of its first and last record.
pub(crate) fn journal_checksum(ends: [u64; 2], data: &[u8]) -> i64 {
    let sum = Checksum::new(Table::Journal);
    let sum = ends.into_iter().fold(sum, |sum, end| sum.int(end as i64));
    sum.bytes(data).finish()
}
