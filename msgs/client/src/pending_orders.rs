//! Notice to the brushes that something is asked for and not done yet: a stroke that begins later waits for it.

use maulstick_bus::typed::{Sender, random_epoch};
use maulstick_bus::{Bus, BusError, Qos};
use maulstick_types::window::PendingOrders;
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Origin, name_hash};

/// Interval at which the notice is repeated while something is pending, ns.
const AGAIN_NS: u64 = 50_000_000;

/// The sender of a front end.
pub struct PendingSender {
    sender: Sender<PendingOrders>,
    /// The time that was sent last, and when that was, ns.
    last: (u64, u64),
}

impl PendingSender {
    /// A sender that has sent nothing.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn new(bus: &dyn Bus, topics: &Topics) -> Result<Self, BusError> {
        let me = Origin {
            source: name_hash("ui"),
            epoch: random_epoch(),
        };
        Ok(Self {
            sender: Sender::new(bus, &topics.pending_orders(), Qos::Control, me)?,
            last: (0, 0),
        })
    }

    /// Sends since when something is pending, if that has changed or was sent long ago.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn send(&mut self, now_ns: u64, since_ns: Option<u64>) -> Result<(), BusError> {
        let since_ns = since_ns.unwrap_or(0);
        let (last, at_ns) = self.last;
        let is_late = since_ns != 0 && now_ns >= at_ns.saturating_add(AGAIN_NS);
        if last == since_ns && !is_late {
            return Ok(());
        }
        self.last = (since_ns, now_ns);
        self.sender
            .send(now_ns, now_ns, &PendingOrders { since_ns })
    }
}
