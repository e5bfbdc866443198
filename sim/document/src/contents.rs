//! Contents of a painting's file, and a check that all of it is intact.

use std::path::Path;

use rusqlite::params;

use crate::database::{Access, Database};
use crate::error::DocumentError;
use crate::schema::VERSION;

/// Contents of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Contents {
    /// Version of its schema.
    pub format: i32,
    /// Bytes of the file.
    pub bytes: u64,
    /// Bytes of the data of each table, where it has any.
    pub tables: Vec<(&'static str, u64)>,
}

/// Tables with data, and the column that holds it.
const DATA: [(&str, &str); 7] = [
    ("page", "data"),
    ("load", "data"),
    ("step", "tiles"),
    ("version", "tiles"),
    ("file", "data"),
    ("journal", "data"),
    ("shown", "data"),
];

impl Contents {
    /// Reads what a file holds.
    ///
    /// # Errors
    /// Any [`DocumentError`].
    pub fn read(path: &Path) -> Result<Self, DocumentError> {
        let (database, _) = Database::open(path, Access::Read, None)?;
        let mut tables = Vec::new();
        for (table, column) in DATA {
            let query = format!("SELECT coalesce(sum(length({column})), 0) FROM {table}");
            let bytes: i64 = database
                .connection
                .query_row(&query, params![], |row| row.get(0))?;
            if bytes > 0 {
                tables.push((table, bytes as u64));
            }
        }
        database.leave()?;
        Ok(Self {
            format: VERSION,
            bytes: std::fs::metadata(path)?.len(),
            tables,
        })
    }

    /// Reads every page, of the painting and of its history.
    ///
    /// # Errors
    /// [`DocumentError::Damaged`] with the first that is not whole.
    pub fn check(&self, path: &Path, tell: &mut dyn FnMut(u64, u64)) -> Result<(), DocumentError> {
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
            tell(done as u64, all);
        }
        for id in loads {
            database.load(id as u64)?;
        }
        let verdict: String =
            database
                .connection
                .query_row("PRAGMA integrity_check(1)", params![], |row| row.get(0))?;
        tell(all, all);
        database.leave()?;
        match verdict.as_str() {
            "ok" => Ok(()),
            other => Err(DocumentError::Damaged(other.to_owned())),
        }
    }
}
