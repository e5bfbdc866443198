//! Packing: makes a painting's file as small as possible.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use rusqlite::params;

use crate::checkpoint::Checkpoint;
use crate::document::{Document, DocumentSettings};
use crate::error::DocumentError;
use crate::file::database::{Access, Database};
use crate::tables::checksum::page_checksum;
use crate::tables::planes;

/// Parts that a packed painting leaves out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Forget {
    /// Keeps all parts.
    Nothing,
    /// The record of the painting; a new one begins.
    Record,
    /// The steps of its history, and the record, which may undo them; versions stay.
    History,
}

/// Number of pages recompressed in one transaction.
const BATCH: usize = 256;

/// Packs a painting; returns the size of its file before and after, bytes. Each step is a transaction of SQLite, so the
/// painting is intact whenever it is interrupted.
///
/// # Errors
/// Any [`DocumentError`].
pub fn pack(
    path: &Path,
    forget: Forget,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<[u64; 2], DocumentError> {
    if !path.exists() {
        return Err(DocumentError::Missing);
    }
    replay_journal(path, forget)?;
    let before = std::fs::metadata(path)?.len();
    let (database, _) = Database::open(path, Access::Paint, None)?;
    let pages: Vec<i64> = {
        let mut statement = database
            .connection
            .prepare("SELECT id FROM page ORDER BY id")?;
        let rows = statement.query_map(params![], |row| row.get(0))?;
        rows.collect::<Result<_, _>>()?
    };
    let all = pages.len() as u64 + 1;
    for (batch, ids) in pages.chunks(BATCH).enumerate() {
        database.connection.execute_batch("BEGIN IMMEDIATE")?;
        compress(&database, ids)?;
        progress((batch * BATCH + ids.len()) as u64, all);
        database.connection.execute_batch("COMMIT")?;
    }
    // SQLite's copy of the painting may be larger than memory.
    database
        .connection
        .execute_batch("PRAGMA temp_store = FILE; VACUUM")?;
    progress(all, all);
    database.close()?;
    Ok([before, std::fs::metadata(path)?.len()])
}

/// Replays the journal of a closed painting and writes the result; deletes the parts in `forget`.
///
/// # Errors
/// Any [`DocumentError`].
pub fn replay_journal(path: &Path, forget: Forget) -> Result<(), DocumentError> {
    let (document, opened) = Document::open(&DocumentSettings::new(path, Access::Paint))?;
    let Some(opened) = opened else {
        return document.close();
    };
    let since = opened.snapshot().versions;
    let mut sequencer = opened
        .sequencer()
        .map_err(|refusal| DocumentError::Damaged(refusal.to_string()))?;
    if let Some(fault) = document.pager().fault() {
        return Err(DocumentError::Damaged(fault.to_owned()));
    }
    match forget {
        Forget::Nothing => {}
        Forget::Record => sequencer.painting_mut().break_record(),
        Forget::History => sequencer.painting_mut().forget_history(),
    }
    document.write_checkpoint(Checkpoint::of(&mut sequencer, since));
    document.flush();
    if !document.is_ready() {
        return document.close();
    }
    // Pages of deleted parts are removed with the next checkpoint.
    let versions = sequencer.painting().versions();
    document.write_checkpoint(Checkpoint::of(&mut sequencer, versions));
    document.close()
}

/// Row of a page.
struct Row {
    id: u64,
    /// Base, depth and slots.
    ints: [i64; 3],
    data: Vec<u8>,
    sum: i64,
}

impl Row {
    fn read(database: &Database, id: i64) -> Result<Self, DocumentError> {
        let query = "SELECT base, depth, slots, data, sum FROM page WHERE id = ?1";
        let mut statement = database.connection.prepare_cached(query)?;
        Ok(statement.query_row(params![id], |row| {
            Ok(Self {
                id: id as u64,
                ints: [row.get(0)?, row.get(1)?, row.get(2)?],
                data: row.get(3)?,
                sum: row.get(4)?,
            })
        })?)
    }

    /// Recompressed data and their checksum, if they are smaller. The input of the compression is equal at every level,
    /// so the page's base is not read.
    fn recompressed(&self) -> Result<Option<(Vec<u8>, i64)>, DocumentError> {
        let damaged = |what: &str| DocumentError::Damaged(format!("page {} {what}", self.id));
        if page_checksum(self.id, self.ints, &self.data) != self.sum {
            return Err(damaged("does not match its checksum"));
        }
        let packed = planes::repack(self.ints[2] as u64, &self.data, planes::PACKED_LEVEL);
        let packed = packed.map_err(|defect| damaged(&defect.to_string()))?;
        let sum = page_checksum(self.id, self.ints, &packed);
        Ok((packed.len() < self.data.len()).then_some((packed, sum)))
    }
}

/// Recompresses pages, on all cores.
fn compress(database: &Database, ids: &[i64]) -> Result<(), DocumentError> {
    let rows = ids.iter().map(|id| Row::read(database, *id));
    let rows = rows.collect::<Result<Vec<Row>, _>>()?;
    let next = AtomicUsize::new(0);
    let work = || -> Result<Vec<_>, DocumentError> {
        let mut smaller = Vec::new();
        while let Some(row) = rows.get(next.fetch_add(1, Relaxed)) {
            smaller.extend(row.recompressed()?.map(|packed| (row.id, packed)));
        }
        Ok(smaller)
    };
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let smaller: Result<Vec<_>, DocumentError> = std::thread::scope(|scope| {
        let others: Vec<_> = (1..cores).map(|_| scope.spawn(work)).collect();
        let mut smaller = work()?;
        for other in others {
            let panicked = |_| DocumentError::Other("internal error: packing panicked".to_owned());
            smaller.extend(other.join().map_err(panicked)??);
        }
        Ok(smaller)
    });
    for (id, (data, sum)) in smaller? {
        database
            .connection
            .prepare_cached("UPDATE page SET data = ?2, sum = ?3 WHERE id = ?1")?
            .execute(params![id as i64, data, sum])?;
    }
    Ok(())
}
