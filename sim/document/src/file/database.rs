//! The file, opened for one program alone, and access to its pages, loads and displayed tiles.

use std::path::Path;

use maulstick_canvas::planes::Planes;
use maulstick_files::{FileId, OpenDatabase, companion, is_companion, read_head};
use maulstick_model::brush::load::BrushLoad;
use rusqlite::config::DbConfig;
use rusqlite::{Connection, OpenFlags, OptionalExtension as _, params};

use crate::error::DocumentError;
use crate::file::connect::connect;
use crate::file::path::{length, resolved};
use crate::file::probe::Probe;
use crate::tables::checksum::{load_checksum, page_checksum, shown_checksum};
use crate::tables::{loads, planes, schema};

/// Purpose for which a file is opened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Reads and writes; the file is created if it does not exist.
    Paint,
    /// Reads only; nothing is changed.
    Read,
}

/// Size of a page of the file, bytes.
const PAGE_BYTES: u32 = 8192;
/// The first bytes of every SQLite file.
const MAGIC: &[u8; 16] = b"SQLite format 3\0";
/// Greatest number of links in a page's chain of differences.
pub(crate) const DEPTH_MAX: i64 = 8;

/// An open painting.
#[derive(Debug)]
pub struct Database {
    pub(crate) connection: Connection,
    /// zstd level of the data written.
    pub(crate) level: i32,
    /// Probe that distinguishes a failing disk from a damaged file. It is dropped after the connection.
    probe: Option<Probe>,
    /// Registration that keeps the rest of the process from opening the file, which would drop its locks.
    _registered: Option<OpenDatabase>,
    /// True if it was not closed the last time: its journal may hold rows to recover.
    was_unclosed: bool,
}

/// Checks that the journal of a closed painting is merged into its file, as is required before the file is renamed.
///
/// # Errors
/// [`DocumentError::Unmerged`] if there was no room to merge it.
pub(crate) fn merged(path: &Path) -> Result<(), DocumentError> {
    match length(&companion(&resolved(path), "-wal")) {
        Some(1..) => Err(DocumentError::Unmerged(path.to_owned())),
        _ => Ok(()),
    }
}

