//! The thread that talks to the rig: samples and status out, contact models and force orders in.

mod orders;

use std::time::Duration;

use maulstick_bus::credit::Stamp;
use maulstick_bus::typed::{Receiver, Sender};
use maulstick_bus::{CreditSender, Qos, Queue};
use maulstick_device::actions::{Action, Actions, Actor};
use maulstick_device::device_missing::report_missing;
use maulstick_device::registration::Registration;
use maulstick_haptics::{Contact, Fluid, Guide, Limits, Recipient, ServoMemory, Switch};
use maulstick_num::geometry::Rigid;
use maulstick_rig::{NodeHandle, RigConfig, UserError};
use maulstick_types::Flags;
use maulstick_types::brush::BrushConsumed;
use maulstick_types::haptics::{ContactModel, FluidForce, GuideModel};
use maulstick_types::node::NodeWork;
use maulstick_types::stylus::{StylusInfo, StylusPose, StylusSample, StylusStatus};

use crate::device::mounted_device::MountedDevice;
use crate::device::open::{HapticSettings, open};
use crate::force_state_file::{ForceState, ForceStateFile};
use crate::inlet::Inlet;
use crate::senders::{Means, Senders};
use crate::servo::channels::TickRecord;
use crate::servo::force_control::ForceControl;
use crate::servo::servo_loop::PreviousServo;
use crate::servo::servo_thread::{BINS, Ended, ServoThread, bin};
use orders::Orders;

/// Time between two statuses, ns.
const STATUS_PERIOD_NS: u64 = 100_000_000;
/// Time between two attempts to open a device that is not there, ns.
const ATTEMPT_PERIOD_NS: u64 = 1_000_000_000;
/// Time between two samples out of range, ns.
const IDLE_PERIOD_NS: u64 = 50_000_000;

/// Runs a device in the rig of `member`.
///
/// # Errors
/// [`UserError`] if the device or the rig cannot be used.
pub fn run(member: &mut NodeHandle, settings: &HapticSettings) -> Result<(), UserError> {
    let mut daemon = Daemon::new(member, settings)?;
    member.ready()?;
    member.run(|| {
        let wait = daemon.turn()?;
        member.work.set(daemon.work());
        Ok(wait)
    })
}

struct Daemon {
    bus: std::sync::Arc<dyn maulstick_bus::Bus>,
    config: RigConfig,
    settings: HapticSettings,
    /// The servo, while a device is open.
    servo: Option<ServoThread>,
    /// State of the previous servo, and the time of its end, ns.
    previous: Option<(PreviousServo, u64)>,
    /// Force settings and latched fault as they survive this daemon.
    state_file: ForceStateFile,
    /// Latched fault.
    latched: Option<maulstick_haptics::Fault>,
    /// Description of the device that was logged last.
    what: String,
    /// Actions of the switches except the clutch; ended after the servo, for it may wait for the paint node.
    actor: Actor,
    /// Registration of the device to the canvas.
    registration: Registration,
    /// Time of the next attempt to open the device, ns.
    attempt_ns: u64,
    senses: u32,
    recipient: Recipient,
    samples: CreditSender<StylusSample>,
    models: Inlet<ContactModel, Contact>,
    guides: Inlet<GuideModel, Guide>,
    fluids: Inlet<FluidForce, Fluid>,
    /// What brushes have consumed of the samples.
    consumed: Receiver<BrushConsumed>,
    senders: Senders,
    orders: Orders,
    control: ForceControl,
    status: Sender<StylusStatus>,
    info: Sender<StylusInfo>,
    /// Offset from `CLOCK_MONOTONIC`, which stamps the ticks, to the rig's clock, ns.
    offset_ns: u64,
    told: StylusStatus,
    /// Tick records dropped with devices that are gone.
    dropped_before: u64,
    status_ns: u64,
    published_ns: u64,
    newest: StylusSample,
}

