//! Nodes of devices that appear below /dev or get other permissions, as the kernel reports them through inotify.

use std::path::Path;

use nix::errno::Errno;
use nix::sys::inotify::{AddWatchFlags, InitFlags, Inotify};

/// Beginnings of the names of nodes: HID devices, event devices, serial ports.
const NODES: [&str; 3] = ["hidraw", "event", "tty"];

/// A watch of the nodes of devices.
#[derive(Debug)]
pub struct NodeWatch {
    inotify: Inotify,
}

impl NodeWatch {
    /// Watches what stands for /dev, and its folder `input` if there is one; absent where the system does not allow it,
    /// so that who waits for a device needs a time of its own too.
    #[must_use]
    pub fn of(dev: &Path) -> Option<Self> {
        match Self::begin(dev) {
            Ok(watch) => Some(watch),
            Err(error) => {
                tracing::warn!("new devices are noticed late: {}: {error}", dev.display());
                None
            }
        }
    }

    fn begin(dev: &Path) -> Result<Self, Errno> {
        let inotify = Inotify::init(InitFlags::IN_CLOEXEC | InitFlags::IN_NONBLOCK)?;
        // A node is root's until udev has given it to the user.
        let kinds =
            AddWatchFlags::IN_CREATE | AddWatchFlags::IN_MOVED_TO | AddWatchFlags::IN_ATTRIB;
        inotify.add_watch(dev, kinds)?;
        match inotify.add_watch(&dev.join("input"), kinds) {
            Ok(_) | Err(Errno::ENOENT) => Ok(Self { inotify }),
            Err(error) => Err(error),
        }
    }

    /// True if a node has appeared or changed since the last call.
    #[must_use]
    pub fn has_news(&self) -> bool {
        let mut is_new = false;
        while let Ok(events) = self.inotify.read_events() {
            // Where events were lost there is no name.
            is_new |= events.iter().any(|event| {
                let name = event.name.as_ref().map(|name| name.to_string_lossy());
                name.is_none_or(|name| NODES.iter().any(|node| name.starts_with(node)))
            });
        }
        is_new
    }
}

#[cfg(test)]
mod tests {
    use std::fs::{Permissions, create_dir, remove_file, set_permissions, write};
    use std::os::unix::fs::PermissionsExt as _;

    use super::*;

    #[test]
    fn nodes_that_appear_and_get_permissions_are_news_once() {
        let dev = tempfile::tempdir().expect("a folder");
        let path = |name: &str| dev.path().join(name);
        create_dir(path("input")).expect("made");
        write(path("hidraw0"), "").expect("made");
        let watch = NodeWatch::of(dev.path()).expect("inotify");
        assert!(!watch.has_news(), "it was there before");
        for name in ["hidraw1", "input/event7", "ttyACM0"] {
            write(path(name), "").expect("made");
            assert!(watch.has_news(), "{name}");
            assert!(!watch.has_news(), "{name} was told");
        }
        set_permissions(path("hidraw0"), Permissions::from_mode(0o600)).expect("set");
        assert!(watch.has_news(), "a permission");
        write(path("sda1"), "").expect("made");
        remove_file(path("hidraw1")).expect("gone");
        assert!(!watch.has_news(), "no node of a device has come");
        assert!(NodeWatch::of(&path("none")).is_none());
    }
}
