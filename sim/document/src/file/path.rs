//! Paths of a painting's files, and checks of what is there.

use std::path::{Path, PathBuf};

/// Real path of a file: the target of a link, beside which SQLite puts its journal.
pub(crate) fn resolved(path: &Path) -> PathBuf {
    std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

/// Bytes of a file; `None` if there is none.
pub(crate) fn length(path: &Path) -> Option<u64> {
    std::fs::metadata(path).ok().map(|about| about.len())
}