/// True if a painting is to be created at this path.
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
        return match length(&companion(path, "-wal")) {
            Some(1..) => Err(DocumentError::Damaged("the file is empty".to_owned())),
            _ => Ok(true),
        };
    }
    if length(&companion(path, "-journal")).is_some_and(|length| length > 0) {
        // Power was lost while it was created: SQLite rolls that back.
        return Ok(false);
    }
    let mut head = [0; 100];
    let whole = read_head(path, &mut head)? == head.len();
    match whole {
        true if head.starts_with(MAGIC) && head[WRITE_VERSION] == ROLLBACK => {
            if schema::is_foreign(path)? {
                Err(DocumentError::NoPainting)
            } else {
                Ok(false)
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
/// Write version of a file that never had a write-ahead log, as every new painting.
const ROLLBACK: u8 = 1;

/// True if these may be the first bytes of a painting, a few of them damaged.
fn damaged_head(head: &[u8]) -> bool {
    head.iter()
        .zip(MAGIC)
        .filter(|(one, other)| one == other)
        .count()
        >= 8
}

impl Database {
    /// Connection to the file, for rows without a method here.
    #[must_use]
    pub fn connection(&self) -> &Connection {
        &self.connection
    }

    /// zstd level of the data written.
    #[must_use]
    pub fn level(&self) -> i32 {
        self.level
    }

    /// Opens a painting; `vfs` is the name of the SQLite VFS, if not the default. The flag is true if it was created.
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
            return Err(if path.exists() {
                DocumentError::NoPainting
            } else {
                DocumentError::Missing
            });
        }
        let flags = OpenFlags::SQLITE_OPEN_READ_WRITE
            | OpenFlags::SQLITE_OPEN_NO_MUTEX
            | OpenFlags::SQLITE_OPEN_CREATE;
        let was_unclosed =
            length(&companion(&resolved(path), "-wal")).is_some_and(|length| length > 0);
        let mut database = Self {
            connection: connect(path, flags, vfs)?,
            level: planes::LEVEL,
            probe: None,
            _registered: FileId::of(path).ok().map(OpenDatabase::new),
            was_unclosed,
        };
        match database.lock(path) {
            Err(DocumentError::ReadOnly(_)) if access == Access::Read => {
                database = Self::open_immutable(path)?;
            }
            Err(DocumentError::InUse { .. }) => {
                return Err(DocumentError::InUse {
                    holder: lock_holder(path),
                });
            }
            locked => {
                locked?;
                database.probe = Probe::new(path);
            }
        }
        match database.set_up(new, access) {
            Ok(new) => Ok((database, new)),
            Err(error) => {
                database.close_unchanged().ok();
                Err(error)
            }
        }
    }

    /// Creates the tables of a new painting, or migrates an older one; true if it is new.
    fn set_up(&self, new: bool, access: Access) -> Result<bool, DocumentError> {
        // A crash may have come before its tables were written.
        let new = new || (access == Access::Paint && schema::is_blank(&self.connection)?);
        if new {
            schema::create(&self.connection)?;
        }
        schema::check(&self.connection)?;
        if access == Access::Paint {
            schema::migrate(&self.connection)?;
        }
        Ok(new)
    }

    /// Locks the file for this program and sets its mode of writing.
    fn lock(&self, path: &Path) -> Result<(), DocumentError> {
        let connection = &self.connection;
        // The system may release the locks of a killed program late.
        connection.busy_timeout(std::time::Duration::from_secs(1))?;
        // A damaged painting keeps its journal unchanged.
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

    /// Opens a read-only painting without a journal.
    pub(crate) fn open_immutable(path: &Path) -> Result<Self, DocumentError> {
        if length(&companion(path, "-wal")).is_some_and(|length| length > 0) {
            return Err(DocumentError::ReadOnly(
                "it was not closed, and its journal has to be merged first".to_owned(),
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
            connection: connect(Path::new(&uri), flags, None)?,
            level: planes::LEVEL,
            probe: None,
            _registered: FileId::of(path).ok().map(OpenDatabase::new),
            was_unclosed: false,
        })
    }

    /// Closes the file. An earlier journal stays unchanged; a new one is merged.
    ///
    /// # Errors
    /// The error of SQLite.
    pub fn close_unchanged(self) -> Result<(), DocumentError> {
        if self.was_unclosed {
            self.connection.close().map_err(|(_, error)| error.into())
        } else {
            self.close()
        }
    }

    /// Merges the journal into the file and closes it.
    ///
    /// # Errors
    /// The error of SQLite.
    pub fn close(self) -> Result<(), DocumentError> {
        if !self.connection.is_readonly("main")? {
            match self.try_merge_journal() {
                // The data are safe in the journal, and are merged once there is room.
                Err(DocumentError::Full) => {}
                merged => merged?,
            }
            let keep_journal = DbConfig::SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE;
            self.connection.set_db_config(keep_journal, false)?;
        }
        self.connection.close().map_err(|(_, error)| error.into())
    }

    /// Closes it without touching a file, because other files may have its names.
    pub(crate) fn abandon(self) {
        // The connection leaves the journal as it is, see `lock`.
        if let Err((_, error)) = self.connection.close() {
            tracing::debug!("closing a removed file: {error}");
        }
    }

    /// Merges the journal into the file, as far as there is room, and stays open.
    pub(crate) fn merge_journal(&self) {
        if let Err(error) = self.try_merge_journal() {
            tracing::debug!("the journal is not merged: {error}");
        }
    }

    /// Merges the journal into the file, and stays open.
    ///
    /// # Errors
    /// The reason why it cannot be merged, from SQLite.
    pub(crate) fn try_merge_journal(&self) -> Result<(), DocumentError> {
        let query = "PRAGMA wal_checkpoint(TRUNCATE)";
        Ok(self.connection.query_row(query, params![], |_| Ok(()))?)
    }

    /// Writes its content, including the journal, to a new file.
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

    /// The error, or the disk's where that is the cause of apparent damage.
    pub(crate) fn judged(&self, error: DocumentError) -> DocumentError {
        match &self.probe {
            Some(probe) => probe.judged(error),
            None => error,
        }
    }

    /// Planes of a page.
    ///
    /// # Errors
    /// [`DocumentError::Damaged`] if it is not intact, or the error of SQLite.
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
        if page_checksum(id, [base, depth, slots], &data) != sum {
            return Err(damaged("does not match its checksum"));
        }
        let base = match base {
            0 => None,
            base => Some(self.planes_at(base as u64, left - 1)?),
        };
        planes::decode(slots as u64, &data, base.as_ref())
            .map_err(|defect| damaged(&defect.to_string()))
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
        if load_checksum(id, &data) != sum {
            return Err(damaged("does not match its checksum"));
        }
        loads::decode(&data).map_err(|defect| damaged(&defect.to_string()))
    }

    /// Checks that it has the tables of this version: an unlocked file is not migrated.
    ///
    /// # Errors
    /// [`DocumentError::NoPainting`] if not, [`DocumentError::Altered`], or the error of SQLite.
    pub(crate) fn is_of_this_version(&self) -> Result<(), DocumentError> {
        schema::check(&self.connection)?;
        if schema::has_record(&self.connection)? {
            Ok(())
        } else {
            Err(DocumentError::NoPainting)
        }
    }

    /// A displayed tile of a version, whatever its light; `None` if it is absent or damaged.
    pub(crate) fn shown_under_any_look(&self, place: i64, version: i64) -> Option<Vec<u8>> {
        let query = "SELECT look FROM shown WHERE place = ?1 AND version = ?2";
        let mut statement = self.connection.prepare_cached(query).ok()?;
        let look = statement.query_row(params![place, version], |row| row.get(0));
        self.shown(place, version, look.ok()?)
    }

    /// A displayed tile; `None` if it is absent or damaged.
    #[must_use]
    pub fn shown(&self, place: i64, version: i64, look: i64) -> Option<Vec<u8>> {
        let query = "SELECT data, sum FROM shown WHERE place = ?1 AND version = ?2 AND look = ?3";
        let mut statement = self.connection.prepare_cached(query).ok()?;
        let row = statement.query_row(params![place, version, look], |row| {
            Ok((row.get::<_, Vec<u8>>(0)?, row.get::<_, i64>(1)?))
        });
        let (data, sum) = row.ok()?;
        (shown_checksum(place, version, look, &data) == sum).then_some(data)
    }
}

/// Process that holds the lock of a file, if the system reports it. The file is not opened: closing it again would drop
/// this process's own locks.
#[must_use]
pub fn lock_holder(path: &Path) -> Option<i32> {
    use std::os::unix::fs::MetadataExt as _;
    // Bytes that SQLite locks: pending, reserved and shared, from 1 GiB on.
    const LOCKED: std::ops::Range<u64> = 0x4000_0000..0x4000_0200;
    let inode = std::fs::metadata(path).ok()?.ino();
    let locks = std::fs::read_to_string("/proc/locks").ok()?;
    let holder = locks.lines().find_map(|line| {
        // 1: POSIX  ADVISORY  WRITE 4242 08:01:131090 1073741824 1073742335
        let words: Vec<&str> = line.split_whitespace().collect();
        let [_, "POSIX", _, _, process, file, from, _] = words[..] else {
            return None;
        };
        let is_this_file = file.rsplit(':').next()?.parse() == Ok(inode);
        let is_lock = LOCKED.contains(&from.parse().ok()?);
        (is_this_file && is_lock).then(|| process.parse().ok())?
    });
    holder.filter(|process| *process > 0)
}