impl Daemon {
    fn new(member: &NodeHandle, settings: &HapticSettings) -> Result<Self, UserError> {
        let device = &settings.device;
        let (bus, topics) = (&*member.bus, &member.topics);
        let origin = member.origin(&device.name);
        let state_file = ForceStateFile::of(&member.folder, &device.name, member.clock.offset_ns());
        let state = state_file.read();
        let registration = Registration::of(device, &member.config.canvas)?;
        if let Some(warning) = registration.warning() {
            let name = &device.name;
            tracing::warn!("{name}: {warning}; touch them again: `maulstick device fit {name}`");
        }
        let actions = Actions::of(device);
        let actor = Actor::start(member.bus.clone(), topics, &device.brush, actions)?;
        let topic = topics.contact_model(&device.name);
        let (guides, fluids) = (topics.guide(&device.name), topics.fluid_force(&device.name));
        let (paint_drag, relief, wake) = (device.paint_drag, device.relief, &member.wake);
        let samples = CreditSender::new(
            bus,
            topics,
            &topics.sample(&device.name),
            origin,
            &member.wake,
        )?;
        let info = Sender::new(bus, &topics.stylus_info(&device.name), Qos::Cached, origin)?;
        let mut daemon = Self {
            config: member.config.clone(),
            settings: settings.clone(),
            servo: None,
            previous: None,
            what: String::new(),
            actor,
            registration,
            attempt_ns: 0,
            senses: 0,
            recipient: Recipient {
                device: samples.origin(),
                brush: device.brush.clone(),
            },
            samples,
            models: Inlet::new(
                (bus, &topic),
                Means::Contact,
                Recipient::accepts,
                move |model| Contact::with_relief(model, relief),
                wake,
            )?,
            guides: Inlet::new(
                (bus, &guides),
                Means::Guide,
                Recipient::accepts_guide,
                Guide::new,
                wake,
            )?,
            fluids: Inlet::new(
                (bus, &fluids),
                Means::Paint,
                Recipient::accepts_fluid,
                move |force| Fluid::new(force, paint_drag),
                wake,
            )?,
            consumed: Receiver::new(
                bus,
                &topics.brush_consumed(&device.brush),
                Qos::Control,
                Queue::Ring(64),
                wake,
            )?,
            senders: Senders::new(&device.brush, &device.driven_by),
            orders: Orders::new(bus.serve(&topics.force(&device.name), 16, wake)?),
            control: ForceControl {
                switch: state.switch,
                strength: state.strength,
                guidance: state.guidance,
                ..ForceControl::default()
            },
            state_file,
            latched: None,
            status: Sender::new(
                bus,
                &topics.stylus_status(&device.name),
                Qos::Background,
                origin,
            )?,
            info,
            offset_ns: member.clock.offset_ns(),
            told: StylusStatus::fresh(BINS),
            dropped_before: 0,
            status_ns: 0,
            published_ns: 0,
            newest: StylusSample::away(),
            bus: member.bus.clone(),
        };
        daemon.tell_control();
        if let Some(fault) = state.fault {
            daemon.latch(fault);
        }
        Ok(daemon)
    }

    fn turn(&mut self) -> Result<Duration, UserError> {
        let now_ns = self.bus.now_ns();
        if self.servo.is_none() && now_ns >= self.attempt_ns {
            self.attempt_ns = now_ns + ATTEMPT_PERIOD_NS;
            self.attempt(now_ns)?;
        }
        self.obey(now_ns);
        self.deliver(now_ns);
        while let Some(Ok(record)) = self.servo.as_mut().map(|servo| servo.ticks.pop()) {
            self.publish(&record, now_ns)?;
        }
        if self.servo.as_ref().is_some_and(ServoThread::has_ended) {
            self.lose(now_ns)?;
        }
        // A live device never waits for credit; the ring serves receivers that missed a sample.
        self.samples.reset_credit();
        self.samples.serve(now_ns)?;
        if now_ns >= self.status_ns + STATUS_PERIOD_NS {
            self.status_ns = now_ns;
            self.told.dropped = self.dropped();
            self.status.send(now_ns, now_ns, &self.told)?;
        }
        Ok(Duration::from_millis(1))
    }

    /// What it has done since its start.
    fn work(&self) -> NodeWork {
        NodeWork {
            produced: self.told.samples,
            lost: self.told.dropped,
            refused: self.told.foreign_models + self.told.refused_senders,
            ..NodeWork::default()
        }
    }

