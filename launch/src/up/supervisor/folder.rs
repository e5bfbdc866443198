//! Check for the rig's folder: if somebody removes it, the processes go on, but nobody finds them.

use std::time::{Duration, Instant};

use super::Supervisor;

/// Interval of the check.
const PERIOD: Duration = Duration::from_secs(1);

/// Time of the last check, and true once the loss was reported.
#[derive(Debug, Default)]
pub(super) struct FolderWatch {
    looked: Option<Instant>,
    told: bool,
}

impl Supervisor {
    /// Says once that the folder, or its lock, is gone.
    pub(super) fn watch_folder(&mut self) {
        let watch = &mut self.folder_watch;
        let rests = watch.looked.is_some_and(|looked| looked.elapsed() < PERIOD);
        if watch.told || rests {
            return;
        }
        watch.looked = Some(Instant::now());
        if self.folder.is_whole() {
            return;
        }
        watch.told = true;
        tracing::error!(
            "the folder of the rig, {}, was removed: painting goes on, but no command finds the rig, and \
             a node that ends cannot join again; end the rig and start it again",
            self.folder.path().display()
        );
    }
}
