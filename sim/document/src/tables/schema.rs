//! The tables of a painting. `docs/document.md` describes them for other programs.

use std::collections::BTreeSet;
use std::path::Path;

use rusqlite::{Connection, OpenFlags, Row, params};

use crate::error::DocumentError;
use crate::file::connect::connect;

/// `application_id` of a painting: "Maul".
pub const APPLICATION_ID: i32 = 0x4D61_756C;
/// The schema that this program writes.
pub const VERSION: i32 = 8;
/// The oldest schema that it reads.
const OLDEST_VERSION: i32 = 4;

/// Every row begins with its table's number, so that rows can be sorted even if the schema is lost, and ends with a
/// checksum of its other columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i64)]
pub enum Table {
    /// The painting besides its tiles, JSON.
    State = 1,
    /// Files by hash: brushes, paints, pictures.
    File = 2,
    /// Planes of counts.
    Page = 3,
    /// Dry layers of tiles.
    Dry = 4,
    /// Loads of brushes.
    Load = 5,
    /// Contents of tiles.
    Tile = 6,
    /// Steps of the history.
    Step = 7,
    /// Named versions.
    Version = 8,
    /// Records accepted since the state.
    Journal = 9,
    /// Tiles as they are shown.
    Shown = 10,
    /// The painting at the beginning of its record.
    Beginning = 11,
    /// Records accepted from the beginning to the state.
    Record = 12,
}

impl Table {
    /// The table of this number.
    #[must_use]
    pub fn of(tag: i64) -> Option<Self> {
        const ALL: [Table; 12] = [
            Table::State,
            Table::File,
            Table::Page,
            Table::Dry,
            Table::Load,
            Table::Tile,
            Table::Step,
            Table::Version,
            Table::Journal,
            Table::Shown,
            Table::Beginning,
            Table::Record,
        ];
        ALL.into_iter().find(|table| *table as i64 == tag)
    }

    /// Name of the table in SQL.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Table::State => "state",
            Table::File => "file",
            Table::Page => "page",
            Table::Dry => "dry",
            Table::Load => "load",
            Table::Tile => "tile",
            Table::Step => "step",
            Table::Version => "version",
            Table::Journal => "journal",
            Table::Shown => "shown",
            Table::Beginning => "beginning",
            Table::Record => "record",
        }
    }

    /// Kinds of the columns between tag and sum: `i` an integer, `t` a text, `b` a blob. A leading integer is the row's
    /// key.
    #[must_use]
    pub fn columns(self) -> &'static str {
        match self {
            Table::State => "tt",
            Table::File => "tttb",
            Table::Page => "iiiib",
            Table::Dry | Table::Tile => "iiii",
            Table::Load => "ib",
            Table::Step => "ittiitb",
            Table::Version => "tttb",
            Table::Journal => "iib",
            Table::Shown => "iiib",
            Table::Beginning => "ttb",
            Table::Record => "iiiib",
        }
    }
}

const TABLES: &str = "
CREATE TABLE state(tag INTEGER NOT NULL, key TEXT PRIMARY KEY, value TEXT NOT NULL, sum INTEGER NOT NULL);
CREATE TABLE file(tag INTEGER NOT NULL, hash TEXT PRIMARY KEY, kind TEXT NOT NULL, name TEXT NOT NULL, data BLOB NOT NULL, sum INTEGER NOT NULL);
CREATE TABLE page(tag INTEGER NOT NULL, id INTEGER PRIMARY KEY, base INTEGER NOT NULL, depth INTEGER NOT NULL, slots INTEGER NOT NULL, data BLOB NOT NULL, sum INTEGER NOT NULL);
CREATE INDEX page_base ON page(base) WHERE base > 0;
CREATE TABLE dry(tag INTEGER NOT NULL, id INTEGER PRIMARY KEY, below INTEGER NOT NULL, layer INTEGER NOT NULL, page INTEGER NOT NULL, sum INTEGER NOT NULL);
CREATE TABLE load(tag INTEGER NOT NULL, id INTEGER PRIMARY KEY, data BLOB NOT NULL, sum INTEGER NOT NULL);
CREATE TABLE tile(tag INTEGER NOT NULL, place INTEGER PRIMARY KEY, version INTEGER NOT NULL, page INTEGER NOT NULL, dry INTEGER NOT NULL, sum INTEGER NOT NULL);
CREATE TABLE step(tag INTEGER NOT NULL, id INTEGER PRIMARY KEY, what TEXT NOT NULL, brush TEXT NOT NULL, operations INTEGER NOT NULL, done INTEGER NOT NULL, deed TEXT NOT NULL, tiles BLOB NOT NULL, sum INTEGER NOT NULL);
CREATE TABLE version(tag INTEGER NOT NULL, name TEXT PRIMARY KEY, parent TEXT NOT NULL, rest TEXT NOT NULL, tiles BLOB NOT NULL, sum INTEGER NOT NULL);
CREATE TABLE journal(tag INTEGER NOT NULL, id INTEGER PRIMARY KEY, last INTEGER NOT NULL, data BLOB NOT NULL, sum INTEGER NOT NULL);
CREATE TABLE shown(tag INTEGER NOT NULL, place INTEGER PRIMARY KEY, version INTEGER NOT NULL, look INTEGER NOT NULL, data BLOB NOT NULL, sum INTEGER NOT NULL);
";

