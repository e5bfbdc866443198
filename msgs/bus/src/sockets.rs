//! The sockets of a rig, looked after: what cleans temporary folders removes what was not touched for long, and a process
//! that starts later finds no socket that was removed, though its owner still listens. So each has a second name in a folder
//! beside it, from which a removed one gets its own back: it is the same socket. All of them, and what else a
//! program needs to join, are touched.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs;
use std::io;
use std::os::unix::ffi::OsStrExt as _;
use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};

use nix::fcntl::AT_FDCWD;
use nix::sys::stat::{UtimensatFlags, utimensat};
use nix::sys::time::TimeSpec;

/// Folder of the second names, in the rig's.
const SPARES: &str = "spare";
/// Ending of a socket.
const SOCKET: &str = "sock";
/// Sockets of all processes of the machine, as the kernel lists them.
const LISTED: &str = "/proc/net/unix";
/// Flags of one on which somebody listens, there.
const LISTENING: &[u8] = b"00010000";

/// Looks after the sockets in a folder.
#[derive(Debug)]
pub struct SocketKeeper {
    folder: PathBuf,
    spares: PathBuf,
    /// Sockets that were there.
    known: BTreeSet<OsString>,
}

/// Changes that a look at the sockets found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SocketNews {
    /// Nodes whose removed socket is back.
    pub restored: Vec<String>,
    /// Nodes that listen on a socket that is gone for good: they have to listen again.
    pub lost: Vec<String>,
}

impl SocketKeeper {
    /// Looks after the sockets in the folder of a rig.
    #[must_use]
    pub fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
            spares: folder.join(SPARES),
            known: BTreeSet::new(),
        }
    }

    /// Gives sockets that were removed their names back, and those that are new a second one. A name whose owner has
    /// ended is forgotten.
    ///
    /// # Errors
    /// The system's error where the folder cannot be used.
    pub fn look(&mut self) -> io::Result<SocketNews> {
        let mut news = SocketNews::default();
        match fs::create_dir(&self.spares) {
            Err(error) if error.kind() != io::ErrorKind::AlreadyExists => return Err(error),
            _ => {}
        }
        let there = sockets(&self.folder)?;
        let missing = sockets(&self.spares)?
            .into_iter()
            .chain(std::mem::take(&mut self.known))
            .filter(|name| !there.contains(name));
        let missing: BTreeSet<OsString> = missing.collect();
        let listening = if missing.is_empty() {
            BTreeSet::new()
        } else {
            listening()?
        };
        for name in missing {
            let (socket, spare) = (self.folder.join(&name), self.spares.join(&name));
            if !listening.contains(&socket) {
                fs::remove_file(&spare).ok();
                continue;
            }
            let node = Path::new(&name).file_stem().unwrap_or_default();
            let node = node.to_string_lossy().into_owned();
            match fs::hard_link(&spare, &socket) {
                Ok(()) => news.restored.push(node),
                Err(_) => news.lost.push(node),
            }
        }
        for name in &there {
            let (socket, spare) = (self.folder.join(name), self.spares.join(name));
            if number(&socket).is_some() && number(&socket) != number(&spare) {
                fs::remove_file(&spare).ok();
                // Its owner may have ended this moment.
                fs::hard_link(&socket, &spare).ok();
            }
        }
        self.known = there;
        Ok(news)
    }

    /// Touches all that is in the folder, so that nothing looks old.
    pub fn touch(&self) {
        for folder in [&self.folder, &self.spares] {
            let files = fs::read_dir(folder).into_iter().flatten().flatten();
            let files = files.map(|file| file.path());
            for path in files.chain([folder.clone()]) {
                let (now, flags) = (TimeSpec::UTIME_NOW, UtimensatFlags::NoFollowSymlink);
                // What ends this moment needs no touch.
                utimensat(AT_FDCWD, &path, &now, &now, flags).ok();
            }
        }
    }
}

/// Names of the sockets in a folder.
fn sockets(folder: &Path) -> io::Result<BTreeSet<OsString>> {
    let names = fs::read_dir(folder)?.flatten().map(|file| file.file_name());
    let is_socket = |name: &OsString| Path::new(name).extension().is_some_and(|own| own == SOCKET);
    Ok(names.filter(is_socket).collect())
}

/// Device and number of a file; none where it is gone.
fn number(path: &Path) -> Option<(u64, u64)> {
    let meta = fs::symlink_metadata(path).ok()?;
    Some((meta.dev(), meta.ino()))
}

