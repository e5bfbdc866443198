//! Databases after a power cut: a VFS that logs SQLite's operations on its files, and the possible files after a power
//! cut at any point of the log.
//!
//! Everything before a file's last sync survives, and deletions before the directory's. Any part of the later
//! operations may survive: each write entirely, not at all, or in some of its sectors of 512 bytes; truncations and
//! deletions entirely or not at all. A missing write before a surviving one is equivalent to reordering. Bytes beside a
//! write are never damaged, which is the assumption of SQLite's `SQLITE_IOCAP_POWERSAFE_OVERWRITE` and the promise of
//! the unix VFS. Sources: "Atomic Commit In SQLite", <https://sqlite.org/atomiccommit.html>, section 2; "How SQLite Is
//! Tested", section 3.3.

#![allow(
    dead_code,
    reason = "every test binary compiles this module and uses its own part of it"
)]

mod shim;

use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use rand_pcg::rand_core::Rng;

/// Bytes of a disk's sector, which is written whole or not at all.
const SECTOR: usize = 512;

/// The name of the VFS, for `Connection::open_with_flags_and_vfs`.
pub(crate) const VFS: &std::ffi::CStr = shim::NAME;

/// One of a database's files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FileKind {
    Main,
    Wal,
    Journal,
}

/// An operation of SQLite on a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum FileOperation {
    Write {
        offset: u64,
        bytes: Vec<u8>,
    },
    /// Truncation to a number of bytes.
    Truncate(u64),
    Sync,
    Delete,
    /// The directory is synced: all deletions of its files so far.
    SyncDirectory,
}

/// An operation and its file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Op {
    pub(crate) file: FileKind,
    pub(crate) operation: FileOperation,
}

/// SQLite's operations on the files of one database, in order, over any number of connections.
#[derive(Debug, Clone)]
pub(crate) struct Log(Arc<Mutex<Recorded>>);

#[derive(Debug)]
struct Recorded {
    start: Image,
    ops: Vec<Op>,
    refused: Refused,
}

/// Refused operations on a database's main file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Refused {
    Nothing,
    /// Writes, as where the disk is full.
    Writes,
    Opening,
    /// Reads of the main file and its log.
    Reads,
    /// All reads, writes, truncations and syncs of the main file and its log: a failing disk.
    Everything,
}

/// Files of a database; `None` for an absent one.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Image {
    pub(crate) main: Vec<u8>,
    pub(crate) wal: Option<Vec<u8>>,
    pub(crate) journal: Option<Vec<u8>>,
}

/// Logs SQLite's operations on the database at `main` in connections opened through the VFS [`VFS`]. Its current
/// contents count as synced. The VFS offers no shared memory for a watched database, so a WAL needs `locking_mode =
/// EXCLUSIVE` before it; an unwatched one uses the default VFS's files.
pub(crate) fn watch(main: &Path) -> Log {
    shim::register(shim::Rank::Named);
    let log = Log(Arc::new(Mutex::new(Recorded {
        start: Image::read_from(main),
        ops: Vec::new(),
        refused: Refused::Nothing,
    })));
    shim::watch(main, &log);
    log
}

/// [`watch`], with [`VFS`] for every later connection of this process that names no VFS: for code that opens its
/// databases itself.
pub(crate) fn watch_by_default(main: &Path) -> Log {
    shim::register(shim::Rank::Default);
    watch(main)
}

impl Log {
    /// Number of operations so far.
    pub(crate) fn point(&self) -> usize {
        self.recorded().ops.len()
    }

    /// Refuses these operations from now on.
    pub(crate) fn refuse(&self, refused: Refused) {
        self.recorded().refused = refused;
    }

    fn refuses(&self, file: FileKind, refused: Refused) -> bool {
        let own = self.recorded().refused;
        let is_of_all = matches!(own, Refused::Reads | Refused::Everything);
        own == refused && (file == FileKind::Main || is_of_all)
    }

    /// The operations so far.
    pub(crate) fn ops(&self) -> Vec<Op> {
        self.recorded().ops.clone()
    }

    /// Possible files after a power cut after the first `point` operations. `random` decides about the unsynced ones:
    /// none, all, or each by a coin of some bias.
    pub(crate) fn image(&self, random: &mut impl Rng, point: usize) -> Image {
        self.image_with(random, point, |_| true)
    }

    /// [`image`](Self::image) of a disk that does not sync when requested.
    pub(crate) fn image_of_a_liar(&self, random: &mut impl Rng, point: usize) -> Image {
        self.image_with(random, point, |operation| *operation != FileOperation::Sync)
    }

