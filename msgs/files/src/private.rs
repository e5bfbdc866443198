//! Files that their user alone may read: what a hand did is nobody else's.

use std::fs::{File, OpenOptions, Permissions};
use std::io::Error;
use std::os::unix::fs::{OpenOptionsExt as _, PermissionsExt as _};
use std::path::Path;

use crate::kind::Kind;

/// Permissions of a file that its user alone may read.
const PRIVATE: u32 = 0o600;
/// Permissions of any other file, less what the user's mask takes.
const SHARED: u32 = 0o666;

impl Kind {
    /// True for what a hand did and felt.
    #[must_use]
    pub fn is_private(self) -> bool {
        matches!(self, Self::Take | Self::Recording | Self::Messages)
    }
}

/// A new file that its user alone may read.
///
/// # Errors
/// The file system's; one that exists is left as it is.
pub fn create_private(path: &Path) -> Result<File, Error> {
    let mut options = OpenOptions::new();
    options.write(true).create_new(true).mode(PRIVATE);
    options.open(path)
}

/// A file to be written, with what it holds; from now on its user alone may read it.
///
/// # Errors
/// The file system's.
pub fn open_private(path: &Path) -> Result<File, Error> {
    let mut options = OpenOptions::new();
    options.write(true).create(true).truncate(false);
    let file = options.mode(PRIVATE).open(path)?;
    file.set_permissions(Permissions::from_mode(PRIVATE))?;
    Ok(file)
}

/// A file of a kind, emptied if it exists.
pub(crate) fn create(path: &Path, kind: Kind) -> Result<File, Error> {
    let mode = if kind.is_private() { PRIVATE } else { SHARED };
    let mut options = OpenOptions::new();
    options.write(true).create(true).truncate(true).mode(mode);
    options.open(path)
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::*;
    use crate::whole::write_whole;

    fn mode(path: &Path) -> u32 {
        let data = std::fs::metadata(path).expect("there");
        data.permissions().mode() & 0o777
    }

    #[test]
    fn what_a_hand_did_is_its_users_alone_whatever_wrote_it() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        create_private(&path("a.mcap")).expect("created");
        std::fs::write(path("b.mcap"), b"old").expect("written");
        open_private(&path("b.mcap")).expect("opened");
        assert_eq!(std::fs::read(path("b.mcap")).expect("read"), b"old");
        write_whole(&path("c.hid"), Kind::Recording, |file| {
            file.write_all(b"D:")
        })
        .expect("written");
        for name in ["a.mcap", "b.mcap", "c.hid"] {
            assert_eq!(mode(&path(name)), 0o600, "{name}");
        }
        assert!(create_private(&path("a.mcap")).is_err());
        // Any other file is as the mask of its user has it.
        std::fs::write(path("usual"), b"").expect("written");
        write_whole(&path("d.png"), Kind::Png, |file| file.write_all(b"\x89PNG")).expect("written");
        assert_eq!(mode(&path("d.png")), mode(&path("usual")));
    }
}