/// Tables of the record, since schema 5.
const RECORD_TABLES: &str = "
CREATE TABLE beginning(tag INTEGER NOT NULL, part TEXT PRIMARY KEY, value TEXT NOT NULL, tiles BLOB NOT NULL, sum INTEGER NOT NULL);
CREATE TABLE record(tag INTEGER NOT NULL, id INTEGER PRIMARY KEY, last INTEGER NOT NULL, time INTEGER NOT NULL, bytes INTEGER NOT NULL, data BLOB NOT NULL, sum INTEGER NOT NULL);
";

/// Creates the tables of a new painting.
///
/// # Errors
/// [`DocumentError`] where the file cannot be written.
pub fn create(connection: &Connection) -> Result<(), DocumentError> {
    connection.execute_batch(&format!(
        "BEGIN IMMEDIATE; {TABLES} {RECORD_TABLES} PRAGMA application_id = {APPLICATION_ID}; \
         PRAGMA user_version = {VERSION}; COMMIT;"
    ))?;
    Ok(())
}

/// True if a database is empty and has no application id.
///
/// # Errors
/// The error of SQLite.
pub fn is_blank(connection: &Connection) -> Result<bool, DocumentError> {
    let number = |query: &str| connection.query_row(query, params![], |row| row.get::<_, i64>(0));
    Ok(number("PRAGMA application_id")? == 0
        && number("PRAGMA user_version")? == 0
        && number("SELECT count(*) FROM sqlite_schema")? == 0)
}

/// True if a file is another program's database. It is only read.
///
/// # Errors
/// The error of SQLite.
pub fn is_foreign(path: &Path) -> Result<bool, DocumentError> {
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let connection = connect(path, flags, None)?;
    let application: i32 =
        connection.query_row("PRAGMA application_id", params![], |row| row.get(0))?;
    Ok(application != APPLICATION_ID && !is_blank(&connection)?)
}

/// Migrations from each older schema to the next. Schema 6 stores rows of the record as columns, schema 7 names of
/// steps and decisions as fields, schema 8 edits by name; older rows stay unchanged.
const MIGRATIONS: [&str; (VERSION - OLDEST_VERSION) as usize] = [RECORD_TABLES, "", "", ""];

/// Schema of a painting; rejects one of a newer program or before the oldest schema.
///
/// # Errors
/// [`DocumentError::Newer`], [`DocumentError::Older`], [`DocumentError::NoPainting`], or the error of SQLite.
pub fn version(connection: &Connection) -> Result<i32, DocumentError> {
    let application: i32 =
        connection.query_row("PRAGMA application_id", params![], |row| row.get(0))?;
    let version: i32 = connection.query_row("PRAGMA user_version", params![], |row| row.get(0))?;
    if application != APPLICATION_ID || version < 1 {
        return Err(DocumentError::NoPainting);
    }
    if version < OLDEST_VERSION {
        return Err(DocumentError::Older(version));
    }
    if version > VERSION {
        return Err(DocumentError::Newer {
            found: version,
            known: VERSION,
        });
    }
    Ok(version)
}

/// An object of a schema: its type, name, table and statement.
type Object = [String; 4];

/// Up to `most` objects of a schema.
fn objects(connection: &Connection, most: usize) -> Result<BTreeSet<Object>, DocumentError> {
    // SQLite's own statistics have no statement.
    let query = "SELECT type, name, tbl_name, coalesce(sql, '') FROM sqlite_schema \
         WHERE NOT (type = 'table' AND name GLOB 'sqlite_stat[14]') LIMIT ?1";
    let mut statement = connection.prepare(query)?;
    let object = |row: &Row<'_>| Ok([row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?]);
    let rows = statement.query_map([most as i64], object)?;
    Ok(rows.collect::<Result<_, _>>()?)
}

/// Checks that a painting has exactly the tables and the index of this program: a trigger would change the written
/// data, a view the data read.
///
/// # Errors
/// [`DocumentError::Altered`] with the difference, or as [`version`].
pub fn check(connection: &Connection) -> Result<(), DocumentError> {
    let own = Connection::open_in_memory()?;
    own.execute_batch(TABLES)?;
    for change in MIGRATIONS
        .iter()
        .take((version(connection)? - OLDEST_VERSION) as usize)
    {
        own.execute_batch(change)?;
    }
    let own = objects(&own, usize::MAX >> 1)?;
    // One extra object suffices to detect a difference.
    let found = objects(connection, own.len() + 1)?;
    let strange = found.difference(&own).next();
    let differs = strange.or_else(|| own.difference(&found).next());
    let Some([kind, name, ..]) = differs else {
        return Ok(());
    };
    let known = own.iter().any(|[_, own, ..]| own == name);
    Err(DocumentError::Altered(match (strange, known) {
        (Some(_), false) => format!("the {kind} '{name}' does not belong to a painting"),
        (Some(_), true) => format!("its {kind} '{name}' is another than it was"),
        (None, _) => format!("its {kind} '{name}' is missing"),
    }))
}

/// True if a painting has the tables of the record.
///
/// # Errors
/// As [`version`].
pub fn has_record(connection: &Connection) -> Result<bool, DocumentError> {
    Ok(version(connection)? > OLDEST_VERSION)
}

/// Migrates an older painting to the schema of this program.
///
/// # Errors
/// As [`version`].
pub fn migrate(connection: &Connection) -> Result<(), DocumentError> {
    let version = version(connection)?;
    for (place, change) in MIGRATIONS
        .iter()
        .enumerate()
        .skip((version - OLDEST_VERSION) as usize)
    {
        let to = OLDEST_VERSION + 1 + place as i32;
        let change = format!("BEGIN IMMEDIATE; {change}; PRAGMA user_version = {to}; COMMIT;");
        connection.execute_batch(&change)?;
    }
    Ok(())
}
