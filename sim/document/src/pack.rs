//! A painting's file made as small as it gets.

use std::path::Path;

use maulstick_paint::tile::Planes;
use rusqlite::params;

use crate::database::{Access, Database, page_sum};
use crate::document::{Document, DocumentSettings};
use crate::error::DocumentError;
use crate::planes;
use crate::writing::Moment;

/// What becomes of a packed painting's history.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum History {
    /// It stays.
    Kept,
    /// Its steps go; versions stay.
    Forgotten,
}

/// Pages that are compressed anew in one transaction.
const BATCH: usize = 256;

/// Packs a painting; returns the bytes of its file before and after. Each step of it is a transaction
/// of SQLite: whenever it is stopped, the painting is whole.
///
/// # Errors
/// Any [`DocumentError`].
pub fn pack(
    path: &Path,
    history: History,
    tell: &mut dyn FnMut(u64, u64),
) -> Result<[u64; 2], DocumentError> {
    if !path.exists() {
        return Err(DocumentError::Missing);
    }
    settle(path, history)?;
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
        for (place, id) in ids.iter().enumerate() {
            compress(&database, *id)?;
            tell((batch * BATCH + place) as u64, all);
        }
        database.connection.execute_batch("COMMIT")?;
    }
    // Its copy of the painting may take more room than there is memory.
    database
        .connection
        .execute_batch("PRAGMA temp_store = FILE; VACUUM")?;
    tell(all, all);
    database.close()?;
    Ok([before, std::fs::metadata(path)?.len()])
}

/// Does again what was left to be done again, and writes it; forgets the history if it is to go.
pub(crate) fn settle(path: &Path, history: History) -> Result<(), DocumentError> {
    let (document, opened) = Document::open(&DocumentSettings::new(path, Access::Paint))?;
    let Some(opened) = opened else {
        return document.close();
    };
    let since = opened.kept().versions;
    let mut sequencer = opened
        .sequencer()
        .map_err(|refusal| DocumentError::Damaged(refusal.what))?;
    if let Some(fault) = document.pager().fault() {
        return Err(DocumentError::Damaged(fault.to_owned()));
    }
    if history == History::Forgotten {
        sequencer.painting_mut().forget_history();
    }
    document.keep(Moment::of(&mut sequencer, since));
    document.flush();
    if !document.is_ready() {
        return document.close();
    }
    // What was forgotten goes with the next moment.
    let versions = sequencer.painting().versions();
    document.keep(Moment::of(&mut sequencer, versions));
    document.close()
}

fn compress(database: &Database, id: i64) -> Result<(), DocumentError> {
    let (base, depth, data): (i64, i64, Vec<u8>) = database
        .connection
        .prepare_cached("SELECT base, depth, data FROM page WHERE id = ?1")?
        .query_row(params![id], |row| {
            Ok((row.get(0)?, row.get(1)?, row.get(2)?))
        })?;
    let content: Planes = database.planes(id as u64)?;
    let under = match base {
        0 => None,
        base => Some(database.planes(base as u64)?),
    };
    let packed = planes::encode(&content, under.as_ref(), planes::PACKED_LEVEL)?;
    if packed.len() >= data.len() {
        return Ok(());
    }
    let slots = i64::from(planes::mask(&content));
    let sum = page_sum(id as u64, [base, depth, slots], &packed);
    database
        .connection
        .prepare_cached("UPDATE page SET data = ?2, sum = ?3 WHERE id = ?1")?
        .execute(params![id, packed, sum])?;
    Ok(())
}
