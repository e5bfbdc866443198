//! The file: opened for one program alone, and its rows read one by one.

use std::path::{Path, PathBuf};

use maulstick_canvas::planes::Planes;
use maulstick_files::{FileId, OpenDatabase, is_companion, read_head};
use maulstick_model::brush::load::BrushLoad;
use maulstick_types::scene::Scene;
use rusqlite::config::DbConfig;
use rusqlite::{Connection, OpenFlags, OptionalExtension as _, params};

use crate::error::DocumentError;
use crate::schema::{self, Table};
use crate::sum::Sum;
use crate::{loads, planes};

/// Purpose for which a file is opened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// To paint in it; it is created if it does not exist.
    Paint,
    /// To read it; nothing is changed.
    Read,
}

/// Bytes of a page of the file.
const PAGE_BYTES: u32 = 8192;
/// The first bytes of every SQLite file.
const MAGIC: &[u8; 16] = b"SQLite format 3\0";
/// A page's chain of differences has at most this many links.
pub(crate) const DEPTH_MAX: i64 = 8;

/// An open painting.
#[derive(Debug)]
pub struct Database {
    pub(crate) connection: Connection,
    /// zstd's level of what is written.
    pub(crate) level: i32,
    /// Keeps the rest of the process from opening the file, which would drop its locks.
    _registered: Option<OpenDatabase>,
    /// It was not closed the last time: its journal may hold what is to be recovered.
    unclosed: bool,
}

/// The journal that SQLite keeps beside a file.
pub(crate) fn beside(path: &Path, suffix: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(suffix);
    name.into()
}

/// Real path of a file: the target of a link, beside which SQLite puts its journal.
pub(crate) fn resolved(path: &Path) -> PathBuf {
    std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

/// Sees that a closed painting is in its file alone, as it has to be before that gets another name.
///
/// # Errors
/// [`DocumentError::Unfolded`] where there was no room to fold its journal in.
pub(crate) fn folded(path: &Path) -> Result<(), DocumentError> {
    match length(&beside(&resolved(path), "-wal")) {
        Some(1..) => Err(DocumentError::Unfolded(path.to_owned())),
        _ => Ok(()),
    }
}

/// True if there is a painting to continue; false if one is to be created.
///
/// # Errors
/// Any [`DocumentError`], and nothing is changed.
pub fn glance(path: &Path) -> Result<bool, DocumentError> {
    Ok(scene(path)?.is_some())
}

/// The desk of a painting, where one is there that can go on.
///
/// # Errors
/// As [`glance`].
pub fn scene(path: &Path) -> Result<Option<Scene>, DocumentError> {
    if is_new(path)? {
        return Ok(None);
    }
    let (database, _) = Database::open(path, Access::Paint, None)?;
    let scene = crate::opening::scene(&database);
    database.leave()?;
    scene
}

fn length(path: &Path) -> Option<u64> {
    std::fs::metadata(path).ok().map(|about| about.len())
}

/// True if a painting is to be created there.
pub(crate) fn is_new(path: &Path) -> Result<bool, DocumentError> {
    let Some(length_found) = length(path) else {
        if is_companion(path) {
            return Err(DocumentError::Companion);
        }
        return match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() && !folder.is_dir() => {
                Err(DocumentError::Other("its folder does not exist".to_owned()))
            }
            _ => Ok(true),
        };
    };
    if !path.is_file() {
        return Err(DocumentError::NoPainting);
    }
    if length_found == 0 {
        return match length(&beside(path, "-wal")) {
            Some(1..) => Err(DocumentError::Damaged("the file is empty".to_owned())),
            _ => Ok(true),
        };
    }
    if length(&beside(path, "-journal")).is_some_and(|length| length > 0) {
        // The power went while it was begun: SQLite takes back what there is of it.
        return Ok(false);
    }
    let mut head = [0; 100];
    let whole = read_head(path, &mut head)? == head.len();
    match whole {
        true if head.starts_with(MAGIC) && head[WRITE_VERSION] == ROLLBACK => {
            match schema::is_foreign(path)? {
                true => Err(DocumentError::NoPainting),
                false => Ok(false),
            }
        }
        true if head.starts_with(MAGIC) => Ok(false),
        true if length_found > 4096 && damaged_head(&head) => Err(DocumentError::Damaged(
            "its first bytes are wrong".to_owned(),
        )),
        _ => Err(DocumentError::NoPainting),
    }
}

