//! Names of one file.

use std::path::Path;

/// True if two names are one path, links followed. A hard link is another path, although it leads to the same file.
#[must_use]
pub fn is_same(one: &Path, other: &Path) -> bool {
    let real = |path: &Path| std::fs::canonicalize(path).ok();
    one == other || real(one).is_some_and(|path| real(other) == Some(path))
}
