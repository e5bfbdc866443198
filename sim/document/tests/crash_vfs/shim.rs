//! The VFS itself: it passes everything to the default one and logs changes of files. "The SQLite OS Interface or VFS",
//! <https://sqlite.org/vfs.html>.

#![allow(
    unsafe_code,
    reason = "SQLite calls a VFS through C function pointers with pointers to its own structures"
)]

use std::ffi::{CStr, OsStr, c_char, c_int, c_void};
use std::os::unix::ffi::OsStrExt as _;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock, PoisonError};

use rusqlite::ffi;

use super::{FileKind, FileOperation, Log, Refused};

/// The VFS's name.
pub(super) const NAME: &CStr = c"crash";

/// The main files that are watched.
static WATCHED: Mutex<Vec<(PathBuf, Log)>> = Mutex::new(Vec::new());

/// Rank of the VFS among those of connections that name none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Rank {
    Named,
    Default,
}

/// An open file that is watched; the base VFS's own structure follows it in memory.
#[repr(C)]
struct CrashFile {
    base: ffi::sqlite3_file,
    /// A box that the file owns.
    watched: *mut Watched,
}

struct Watched {
    file: FileKind,
    log: Log,
    /// True if the unix VFS also syncs the directory with the next sync: it does with the first of each log or journal
    /// that it opens (`UNIXFILE_DIRSYNC` in SQLite's `os_unix.c`).
    syncs_directory: bool,
}

/// The registered VFS, which SQLite keeps for as long as the process lives.
struct Vfs(*mut ffi::sqlite3_vfs);

// SAFETY: the structure is not changed after it is registered but by SQLite under its own lock.
unsafe impl Send for Vfs {}
// SAFETY: as above.
unsafe impl Sync for Vfs {}

/// Version 1 of the methods: no shared memory, which a WAL under `locking_mode = EXCLUSIVE` does
/// without, and no memory-mapped reading.
static METHODS: ffi::sqlite3_io_methods = ffi::sqlite3_io_methods {
    iVersion: 1,
    xClose: Some(close),
    xRead: Some(read),
    xWrite: Some(write),
    xTruncate: Some(truncate),
    xSync: Some(sync),
    xFileSize: Some(file_size),
    xLock: Some(lock),
    xUnlock: Some(unlock),
    xCheckReservedLock: Some(check_reserved_lock),
    xFileControl: Some(file_control),
    xSectorSize: Some(sector_size),
    xDeviceCharacteristics: Some(device_characteristics),
    xShmMap: None,
    xShmLock: None,
    xShmBarrier: None,
    xShmUnmap: None,
    xFetch: None,
    xUnfetch: None,
};

/// Registers the VFS, again with another rank if necessary.
pub(super) fn register(rank: Rank) {
    static VFS: OnceLock<Vfs> = OnceLock::new();
    let mut is_new = false;
    let vfs = VFS.get_or_init(|| {
        is_new = true;
        // SAFETY: the default VFS is found before this one can be it, and lives as long as the
        // process. Methods that are not replaced are its own; of the structure that they are called
        // with, which is this copy, the unix VFS's read nothing but the length of paths.
        unsafe {
            let base = ffi::sqlite3_vfs_find(std::ptr::null());
            assert!(!base.is_null(), "SQLite has a default VFS");
            let mut vfs = *base;
            vfs.iVersion = 1;
            vfs.szOsFile += size_of::<CrashFile>() as c_int;
            vfs.pNext = std::ptr::null_mut();
            vfs.zName = NAME.as_ptr();
            vfs.pAppData = base.cast();
            vfs.xOpen = Some(open);
            vfs.xDelete = Some(delete);
            Vfs(Box::into_raw(Box::new(vfs)))
        }
    });
    if is_new || rank == Rank::Default {
        // SAFETY: the structure is complete and is never freed.
        let code = unsafe { ffi::sqlite3_vfs_register(vfs.0, c_int::from(rank == Rank::Default)) };
        assert_eq!(code, ffi::SQLITE_OK, "the VFS is registered");
    }
}

/// Logs later operations on the database at `main` into `log`.
pub(super) fn watch(main: &Path, log: &Log) {
    let name = main.file_name().expect("a file's name");
    let dir = main.parent().filter(|dir| !dir.as_os_str().is_empty());
    let dir = dir.unwrap_or(Path::new(".")).canonicalize();
    let main = dir.expect("the directory is there").join(name);
    let mut watched = WATCHED.lock().unwrap_or_else(PoisonError::into_inner);
    watched.retain(|(other, _)| *other != main);
    watched.push((main, log.clone()));
}

