//! Sizes of the tables of a painting's file, and a check of its integrity.

use std::path::Path;

use rusqlite::params;

use crate::error::DocumentError;
use crate::file::database::{Access, Database};
use crate::record::{self, RecordStats};
use crate::tables::schema;

/// Format and sizes of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DocumentStats {
    /// Schema version.
    pub format: i32,
    /// Size of the file, bytes.
    pub bytes: u64,
    /// Size of the data of each non-empty table, bytes.
    pub tables: Vec<(&'static str, u64)>,
    /// The record, if there is one.
    pub record: Option<RecordStats>,
}

/// Tables with data, and the column of that data.
const DATA: [(&str, &str); 9] = [
    ("page", "data"),
    ("load", "data"),
    ("step", "tiles"),
    ("version", "tiles"),
    ("file", "data"),
    ("journal", "data"),
    ("shown", "data"),
    ("beginning", "tiles"),
    ("record", "data"),
];

impl DocumentStats {
    /// Reads the sizes of a file's tables.
    ///
    /// # Errors
    /// Any [`DocumentError`].
    pub fn read(path: &Path) -> Result<Self, DocumentError> {
        let (database, _) = Database::open(path, Access::Read, None)?;
        let mut tables = Vec::new();
        let format = schema::version(&database.connection)?;
        let record = RecordStats::read(&database)?;
        for (table, column) in DATA {
            let known = "SELECT 1 FROM sqlite_schema WHERE type = 'table' AND name = ?1";
            if !database.connection.prepare_cached(known)?.exists([table])? {
                continue;
            }
            if table == "record" {
                // Its rows include their own sizes.
                let bytes = record.map_or(0, |record| record.bytes);
                tables.extend((bytes > 0).then_some((table, bytes)));
                continue;
            }
            let query = format!("SELECT coalesce(sum(length({column})), 0) FROM {table}");
            let bytes: i64 = database
                .connection
                .query_row(&query, params![], |row| row.get(0))?;
            if bytes > 0 {
                tables.push((table, bytes as u64));
            }
        }
        database.close_unchanged()?;
        Ok(Self {
            format,
            bytes: std::fs::metadata(path)?.len(),
            tables,
            record,
        })
    }

    /// Reads every page, of the painting and of its history.
    ///
    /// # Errors
    /// [`DocumentError::Damaged`] with the first damaged one.
    pub fn check(
        &self,
        path: &Path,
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<(), DocumentError> {
        let (database, _) = Database::open(path, Access::Read, None)?;
        let ids = |table: &str| -> Result<Vec<i64>, DocumentError> {
            let mut statement = database
                .connection
                .prepare(&format!("SELECT id FROM {table}"))?;
            let rows = statement.query_map(params![], |row| row.get(0))?;
            Ok(rows.collect::<Result<_, _>>()?)
        };
        let (pages, loads) = (ids("page")?, ids("load")?);
        let all = (pages.len() + loads.len()) as u64;
        for (done, id) in pages.iter().enumerate() {
            database.planes(*id as u64)?;
            progress(done as u64, all);
        }
        for id in loads {
            database.load(id as u64)?;
        }
        record::check(&database)?;
        let verdict: String =
            database
                .connection
                .query_row("PRAGMA integrity_check(1)", params![], |row| row.get(0))?;
        progress(all, all);
        database.close_unchanged()?;
        match verdict.as_str() {
            "ok" => Ok(()),
            other => Err(DocumentError::Damaged(other.to_owned())),
        }
    }
}
