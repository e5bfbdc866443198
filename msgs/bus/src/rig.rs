//! The rig's folder: sockets, the lock that reserves a name for one rig, and the data that others need to join.

use std::fs::{self, DirBuilder, File, OpenOptions};
use std::io::Write as _;
use std::os::unix::fs::{DirBuilderExt as _, MetadataExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use maulstick_types::wire::topics::check_name;
use nix::fcntl::{Flock, FlockArg};
use serde::{Deserialize, Serialize};

use crate::bus::BusError;
use crate::clock::RigClock;

/// Sockets have at most 107 bytes of path on Linux.
const SOCKET_PATH_MAX: usize = 107;

/// Data that a program needs to join a rig; `rig.json` in its folder.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RigInfo {
    /// Name of the rig.
    pub rig: String,
    /// zenoh locator to connect to, in mode `client` or `peer`.
    pub endpoint: String,
    /// Prefix of every topic.
    pub prefix: String,
    /// Rig clock = `CLOCK_MONOTONIC` + this, ns.
    pub clock_offset_ns: u64,
    /// Process of the launcher.
    pub pid: u32,
}

/// A rig's folder, mode 0700.
#[derive(Debug)]
pub struct RigFolder {
    path: PathBuf,
    rig: String,
    lock: Option<Flock<File>>,
}

fn folder_error(reason: String, help: &str) -> BusError {
    BusError::Folder {
        reason,
        help: help.to_owned(),
    }
}

/// Parent folder of all rigs: the user's run-time folder, else one in the temporary folder.
fn base() -> PathBuf {
    match std::env::var_os("XDG_RUNTIME_DIR") {
        Some(dir) if Path::new(&dir).is_dir() => PathBuf::from(dir).join("maulstick"),
        _ => std::env::temp_dir().join(format!("maulstick-{}", nix::unistd::getuid())),
    }
}

fn make_private(path: &Path) -> Result<(), BusError> {
    DirBuilder::new()
        .recursive(true)
        .mode(0o700)
        .create(path)
        .map_err(|error| {
            folder_error(
                format!("cannot make {}: {error}", path.display()),
                "check its permissions",
            )
        })?;
    check_private(path)
}

/// Checks that a path is a folder that nobody else may use or has made. A link is refused: in a folder that all share,
/// such as /tmp, it may be another user's.
fn check_private(path: &Path) -> Result<(), BusError> {
    let meta = fs::symlink_metadata(path).map_err(|error| {
        folder_error(
            format!("cannot read {}: {error}", path.display()),
            "check its permissions",
        )
    })?;
    let is_own = meta.uid() == nix::unistd::getuid().as_raw();
    if !meta.is_dir() || !is_own || meta.permissions().mode() & 0o077 != 0 {
        return Err(folder_error(
            format!("{} is not a folder of yours alone", path.display()),
            "remove it, or set XDG_RUNTIME_DIR to a folder of mode 0700",
        ));
    }
    Ok(())
}

/// The processes of a killed rig are gone within this time.
const LAST_BREATH: Duration = Duration::from_secs(3);

/// Removes what a rig before left behind, once the last of its processes has let go of it.
fn clear(path: &Path) -> Result<(), BusError> {
    let give_up = Instant::now() + LAST_BREATH;
    for entry in fs::read_dir(path).into_iter().flatten().flatten() {
        let file = entry.path();
        let extension = file.extension().and_then(|extension| extension.to_str());
        if extension == Some("lock") {
            while File::open(&file)
                .is_ok_and(|file| Flock::lock(file, FlockArg::LockExclusiveNonblock).is_err())
            {
                if Instant::now() > give_up {
                    return Err(folder_error(
                        format!("a process of the rig before still holds {}", file.display()),
                        "end it: `pkill maulstick-`",
                    ));
                }
                std::thread::sleep(Duration::from_millis(10));
            }
        }
        if matches!(extension, Some("lock" | "sock" | "json")) {
            fs::remove_file(&file).ok();
        }
    }
    Ok(())
}

/// Checks that sockets fit into the folder of a rig.
fn check_length(path: &Path) -> Result<(), BusError> {
    let longest = path.join("0123456789abcdef0123456789abcdef.sock");
    if longest.as_os_str().len() > SOCKET_PATH_MAX {
        return Err(folder_error(
            format!("{} is too long for a socket", path.display()),
            "set XDG_RUNTIME_DIR to a shorter path",
        ));
    }
    Ok(())
}

