//! Files of a painting that are stored in it.

use maulstick_canvas::assets::hash_of;
use rusqlite::params;

use super::damaged;
use crate::error::DocumentError;
use crate::file::database::Database;

/// File by its hash.
pub(crate) fn file(database: &Database, hash: &str) -> Result<Vec<u8>, DocumentError> {
    let data: Vec<u8> = database.connection.query_row(
        "SELECT data FROM file WHERE hash = ?1",
        params![hash],
        |row| row.get(0),
    )?;
    if hash_of(&data) == hash {
        Ok(data)
    } else {
        Err(damaged(format!("file {hash} does not match its hash")))
    }
}

/// Text file by its hash.
///
/// # Errors
/// [`DocumentError::Damaged`] if it is missing, or does not match its hash.
pub fn text(database: &Database, hash: &str) -> Result<String, DocumentError> {
    String::from_utf8(file(database, hash)?).map_err(damaged)
}
