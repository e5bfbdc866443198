//! A pen on the bus: its samples, in order of time.
//!
//! A brush takes a leap of more than a tenth of a second for a new beginning, and many tablets are silent while nothing
//! changes. So the sample of a near and silent pen is repeated, and a resting stroke continues. On a tablet that never
//! reports its pen as away, one that hovers in silence for a second counts as away.

use std::sync::Arc;

use maulstick_bus::credit::Stamp;
use maulstick_bus::typed::Sender;
use maulstick_bus::{Bus, BusError, CreditSender, Qos, Wake};
use maulstick_device::actions::{Actions, Actor};
use maulstick_rig::UserError;
use maulstick_rig::config::DeviceSection;
use maulstick_types::stylus::{StylusInfo, StylusSample};
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Flags, Origin};

use crate::open::Decoder;
use crate::pen::{Pen, Presence, Reading};
use crate::tablet::Tablet;

/// Interval at which the sample of a silent pen is repeated, ns.
pub const REPEAT_NS: u64 = 50_000_000;
/// A pen that hovers in silence for so long is away, where the tablet would not say so, ns.
pub const GONE_NS: u64 = 1_000_000_000;
/// Samples are at least this far apart, ns: reports that were read together did not come together.
pub const SPACING_NS: u64 = 500_000;
/// A silence of more than this, ns, is not filled: the machine slept.
const LONGEST_NS: u64 = 60_000_000_000;
/// Reports a second of most tablets, which do not say.
const RATE_HZ: f64 = 200.0;

/// A pen, from its reports to its samples.
pub struct Stylus {
    pen: Pen,
    /// Decoder of the reports and the tablet on the desk; `None` while there is no tablet.
    tablet: Option<(Decoder, Tablet)>,
    samples: CreditSender<StylusSample>,
    info: Sender<StylusInfo>,
    /// Does what its switches ask for.
    actor: Actor,
    newest: StylusSample,
    event_ns: u64,
    /// When the pen was last reported, ns.
    heard_ns: u64,
    sent: u64,
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
            pen: Pen::default(),
            tablet: None,
            samples,
            info: Sender::new(&**bus, &topic, Qos::Cached, origin)?,
            actor: Actor::start(Arc::clone(bus), topics, &device.brush, actions)?,
            newest: StylusSample::away(),
            event_ns: 0,
            heard_ns: 0,
            sent: 0,
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
        self.tablet = Some((decoder, tablet));
        self.info.send(now_ns, now_ns, &told)
    }

    /// A report of time `event_ns`.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn report(&mut self, report: &[u8], event_ns: u64, now_ns: u64) -> Result<(), BusError> {
        let decoder = self.tablet.as_mut().map(|(decoder, _)| decoder);
        let Some(said) = decoder.and_then(|decoder| decoder.decode(report)) else {
            return Ok(());
        };
        // A report at the same time needs no fill-in.
        self.silent(event_ns.saturating_sub(1), now_ns)?;
        self.heard_ns = event_ns;
        let mut readings = Vec::with_capacity(3);
        self.pen.follow(said, &mut |reading| readings.push(reading));
        self.tell(&readings, event_ns, now_ns)
    }

    /// Nothing came until `until_ns`.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn silent(&mut self, until_ns: u64, now_ns: u64) -> Result<(), BusError> {
        if self.newest.in_range && until_ns.saturating_sub(self.event_ns) > LONGEST_NS {
            self.event_ns = until_ns;
        }
        let gone_ns = self.gone_ns().filter(|gone_ns| *gone_ns <= until_ns);
        let near_ns = gone_ns.unwrap_or(until_ns);
        while self.newest.in_range && self.event_ns + REPEAT_NS <= near_ns {
            self.send(self.newest.clone(), self.event_ns + REPEAT_NS, now_ns)?;
        }
        match gone_ns {
            Some(gone_ns) => self.leave(gone_ns, now_ns),
            None => Ok(()),
        }
    }

    /// Time at which a hovering pen counts as away, ns; `None` if the tablet reports it.
    fn gone_ns(&self) -> Option<u64> {
        let (decoder, _) = self.tablet.as_ref()?;
        let hovers = self.pen.newest().presence == Presence::Hovering;
        (hovers && !decoder.tells_range()).then_some(self.heard_ns + GONE_NS)
    }

    fn leave(&mut self, event_ns: u64, now_ns: u64) -> Result<(), BusError> {
        let mut readings = Vec::with_capacity(2);
        self.pen.leave(&mut |reading| readings.push(reading));
        self.tell(&readings, event_ns, now_ns)
    }

    /// The tablet is gone, at `event_ns`: the pen is lifted, and leaves.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn end(&mut self, event_ns: u64, now_ns: u64) -> Result<(), BusError> {
        self.leave(event_ns, now_ns)?;
        self.tablet = None;
        Ok(())
    }

    /// Answers for lost samples. Nobody waits for credit on a live device.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn serve(&mut self, now_ns: u64) -> Result<(), BusError> {
        self.samples.reset_credit();
        self.samples.serve(now_ns)
    }

    /// Time at which the sample of a silent pen is due again, ns.
    #[must_use]
    pub fn due_ns(&self) -> Option<u64> {
        self.newest.in_range.then_some(self.event_ns + REPEAT_NS)
    }

    /// Samples sent.
    #[must_use]
    pub fn sent(&self) -> u64 {
        self.sent
    }

    fn tell(&mut self, readings: &[Reading], event_ns: u64, now_ns: u64) -> Result<(), BusError> {
        for reading in readings {
            let sample = self
                .tablet
                .as_ref()
                .map(|(_, tablet)| tablet.sample(reading));
            if let Some(sample) = sample {
                self.send(sample, event_ns, now_ns)?;
            }
        }
        Ok(())
    }

    fn send(&mut self, sample: StylusSample, event_ns: u64, now_ns: u64) -> Result<(), BusError> {
        self.event_ns = event_ns.max(self.event_ns + SPACING_NS);
        let stamp = Stamp {
            now_ns,
            event_ns: self.event_ns,
        };
        self.samples.send(Flags::NONE, stamp, &sample)?;
        self.actor.receive(&sample);
        self.newest = sample;
        self.sent += 1;
        Ok(())
    }
}

impl std::fmt::Debug for Stylus {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Stylus")
            .field("pen", &self.pen)
            .field("sent", &self.sent)
            .finish_non_exhaustive()
    }
}