/// Offset of the write version in a SQLite file.
const WRITE_VERSION: usize = 18;
/// Its value if no write-ahead log was ever requested, as in every new painting.
const ROLLBACK: u8 = 1;

/// True if these are a painting's first bytes with a few of them wrong.
fn damaged_head(head: &[u8]) -> bool {
    head.iter()
        .zip(MAGIC)
        .filter(|(one, other)| one == other)
        .count()
        >= 8
}

impl Database {
    /// Opens a painting; `vfs` is the name of the SQLite VFS, if not the usual one. True if it was created.
    ///
    /// # Errors
    /// Any [`DocumentError`].
    pub fn open(
        path: &Path,
        access: Access,
        vfs: Option<&str>,
    ) -> Result<(Self, bool), DocumentError> {
        let new = is_new(path)?;
        if new && access == Access::Read {
            return Err(match path.exists() {
                true => DocumentError::NoPainting,
                false => DocumentError::Missing,
            });
        }
        let flags = OpenFlags::SQLITE_OPEN_READ_WRITE
            | OpenFlags::SQLITE_OPEN_NO_MUTEX
            | OpenFlags::SQLITE_OPEN_CREATE;
        let unclosed = length(&beside(&resolved(path), "-wal")).is_some_and(|length| length > 0);
        let connection = match vfs {
            Some(vfs) => Connection::open_with_flags_and_vfs(path, flags, vfs),
            None => Connection::open_with_flags(path, flags),
        };
        let mut database = Self {
            connection: connection?,
            level: planes::LEVEL,
            _registered: FileId::of(path).ok().map(OpenDatabase::new),
            unclosed,
        };
        match database.take(path) {
            Err(DocumentError::ReadOnly(_)) if access == Access::Read => {
                database = Self::open_frozen(path)?;
            }
            Err(DocumentError::InUse { .. }) => {
                return Err(DocumentError::InUse {
                    holder: holder(path),
                });
            }
            taken => taken?,
        }
        match database.set_up(new, access) {
            Ok(new) => Ok((database, new)),
            Err(error) => {
                database.leave().ok();
                Err(error)
            }
        }
    }

    /// Makes the tables of a new painting, and brings an older one up to this program; true where it is
    /// new.
    fn set_up(&self, new: bool, access: Access) -> Result<bool, DocumentError> {
        // It was begun, and not even its tables were written.
        let new = new || (access == Access::Paint && schema::is_blank(&self.connection)?);
        if new {
            schema::create(&self.connection)?;
        }
        schema::migrate(&self.connection)?;
        Ok(new)
    }

    /// Makes the file this program's own and sets how it is written.
    fn take(&self, path: &Path) -> Result<(), DocumentError> {
        let connection = &self.connection;
        // A program that was killed holds its locks until the system has cleared it away.
        connection.busy_timeout(std::time::Duration::from_secs(1))?;
        // A painting that turns out to be damaged keeps its journal as it is.
        connection.set_db_config(DbConfig::SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, true)?;
        if connection.is_readonly("main")? {
            return Err(DocumentError::ReadOnly("no permission to write".to_owned()));
        }
        // Before the first access, so that SQLite needs no memory shared between programs.
        connection.pragma_update(None, "locking_mode", "EXCLUSIVE")?;
        connection.pragma_update(None, "page_size", PAGE_BYTES)?;
        let mode: String =
            connection.query_row("PRAGMA journal_mode = WAL", params![], |row| row.get(0))?;
        if mode != "wal" {
            let folder = path.parent().unwrap_or(path).display();
            return Err(DocumentError::ReadOnly(format!("no journal in {folder}")));
        }
        connection.pragma_update(None, "synchronous", "FULL")?;
        connection.execute_batch(
            "PRAGMA cache_size = -8192; PRAGMA temp_store = MEMORY; PRAGMA cell_size_check = ON; \
             BEGIN EXCLUSIVE; COMMIT;",
        )?;
        Ok(())
    }

