//! The window's membership in the rig, and all that it receives there.

use std::sync::Arc;

use maulstick_bus::{Bus, Wake};
use maulstick_client::listener::RigListener;
use maulstick_client::thumbnails::ThumbnailFetcher;
use maulstick_rig::{NodeHandle, Stop, UserError};
use maulstick_types::wire::topics::Topics;

use crate::app::studio::Studio;
use crate::rig::brushes::BrushTracker;
use crate::rig::health::HealthMonitor;

/// Connection of the window to its rig.
pub(super) struct Connection {
    pub(super) bus: Arc<dyn Bus>,
    pub(super) stop: Stop,
    pub(super) wake: Wake,
    pub(super) topics: Topics,
    pub(super) tracker: BrushTracker,
    /// Membership, held for the lifetime of the window.
    pub(super) member: Option<NodeHandle>,
    listener: RigListener,
    monitor: HealthMonitor,
    fetcher: ThumbnailFetcher,
}

impl Connection {
    /// Listens to the rig of `member`; `mouse` is the source of the window's own mouse.
    ///
    /// # Errors
    /// A [`UserError`] where the bus is closed.
    pub(super) fn new(member: &NodeHandle, mouse: u32) -> Result<Self, UserError> {
        let (bus, topics, wake) = (&member.bus, &member.topics, &member.wake);
        let brushes = member.config.brush.iter();
        let depth_shares = brushes.map(|brush| (brush.name.clone(), brush.depth_share));
        Ok(Self {
            tracker: BrushTracker::new(&**bus, topics, wake, depth_shares.collect(), mouse)?,
            listener: RigListener::new(&**bus, topics, wake)?,
            monitor: HealthMonitor::default(),
            fetcher: ThumbnailFetcher::of_rig(member),
            bus: Arc::clone(bus),
            stop: member.stop.clone(),
            wake: wake.clone(),
            topics: topics.clone(),
            member: None,
        })
    }

    /// Reads what the rig has sent.
    pub(super) fn drain(&mut self, now_ns: u64, studio: &mut Studio) {
        let Studio {
            rig, notifications, ..
        } = studio;
        rig.drain(&mut self.listener, now_ns);
        self.tracker.drain(now_ns);
        for brush in &mut rig.brushes {
            brush.carried = self.tracker.carried(&brush.name).cloned();
        }
        self.monitor.look(rig, &self.topics, notifications);
        self.fetcher.exchange(&mut rig.live.thumbnails, now_ns);
    }

    pub(super) fn leave(&mut self) {
        if let Some(member) = self.member.take() {
            member.leave();
        }
    }
}