/// Watcher of the file that SQLite calls `name`.
///
/// # Safety
/// `name` is null or a string.
unsafe fn watched(name: *const c_char) -> Option<Watched> {
    if name.is_null() {
        return None;
    }
    // SAFETY: the caller's.
    let name = unsafe { CStr::from_ptr(name) }.to_bytes();
    let (main, file) = if let Some(main) = name.strip_suffix(b"-wal") {
        (main, FileKind::Wal)
    } else if let Some(main) = name.strip_suffix(b"-journal") {
        (main, FileKind::Journal)
    } else {
        (name, FileKind::Main)
    };
    let main = Path::new(OsStr::from_bytes(main));
    let all = WATCHED.lock().unwrap_or_else(PoisonError::into_inner);
    let (_, log) = all.iter().find(|(path, _)| path == main)?;
    Some(Watched {
        file,
        log: log.clone(),
        syncs_directory: file != FileKind::Main,
    })
}

/// The base VFS's file behind this one's.
///
/// # Safety
/// `file` was opened by [`open`].
unsafe fn inner(file: *mut ffi::sqlite3_file) -> *mut ffi::sqlite3_file {
    // SAFETY: SQLite reserved `szOsFile` bytes, and `CrashFile` is as aligned as pointers are.
    unsafe { file.cast::<CrashFile>().add(1).cast() }
}

/// Logs an operation on `file`, if it succeeded.
///
/// # Safety
/// `file` was opened by [`open`].
unsafe fn note(
    file: *mut ffi::sqlite3_file,
    code: c_int,
    operation: impl FnOnce() -> FileOperation,
) {
    // SAFETY: `watched` is a box that lives until `close`.
    let watched = unsafe { (*file.cast::<CrashFile>()).watched.as_mut() };
    if let (ffi::SQLITE_OK, Some(watched)) = (code, watched) {
        let operation = operation();
        let syncs_directory =
            operation == FileOperation::Sync && std::mem::take(&mut watched.syncs_directory);
        watched.log.note(watched.file, operation);
        if syncs_directory {
            watched.log.note(watched.file, FileOperation::SyncDirectory);
        }
    }
}

unsafe extern "C" fn open(
    vfs: *mut ffi::sqlite3_vfs,
    name: ffi::sqlite3_filename,
    file: *mut ffi::sqlite3_file,
    flags: c_int,
    out_flags: *mut c_int,
) -> c_int {
    // SAFETY: SQLite gives `szOsFile` bytes at `file`; `pAppData` is the base VFS.
    unsafe {
        let base: *mut ffi::sqlite3_vfs = (*vfs).pAppData.cast();
        let Some(base_open) = (*base).xOpen else {
            return ffi::SQLITE_CANTOPEN;
        };
        let Some(watched) = watched(name) else {
            return base_open(base, name, file, flags, out_flags);
        };
        let inner = inner(file);
        (*file).pMethods = std::ptr::null();
        if watched.log.refuses(watched.file, Refused::Opening) {
            return ffi::SQLITE_CANTOPEN;
        }
        (*inner).pMethods = std::ptr::null();
        let code = base_open(base, name, inner, flags, out_flags);
        if !(*inner).pMethods.is_null() {
            file.cast::<CrashFile>().write(CrashFile {
                base: ffi::sqlite3_file {
                    pMethods: &raw const METHODS,
                },
                watched: Box::into_raw(Box::new(watched)),
            });
        }
        code
    }
}

unsafe extern "C" fn delete(
    vfs: *mut ffi::sqlite3_vfs,
    name: *const c_char,
    sync_dir: c_int,
) -> c_int {
    // SAFETY: `pAppData` is the base VFS; `name` is SQLite's.
    unsafe {
        let base: *mut ffi::sqlite3_vfs = (*vfs).pAppData.cast();
        let Some(base_delete) = (*base).xDelete else {
            return ffi::SQLITE_IOERR_DELETE;
        };
        let code = base_delete(base, name, sync_dir);
        if let (ffi::SQLITE_OK, Some(watched)) = (code, watched(name)) {
            watched.log.note(watched.file, FileOperation::Delete);
            if sync_dir != 0 {
                watched.log.note(watched.file, FileOperation::SyncDirectory);
            }
        }
        code
    }
}

/// Calls the base file's method of the same name.
macro_rules! base {
    ($file:expr, $method:ident $(, $argument:expr)*) => {{
        // SAFETY: `open` gave the file its methods only where the base file has its own.
        unsafe {
            let inner = inner($file);
            match (*(*inner).pMethods).$method {
                Some(method) => method(inner $(, $argument)*),
                None => ffi::SQLITE_IOERR,
            }
        }
    }};
}