    /// Opens a painting that nobody can write to, if there is no journal beside it.
    fn open_frozen(path: &Path) -> Result<Self, DocumentError> {
        if length(&beside(path, "-wal")).is_some_and(|length| length > 0) {
            return Err(DocumentError::ReadOnly(
                "it was not closed, and its journal is to be folded in first".to_owned(),
            ));
        }
        let text = path.as_os_str().as_encoded_bytes();
        let escaped: String = text
            .iter()
            .map(|byte| match byte {
                b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'/' | b'.' | b'_' | b'-' => {
                    char::from(*byte).to_string()
                }
                other => format!("%{other:02X}"),
            })
            .collect();
        let flags = OpenFlags::SQLITE_OPEN_READ_ONLY
            | OpenFlags::SQLITE_OPEN_URI
            | OpenFlags::SQLITE_OPEN_NO_MUTEX;
        let uri = format!("file:{escaped}?immutable=1");
        Ok(Self {
            connection: Connection::open_with_flags(uri, flags)?,
            level: planes::LEVEL,
            _registered: FileId::of(path).ok().map(OpenDatabase::new),
            unclosed: false,
        })
    }

    /// Closes it with the journal that was there when it was opened, unchanged; a journal of its own is merged.
    ///
    /// # Errors
    /// The error of SQLite.
    pub fn leave(self) -> Result<(), DocumentError> {
        match self.unclosed {
            true => self.connection.close().map_err(|(_, error)| error.into()),
            false => self.close(),
        }
    }

    /// Merges the journal into the file and closes it.
    ///
    /// # Errors
    /// The error of SQLite.
    pub fn close(self) -> Result<(), DocumentError> {
        if !self.connection.is_readonly("main")? {
            let folded =
                self.connection
                    .query_row("PRAGMA wal_checkpoint(TRUNCATE)", params![], |_| Ok(()));
            match folded.map_err(DocumentError::from) {
                // Data in the journal are safe there, and are merged in when there is room.
                Err(DocumentError::Full) => {}
                folded => folded?,
            }
            let folded = DbConfig::SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE;
            self.connection.set_db_config(folded, false)?;
        }
        self.connection.close().map_err(|(_, error)| error.into())
    }

    /// Closes it and touches no file: its names may be those of others.
    pub(crate) fn abandon(self) {
        // The connection leaves the journal as it is, see `take`.
        if let Err((_, error)) = self.connection.close() {
            tracing::debug!("the file that is gone is closed: {error}");
        }
    }

    /// Folds the journal in and stays open, as far as there is room.
    pub(crate) fn fold(&self) {
        let query = "PRAGMA wal_checkpoint(TRUNCATE)";
        if let Err(error) = self.connection.query_row(query, params![], |_| Ok(())) {
            tracing::debug!("the journal is not folded in: {error}");
        }
    }

    /// Writes all its content, with its journal, to a new file.
    ///
    /// # Errors
    /// The error of SQLite.
    pub(crate) fn copy_to(&self, to: &Path) -> Result<(), DocumentError> {
        let to = to
            .to_str()
            .ok_or_else(|| DocumentError::Other(format!("{} is not UTF-8", to.display())))?;
        self.connection.execute("VACUUM INTO ?1", params![to])?;
        Ok(())
    }

    /// The planes of a page.
    ///
    /// # Errors
    /// [`DocumentError::Damaged`] where it is not whole, or what SQLite says.
    pub fn planes(&self, id: u64) -> Result<Planes, DocumentError> {
        self.planes_at(id, DEPTH_MAX + 1)
    }

