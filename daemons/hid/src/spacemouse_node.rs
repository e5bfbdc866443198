//! A 6-DOF mouse on the bus: its samples, the canvas that it moves, its switches.

use std::sync::Arc;

use maulstick_bus::typed::Sender;
use maulstick_bus::{Bus, BusError, Qos};
use maulstick_device::actions::{Actions, Actor};
use maulstick_device::canvas_mover::CanvasMover;
use maulstick_rig::UserError;
use maulstick_rig::config::DeviceSection;
use maulstick_types::Origin;
use maulstick_types::control::ControlSample;
use maulstick_types::stylus::StylusInfo;
use maulstick_types::wire::topics::Topics;

use crate::spacemouse::{SILENCE_NS, SpaceMouse};

/// Time between two samples of a mouse that comes to rest by itself, ns.
const DECAY_STEP_NS: u64 = 10_000_000;
/// Time after which the newest sample is repeated, ns: it may have been lost, and may be the last.
const REPEAT_NS: u64 = 100_000_000;

/// Reports a second of most mice while they are pushed.
const RATE_HZ: f64 = 125.0;

/// A mouse, from its reports to its samples.
pub struct SpaceMouseNode {
    mouse: Option<SpaceMouse>,
    samples: Sender<ControlSample>,
    info: Sender<StylusInfo>,
    /// Moves the canvas.
    mover: CanvasMover,
    /// Performs the actions of its switches.
    actor: Actor,
    /// Time of the newest sample, ns.
    sent_ns: u64,
    /// Time of the newest report, ns.
    reported_ns: u64,
    sent: u64,
}

impl SpaceMouseNode {
    /// The mouse of a section.
    ///
    /// # Errors
    /// A [`UserError`] where the rig or the system refuses.
    pub fn new(
        bus: &Arc<dyn Bus>,
        topics: &Topics,
        device: &DeviceSection,
        origin: Origin,
    ) -> Result<Self, UserError> {
        let (topic, actions) = (topics.control(&device.name), Actions::of(device));
        Ok(Self {
            mouse: None,
            samples: Sender::new(&**bus, &topic, Qos::RealTime, origin)?,
            info: Sender::new(
                &**bus,
                &topics.stylus_info(&device.name),
                Qos::Cached,
                origin,
            )?,
            mover: CanvasMover::start(bus, topics)?,
            actor: Actor::start(Arc::clone(bus), topics, &device.brush, actions)?,
            sent_ns: 0,
            reported_ns: 0,
            sent: 0,
        })
    }

    /// Begins with a mouse that was opened.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn begin(
        &mut self,
        mouse: SpaceMouse,
        device: &DeviceSection,
        now_ns: u64,
    ) -> Result<(), BusError> {
        self.mouse = Some(mouse);
        // Not a stylus, but listed with them.
        let info = StylusInfo {
            device: device.name.clone(),
            driver: device.driver.clone(),
            brush: device.brush.clone(),
            priority: device.priority,
            senses: 0,
            drives: 0,
            rate_hz: RATE_HZ,
            max_force_n: 0.0,
            max_stiffness_n_m: 0.0,
            workspace_m: [0.0; 6],
        };
        self.info.send(now_ns, now_ns, &info)
    }

    /// Takes in a report of time `event_ns`.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn report(&mut self, report: &[u8], event_ns: u64, now_ns: u64) -> Result<(), BusError> {
        let mouse = self.mouse.as_mut();
        if !mouse.is_some_and(|mouse| mouse.follow(report, event_ns)) {
            return Ok(());
        }
        self.reported_ns = event_ns;
        self.publish(event_ns, now_ns)
    }

    /// Advances to `until_ns` without a report.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn silent(&mut self, until_ns: u64, now_ns: u64) -> Result<(), BusError> {
        match self.due_ns() {
            Some(due_ns) if due_ns <= until_ns => self.publish(until_ns, now_ns),
            _ => Ok(()),
        }
    }

    /// Ends with a mouse that is gone: it is not pushed any more.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn end(&mut self, event_ns: u64, now_ns: u64) -> Result<(), BusError> {
        if let Some(mouse) = &mut self.mouse {
            mouse.leave();
            self.publish(event_ns, now_ns)?;
        }
        self.mouse = None;
        Ok(())
    }

    /// Time of the next sample, ns.
    #[must_use]
    pub fn due_ns(&self) -> Option<u64> {
        let mouse = self.mouse.as_ref()?;
        let again_ns = self.sent_ns + REPEAT_NS;
        Some(if mouse.is_deflected() {
            let decay_ns = (self.reported_ns + SILENCE_NS).max(self.sent_ns) + DECAY_STEP_NS;
            again_ns.min(decay_ns)
        } else {
            again_ns
        })
    }

    /// Number of samples sent.
    #[must_use]
    pub fn sent(&self) -> u64 {
        self.sent
    }

    fn publish(&mut self, event_ns: u64, now_ns: u64) -> Result<(), BusError> {
        let Some(mouse) = &mut self.mouse else {
            return Ok(());
        };
        let sample = mouse.sample(event_ns);
        self.samples.send(now_ns, event_ns, &sample)?;
        self.mover.receive(&sample);
        self.actor.press(sample.switches);
        self.sent_ns = event_ns;
        self.sent += 1;
        Ok(())
    }
}

impl std::fmt::Debug for SpaceMouseNode {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SpaceMouseNode")
            .field("mouse", &self.mouse)
            .field("sent", &self.sent)
            .finish_non_exhaustive()
    }
}
