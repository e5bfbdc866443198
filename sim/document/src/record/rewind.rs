//! Rewinding of a painting to the beginning of its record.

use std::path::Path;

use crate::checkpoint::Checkpoint;
use crate::document::{Document, DocumentSettings};
use crate::error::DocumentError;
use crate::file::database::{Access, Database};

/// Rewinds a closed painting to the beginning of its record; false, with the painting unchanged, without a record that
/// this program can replay. Later paint, history and the record are deleted; an error may leave the file without its
/// tiles, so use a copy.
///
/// # Errors
/// Any [`DocumentError`].
pub fn rewind(path: &Path) -> Result<bool, DocumentError> {
    let settings = DocumentSettings::new(path, Access::Paint);
    let open = || -> Result<_, DocumentError> {
        let (document, opened) = Document::open(&settings)?;
        Ok((document, opened.ok_or(DocumentError::NoPainting)?))
    };
    let (document, opened) = open()?;
    let has_record = opened.beginning().is_some();
    drop(opened);
    document.close()?;
    if !has_record {
        return Ok(false);
    }
    // The checkpoint writes rows, and removes only those that it refers to.
    let (database, _) = Database::open(path, Access::Paint, None)?;
    let query = "BEGIN; DELETE FROM tile; DELETE FROM step; DELETE FROM version; DELETE FROM journal; \
                 DELETE FROM record; DELETE FROM shown; COMMIT";
    database.connection.execute_batch(query)?;
    database.close()?;
    let (document, opened) = open()?;
    let first = opened.first();
    let first = first.map_err(|error| DocumentError::Damaged(error.to_string()))?;
    let mut sequencer = first.ok_or(DocumentError::NoPainting)?;
    sequencer.painting_mut().tell_all_again();
    document.write_checkpoint(Checkpoint::of(&mut sequencer, 0));
    document.close()?;
    super::discard(path)?;
    Ok(true)
}
