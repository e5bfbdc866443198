//! Tells the brushes that something is asked for and not done yet: a stroke that begins later waits for it.

use maulstick_bus::typed::{Sender, random_epoch};
use maulstick_bus::{Bus, BusError, Qos};
use maulstick_types::window::PendingOrders;
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Origin, name_hash};

/// Interval at which what is pending is told again, ns.
const AGAIN_NS: u64 = 50_000_000;

/// The sender of a window.
pub(crate) struct PendingTeller {
    sender: Sender<PendingOrders>,
    /// What was told last, and when, ns.
    told: (u64, u64),
}

impl PendingTeller {
    /// A sender that has told nothing.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub(crate) fn new(bus: &dyn Bus, topics: &Topics) -> Result<Self, BusError> {
        let me = Origin {
            source: name_hash("ui"),
            epoch: random_epoch(),
        };
        Ok(Self {
            sender: Sender::new(bus, &topics.pending_orders(), Qos::Control, me)?,
            told: (0, 0),
        })
    }

    /// Tells since when something is pending, where that is news or was told long ago.
    ///
    /// # Errors
    /// [`BusError`].
    pub(crate) fn tell(&mut self, now_ns: u64, since_ns: Option<u64>) -> Result<(), BusError> {
        let since_ns = since_ns.unwrap_or(0);
        let (told, at_ns) = self.told;
        let is_late = since_ns != 0 && now_ns >= at_ns.saturating_add(AGAIN_NS);
        if told == since_ns && !is_late {
            return Ok(());
        }
        self.told = (since_ns, now_ns);
        self.sender
            .send(now_ns, now_ns, &PendingOrders { since_ns })
    }
}
