//! The secret in the address of the bridge, one for each user, stored, so that an address remembered by a viewer stays
//! valid. Programs with access to the user's files may watch; other users of the machine, and web pages, may not.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{Error, ErrorKind, Read as _, Write as _};
use std::os::unix::fs::MetadataExt as _;
use std::path::Path;

use maulstick_rig::UserError;
use tempfile::NamedTempFile;

/// Random bytes of a token.
const BYTES: usize = 16;

/// The token of this user, created if absent.
///
/// # Errors
/// A [`UserError`] where it cannot be read or kept.
pub fn own() -> Result<String, UserError> {
    let folders = directories::ProjectDirs::from("", "", "maulstick").ok_or_else(|| {
        UserError::failure("there is no folder for the settings of this user")
            .help("set HOME to a folder of your own, or let every program watch: --no-token")
    })?;
    kept_in(&folders.config_dir().join("bridge-token"))
}

/// The token in a file, created if absent.
fn kept_in(path: &Path) -> Result<String, UserError> {
    match read(path)? {
        Some(token) => Ok(token),
        None => make(path),
    }
}

/// The token in a file; `None` where the file is absent or damaged.
fn read(path: &Path) -> Result<Option<String>, UserError> {
    let text = match std::fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::InvalidData) => {
            return Ok(None);
        }
        Err(error) => return Err(UserError::reading(path, &error)),
    };
    let token = text.trim();
    let is_sound = token.len() == 2 * BYTES && token.bytes().all(|byte| byte.is_ascii_hexdigit());
    Ok(is_sound.then(|| token.to_owned()))
}

/// A new token, or that of another bridge that has just made one. The file appears under its name completely or not at
/// all.
fn make(path: &Path) -> Result<String, UserError> {
    let failed = |error: Error| UserError::writing(path, &error);
    let folder = path.parent().unwrap_or_else(|| Path::new("."));
    std::fs::create_dir_all(folder).map_err(|error| UserError::writing(folder, &error))?;
    let mut random = [0; BYTES];
    File::open("/dev/urandom")
        .and_then(|mut source| source.read_exact(&mut random))
        .map_err(|error| UserError::failure(format!("no random numbers: {error}")))?;
    let mut token = String::new();
    for byte in random {
        write!(token, "{byte:02x}").unwrap_or_default();
    }
    // Only its user may read it, like all files of this kind.
    let mut written = NamedTempFile::new_in(folder).map_err(failed)?;
    written
        .write_all(format!("{token}\n").as_bytes())
        .and_then(|()| written.as_file().sync_all())
        .map_err(failed)?;
    match written.persist_noclobber(path) {
        Ok(_) => Ok(token),
        Err(there) if there.error.kind() == ErrorKind::AlreadyExists => {
            replace(path, token, there.file)
        }
        Err(other) => Err(failed(other.error)),
    }
}

/// Replaces a damaged file of this user by the one of a new token; a whole one stays, and its token is used.
fn replace(path: &Path, token: String, written: NamedTempFile) -> Result<String, UserError> {
    let failed = |error: Error| UserError::writing(path, &error);
    let there = File::options().write(true).open(path).map_err(failed)?;
    let owner = |file: &File| file.metadata().map(|data| data.uid()).map_err(failed);
    if owner(&there)? != owner(written.as_file())? {
        return Err(UserError::usage("this file belongs to another user")
            .at(path.display().to_string())
            .help("remove the file: another is made"));
    }
    // The first of several bridges that find it damaged replaces it.
    there.lock().map_err(failed)?;
    match read(path)? {
        Some(token) => Ok(token),
        None => match written.persist(path) {
            Ok(_) => Ok(token),
            Err(other) => Err(failed(other.error)),
        },
    }
}

#[cfg(test)]
mod tests {
    use std::os::unix::fs::PermissionsExt as _;
    use std::sync::Barrier;

    use super::*;

    fn mode(path: &Path) -> u32 {
        let data = std::fs::metadata(path).expect("there");
        data.permissions().mode() & 0o777
    }

    #[test]
    fn a_token_is_made_once_and_is_its_users_alone() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("maulstick/bridge-token");
        let token = kept_in(&path).expect("made");
        assert_eq!(kept_in(&path), Ok(token.clone()));
        assert_eq!(mode(&path), 0o600);
        let other = folder.path().join("other");
        assert_ne!(kept_in(&other).expect("made"), token);
    }

    #[test]
    fn a_damaged_token_is_made_anew() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("bridge-token");
        for damaged in [&b""[..], b"short", &[b'z'; 2 * BYTES], &[0xff; 2 * BYTES]] {
            std::fs::write(&path, damaged).expect("written");
            let token = kept_in(&path).expect("made");
            assert_eq!(read(&path), Ok(Some(token)), "{damaged:?}");
            assert_eq!(mode(&path), 0o600);
        }
        std::fs::remove_file(&path).expect("removed");
        std::fs::create_dir(&path).expect("made");
        assert!(kept_in(&path).is_err(), "a folder");
    }

    #[test]
    fn bridges_that_start_at_the_same_time_have_one_token() {
        for damaged in [None, Some("")] {
            let folder = tempfile::tempdir().expect("a folder");
            let path = folder.path().join("bridge-token");
            if let Some(text) = damaged {
                std::fs::write(&path, text).expect("written");
            }
            let start = Barrier::new(8);
            let tokens: Vec<String> = std::thread::scope(|scope| {
                let bridge = || {
                    start.wait();
                    kept_in(&path).expect("a token")
                };
                let bridges = [(); 8].map(|()| scope.spawn(bridge));
                bridges.map(|bridge| bridge.join().expect("ended")).into()
            });
            assert!(tokens.iter().all(|token| *token == tokens[0]), "{tokens:?}");
            assert_eq!(kept_in(&path), Ok(tokens[0].clone()));
            let files = std::fs::read_dir(folder.path()).expect("a folder");
            assert_eq!(files.count(), 1);
        }
    }
}