    fn dropped(&self) -> u64 {
        self.dropped_before + self.servo.as_ref().map_or(0, ServoThread::dropped)
    }

    /// Tries to open the device.
    fn attempt(&mut self, now_ns: u64) -> Result<(), UserError> {
        let opened = match open(&self.config, &self.settings) {
            Ok(opened) => opened,
            Err(fault) => {
                report_missing(&self.settings.device.name, &fault, &mut self.told);
                return Ok(());
            }
        };
        let device = &self.settings.device;
        if self.what != opened.what {
            tracing::info!("{}: {}", device.name, opened.what);
            self.what = opened.what;
        }
        let clutch = Actions::of(device).bits(Action::Clutch);
        let mounted = MountedDevice::new(opened.driver, self.registration, clutch);
        let abilities = mounted.abilities();
        let scale = mounted.scale();
        let limits = abilities.limits(device.max_force_n);
        let unscaled = limits;
        let limits = limits.scaled(scale);
        let previous = self.previous_of(limits, now_ns);
        let mut servo = ServoThread::resume(mounted, opened.clock, limits, previous)
            .map_err(|error| UserError::failure(format!("the servo cannot start: {error}")))?;
        for warning in &servo.warnings {
            tracing::warn!("{}: {warning}", device.name);
        }
        servo.controls.write(self.control);
        let told = StylusInfo {
            device: device.name.clone(),
            driver: device.driver.clone(),
            brush: device.brush.clone(),
            priority: device.priority,
            senses: abilities.senses,
            drives: abilities.drives,
            rate_hz: 1000.0,
            max_force_n: unscaled.max_force_n,
            max_stiffness_n_m: unscaled.max_stiffness_n_m,
            workspace_m: abilities.workspace_m,
        };
        self.info.send(now_ns, now_ns, &told)?;
        self.senses = abilities.senses;
        self.servo = Some(servo);
        Ok(())
    }

    /// State for a new servo: a device that is lost and found again is still without force after a fault,
    /// and its motors have cooled only while it was away.
    fn previous_of(&self, limits: Limits, now_ns: u64) -> PreviousServo {
        let (mut previous, since_ns) = self.previous.unwrap_or((
            PreviousServo {
                memory: ServoMemory {
                    fault: self.latched,
                    ..ServoMemory::fresh(limits)
                },
                rearms: self.control.rearms,
            },
            now_ns,
        ));
        if previous.rearms != self.control.rearms {
            previous.memory.fault = None;
            previous.rearms = self.control.rearms;
        }
        let away_s = now_ns.saturating_sub(since_ns) as f64 * 1e-9;
        previous.memory = previous.memory.cooled(away_s);
        previous
    }

    /// Handles the end of the servo: lifts the brush, and looks for the device again if that was lost.
    fn lose(&mut self, now_ns: u64) -> Result<(), UserError> {
        self.dropped_before = self.dropped();
        let Some(Ended { error, previous }) = self.servo.take().and_then(|servo| servo.ended())
        else {
            return Err(
                UserError::failure("the servo has ended by a fault of its own")
                    .help("its own message above says why"),
            );
        };
        if let Some(fault) = previous.memory.fault
            && previous.rearms == self.control.rearms
        {
            self.latch(fault);
        }
        self.previous = Some((previous, now_ns));
        let away = StylusSample {
            in_range: false,
            switches: 0,
            force_n: [0.0; 3],
            velocity_m_s: [0.0; 3],
            ..self.newest.clone()
        };
        self.actor.receive(&away);
        if self.newest.in_range {
            self.send(now_ns, now_ns, away)?;
        }
        (self.told.force_n, self.told.is_guided) = (0.0, false);
        self.attempt_ns = now_ns + ATTEMPT_PERIOD_NS;
        let fault = UserError::failure(error.to_string()).help(error.help);
        report_missing(&self.settings.device.name, &fault, &mut self.told);
        Ok(())
    }

