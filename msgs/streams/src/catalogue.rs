//! Messages of this program by the hash of their field table.

use maulstick_types::{CATALOGUE, CatalogueEntry};

/// The message of a hash, if this program knows it.
#[must_use]
pub fn message_of(schema: u32) -> Option<&'static CatalogueEntry> {
    let mut entries = CATALOGUE.iter();
    entries.find(|entry| (entry.schema)().hash == schema)
}
