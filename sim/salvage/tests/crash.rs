//! Commits survive a power cut, and the check detects their loss.

#[path = "../../document/tests/crash_vfs/mod.rs"]
mod crash_vfs;

use std::collections::BTreeSet;
use std::io::Cursor;
use std::path::Path;

use crash_vfs::{FileKind, FileOperation, Image, Log, VFS, watch, watch_by_default};
use maulstick_salvage::sqlite::{Scan, Value};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng as _;
use rusqlite::{Connection, OpenFlags, params};

/// Rows of each transaction.
const ROWS: i64 = 3;

/// Commits of a session: for each transaction, from 1 on, the points of the log at which its commit began and returned.
struct Session {
    log: Log,
    called: Vec<usize>,
    returned: Vec<usize>,
}

/// Bytes of row `row`: up to three pages, by the row's number.
fn body(row: i64) -> Vec<u8> {
    let mut body = vec![0; 10 + (row * 7919 % 9000) as usize];
    Pcg32::new(row.cast_unsigned(), 1).fill_bytes(&mut body);
    body
}

fn open(path: &Path, synchronous: &str) -> Connection {
    let db = Connection::open_with_flags_and_vfs(path, OpenFlags::default(), VFS).expect("opens");
    db.execute_batch(&format!(
        "PRAGMA locking_mode = EXCLUSIVE; PRAGMA journal_mode = WAL;
         PRAGMA synchronous = {synchronous}; PRAGMA wal_autocheckpoint = 40;
         CREATE TABLE IF NOT EXISTS numbered (row INTEGER PRIMARY KEY, body BLOB);"
    ))
    .expect("is made");
    db
}

/// Commits transactions in two connections, one after the other.
fn session(synchronous: &str) -> Session {
    let dir = tempfile::tempdir().expect("a directory");
    let path = dir.path().join("a.maul");
    let log = watch(&path);
    let mut session = Session {
        log: log.clone(),
        called: Vec::new(),
        returned: Vec::new(),
    };
    for _ in 0..2 {
        let mut db = open(&path, synchronous);
        for _ in 0..40 {
            let first = session.returned.len() as i64 * ROWS;
            session.called.push(log.point());
            let transaction = db.transaction().expect("begins");
            for row in first..first + ROWS {
                let insert = "INSERT INTO numbered VALUES (?, ?)";
                transaction
                    .execute(insert, params![row, body(row)])
                    .expect("is stored");
            }
            transaction.commit().expect("is committed");
            session.returned.push(log.point());
        }
    }
    session
}

/// A fault of an image.
#[derive(Debug, PartialEq)]
enum Wrong {
    /// SQLite finds the database damaged.
    Database(String),
    /// This row has another content.
    Row(i64),
    /// Other rows are there than were committed.
    Commits { found: usize, due: usize },
    /// A scan finds fewer rows than there are.
    Scan(usize, usize),
}

impl Session {
    /// What is wrong with an image of the files at `point`: SQLite must open it, find it whole, and
    /// find in it the rows of all transactions committed by then, and of none that was begun later
    /// or only in part. A scan must find the same rows.
    fn check(&self, image: &Image, point: usize) -> Result<(), Wrong> {
        let dir = tempfile::tempdir().expect("a directory");
        image.write_to(dir.path(), "b.maul");
        let failed = |error: rusqlite::Error| Wrong::Database(error.to_string());
        let db = Connection::open(dir.path().join("b.maul")).map_err(failed)?;
        let whole: String = db
            .query_row("PRAGMA integrity_check(1)", [], |row| row.get(0))
            .map_err(failed)?;
        if whole != "ok" {
            return Err(Wrong::Database(whole));
        }
        let rows = if db.table_exists(None, "numbered").map_err(failed)? {
            let mut rows = db
                .prepare("SELECT row, body FROM numbered ORDER BY row")
                .map_err(failed)?;
            let rows = rows
                .query_map([], |row| Ok((row.get(0)?, row.get(1)?)))
                .map_err(failed)?;
            rows.collect::<Result<Vec<(i64, Vec<u8>)>, _>>()
                .map_err(failed)?
        } else {
            Vec::new()
        };
        if let Some((row, _)) = rows.iter().zip(0..).find_map(|((row, bytes), number)| {
            (*row != number || *bytes != body(number)).then_some((row, number))
        }) {
            return Err(Wrong::Row(*row));
        }
        let due = self.returned.iter().filter(|at| **at <= point).count() * ROWS as usize;
        let most = self.called.iter().filter(|at| **at < point).count() * ROWS as usize;
        if !(due..=most.max(due)).contains(&rows.len()) || rows.len() % ROWS as usize != 0 {
            let found = rows.len();
            return Err(Wrong::Commits { found, due });
        }
        let wal = image.wal.as_deref().map(Cursor::new);
        let mut scan = Scan::new(Cursor::new(image.main.as_slice()), wal).expect("memory");
        let scanned: BTreeSet<i64> = scan
            .rows()
            .filter(|row| row.current)
            .filter(|row| row.values == [Value::Null, Value::Blob(body(row.rowid))])
            .map(|row| row.rowid)
            .collect();
        if !rows.iter().all(|(row, _)| scanned.contains(row)) {
            return Err(Wrong::Scan(scanned.len(), rows.len()));
        }
        Ok(())
    }