    /// Hands the newest model, guide and force of paint to the servo.
    fn deliver(&mut self, now_ns: u64) {
        while let Some(received) = self.consumed.try_recv() {
            let (me, consumed) = (self.recipient.device, &received.message);
            if (consumed.device, consumed.device_epoch) == (me.source, me.epoch) {
                self.senders.consumed_by(received.header.origin(), now_ns);
            }
        }
        let (to, senders, told) = (&self.recipient, &mut self.senders, &mut self.told);
        let model = self.models.newest(to, senders, told, now_ns);
        let guide = self.guides.newest(to, senders, told, now_ns);
        let fluid = self.fluids.newest(to, senders, told, now_ns);
        let Some(servo) = &mut self.servo else {
            return;
        };
        if let Some(model) = model {
            servo.models.write(model);
        }
        if let Some(guide) = guide {
            servo.guides.write(guide);
        }
        if let Some(fluid) = fluid {
            servo.fluids.write(fluid);
        }
    }

    /// Reports the painter's settings.
    fn tell_control(&mut self) {
        self.told.is_on = self.control.switch == Switch::On;
        (self.told.strength, self.told.guidance) = (self.control.strength, self.control.guidance);
    }

    fn publish(&mut self, record: &TickRecord, now_ns: u64) -> Result<(), UserError> {
        self.told.lateness[bin(record.late_ns)] += 1;
        self.told.execution[bin(record.spent_ns)] += 1;
        self.told.force_n = record.force.length();
        // Only a reading ends the reported trouble: a device may be lost again before it gives one.
        self.told.clear_trouble();
        if let Some(fault) = record.tick.fault
            && record.rearms == self.control.rearms
        {
            self.latch(fault);
        }
        let tick = &record.tick;
        (self.told.resting, self.told.is_guided) = (tick.resting, tick.guided);
        (self.told.asked_n_m, self.told.stiffness_n_m) = (tick.asked_n_m, tick.stiffness_n_m);
        self.told.cap_n = tick.cap_n;
        let reading = &record.reading;
        self.told.motor_temperature = reading.motor_temperature;
        let event_ns = record.monotonic_ns + self.offset_ns;
        let handle = Rigid {
            rotation: reading.handle.orientation,
            translation: reading.handle.position,
        };
        let sample = StylusSample {
            senses: self.senses,
            pose: StylusPose::Ferrule {
                pose: handle.to_pose(),
            },
            velocity_m_s: reading.handle.velocity.to_array(),
            force_n: record.force.to_array(),
            switches: reading.switches,
            in_range: reading.in_range,
        };
        self.actor.receive(&sample);
        let left = self.newest.in_range && !sample.in_range;
        if !sample.in_range && !left && event_ns < self.published_ns + IDLE_PERIOD_NS {
            return Ok(());
        }
        self.send(now_ns, event_ns, sample)
    }

    /// Reports a latched fault, once.
    fn latch(&mut self, fault: maulstick_haptics::Fault) {
        if self.told.faults.is_empty() {
            let commands = match fault {
                maulstick_haptics::Fault::UnknownState => {
                    "`maulstick device force on` and `maulstick device force rearm`"
                }
                _ => "`maulstick device force rearm`",
            };
            let what = format!("{fault}: no force until {commands}");
            tracing::warn!("{}: {what}", self.settings.device.name);
            self.told.faults.push(what);
            self.latched = Some(fault);
            self.write_state();
        }
    }

    /// Writes force settings and latched fault to the state file.
    fn write_state(&self) {
        let state = ForceState {
            switch: self.control.switch,
            strength: self.control.strength,
            guidance: self.control.guidance,
            fault: self.latched,
        };
        if let Err(error) = self.state_file.write(&state) {
            tracing::warn!("orders do not outlive this daemon: {error}");
        }
    }

    fn send(&mut self, now_ns: u64, event_ns: u64, sample: StylusSample) -> Result<(), UserError> {
        self.published_ns = event_ns;
        self.told.samples += 1;
        self.samples
            .send(Flags::NONE, Stamp { now_ns, event_ns }, &sample)?;
        self.newest = sample;
        Ok(())
    }

    /// Reason why the device has no force, or an empty text.
    fn fault(&self) -> String {
        match self.told.trouble() {
            Some(trouble) if self.told.faults.is_empty() => trouble.to_string(),
            _ => self.told.faults.join("; "),
        }
    }
}
