//! Connections to files from anywhere: nothing in a file is executed.

use std::path::Path;

use rusqlite::config::DbConfig;
use rusqlite::{Connection, OpenFlags};

use crate::error::DocumentError;

/// Opens a file, with a named SQLite VFS if it is not the default. Its triggers and views do nothing, its expressions
/// call no function with side effects, and no statement changes its schema behind SQLite's back. Each connection to a
/// painting is made here. Source: "Defense Against The Dark Arts", <https://sqlite.org/security.html>.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::file::database::{Access, Database};

    /// Settings that keep a file from executing anything: name, setting, required value.
    const SETTINGS: [(&str, DbConfig, bool); 4] = [
        ("DEFENSIVE", DbConfig::SQLITE_DBCONFIG_DEFENSIVE, true),
        (
            "TRUSTED_SCHEMA",
            DbConfig::SQLITE_DBCONFIG_TRUSTED_SCHEMA,
            false,
        ),
        ("triggers", DbConfig::SQLITE_DBCONFIG_ENABLE_TRIGGER, false),
        ("views", DbConfig::SQLITE_DBCONFIG_ENABLE_VIEW, false),
    ];

    /// Names of the settings that SQLite reports with another value.
    fn left_open(connection: &Connection) -> Vec<&'static str> {
        let settings = SETTINGS.into_iter();
        settings
            .filter(|(_, config, wanted)| {
                connection.db_config(*config).expect("read back") != *wanted
            })
            .map(|(name, ..)| name)
            .collect()
    }

    #[test]
    fn every_way_to_open_a_painting_executes_nothing_of_it() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("sea.maul");
        for access in [Access::Paint, Access::Paint, Access::Read] {
            let (database, _) = Database::open(&path, access, None).expect("opened");
            let left = left_open(database.connection());
            assert!(left.is_empty(), "{access:?}: {left:?}");
            database.close().expect("closed");
        }
        let database = Database::open_immutable(&path).expect("opened");
        let left = left_open(database.connection());
        assert!(left.is_empty(), "immutable: {left:?}");
    }

    #[test]
    fn a_setting_that_is_left_open_is_found() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("sea.maul");
        for (name, config, wanted) in SETTINGS {
            let connection = connect(&path, OpenFlags::default(), None).expect("opened");
            assert!(left_open(&connection).is_empty(), "a fault would pass");
            connection.set_db_config(config, !wanted).expect("set");
            assert_eq!(left_open(&connection), [name]);
        }
    }
}
