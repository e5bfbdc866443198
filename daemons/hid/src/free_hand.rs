//! A 6-DOF mouse on the bus.

use std::sync::Arc;

use maulstick_bus::typed::Sender;
use maulstick_bus::{Bus, BusError, Class};
use maulstick_device::actions::{Actions, Actor};
use maulstick_device::mover::Mover;
use maulstick_rig::Fault;
use maulstick_rig::config::DeviceSection;
use maulstick_types::Origin;
use maulstick_types::control::ControlSample;
use maulstick_types::stylus::StylusInfo;
use maulstick_types::topics::Topics;

use crate::spacemouse::{SILENCE_NS, SpaceMouse};

/// A mouse that comes to rest by itself is told of this often, ns.
const DECAY_STEP_NS: u64 = 10_000_000;
/// What a mouse does is told of again after this time, ns: a sample may be lost, and it may be the last.
const REPEAT_NS: u64 = 100_000_000;

/// Reports a second of most mice while they are pushed.
const RATE_HZ: f64 = 125.0;

/// A mouse, from its reports to its samples.
pub struct FreeHand {
    mouse: Option<SpaceMouse>,
    samples: Sender<ControlSample>,
    info: Sender<StylusInfo>,
    /// Moves the canvas.
    mover: Mover,
    /// Does what its switches ask for.
    actor: Actor,
    /// When it was last told of, and when it last reported, ns.
    told_ns: u64,
    heard_ns: u64,
    sent: u64,
}

impl FreeHand {
    /// The mouse of a section.
    ///
    /// # Errors
    /// A [`Fault`] where the rig or the system refuses.
    pub fn new(
        bus: &Arc<dyn Bus>,
        topics: &Topics,
        device: &DeviceSection,
        origin: Origin,
    ) -> Result<Self, Fault> {
        let (topic, actions) = (topics.control(&device.name), Actions::of(device));
        Ok(Self {
            mouse: None,
            samples: Sender::new(&**bus, &topic, Class::RealTime, origin)?,
            info: Sender::new(
                &**bus,
                &topics.stylus_info(&device.name),
                Class::Cached,
                origin,
            )?,
            mover: Mover::start(bus, topics)?,
            actor: Actor::start(Arc::clone(bus), topics, &device.brush, actions)?,
            told_ns: 0,
            heard_ns: 0,
            sent: 0,
        })
    }

    /// A mouse is there.
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
        // It is no stylus, but is listed with them.
        let told = StylusInfo {
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
        self.info.send(now_ns, now_ns, &told)
    }

    /// A report of time `event_ns`.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn report(&mut self, report: &[u8], event_ns: u64, now_ns: u64) -> Result<(), BusError> {
        let mouse = self.mouse.as_mut();
        if !mouse.is_some_and(|mouse| mouse.follow(report, event_ns)) {
            return Ok(());
        }
        self.heard_ns = event_ns;
        self.tell(event_ns, now_ns)
    }

    /// Nothing came until `until_ns`.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn silent(&mut self, until_ns: u64, now_ns: u64) -> Result<(), BusError> {
        match self.due_ns() {
            Some(due_ns) if due_ns <= until_ns => self.tell(until_ns, now_ns),
            _ => Ok(()),
        }
    }

    /// The mouse is gone: nobody pushes it.
    ///
    /// # Errors
    /// [`BusError`].
    pub fn end(&mut self, event_ns: u64, now_ns: u64) -> Result<(), BusError> {
        if let Some(mouse) = &mut self.mouse {
            mouse.leave();
            self.tell(event_ns, now_ns)?;
        }
        self.mouse = None;
        Ok(())
    }

    /// When to tell of it again, ns.
    #[must_use]
    pub fn due_ns(&self) -> Option<u64> {
        let mouse = self.mouse.as_ref()?;
        let again_ns = self.told_ns + REPEAT_NS;
        Some(match mouse.is_deflected() {
            true => {
                let decay_ns = (self.heard_ns + SILENCE_NS).max(self.told_ns) + DECAY_STEP_NS;
                again_ns.min(decay_ns)
            }
            false => again_ns,
        })
    }

    /// Samples sent.
    #[must_use]
    pub fn sent(&self) -> u64 {
        self.sent
    }

    fn tell(&mut self, event_ns: u64, now_ns: u64) -> Result<(), BusError> {
        let Some(mouse) = &mut self.mouse else {
            return Ok(());
        };
        let sample = mouse.sample(event_ns);
        self.samples.send(now_ns, event_ns, &sample)?;
        self.mover.hear(&sample);
        self.actor.press(sample.switches);
        self.told_ns = event_ns;
        self.sent += 1;
        Ok(())
    }
}

impl std::fmt::Debug for FreeHand {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("FreeHand")
            .field("mouse", &self.mouse)
            .field("sent", &self.sent)
            .finish_non_exhaustive()
    }
}
