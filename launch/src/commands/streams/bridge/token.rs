//! The secret in the address of the bridge: one of each user, kept, so that an address that a viewer remembers goes on to
//! hold. Whoever reads the user's files may watch; other users of the machine, and pages, may not.

use std::fmt::Write as _;
use std::io::{ErrorKind, Read as _, Write as _};
use std::path::{Path, PathBuf};

use maulstick_rig::UserError;
use maulstick_rig::files::create_private;

/// Random bytes of a token.
const BYTES: usize = 16;

/// The token of this user; a new one where there is none.
///
/// # Errors
/// A [`UserError`] where it cannot be read or kept.
pub(super) fn own() -> Result<String, UserError> {
    let folders = directories::ProjectDirs::from("", "", "maulstick").ok_or_else(|| {
        UserError::failure("there is no folder for the settings of this user")
            .help("set HOME to a folder of your own, or let every program watch: --no-token")
    })?;
    kept_in(&folders.config_dir().join("bridge-token"))
}

/// The token in a file, which is made where it is not there.
fn kept_in(path: &Path) -> Result<String, UserError> {
    match std::fs::read_to_string(path) {
        Ok(text) => read(&text, path),
        Err(error) if error.kind() == ErrorKind::NotFound => make(path),
        Err(error) => Err(UserError::reading(path, &error)),
    }
}

fn read(text: &str, path: &Path) -> Result<String, UserError> {
    let token = text.trim();
    let is_sound = token.len() == 2 * BYTES && token.bytes().all(|byte| byte.is_ascii_hexdigit());
    match is_sound {
        true => Ok(token.to_owned()),
        false => Err(UserError::usage("this is no token of the bridge")
            .at(path.display().to_string())
            .help("remove the file: another is made")),
    }
}

fn make(path: &Path) -> Result<String, UserError> {
    let failed = |path: PathBuf| move |error| UserError::writing(&path, &error);
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(failed(folder.to_owned()))?;
    }
    let mut random = [0; BYTES];
    std::fs::File::open("/dev/urandom")
        .and_then(|mut source| source.read_exact(&mut random))
        .map_err(|error| UserError::failure(format!("no random numbers: {error}")))?;
    let mut token = String::new();
    for byte in random {
        write!(token, "{byte:02x}").unwrap_or_default();
    }
    match create_private(path) {
        Ok(mut file) => {
            let written = file.write_all(format!("{token}\n").as_bytes());
            written.map_err(failed(path.to_owned()))?;
            Ok(token)
        }
        // Another bridge has just made it.
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            let text = std::fs::read_to_string(path);
            read(
                &text.map_err(|error| UserError::reading(path, &error))?,
                path,
            )
        }
        Err(error) => Err(UserError::writing(path, &error)),
    }
}

#[cfg(test)]
mod tests {
    use std::os::unix::fs::PermissionsExt as _;

    use super::*;

    #[test]
    fn a_token_is_made_once_and_is_its_users_alone() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("maulstick/bridge-token");
        let token = kept_in(&path).expect("made");
        assert_eq!(kept_in(&path), Ok(token.clone()));
        let mode = std::fs::metadata(&path)
            .expect("there")
            .permissions()
            .mode();
        assert_eq!(mode & 0o777, 0o600);
        let other = folder.path().join("other");
        assert_ne!(kept_in(&other).expect("made"), token);
        for wrong in ["", "short", &"z".repeat(2 * BYTES)] {
            std::fs::write(&path, wrong).expect("written");
            let refused = kept_in(&path).expect_err(wrong);
            assert!(
                refused.place.is_some() && refused.help.is_some(),
                "{refused}"
            );
        }
    }
}