    fn image_with(
        &self,
        random: &mut impl Rng,
        point: usize,
        is_done: impl Fn(&FileOperation) -> bool,
    ) -> Image {
        let recorded = self.recorded();
        let start = recorded.start.clone();
        let file = |kind, content| {
            let ops = recorded
                .ops
                .iter()
                .take(point)
                .filter(|op| is_done(&op.operation));
            let ops =
                ops.filter(|op| op.file == kind || op.operation == FileOperation::SyncDirectory);
            (content, ops.map(|op| &op.operation).collect::<Vec<_>>())
        };
        let [main, wal, journal] = [
            file(FileKind::Main, Some(start.main)),
            file(FileKind::Wal, start.wal),
            file(FileKind::Journal, start.journal),
        ]
        .map(|(content, operations)| cut(random, content, &operations));
        Image {
            main: main.unwrap_or_default(),
            wal,
            journal,
        }
    }

    fn recorded(&self) -> MutexGuard<'_, Recorded> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn note(&self, file: FileKind, operation: FileOperation) {
        self.recorded().ops.push(Op { file, operation });
    }
}

impl Image {
    /// Writes the files into `dir`, the main file as `name`; those of an earlier image are removed.
    pub(crate) fn write_to(&self, dir: &Path, name: &str) {
        std::fs::write(dir.join(name), &self.main).expect("the main file is written");
        for (suffix, bytes) in [("-wal", &self.wal), ("-journal", &self.journal)] {
            let path = dir.join(format!("{name}{suffix}"));
            match bytes {
                Some(bytes) => std::fs::write(path, bytes).expect("the log is written"),
                None if path.exists() => std::fs::remove_file(path).expect("the log is removed"),
                None => {}
            }
        }
    }

    /// The files of the database at `main`.
    pub(crate) fn read_from(main: &Path) -> Self {
        let beside = |suffix: &str| {
            let mut path = main.as_os_str().to_owned();
            path.push(suffix);
            std::fs::read(path).ok()
        };
        Self {
            main: beside("").unwrap_or_default(),
            wal: beside("-wal"),
            journal: beside("-journal"),
        }
    }
}

/// A file with `content` after `operations` and a power cut.
fn cut(
    random: &mut impl Rng,
    content: Option<Vec<u8>>,
    operations: &[&FileOperation],
) -> Option<Vec<u8>> {
    let last = |operation: &FileOperation, operations: &[&FileOperation]| {
        operations.iter().rposition(|other| *other == operation)
    };
    let synced = last(&FileOperation::Sync, operations);
    let directory = last(&FileOperation::SyncDirectory, operations).unwrap_or(0);
    let deleted = last(&FileOperation::Delete, &operations[..directory]);
    let settled = synced.max(deleted).map_or(0, |last| last + 1);
    let (settled, since) = operations.split_at(settled);
    let mut content = content;
    for operation in settled {
        apply(&mut content, operation, |_| true);
    }
    let bias = [0, 1, 2, 3, 4][random.next_u32() as usize % 5];
    for operation in since {
        let mut coin = || random.next_u32() % 4 < bias;
        let is_there = coin();
        match operation {
            FileOperation::Write { .. } if random.next_u32().is_multiple_of(4) => {
                let mut coin = || random.next_u32() % 4 < bias;
                apply(&mut content, operation, |_| coin());
            }
            // The name still refers to the old file: data in a new one are lost with it.
            FileOperation::Delete if !is_there => break,
            _ if is_there => apply(&mut content, operation, |_| true),
            _ => {}
        }
    }
    content
}

/// Applies an operation to a file; of a write only the sectors selected by `sector`.
fn apply(
    content: &mut Option<Vec<u8>>,
    operation: &FileOperation,
    mut sector: impl FnMut(usize) -> bool,
) {
    match operation {
        FileOperation::Write { offset, bytes } => {
            let file = content.get_or_insert_default();
            let mut at = usize::try_from(*offset).expect("a test's file is small");
            let mut rest = bytes.as_slice();
            while !rest.is_empty() {
                let room = SECTOR - at % SECTOR;
                let (run, beyond) = rest.split_at(room.min(rest.len()));
                if sector(at / SECTOR) {
                    let end = at + run.len();
                    file.resize(file.len().max(end), 0);
                    file[at..end].copy_from_slice(run);
                }
                at += run.len();
                rest = beyond;
            }
        }
        FileOperation::Truncate(length) => {
            let length = usize::try_from(*length).expect("a test's file is small");
            content.get_or_insert_default().resize(length, 0);
        }
        FileOperation::Sync | FileOperation::SyncDirectory => {}
        FileOperation::Delete => *content = None,
    }
}
