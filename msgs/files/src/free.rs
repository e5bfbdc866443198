//! Names that are not taken.

use std::path::{Path, PathBuf};

use crate::kind::COMPANIONS;

/// The first of the names `named(from)`, `named(from + 1)`, … that is not there, and its number. A link counts as there
/// wherever it leads, and so does a name beside which a file of SQLite lies.
pub fn first_free(from: u32, named: impl Fn(u32) -> PathBuf) -> (u32, PathBuf) {
    (from..u32::MAX)
        .map(|number| (number, named(number)))
        .find(|(_, path)| is_free(path))
        .unwrap_or_else(|| (u32::MAX, named(u32::MAX)))
}

/// The file that lies beside another under its name and `suffix`: of SQLite's one of [`COMPANIONS`].
#[must_use]
pub fn companion(path: &Path, suffix: &str) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(suffix);
    path.with_file_name(name)
}

fn is_free(path: &Path) -> bool {
    let companions = COMPANIONS.iter().map(|suffix| companion(path, suffix));
    std::iter::once(path.to_owned())
        .chain(companions)
        .all(|path| path.symlink_metadata().is_err())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_link_that_leads_nowhere_and_a_journal_without_its_database_take_a_name() {
        let folder = tempfile::tempdir().expect("a folder");
        let named = |number: u32| folder.path().join(format!("sea-{number}.maul"));
        let free = || first_free(1, named);
        assert_eq!(free(), (1, named(1)));
        std::os::unix::fs::symlink("/nowhere", named(1)).expect("a link");
        assert_eq!(free(), (2, named(2)));
        std::fs::write(folder.path().join("sea-2.maul-wal"), "frames").expect("written");
        assert_eq!(free(), (3, named(3)));
        assert_eq!(first_free(7, named), (7, named(7)));
    }
}