impl RigFolder {
    /// Parent folder of all rigs, made if it is not there, in which a rig called `rig` could run.
    ///
    /// # Errors
    /// [`BusError::Folder`] where it is not the user's alone, cannot be made, or is too long for a socket.
    pub fn parent_for(rig: &str) -> Result<PathBuf, BusError> {
        let base = base();
        make_private(&base)?;
        check_length(&base.join(rig))?;
        Ok(base)
    }

    /// Makes the folder of a new rig and takes its name.
    ///
    /// # Errors
    /// [`BusError::Folder`] where the name is bad or taken, or the folder cannot be made.
    pub fn create(rig: &str) -> Result<Self, BusError> {
        Self::create_in(&base(), rig)
    }

    /// As [`RigFolder::create`], below `base`.
    ///
    /// # Errors
    /// As [`RigFolder::create`].
    pub fn create_in(base: &Path, rig: &str) -> Result<Self, BusError> {
        check_name(rig)
            .map_err(|what| folder_error(format!("rig name {what}"), "choose another name"))?;
        make_private(base)?;
        let path = base.join(rig);
        make_private(&path)?;
        check_length(&path)?;
        let lock_path = path.join("lock");
        let file = OpenOptions::new()
            .create(true)
            .truncate(false)
            .write(true)
            .open(&lock_path)
            .map_err(|error| {
                folder_error(
                    format!("cannot open {}: {error}", lock_path.display()),
                    "check its permissions",
                )
            })?;
        let lock = Flock::lock(file, FlockArg::LockExclusiveNonblock).map_err(|_| {
            let owner = RigInfo::read(&path).map_or(String::new(), |i| format!(" (pid {})", i.pid));
            folder_error(
                format!("a rig called '{rig}' is already running{owner}"),
                "stop it, or give this one another name with `--name` or in rig.toml",
            )
        })?;
        clear(&path)?;
        Ok(Self {
            path,
            rig: rig.to_owned(),
            lock: Some(lock),
        })
    }

    /// The folder of a running rig.
    ///
    /// # Errors
    /// [`BusError::NoRig`] where no such rig runs.
    pub fn join(rig: &str) -> Result<(Self, RigInfo), BusError> {
        Self::join_in(&base(), rig)
    }

    /// As [`RigFolder::join`], below `base`.
    ///
    /// # Errors
    /// As [`RigFolder::join`], and where `base` is not the user's alone.
    pub fn join_in(base: &Path, rig: &str) -> Result<(Self, RigInfo), BusError> {
        if base.symlink_metadata().is_ok() {
            check_private(base)?;
        }
        Self::join_at(&base.join(rig))
    }

    /// The running rig of the folder `path`.
    ///
    /// # Errors
    /// [`BusError::NoRig`] where no rig runs there, [`BusError::Folder`] where the folder is not the user's alone.
    pub fn join_at(path: &Path) -> Result<(Self, RigInfo), BusError> {
        if path.symlink_metadata().is_ok() {
            check_private(path)?;
        }
        let running = File::open(path.join("lock"))
            .is_ok_and(|file| Flock::lock(file, FlockArg::LockSharedNonblock).is_err());
        let info = RigInfo::read(path).filter(|_| running).ok_or_else(|| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            BusError::NoRig(name.into_owned())
        })?;
        Ok((
            Self {
                path: path.to_owned(),
                rig: info.rig.clone(),
                lock: None,
            },
            info,
        ))
    }

    /// True if the lock file of this program is still at its path.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        let own = self.lock.as_ref().and_then(|lock| lock.metadata().ok());
        let found = fs::metadata(self.path.join("lock")).ok();
        let number = |meta: &fs::Metadata| (meta.dev(), meta.ino());
        own.is_none() || own.as_ref().map(number) == found.as_ref().map(number)
    }

    /// Path of the folder.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Name of the rig.
    #[must_use]
    pub fn rig(&self) -> &str {
        &self.rig
    }

    /// The zenoh locator of a node's socket.
    #[must_use]
    pub fn locator(&self, node: &str) -> String {
        format!(
            "unixsock-stream/{}",
            self.path.join(format!("{node}.sock")).display()
        )
    }

    /// Writes `rig.json`, by which others find the rig.
    ///
    /// # Errors
    /// [`BusError::Folder`] where the folder cannot be written.
    pub fn announce(&self, hub: &str, clock: RigClock) -> Result<RigInfo, BusError> {
        let info = RigInfo {
            rig: self.rig.clone(),
            endpoint: self.locator(hub),
            prefix: format!("maulstick/{}/", self.rig),
            clock_offset_ns: clock.offset_ns(),
            pid: std::process::id(),
        };
        let beside = self.path.join("rig.json.tmp");
        let write = || -> std::io::Result<()> {
            let mut file = File::create(&beside)?;
            file.write_all(serde_json::to_string_pretty(&info)?.as_bytes())?;
            fs::rename(&beside, self.path.join("rig.json"))
        };
        write().map_err(|error| {
            folder_error(
                format!("cannot write {}: {error}", beside.display()),
                "free some space",
            )
        })?;
        Ok(info)
    }

    /// Takes back `rig.json`; the launcher calls it when the rig stops.
    pub fn withdraw(&self) {
        fs::remove_file(self.path.join("rig.json")).ok();
    }
}

