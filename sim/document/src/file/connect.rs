//! Connections to files that came from anywhere: nothing that a file says is executed.

use std::path::Path;

use rusqlite::config::DbConfig;
use rusqlite::{Connection, OpenFlags};

use crate::error::DocumentError;

/// Opens a file, through the SQLite VFS of a name if it is not the usual one. Its triggers and views do nothing, its
/// expressions call no function that has effects, and no statement changes its schema behind SQLite's back. Each connection to
/// a painting is made here. Sources: "Defense Against The Dark Arts", <https://sqlite.org/security.html>.
///
/// # Errors
/// The error of SQLite.
pub(crate) fn connect(
    path: &Path,
    flags: OpenFlags,
    vfs: Option<&str>,
) -> Result<Connection, DocumentError> {
    let connection = match vfs {
        Some(vfs) => Connection::open_with_flags_and_vfs(path, flags, vfs),
        None => Connection::open_with_flags(path, flags),
    }?;
    for (config, on) in [
        (DbConfig::SQLITE_DBCONFIG_DEFENSIVE, true),
        (DbConfig::SQLITE_DBCONFIG_TRUSTED_SCHEMA, false),
        (DbConfig::SQLITE_DBCONFIG_ENABLE_TRIGGER, false),
        (DbConfig::SQLITE_DBCONFIG_ENABLE_VIEW, false),
    ] {
        connection.set_db_config(config, on)?;
    }
    Ok(connection)
}
