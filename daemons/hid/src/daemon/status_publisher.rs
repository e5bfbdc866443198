//! Status of a device without force.

use maulstick_bus::typed::Sender;
use maulstick_bus::{Bus, BusError, Qos};
use maulstick_device::device_missing::report_missing;
use maulstick_rig::UserError;
use maulstick_types::Origin;
use maulstick_types::node::NodeWork;
use maulstick_types::stylus::StylusStatus;
use maulstick_types::wire::topics::Topics;

/// Time between two statuses, ns.
const PERIOD_NS: u64 = 100_000_000;
/// Histogram bins in the status of a daemon without a servo.
const NO_BINS: usize = 0;

/// Publisher of the status.
pub(super) struct StatusPublisher {
    device: String,
    statuses: Sender<StylusStatus>,
    status: StylusStatus,
    sent_ns: u64,
}

impl StatusPublisher {
    /// The status of the device of this name.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn new(
        bus: &dyn Bus,
        topics: &Topics,
        device: &str,
        origin: Origin,
    ) -> Result<Self, BusError> {
        let topic = topics.stylus_status(device);
        Ok(Self {
            device: device.to_owned(),
            statuses: Sender::new(bus, &topic, Qos::Background, origin)?,
            status: StylusStatus {
                // It has no force.
                is_on: false,
                strength: 0.0,
                ..StylusStatus::fresh(NO_BINS)
            },
            sent_ns: 0,
        })
    }

    /// Publishes counts of samples at its period.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn publish(
        &mut self,
        samples: u64,
        dropped: u64,
        now_ns: u64,
    ) -> Result<(), BusError> {
        if now_ns < self.sent_ns + PERIOD_NS {
            return Ok(());
        }
        self.sent_ns = now_ns;
        (self.status.samples, self.status.dropped) = (samples, dropped);
        self.statuses.send(now_ns, now_ns, &self.status)
    }

    /// Reports why the device cannot be used.
    pub(super) fn report_missing(&mut self, fault: &UserError) {
        report_missing(&self.device, fault, &mut self.status);
    }

    /// Reports that the device is in use.
    pub(super) fn report_open(&mut self) {
        self.status.clear_trouble();
    }

    /// Work since the start, as last published.
    pub(super) fn work(&self) -> NodeWork {
        NodeWork {
            produced: self.status.samples,
            lost: self.status.dropped,
            ..NodeWork::default()
        }
    }
}
