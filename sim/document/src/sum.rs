//! Checksums of rows: CRC-32 of the columns' values after the tag, in order: integers as 8 bytes
//! little endian, texts and blobs as their bytes with their length before them.

/// Adds up a row's columns.
#[derive(Clone, Debug)]
pub struct Sum(crc32fast::Hasher);

impl Sum {
    /// The sum of a row of the table with this number.
    #[must_use]
    pub fn of(table: crate::schema::Table) -> Self {
        let mut hasher = crc32fast::Hasher::new();
        hasher.update(&(table as i64).to_le_bytes());
        Self(hasher)
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

    /// The sum.
    #[must_use]
    pub fn done(self) -> i64 {
        i64::from(self.0.finalize())
    }
}
