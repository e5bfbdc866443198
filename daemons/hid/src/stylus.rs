//! A pen on the bus, from the reports of its tablet.

use std::sync::Arc;

use maulstick_bus::typed::Sender;
use maulstick_bus::{Bus, BusError, CreditSender, Qos, Wake};
use maulstick_device::actions::{Actions, Actor};
use maulstick_device::pen::Reading;
use maulstick_device::pen_stream::{DeskFit, PenStream};
use maulstick_rig::UserError;
use maulstick_rig::config::DeviceSection;
use maulstick_types::Origin;
use maulstick_types::stylus::{StylusInfo, StylusSample};
use maulstick_types::wire::topics::Topics;

use crate::open::Decoder;
use crate::tablet::Tablet;

/// Reports a second of most tablets, which do not say.
const RATE_HZ: f64 = 200.0;

/// A pen, from its reports to its samples.
pub struct Stylus {
    pen: PenStream,
    /// Decoder of the reports; `None` while there is no tablet.
    decoder: Option<Decoder>,
    desk: Desk,
    info: Sender<StylusInfo>,
}

/// The tablet on the desk, and who does what its switches ask for.
struct Desk {
    tablet: Option<Tablet>,
    actor: Actor,
}

impl DeskFit for Desk {
    fn sample(&mut self, reading: &Reading) -> StylusSample {
        let tablet = self.tablet.as_ref();
        tablet.map_or_else(StylusSample::away, |tablet| tablet.sample(reading))
    }

    fn sent(&mut self, sample: &StylusSample) {
        self.actor.receive(sample);
    }
}

impl Stylus {
    /// The pen of a section.
    ///
    /// # Errors
    /// A [`UserError`] where the rig or the system refuses.
    pub fn new(
        bus: &Arc<dyn Bus>,
        topics: &Topics,
        device: &DeviceSection,
        origin: Origin,
        wake: &Wake,
    ) -> Result<Self, UserError> {
        let (name, actions) = (&device.name, Actions::of(device));
        let samples = CreditSender::new(&**bus, topics, &topics.sample(name), origin, wake)?;
        let topic = topics.stylus_info(name);
        Ok(Self {
            pen: PenStream::new(samples),
            decoder: None,
            desk: Desk {
                tablet: None,
                actor: Actor::start(Arc::clone(bus), topics, &device.brush, actions)?,
            },
            info: Sender::new(&**bus, &topic, Qos::Cached, origin)?,
        })
    }

    /// A tablet is there.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn begin(
        &mut self,
        decoder: Decoder,
        tablet: Tablet,
        device: &DeviceSection,
        now_ns: u64,
    ) -> Result<(), BusError> {
        let told = StylusInfo {
            device: device.name.clone(),
            driver: device.driver.clone(),
            brush: device.brush.clone(),
            priority: device.priority,
            senses: decoder.senses(),
            drives: 0,
            rate_hz: RATE_HZ,
            max_force_n: 0.0,
            max_stiffness_n_m: 0.0,
            workspace_m: tablet.workspace_m(),
        };
        self.pen.set_reports_range(decoder.tells_range());
        (self.decoder, self.desk.tablet) = (Some(decoder), Some(tablet));
        self.info.send(now_ns, now_ns, &told)
    }

    /// A report of time `event_ns`.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn report(&mut self, report: &[u8], event_ns: u64, now_ns: u64) -> Result<(), BusError> {
        let read = self.decoder.as_mut().and_then(|own| own.decode(report));
        match read {
            Some(reading) => self.pen.read(reading, (event_ns, now_ns), &mut self.desk),
            None => Ok(()),
        }
    }

    /// Nothing came until `until_ns`.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn silent(&mut self, until_ns: u64, now_ns: u64) -> Result<(), BusError> {
        self.pen.silent(until_ns, now_ns, &mut self.desk)
    }

    /// The tablet is gone, at `event_ns`: the pen is lifted, and leaves.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn end(&mut self, event_ns: u64, now_ns: u64) -> Result<(), BusError> {
        self.pen.leave(event_ns, now_ns, &mut self.desk)?;
        (self.decoder, self.desk.tablet) = (None, None);
        Ok(())
    }

    /// Answers for lost samples.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn serve(&mut self, now_ns: u64) -> Result<(), BusError> {
        self.pen.serve(now_ns)
    }

    /// Time at which the sample of a silent pen is due again, ns.
    #[must_use]
    pub fn due_ns(&self) -> Option<u64> {
        self.pen.due_ns()
    }

    /// Samples sent.
    #[must_use]
    pub fn sent(&self) -> u64 {
        self.pen.sent()
    }
}

impl std::fmt::Debug for Stylus {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Stylus")
            .field("pen", &self.pen)
            .finish_non_exhaustive()
    }
}