    fn planes_at(&self, id: u64, left: i64) -> Result<Planes, DocumentError> {
        let damaged = |what: &str| DocumentError::Damaged(format!("page {id} {what}"));
        if left < 0 {
            return Err(damaged("is a difference to itself"));
        }
        let mut statement = self
            .connection
            .prepare_cached("SELECT base, depth, slots, data, sum FROM page WHERE id = ?1")?;
        let row = statement.query_row(params![id as i64], |row| {
            let ints: [i64; 3] = [row.get(0)?, row.get(1)?, row.get(2)?];
            Ok((ints, row.get::<_, Vec<u8>>(3)?, row.get::<_, i64>(4)?))
        });
        let ([base, depth, slots], data, sum) =
            row.optional()?.ok_or_else(|| damaged("is missing"))?;
        if page_sum(id, [base, depth, slots], &data) != sum {
            return Err(damaged("does not match its checksum"));
        }
        let base = match base {
            0 => None,
            base => Some(self.planes_at(base as u64, left - 1)?),
        };
        planes::decode(slots as u32, &data, base.as_ref()).map_err(|what| damaged(&what))
    }

    /// Load of a brush.
    ///
    /// # Errors
    /// As [`planes`](Self::planes).
    pub fn load(&self, id: u64) -> Result<BrushLoad, DocumentError> {
        let damaged = |what: &str| DocumentError::Damaged(format!("load {id} {what}"));
        let mut statement = self
            .connection
            .prepare_cached("SELECT data, sum FROM load WHERE id = ?1")?;
        let row = statement.query_row(params![id as i64], |row| {
            Ok((row.get::<_, Vec<u8>>(0)?, row.get::<_, i64>(1)?))
        });
        let (data, sum) = row.optional()?.ok_or_else(|| damaged("is missing"))?;
        if load_sum(id, &data) != sum {
            return Err(damaged("does not match its checksum"));
        }
        loads::decode(&data).map_err(|what| damaged(&what))
    }

    /// A tile as it was shown; `None` if it is absent or damaged.
    #[must_use]
    pub fn shown(&self, place: i64, version: i64, look: i64) -> Option<Vec<u8>> {
        let query = "SELECT data, sum FROM shown WHERE place = ?1 AND version = ?2 AND look = ?3";
        let mut statement = self.connection.prepare_cached(query).ok()?;
        let row = statement.query_row(params![place, version, look], |row| {
            Ok((row.get::<_, Vec<u8>>(0)?, row.get::<_, i64>(1)?))
        });
        let (data, sum) = row.ok()?;
        (shown_sum(place, version, look, &data) == sum).then_some(data)
    }
}

pub(crate) fn page_sum(id: u64, ints: [i64; 3], data: &[u8]) -> i64 {
    let sum = Sum::of(Table::Page).int(id as i64);
    let sum = ints.into_iter().fold(sum, Sum::int);
    sum.bytes(data).done()
}

pub(crate) fn load_sum(id: u64, data: &[u8]) -> i64 {
    Sum::of(Table::Load).int(id as i64).bytes(data).done()
}

pub(crate) fn shown_sum(place: i64, version: i64, look: i64, data: &[u8]) -> i64 {
    let sum = Sum::of(Table::Shown).int(place).int(version).int(look);
    sum.bytes(data).done()
}

/// The process that holds the lock of a file, if the system knows it. The file is not opened: closing
/// it again would drop this process's own locks of it.
pub(crate) fn holder(path: &Path) -> Option<i32> {
    use std::os::unix::fs::MetadataExt as _;
    // The first bytes that SQLite locks: pending, reserved and shared, from 1 GiB on.
    const LOCKED: std::ops::Range<u64> = 0x4000_0000..0x4000_0200;
    let inode = std::fs::metadata(path).ok()?.ino();
    let locks = std::fs::read_to_string("/proc/locks").ok()?;
    let held = locks.lines().find_map(|line| {
        // 1: POSIX  ADVISORY  WRITE 4242 08:01:131090 1073741824 1073742335
        let words: Vec<&str> = line.split_whitespace().collect();
        let [_, "POSIX", _, _, process, file, from, _] = words[..] else {
            return None;
        };
        let of_it = file.rsplit(':').next()?.parse() == Ok(inode);
        let is_lock = LOCKED.contains(&from.parse().ok()?);
        (of_it && is_lock).then(|| process.parse().ok())?
    });
    held.filter(|process| *process > 0)
}
