//! Paintings with which sessions begin, and their errors as the user sees them.

use std::path::Path;

use maulstick_document::{Access, Document, DocumentError, DocumentSettings};
use maulstick_painting::Sequencer;
use maulstick_rig::UserError;
use maulstick_rig::user_error::EXIT_FAILURE;

/// Error of a document, as the user sees it.
#[must_use]
pub fn wrong(path: &Path, error: &DocumentError) -> UserError {
    let fault = UserError::usage(error.to_string())
        .at(path.display().to_string())
        .advise(error.advice());
    let is_failure = matches!(
        error,
        DocumentError::Full
            | DocumentError::Disk(_)
            | DocumentError::Incomplete(_)
            | DocumentError::ReadOnly(_)
            | DocumentError::InUse { .. }
            | DocumentError::Unwritten(_)
    );
    if is_failure {
        UserError {
            code: EXIT_FAILURE,
            ..fault
        }
    } else {
        fault
    }
}

/// The painting of a beginning, in the midst of its journal, and the tile versions that its file has.
///
/// # Errors
/// A [`UserError`] where the file is no painting, or cannot be read.
pub fn open_begin(path: &Path) -> Result<(Document, Sequencer, u64), UserError> {
    let failed = |error| wrong(path, &error);
    let settings = DocumentSettings::new(path, Access::Paint);
    let (document, opened) = Document::open(&settings).map_err(failed)?;
    let opened = opened.ok_or_else(|| failed(DocumentError::NoPainting))?;
    let since = opened.snapshot().versions;
    let sequencer = opened.in_its_midst();
    let sequencer = sequencer
        .map_err(|refusal| UserError::usage(refusal.to_string()).advise(refusal.advice()))?;
    Ok((document, sequencer, since))
}
