//! Deletion of pages, layers and loads that nothing refers to any more.

use std::collections::BTreeSet;
use std::sync::Arc;

use maulstick_canvas::planes::Planes;
use rusqlite::{OptionalExtension as _, params};

use super::{Base, Writer};
use crate::error::DocumentError;
use crate::file::database::DEPTH_MAX;
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
                    Ok(content) => {
                        let onto = self.living_base(*id, &dead)?;
                        self.rebase(later, &content, onto)?;
                    }
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

    /// The page that one which is deleted is a difference to, if it stays.
    fn living_base(&self, id: u64, dead: &BTreeSet<u64>) -> Result<Option<Base>, DocumentError> {
        let mut statement = self
            .database
            .connection
            .prepare_cached("SELECT base, depth FROM page WHERE id = ?1")?;
        let mut row = |id: i64| -> Result<Option<[i64; 2]>, DocumentError> {
            let row = statement.query_row(params![id], |row| Ok([row.get(0)?, row.get(1)?]));
            Ok(row.optional()?)
        };
        let mut base = row(id as i64)?.map_or(0, |[base, _]| base);
        for _ in 0..=DEPTH_MAX {
            let Some([next, depth]) = row(base)? else {
                break;
            };
            if !dead.contains(&(base as u64)) {
                return match self.database.planes(base as u64) {
                    Ok(content) => Ok(Some((base, depth, Arc::new(content)))),
                    // Nothing new may depend on a damaged page.
                    Err(DocumentError::Damaged(_)) => Ok(None),
                    Err(error) => Err(error),
                };
            }
            base = next;
        }
        Ok(None)
    }

    /// Writes a page that was a difference to one which is deleted as a difference to another, or without one.
    fn rebase(&self, id: u64, content: &Planes, onto: Option<Base>) -> Result<(), DocumentError> {
        let base = onto.as_ref().map(|(_, _, content)| &**content);
        let data = planes::encode(content, base, self.database.level)?;
        let (base, depth) = onto.map_or((0, 0), |(base, depth, _)| (base, depth + 1));
        let slots = planes::mask(content) as i64;
        let sum = page_checksum(id, [base, depth, slots], &data);
        let query =
            "UPDATE page SET base = ?2, depth = ?3, slots = ?4, data = ?5, sum = ?6 WHERE id = ?1";
        self.database
            .connection
            .prepare_cached(query)?
            .execute(params![id as i64, base, depth, slots, data, sum])?;
        Ok(())
    }
}
