//! News of the rig for the brush node, but for samples, scenes and commands.

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, BusError, Qos, Queue, Subscription, Wake};
use maulstick_types::Header;
use maulstick_types::brush::BrushRelief;
use maulstick_types::paint::PaintConsumed;
use maulstick_types::stylus::StylusInfo;
use maulstick_types::window::PendingOrders;
use maulstick_types::wire::topics::Topics;

/// One piece of news.
pub(super) enum Input {
    /// A node came or went.
    Presence { node: String, is_present: bool },
    /// Credit and contact of the brushes.
    Consumed(PaintConsumed),
    /// The oldest order that a window waits for.
    Pending(Header, PendingOrders),
    /// The newest relief below the brush.
    Relief(BrushRelief),
    /// Claims of a device about itself.
    Device { device: String, info: StylusInfo },
}

/// Subscriptions of the brush node.
pub(super) struct Inputs {
    topics: Topics,
    tokens: Subscription,
    consumed: Receiver<PaintConsumed>,
    pending: Receiver<PendingOrders>,
    reliefs: Receiver<BrushRelief>,
    infos: Receiver<StylusInfo>,
}

impl Inputs {
    /// Subscribes for the brush of this name.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn new(
        bus: &dyn Bus,
        topics: &Topics,
        brush: &str,
        wake: &Wake,
    ) -> Result<Self, BusError> {
        let (control, cached) = (Qos::Control, Qos::Cached);
        let consumed = (topics.paint_consumed(), Queue::Ring(64));
        let pending = (topics.pending_orders(), Queue::Ring(16));
        let infos = (topics.stylus_info("*"), Queue::Ring(64));
        let reliefs = (topics.brush_relief(brush), Queue::Ring(4));
        Ok(Self {
            topics: topics.clone(),
            tokens: bus.watch(&topics.node("*"), wake)?,
            consumed: Receiver::new(bus, &consumed.0, control, consumed.1, wake)?,
            pending: Receiver::new(bus, &pending.0, control, pending.1, wake)?,
            reliefs: Receiver::new(bus, &reliefs.0, Qos::RealTime, reliefs.1, wake)?
                .checking(BrushRelief::fault),
            infos: Receiver::new(bus, &infos.0, cached, infos.1, wake)?,
        })
    }

    /// The next piece of news.
    pub(super) fn next(&mut self) -> Option<Input> {
        if let Some(token) = self.tokens.try_recv() {
            let node = self.topics.node_of(&token.key).unwrap_or_default();
            return Some(Input::Presence {
                node: node.to_owned(),
                is_present: token.present,
            });
        }
        if let Some(consumed) = self.consumed.try_recv() {
            return Some(Input::Consumed(consumed.message));
        }
        if let Some(pending) = self.pending.try_recv() {
            return Some(Input::Pending(pending.header, pending.message));
        }
        if let Some(relief) = self.reliefs.newest() {
            return Some(Input::Relief(relief.message));
        }
        let info = self.infos.try_recv()?;
        let device = self.topics.middle(&info.key).unwrap_or_default();
        Some(Input::Device {
            device: device.to_owned(),
            info: info.message,
        })
    }
}