/// Methods that do nothing but call the base file's.
macro_rules! pass {
    ($($name:ident = $method:ident($($argument:ident: $type:ty),*);)*) => {
        $(unsafe extern "C" fn $name(file: *mut ffi::sqlite3_file $(, $argument: $type)*) -> c_int {
            base!(file, $method $(, $argument)*)
        })*
    };
}

pass! {
    file_size = xFileSize(size: *mut ffi::sqlite3_int64);
    lock = xLock(level: c_int);
    unlock = xUnlock(level: c_int);
    check_reserved_lock = xCheckReservedLock(out: *mut c_int);
    file_control = xFileControl(op: c_int, argument: *mut c_void);
    sector_size = xSectorSize();
}

/// The base's, but for batches of writes that a file system makes atomic: the log knows of none.
unsafe extern "C" fn device_characteristics(file: *mut ffi::sqlite3_file) -> c_int {
    base!(file, xDeviceCharacteristics) & !ffi::SQLITE_IOCAP_BATCH_ATOMIC
}

unsafe extern "C" fn close(file: *mut ffi::sqlite3_file) -> c_int {
    let code = base!(file, xClose);
    // SAFETY: the box is the file's own, and SQLite does not use the file again.
    drop(unsafe { Box::from_raw((*file.cast::<CrashFile>()).watched) });
    code
}

/// True where this is refused of a file.
///
/// # Safety
/// `file` was opened by [`open`].
unsafe fn refuses(file: *mut ffi::sqlite3_file, refused: Refused) -> bool {
    // SAFETY: `watched` is a box that lives until `close`.
    let watched = unsafe { (*file.cast::<CrashFile>()).watched.as_ref() };
    watched.is_some_and(|watched| watched.log.refuses(watched.file, refused))
}

/// True where the disk fails.
///
/// # Safety
/// `file` was opened by [`open`].
unsafe fn fails(file: *mut ffi::sqlite3_file) -> bool {
    // SAFETY: the caller's.
    unsafe { refuses(file, Refused::Everything) }
}

unsafe extern "C" fn read(
    file: *mut ffi::sqlite3_file,
    buffer: *mut c_void,
    bytes: c_int,
    offset: ffi::sqlite3_int64,
) -> c_int {
    // SAFETY: the file is open.
    if unsafe { fails(file) || refuses(file, Refused::Reads) } {
        // As the unix VFS says it of a disk that does not answer (`ETIMEDOUT`). Of `EIO` it says `SQLITE_IOERR_CORRUPTFS`, from
        // which SQLite concludes that the database is malformed; that takes a look at the file itself, not at this one.
        return ffi::SQLITE_IOERR_READ;
    }
    base!(file, xRead, buffer, bytes, offset)
}

unsafe extern "C" fn write(
    file: *mut ffi::sqlite3_file,
    buffer: *const c_void,
    bytes: c_int,
    offset: ffi::sqlite3_int64,
) -> c_int {
    // SAFETY: `watched` is a box that lives until `close`.
    let watched = unsafe { (*file.cast::<CrashFile>()).watched.as_ref() };
    if watched.is_some_and(|watched| watched.log.refuses(watched.file, Refused::Writes)) {
        return ffi::SQLITE_FULL;
    }
    // SAFETY: the file is open.
    if unsafe { fails(file) } {
        return ffi::SQLITE_IOERR_WRITE;
    }
    let code = base!(file, xWrite, buffer, bytes, offset);
    // SAFETY: SQLite gives `bytes` bytes at `buffer`.
    unsafe {
        note(file, code, || FileOperation::Write {
            offset: offset.cast_unsigned(),
            bytes: std::slice::from_raw_parts(buffer.cast(), bytes.cast_unsigned() as usize)
                .to_vec(),
        });
    }
    code
}

unsafe extern "C" fn truncate(file: *mut ffi::sqlite3_file, size: ffi::sqlite3_int64) -> c_int {
    // SAFETY: the file is open.
    if unsafe { fails(file) } {
        return ffi::SQLITE_IOERR_TRUNCATE;
    }
    let code = base!(file, xTruncate, size);
    // SAFETY: the file is open.
    unsafe { note(file, code, || FileOperation::Truncate(size.cast_unsigned())) };
    code
}

unsafe extern "C" fn sync(file: *mut ffi::sqlite3_file, flags: c_int) -> c_int {
    // SAFETY: the file is open.
    if unsafe { fails(file) } {
        return ffi::SQLITE_IOERR_FSYNC;
    }
    let code = base!(file, xSync, flags);
    // SAFETY: the file is open.
    unsafe { note(file, code, || FileOperation::Sync) };
    code
}
