//! Requests to the rig, in their order among the strokes; those that wait for a brush to lift, or are refused until
//! then.

use std::sync::Arc;
use std::time::Duration;

use eframe::egui::Context;
use maulstick_client::dispatcher::CommandDispatcher;
use maulstick_client::pending_orders::PendingSender;
use maulstick_client::stroke_barrier::StrokeBarrier;
use maulstick_rig::{NodeHandle, UserError};

use crate::app::connection::Connection;
use crate::app::hands::Hands;
use crate::app::held_places::HeldPlaces;
use crate::app::studio::Studio;
use crate::rig::device_setup::DeviceSetupRunner;
use crate::rig::state::BrushContact;
use crate::sessions::Sessions;

/// Interval at which a request that waits for its stroke is checked again.
const BARRIER_LOOK: Duration = Duration::from_millis(50);

/// Requests on their way.
pub(super) struct Sending {
    pub(super) dispatcher: CommandDispatcher,
    barrier: StrokeBarrier,
    pending: PendingSender,
    held_places: HeldPlaces,
    device_setup: DeviceSetupRunner,
    sessions: Sessions,
}

impl Sending {
    /// Sends to the rig of `member`.
    ///
    /// # Errors
    /// A [`UserError`] where the bus is closed.
    pub(super) fn new(member: &NodeHandle) -> Result<Self, UserError> {
        let (bus, topics) = (&member.bus, &member.topics);
        Ok(Self {
            dispatcher: CommandDispatcher::new(Arc::clone(bus), topics, &member.wake),
            barrier: StrokeBarrier::new(&**bus, topics)?,
            pending: PendingSender::new(&**bus, topics)?,
            held_places: HeldPlaces::default(),
            device_setup: DeviceSetupRunner::default(),
            sessions: Sessions::default(),
        })
    }

    /// Ends recording, replay and the set-up of devices, while the window is still in the rig.
    pub(super) fn end(&mut self) {
        self.sessions.end();
        self.device_setup.end();
    }

    /// Reads how far the strokes are painted.
    pub(super) fn drain(&mut self, now_ns: u64) {
        self.barrier.drain(now_ns);
    }

    /// Sends the requests whose preceding strokes are painted.
    pub(super) fn send(
        &mut self,
        context: &Context,
        studio: &mut Studio,
        hands: &mut Hands,
        Connection { bus, tracker, .. }: &Connection,
    ) {
        let now_ns = bus.now_ns();
        let is_shown = studio.shows_devices();
        let orders = studio.requests.take_device_orders();
        let shown = (&mut studio.rig, &mut studio.notifications);
        self.device_setup.poll(context, orders, is_shown, shown);
        let orders = studio.requests.take_session_orders();
        let shown = (&mut studio.rig, &mut studio.notifications);
        self.sessions.poll(context, orders, shown);
        // The mouse's samples until then are sent, and those of others received.
        let heard_ns = tracker.heard_until_ns().min(now_ns);
        let asked_ns = studio.rig.live.now_ns.max(heard_ns);
        for follow_up in studio.requests.take_follow_ups() {
            self.barrier.push_follow_up(follow_up);
        }
        // The cleaning key acts within a stroke, and so does the free hand.
        let mut within = hands.clean_key.take();
        within.append(&mut hands.navigation.take());
        let contact = BrushContact::of(hands.holds_desk(tracker));
        let asked = studio.requests.take();
        let released = self.held_places.release(contact, asked, &within);
        // The brush is not changed while the hand has it on a surface.
        let is_sent = |request: &_| !studio.context().refuses(request);
        let released = released.into_iter().filter(is_sent);
        for request in released.chain(within) {
            let newest = tracker.newest(now_ns);
            self.barrier.push(now_ns, (request, asked_ns), newest);
        }
        while let Some(ready) = self.barrier.next_ready(now_ns) {
            self.dispatcher.send(ready);
        }
        let oldest = [self.barrier.oldest_ns(), self.dispatcher.oldest_ns()];
        let since_ns = oldest.into_iter().flatten().min();
        if let Err(error) = self.pending.send(now_ns, since_ns) {
            tracing::warn!("pending settings cannot be sent to the brushes: {error}");
        }
        if self.barrier.is_waiting() || since_ns.is_some() {
            context.request_repaint_after(BARRIER_LOOK);
        }
    }
}