impl RigInfo {
    fn read(folder: &Path) -> Option<Self> {
        serde_json::from_slice(&fs::read(folder.join("rig.json")).ok()?).ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_belongs_to_one_rig_at_a_time() {
        let base = tempfile::tempdir().expect("a folder");
        let base = base.path().join("rigs");
        let first = RigFolder::create_in(&base, "studio").expect("first");
        first.announce("hub", RigClock::start()).expect("announced");
        let error = RigFolder::create_in(&base, "studio")
            .expect_err("second")
            .to_string();
        let pid = std::process::id().to_string();
        assert!(error.contains(&pid), "{error}");
        assert!(RigFolder::create_in(&base, "other").is_ok());
        drop(first);
        assert!(RigFolder::create_in(&base, "studio").is_ok());
    }

    #[test]
    fn others_may_not_read_the_folder() {
        let base = tempfile::tempdir().expect("a folder");
        fs::set_permissions(base.path(), fs::Permissions::from_mode(0o755)).expect("chmod");
        let error = RigFolder::create_in(base.path(), "studio").expect_err("refused");
        let path = base.path().display().to_string();
        assert!(matches!(error, BusError::Folder { reason, .. } if reason.contains(&path)));
    }

    #[test]
    fn a_link_is_no_folder_of_ones_own() {
        let base = tempfile::tempdir().expect("a folder");
        let [real, link] = ["real", "link"].map(|name| base.path().join(name));
        let held = RigFolder::create_in(&real, "studio").expect("its own");
        held.announce("hub", RigClock::start()).expect("announced");
        std::os::unix::fs::symlink(&real, &link).expect("a link");
        for refused in [
            RigFolder::create_in(&link, "other").err(),
            RigFolder::join_in(&link, "studio").err(),
        ] {
            let path = link.display().to_string();
            assert!(
                matches!(refused, Some(BusError::Folder { reason, .. }) if reason.contains(&path))
            );
        }
        std::os::unix::fs::symlink(real.join("studio"), real.join("linked")).expect("a link");
        assert!(RigFolder::join_in(&real, "linked").is_err());
        assert!(
            RigFolder::join_in(&real, "studio").is_ok(),
            "a fault would pass"
        );
    }

    #[test]
    fn a_folder_that_was_removed_is_noticed() {
        let base = tempfile::tempdir().expect("a folder");
        let base = base.path().join("rigs");
        let folder = RigFolder::create_in(&base, "studio").expect("its own");
        assert!(folder.is_whole());
        fs::remove_dir_all(folder.path()).expect("removed");
        assert!(!folder.is_whole());
        let again = RigFolder::create_in(&base, "studio").expect("another");
        assert!(again.is_whole() && !folder.is_whole());
    }

    #[test]
    fn joining_what_does_not_run_says_so() {
        let error = RigFolder::join_at(Path::new("/nonexistent/studio")).expect_err("none");
        assert_eq!(error.to_string(), "no rig called 'studio' is running");
    }
}
