//! Messages of this program by the hash of their field table.

use std::collections::BTreeMap;

use maulstick_types::{CATALOGUE, CatalogueEntry};

use crate::FieldTable;

/// The message of a hash, if this program knows it.
#[must_use]
pub fn message_of(schema: u32) -> Option<&'static CatalogueEntry> {
    let mut entries = CATALOGUE.iter();
    entries.find(|entry| (entry.schema)().hash == schema)
}

/// Field tables of this program's messages, each read when it is first asked for.
#[derive(Debug, Default)]
pub struct KnownTables {
    tables: BTreeMap<u32, Option<FieldTable>>,
}

impl KnownTables {
    /// The table of a hash, if this program knows it.
    pub fn of(&mut self, schema: u32) -> Option<&FieldTable> {
        let table = self.tables.entry(schema).or_insert_with(|| {
            let entry = message_of(schema)?;
            FieldTable::of((entry.schema)()).ok()
        });
        table.as_ref()
    }
}
