//! Publications of a device: samples, claims, status.

use maulstick_bus::credit::Stamp;
use maulstick_bus::typed::Sender;
use maulstick_bus::{Bus, BusError, CreditSender, Qos, Wake};
use maulstick_num::geometry::Rigid;
use maulstick_types::stylus::{StylusInfo, StylusPose, StylusSample, StylusStatus};
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Flags, Origin};

use crate::servo::channels::TickRecord;
use crate::servo::servo_thread::{BINS, bin};

/// Time between two statuses, ns.
const STATUS_PERIOD_NS: u64 = 100_000_000;
/// Time between two samples out of range, ns.
const IDLE_PERIOD_NS: u64 = 50_000_000;

/// Senders of a device, and its newest state.
pub(super) struct Output {
    samples: CreditSender<StylusSample>,
    newest: StylusSample,
    /// Time of the newest sample, ns.
    published_ns: u64,
    infos: Sender<StylusInfo>,
    statuses: Sender<StylusStatus>,
    status: StylusStatus,
    status_ns: u64,
    /// Offset from `CLOCK_MONOTONIC`, which stamps the ticks, to the rig's clock, ns.
    offset_ns: u64,
}

impl Output {
    /// The output of the device of this name.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn new(
        bus: &dyn Bus,
        topics: &Topics,
        (device, me): (&str, Origin),
        offset_ns: u64,
        wake: &Wake,
    ) -> Result<Self, BusError> {
        let status = topics.stylus_status(device);
        Ok(Self {
            samples: CreditSender::new(bus, topics, &topics.sample(device), me, wake)?,
            newest: StylusSample::away(),
            published_ns: 0,
            infos: Sender::new(bus, &topics.stylus_info(device), Qos::Cached, me)?,
            statuses: Sender::new(bus, &status, Qos::Background, me)?,
            status: StylusStatus::fresh(BINS),
            status_ns: 0,
            offset_ns,
        })
    }

    /// Origin of the samples.
    pub(super) fn origin(&self) -> Origin {
        self.samples.origin()
    }

    /// The status that is published next.
    pub(super) fn status(&self) -> &StylusStatus {
        &self.status
    }

    /// The status that is published next.
    pub(super) fn status_mut(&mut self) -> &mut StylusStatus {
        &mut self.status
    }

    /// Publishes what an opened device can do.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn announce(&mut self, info: &StylusInfo, now_ns: u64) -> Result<(), BusError> {
        self.infos.send(now_ns, now_ns, info)
    }

    /// Notes a tick of the servo; the sample of it.
    pub(super) fn note(&mut self, record: &TickRecord, senses: u32) -> StylusSample {
        let (status, tick) = (&mut self.status, &record.tick);
        status.lateness[bin(record.late_ns)] += 1;
        status.execution[bin(record.spent_ns)] += 1;
        status.force_n = record.force.length();
        // Only a reading ends the reported trouble: a device may be lost again before it gives one.
        status.clear_trouble();
        (status.resting, status.is_guided) = (tick.resting, tick.guided);
        (status.asked_n_m, status.stiffness_n_m) = (tick.asked_n_m, tick.stiffness_n_m);
        status.cap_n = tick.cap_n;
        let reading = &record.reading;
        status.motor_temperature = reading.motor_temperature;
        let handle = Rigid {
            rotation: reading.handle.orientation,
            translation: reading.handle.position,
        };
        StylusSample {
            senses,
            pose: StylusPose::Ferrule {
                pose: handle.to_pose(),
            },
            velocity_m_s: reading.handle.velocity.to_array(),
            force_n: record.force.to_array(),
            switches: reading.switches,
            in_range: reading.in_range,
        }
    }

    /// Publishes the sample of a tick; out of range only now and then.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn publish(
        &mut self,
        sample: StylusSample,
        monotonic_ns: u64,
        now_ns: u64,
    ) -> Result<(), BusError> {
        let event_ns = monotonic_ns + self.offset_ns;
        let leaves = self.newest.in_range && !sample.in_range;
        if !sample.in_range && !leaves && event_ns < self.published_ns + IDLE_PERIOD_NS {
            return Ok(());
        }
        self.send(sample, event_ns, now_ns)
    }

    /// Lifts the brush of a device that is lost; the sample that says so.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn lift(&mut self, now_ns: u64) -> Result<StylusSample, BusError> {
        let away = StylusSample {
            in_range: false,
            switches: 0,
            force_n: [0.0; 3],
            velocity_m_s: [0.0; 3],
            ..self.newest.clone()
        };
        if self.newest.in_range {
            self.send(away.clone(), now_ns, now_ns)?;
        }
        (self.status.force_n, self.status.is_guided) = (0.0, false);
        Ok(away)
    }

    fn send(&mut self, sample: StylusSample, event_ns: u64, now_ns: u64) -> Result<(), BusError> {
        self.published_ns = event_ns;
        self.status.samples += 1;
        let stamp = Stamp { now_ns, event_ns };
        self.samples.send(Flags::NONE, stamp, &sample)?;
        self.newest = sample;
        Ok(())
    }

    /// Sends missed samples again, and the status at its period.
    ///
    /// # Errors
    /// [`BusError`].
    pub(super) fn serve(&mut self, dropped: u64, now_ns: u64) -> Result<(), BusError> {
        // A live device never waits for credit; the ring serves receivers that missed a sample.
        self.samples.reset_credit();
        self.samples.serve(now_ns)?;
        if now_ns < self.status_ns + STATUS_PERIOD_NS {
            return Ok(());
        }
        self.status_ns = now_ns;
        self.status.dropped = dropped;
        self.statuses.send(now_ns, now_ns, &self.status)
    }

    /// Reason why the device has no force, or an empty text.
    pub(super) fn fault(&self) -> String {
        match self.status.trouble() {
            Some(trouble) if self.status.faults.is_empty() => trouble.to_string(),
            _ => self.status.faults.join("; "),
        }
    }
}
