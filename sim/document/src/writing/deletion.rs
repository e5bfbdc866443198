//! Deletion of unreferenced pages, layers and loads.

use std::collections::BTreeSet;

use maulstick_canvas::planes::Planes;
use rusqlite::params;

use super::Writer;
use crate::error::DocumentError;
use crate::tables::checksum::page_checksum;
use crate::tables::planes;

impl Writer<'_, '_> {
    /// Deletes pages, layers and loads without references. Pages that are differences to one of them are rebased.
    pub(super) fn delete_unreferenced(&mut self, dead: &[u64]) -> Result<(), DocumentError> {
        let connection = &self.database.connection;
        let dead: BTreeSet<u64> = dead.iter().copied().collect();
        for id in &dead {
            for later in self.differences_to(*id)? {
                if dead.contains(&later) {
                    continue;
                }
                (self.yield_hook)(self.database);
                match self.database.planes(later) {
                    Ok(content) => self.rebase(later, &content)?,
                    // It is lost with or without its base; this checkpoint is not.
                    Err(DocumentError::Damaged(_)) => {}
                    Err(error) => return Err(error),
                }
            }
        }
        for id in &dead {
            for table in ["page", "dry", "load"] {
                connection
                    .prepare_cached(&format!("DELETE FROM {table} WHERE id = ?1"))?
                    .execute(params![*id as i64])?;
            }
        }
        Ok(())
    }

    fn differences_to(&self, id: u64) -> Result<Vec<u64>, DocumentError> {
        let query = "SELECT id FROM page WHERE base = ?1";
        let mut statement = self.database.connection.prepare_cached(query)?;
        let later = statement.query_map(params![id as i64], |row| row.get::<_, i64>(0))?;
        Ok(later
            .map(|id| Ok(id? as u64))
            .collect::<Result<_, rusqlite::Error>>()?)
    }

    /// Writes a page that was a difference without a base.
    fn rebase(&self, id: u64, content: &Planes) -> Result<(), DocumentError> {
        let data = planes::encode(content, None, self.database.level)?;
        let slots = planes::mask(content) as i64;
        let sum = page_checksum(id, [0, 0, slots], &data);
        let query =
            "UPDATE page SET base = 0, depth = 0, slots = ?2, data = ?3, sum = ?4 WHERE id = ?1";
        self.database
            .connection
            .prepare_cached(query)?
            .execute(params![id as i64, slots, data, sum])?;
        Ok(())
    }
}
