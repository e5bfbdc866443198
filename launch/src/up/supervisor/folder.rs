//! Check of the rig's folder: if it is removed, the processes continue, but cannot be found. Removed sockets are
//! restored.

use std::time::{Duration, Instant};

use maulstick_bus::RigFolder;
use maulstick_bus::sockets::{SocketKeeper, SocketNews};

use super::node::{Node, State};
use crate::up::plan::Role;

/// Interval of the check.
const PERIOD: Duration = Duration::from_secs(1);
/// Interval at which the files of the folder are touched, because cleaners remove files that are days old.
const TOUCH: Duration = Duration::from_secs(600);

/// Times of the last check and touch, and true once the loss was reported.
#[derive(Debug)]
pub(super) struct FolderWatch {
    sockets: SocketKeeper,
    looked: Option<Instant>,
    touched: Option<Instant>,
    told: bool,
    /// True once it was reported that sockets cannot be looked after.
    unkept: bool,
}

impl FolderWatch {
    /// Looks after a folder and its sockets.
    pub(super) fn new(sockets: SocketKeeper) -> Self {
        Self {
            sockets,
            looked: None,
            touched: None,
            told: false,
            unkept: false,
        }
    }

    /// If due, restores removed sockets, and reports once that the folder, or its lock, is gone. Returns nodes whose
    /// sockets are gone for good, and that lose nothing by a restart.
    pub(super) fn watch(
        &mut self,
        folder: &RigFolder,
        nodes: &[Node],
        now: Instant,
    ) -> Vec<String> {
        if !self.is_due(now) {
            return Vec::new();
        }
        if !folder.is_whole() {
            self.told = true;
            tracing::error!(
                "the folder of the rig, {}, was removed: painting goes on, but no command finds the rig, and \
                 a node that ends cannot join again; end the rig and start it again",
                folder.path().display()
            );
            return Vec::new();
        }
        let news = self.look(now);
        for node in news.restored {
            tracing::warn!(
                "the socket of '{node}' was removed from the rig's folder, and is put back"
            );
        }
        let (renewed, lost) = news.lost.into_iter().partition(|name| {
            let is_meant = |node: &Node| {
                let can_be = matches!(node.spec.role, Role::Brush | Role::Device);
                node.spec.name == *name && node.state == State::Running && can_be
            };
            nodes.iter().any(is_meant)
        });
        let (renewed, lost): (Vec<String>, Vec<String>) = (renewed, lost);
        for name in lost {
            tracing::error!(
                "the socket of '{name}' is gone: programs that start do not reach it; end the rig and start it again"
            );
        }
        for name in &renewed {
            tracing::warn!("the socket of '{name}' is gone: it is started again");
        }
        renewed
    }

    /// True where it is time to look.
    fn is_due(&mut self, now: Instant) -> bool {
        let rests = |since: Instant| now.duration_since(since) < PERIOD;
        let is_due = !self.told && !self.looked.is_some_and(rests);
        if is_due {
            self.looked = Some(now);
        }
        is_due
    }

    /// Makes the check due.
    pub(super) fn hasten(&mut self) {
        self.looked = None;
    }

    /// Looks at the sockets, and touches them where it is time.
    fn look(&mut self, now: Instant) -> SocketNews {
        let rests = |since: Instant| now.duration_since(since) < TOUCH;
        if !self.touched.is_some_and(rests) {
            self.touched = Some(now);
            self.sockets.touch();
        }
        self.sockets.look().unwrap_or_else(|error| {
            if !std::mem::replace(&mut self.unkept, true) {
                tracing::warn!("the folder of the rig's sockets cannot be watched: {error}");
            }
            SocketNews::default()
        })
    }
}