    /// What was wrong after power cuts at 100 points.
    fn cut_at_random(&self, seed: u64) -> Vec<(usize, Wrong)> {
        let mut random = Pcg32::new(seed, 2);
        let mut wrong = Vec::new();
        for _ in 0..100 {
            let point = random.next_u32() as usize % (self.log.point() + 1);
            let image = self.log.image(&mut random, point);
            wrong.extend(self.check(&image, point).err().map(|error| (point, error)));
        }
        wrong
    }
}

#[test]
fn committed_rows_outlive_a_power_cut_at_any_point() {
    let session = session("FULL");
    let ops = session.log.ops();
    let counts = [FileKind::Main, FileKind::Wal, FileKind::Journal].map(|kind| {
        let syncs = ops
            .iter()
            .filter(|op| op.file == kind && op.operation == FileOperation::Sync);
        syncs.count()
    });
    assert!(
        counts[0] > 5,
        "checkpoints are among the points: {counts:?}"
    );
    assert!(
        counts[1] >= session.returned.len(),
        "each commit is synced: {counts:?}"
    );
    assert!(
        counts[2] > 0,
        "so is the journal of the first transaction: {counts:?}"
    );
    assert_eq!(session.cut_at_random(1), []);
}

#[test]
fn commits_that_are_not_synced_are_found_out() {
    let session = session("OFF");
    let wrong = session.cut_at_random(1);
    assert!(wrong.len() > 50, "{wrong:?}");
    let lost = wrong
        .iter()
        .filter(|(_, wrong)| matches!(wrong, Wrong::Commits { .. }));
    assert!(lost.count() > 0, "{wrong:?}");
}

/// With `synchronous = NORMAL` a commit is not synced: the files stay whole, the rows do not.
#[test]
fn commits_that_are_only_ordered_are_found_out() {
    let session = session("NORMAL");
    let wrong = session.cut_at_random(1);
    assert!(!wrong.is_empty());
    assert!(
        wrong
            .iter()
            .all(|(_, wrong)| matches!(wrong, Wrong::Commits { .. })),
        "{wrong:?}"
    );
}

#[test]
fn an_image_without_losses_is_the_files_themselves() {
    let dir = tempfile::tempdir().expect("a directory");
    let path = dir.path().join("a.maul");
    let log = watch_by_default(&path);
    let db = Connection::open(&path).expect("opens through the default VFS");
    let made = "PRAGMA journal_mode = DELETE; PRAGMA synchronous = EXTRA;
        CREATE TABLE t (n); INSERT INTO t VALUES (1), (2)";
    db.execute_batch(made).expect("is made");
    let mut random = Pcg32::new(1, 2);
    assert!(log.point() > 0);
    assert_eq!(log.image(&mut random, log.point()), Image::read_from(&path));
    assert_eq!(log.image(&mut random, 0), Image::default());
    // Contents at the beginning of the watch count as synced.
    let again = watch(&path);
    assert_eq!(again.image(&mut random, 0), Image::read_from(&path));
}