/// Paths at which a process of this machine listens, whether they are still there or not.
fn listening() -> io::Result<BTreeSet<PathBuf>> {
    let list = fs::read(LISTED)?;
    let path = |line: &[u8]| {
        // Slot, references, protocol, flags, type, state and number, then the path.
        let mut words = line.splitn(8, |byte| *byte == b' ');
        let flags = words.nth(3)?;
        let rest = words.nth(3)?.trim_ascii_start();
        let start = rest.iter().position(|byte| *byte == b'/')?;
        let path = std::ffi::OsStr::from_bytes(&rest[start..]);
        (flags == LISTENING).then(|| PathBuf::from(path))
    };
    Ok(list.split(|byte| *byte == b'\n').filter_map(path).collect())
}

#[cfg(test)]
mod tests {
    use std::os::unix::net::{UnixListener, UnixStream};
    use std::time::{Duration, SystemTime};

    use super::*;

    struct Place {
        folder: tempfile::TempDir,
        keeper: SocketKeeper,
    }

    impl Place {
        fn new() -> Self {
            let folder = tempfile::tempdir().expect("a folder");
            let keeper = SocketKeeper::new(folder.path());
            Self { folder, keeper }
        }

        fn socket(&self, node: &str) -> PathBuf {
            self.folder.path().join(format!("{node}.sock"))
        }

        fn look(&mut self) -> [Vec<String>; 2] {
            let SocketNews { restored, lost } = self.keeper.look().expect("looked");
            [restored, lost]
        }
    }

    const NONE: [Vec<String>; 2] = [Vec::new(), Vec::new()];

    #[test]
    fn a_removed_socket_is_there_again_and_leads_to_its_owner() {
        let mut place = Place::new();
        let brush = place.socket("brush-main");
        let owner = UnixListener::bind(&brush).expect("bound");
        assert_eq!(place.look(), NONE);
        fs::remove_file(&brush).expect("removed");
        assert!(UnixStream::connect(&brush).is_err());
        assert_eq!(place.look(), [vec!["brush-main".to_owned()], Vec::new()]);
        let joining = UnixStream::connect(&brush).expect("connected");
        let (_, from) = owner.accept().expect("accepted");
        assert!(from.is_unnamed());
        drop(joining);
        assert_eq!(place.look(), NONE);
    }

    #[test]
    fn a_node_that_ended_stays_away_and_one_that_starts_anew_is_kept() {
        let mut place = Place::new();
        let brush = place.socket("brush-main");
        drop(UnixListener::bind(&brush).expect("bound"));
        assert_eq!(place.look(), NONE);
        fs::remove_file(&brush).expect("removed");
        assert_eq!(place.look(), NONE);
        assert!(!brush.exists());
        // Another one under its name, between two looks too.
        for _ in 0..2 {
            let owner = UnixListener::bind(&brush).expect("bound");
            assert_eq!(place.look(), NONE);
            fs::remove_file(&brush).expect("removed");
            assert_eq!(place.look()[0].len(), 1);
            drop(owner);
            fs::remove_file(&brush).expect("removed");
        }
    }

    #[test]
    fn where_the_second_name_is_gone_too_it_is_said_whose() {
        let mut place = Place::new();
        let brush = place.socket("brush-main");
        let owner = UnixListener::bind(&brush).expect("bound");
        assert_eq!(place.look(), NONE);
        fs::remove_file(&brush).expect("removed");
        fs::remove_dir_all(place.folder.path().join(SPARES)).expect("removed");
        assert_eq!(place.look(), [Vec::new(), vec!["brush-main".to_owned()]]);
        assert_eq!(place.look(), NONE, "said once");
        drop(owner);
    }

    #[test]
    fn all_that_is_there_is_touched() {
        let mut place = Place::new();
        let brush = place.socket("brush-main");
        let _owner = UnixListener::bind(&brush).expect("bound");
        assert_eq!(place.look(), NONE);
        let old = TimeSpec::new(1_000_000_000, 0);
        let spare = place.folder.path().join(SPARES).join("brush-main.sock");
        let paths = [&brush, &spare, &place.folder.path().to_owned()];
        let age = |path: &Path| {
            let modified = fs::symlink_metadata(path).and_then(|meta| meta.modified());
            let age = SystemTime::now().duration_since(modified.expect("a time"));
            age.unwrap_or_default()
        };
        for path in paths {
            let flags = UtimensatFlags::NoFollowSymlink;
            utimensat(AT_FDCWD, path, &old, &old, flags).expect("aged");
            assert!(age(path) > Duration::from_secs(1_000_000));
        }
        place.keeper.touch();
        for path in paths {
            assert!(age(path) < Duration::from_secs(100), "{}", path.display());
        }
    }
}
