//! The thread that talks to the rig: samples and status out, models in.

use std::time::Duration;

use maulstick_bus::credit::Stamp;
use maulstick_bus::typed::{Reader, Receiver, Sender};
use maulstick_bus::{Class, CreditSender, Queue, Server};
use maulstick_device::actions::{Action, Actions, Actor};
use maulstick_device::fitting::Fitting;
use maulstick_device::missing::miss;
use maulstick_haptics::contact::Contact;
use maulstick_haptics::{Address, Kept, Limits, Switch};
use maulstick_num::geometry::Rigid;
use maulstick_rig::{Fault, Member, RigConfig};
use maulstick_types::haptics::{ContactModel, ForceOrder, ForceReply, ForceRequest};
use maulstick_types::stylus::{StylusInfo, StylusPose, StylusSample, StylusStatus};
use maulstick_types::{Flags, encode};

use crate::beat::{Before, Delivery, Ticked};
use crate::host::{BINS, Ended, Host, bin};
use crate::open::{HapticSettings, open};
use crate::placed::Placed;
use crate::standing::{Orders, Standing};
use crate::wish::Wish;

/// Time between two statuses, ns.
const STATUS_PERIOD_NS: u64 = 100_000_000;
/// Time between two attempts to open a device that is not there, ns.
const ATTEMPT_PERIOD_NS: u64 = 1_000_000_000;
/// Out of range a sample goes out only this often, ns.
const IDLE_PERIOD_NS: u64 = 50_000_000;

/// Runs a device in the rig of `member`.
///
/// # Errors
/// A [`Fault`] where the device or the rig cannot be used.
pub fn run(member: &mut Member, settings: &HapticSettings) -> Result<(), Fault> {
    let mut daemon = Daemon::new(member, settings)?;
    member.ready()?;
    member.run(|| daemon.turn())
}

struct Daemon {
    bus: std::sync::Arc<dyn maulstick_bus::Bus>,
    config: RigConfig,
    settings: HapticSettings,
    /// The servo, while there is a device.
    host: Option<Host>,
    /// What the servo before it has left, and when, ns.
    before: Option<(Before, u64)>,
    /// What of all this outlives this daemon, and the fault that is latched.
    standing: Standing,
    latched: Option<maulstick_haptics::Fault>,
    /// The device that was told of last, in words.
    what: String,
    /// What the switches do, but the clutch; ended after the servo, for it may wait for the paint node.
    actor: Actor,
    /// Where the device stands.
    fitting: Fitting,
    /// When to look for the device again.
    attempt_ns: u64,
    senses: u32,
    address: Address,
    samples: CreditSender<StylusSample>,
    models: Receiver<ContactModel>,
    orders: Server,
    reader: Reader,
    wish: Wish,
    status: Sender<StylusStatus>,
    info: Sender<StylusInfo>,
    /// From `CLOCK_MONOTONIC`, which stamps the ticks, to the rig's clock, ns.
    offset_ns: u64,
    told: StylusStatus,
    /// Ticks that did not fit with devices that are gone.
    dropped_before: u64,
    deliveries: u64,
    status_ns: u64,
    published_ns: u64,
    newest: StylusSample,
    /// Whether a bad model was told of.
    warned: bool,
}

impl Daemon {
    fn new(member: &Member, settings: &HapticSettings) -> Result<Self, Fault> {
        let device = &settings.device;
        let (bus, topics) = (&*member.bus, &member.topics);
        let origin = member.origin(&device.name);
        let standing = Standing::of(&member.folder, &device.name, member.clock.offset_ns());
        let orders = standing.recall();
        let fitting = Fitting::of(device, &member.config.canvas)?;
        if let Some(warning) = fitting.warning() {
            let name = &device.name;
            tracing::warn!("{name}: {warning}; touch them again: `maulstick calibrate {name}`");
        }
        let actions = Actions::of(device);
        let actor = Actor::start(member.bus.clone(), topics, &device.brush, actions)?;
        let topic = topics.contact_model(&device.name);
        let samples = CreditSender::new(
            bus,
            topics,
            &topics.sample(&device.name),
            origin,
            &member.wake,
        )?;
        let info = Sender::new(
            bus,
            &topics.stylus_info(&device.name),
            Class::Cached,
            origin,
        )?;
        let mut daemon = Self {
            config: member.config.clone(),
            settings: settings.clone(),
            host: None,
            before: None,
            what: String::new(),
            actor,
            fitting,
            attempt_ns: 0,
            senses: 0,
            address: Address {
                device: samples.origin(),
                brush: device.brush.clone(),
            },
            samples,
            models: Receiver::new(bus, &topic, Class::RealTime, Queue::Ring(64), &member.wake)?,
            orders: bus.serve(&topics.force(&device.name), 16, &member.wake)?,
            reader: Reader::default(),
            wish: Wish {
                switch: orders.switch,
                strength: orders.strength,
                ..Wish::default()
            },
            standing,
            latched: None,
            status: Sender::new(
                bus,
                &topics.stylus_status(&device.name),
                Class::Background,
                origin,
            )?,
            info,
            offset_ns: member.clock.offset_ns(),
            told: StylusStatus::fresh(BINS),
            dropped_before: 0,
            deliveries: 0,
            status_ns: 0,
            published_ns: 0,
            newest: StylusSample::away(),
            warned: false,
            bus: member.bus.clone(),
        };
        (daemon.told.is_on, daemon.told.strength) = (orders.switch == Switch::On, orders.strength);
        if let Some(fault) = orders.fault {
            daemon.latch(fault);
        }
        Ok(daemon)
    }

    fn turn(&mut self) -> Result<Duration, Fault> {
        let now_ns = self.bus.now_ns();
        if self.host.is_none() && now_ns >= self.attempt_ns {
            self.attempt_ns = now_ns + ATTEMPT_PERIOD_NS;
            self.attempt(now_ns)?;
        }
        self.obey(now_ns);
        self.deliver();
        while let Some(Ok(ticked)) = self.host.as_mut().map(|host| host.ticks.pop()) {
            self.publish(&ticked, now_ns)?;
        }
        if self.host.as_ref().is_some_and(Host::has_ended) {
            self.lose(now_ns)?;
        }
        // Nobody waits for credit on a live device; the ring is there for who missed something.
        self.samples.forgive();
        self.samples.serve(now_ns)?;
        if now_ns >= self.status_ns + STATUS_PERIOD_NS {
            self.status_ns = now_ns;
            self.told.dropped = self.dropped();
            self.status.send(now_ns, now_ns, &self.told)?;
        }
        Ok(Duration::from_millis(1))
    }

    fn dropped(&self) -> u64 {
        self.dropped_before + self.host.as_ref().map_or(0, Host::dropped)
    }

    /// Opens the device, if it is there.
    fn attempt(&mut self, now_ns: u64) -> Result<(), Fault> {
        let opened = match open(&self.config, &self.settings) {
            Ok(opened) => opened,
            Err(fault) => {
                miss(&self.settings.device.name, &fault, &mut self.told);
                return Ok(());
            }
        };
        let device = &self.settings.device;
        if self.what != opened.what {
            tracing::info!("{}: {}", device.name, opened.what);
            self.what = opened.what;
        }
        let clutch = Actions::of(device).bits(Action::Clutch);
        let placed = Placed::new(opened.driver, self.fitting, clutch);
        let abilities = placed.abilities();
        let scale = placed.scale();
        let limits = Limits {
            max_force_n: device.max_force_n.min(abilities.max_force_n),
            continuous_force_n: device.max_force_n.min(abilities.continuous_force_n),
            max_stiffness_n_m: abilities.max_stiffness_n_m,
            damping_n_s_m: abilities.damping_n_s_m,
            ..Limits::default()
        };
        let unscaled = limits;
        let limits = limits.scaled(scale);
        let before = self.before_of(limits, now_ns);
        let mut host = Host::resume(placed, opened.pace, limits, before)
            .map_err(|error| Fault::failure(format!("the servo cannot start: {error}")))?;
        for warning in &host.warnings {
            tracing::warn!("{}: {warning}", device.name);
        }
        host.wishes.write(self.wish);
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
        self.host = Some(host);
        Ok(())
    }

    /// What a new servo is to know: a device that is lost and found again is still without force after a
    /// fault, and its motors have cooled only for as long as it was away.
    fn before_of(&self, limits: Limits, now_ns: u64) -> Before {
        let (mut before, since_ns) = self.before.unwrap_or((
            Before {
                kept: Kept {
                    fault: self.latched,
                    ..Kept::nothing(limits)
                },
                armings: self.wish.armings,
            },
            now_ns,
        ));
        if before.armings != self.wish.armings {
            before.kept.fault = None;
            before.armings = self.wish.armings;
        }
        before.kept = before
            .kept
            .rested(now_ns.saturating_sub(since_ns) as f64 * 1e-9);
        before
    }

    /// The servo has ended: lifts the brush, and looks for the device again if it is that which is
    /// lost.
    fn lose(&mut self, now_ns: u64) -> Result<(), Fault> {
        self.dropped_before = self.dropped();
        let Some(Ended { trouble, before }) = self.host.take().and_then(|host| host.ended()) else {
            return Err(Fault::failure("the servo has ended by a fault of its own")
                .help("its own message above says why"));
        };
        if let Some(fault) = before.kept.fault
            && before.armings == self.wish.armings
        {
            self.latch(fault);
        }
        self.before = Some((before, now_ns));
        let away = StylusSample {
            in_range: false,
            switches: 0,
            force_n: [0.0; 3],
            velocity_m_s: [0.0; 3],
            ..self.newest.clone()
        };
        self.actor.hear(&away);
        if self.newest.in_range {
            self.send(now_ns, now_ns, away)?;
        }
        self.told.force_n = 0.0;
        self.attempt_ns = now_ns + ATTEMPT_PERIOD_NS;
        let fault = Fault::failure(trouble.to_string()).help(trouble.help);
        miss(&self.settings.device.name, &fault, &mut self.told);
        Ok(())
    }

    /// Does what is asked of the force, and tells how it is then.
    fn obey(&mut self, now_ns: u64) {
        while let Some(request) = self.orders.try_recv() {
            let read = self
                .reader
                .read::<ForceRequest>(&request.key, &request.bytes);
            let Some((_, asked)) = read else { continue };
            match asked.order {
                ForceOrder::Off => self.wish.switch = Switch::Off,
                ForceOrder::On => self.wish.switch = Switch::On,
                // A share that is no number is none.
                ForceOrder::Strength { share } if share > 0.0 => {
                    self.wish.strength = share.min(1.0);
                }
                ForceOrder::Strength { .. } => self.wish.strength = 0.0,
                ForceOrder::Rearm => {
                    self.wish.armings += 1;
                    self.told.faults.clear();
                    self.latched = None;
                }
            }
            (self.told.is_on, self.told.strength) =
                (self.wish.switch == Switch::On, self.wish.strength);
            if let Some(host) = &mut self.host {
                host.wishes.write(self.wish);
            }
            self.keep();
            let reply = ForceReply {
                is_on: self.wish.switch == Switch::On,
                strength: self.wish.strength,
                fault: self.fault(),
            };
            let me = self.samples.origin();
            match encode(&me, Flags::NONE, 0, now_ns, now_ns, &reply) {
                Ok(bytes) => {
                    if let Err(error) = request.answer(bytes) {
                        tracing::debug!("a client is gone: {error}");
                    }
                }
                Err(error) => tracing::error!("an order cannot be answered: {error}"),
            }
        }
    }

    /// Hands the newest model to the servo, if it is meant for this device as it is now.
    fn deliver(&mut self) {
        let Some(received) = self.models.newest() else {
            return;
        };
        let model = received.message;
        if !self.address.takes(&model) {
            self.told.foreign_models += 1;
            return;
        }
        let Some(host) = &mut self.host else {
            return;
        };
        match Contact::new(&model) {
            Ok(contact) => {
                self.deliveries += 1;
                host.models.write(Delivery {
                    contact: Some(contact),
                    sender: Some(received.header.origin()),
                    number: self.deliveries,
                });
            }
            Err(what) => {
                self.told.foreign_models += 1;
                if !self.warned {
                    self.warned = true;
                    tracing::warn!("{}: a contact model is dropped: {what}", received.key);
                }
            }
        }
    }

    fn publish(&mut self, ticked: &Ticked, now_ns: u64) -> Result<(), Fault> {
        self.told.lateness[bin(ticked.late_ns)] += 1;
        self.told.execution[bin(ticked.spent_ns)] += 1;
        self.told.force_n = ticked.force.length();
        // A device that is lost before it says anything is still the same trouble.
        self.told.trouble.clear();
        if let Some(fault) = ticked.tick.fault
            && ticked.armings == self.wish.armings
        {
            self.latch(fault);
        }
        let tick = &ticked.tick;
        self.told.resting = tick.resting;
        (self.told.asked_n_m, self.told.stiffness_n_m) = (tick.asked_n_m, tick.stiffness_n_m);
        self.told.cap_n = tick.cap_n;
        let reading = &ticked.reading;
        self.told.motor_temperature = reading.motor_temperature;
        let event_ns = ticked.monotonic_ns + self.offset_ns;
        let held = Rigid {
            rotation: reading.held.orientation,
            translation: reading.held.position,
        };
        let sample = StylusSample {
            senses: self.senses,
            pose: StylusPose::Ferrule {
                pose: held.to_pose(),
            },
            velocity_m_s: reading.held.velocity.to_array(),
            force_n: ticked.force.to_array(),
            switches: reading.switches,
            in_range: reading.in_range,
        };
        self.actor.hear(&sample);
        let left = self.newest.in_range && !sample.in_range;
        if !sample.in_range && !left && event_ns < self.published_ns + IDLE_PERIOD_NS {
            return Ok(());
        }
        self.send(now_ns, event_ns, sample)
    }

    /// Tells of a latched fault, once.
    fn latch(&mut self, fault: maulstick_haptics::Fault) {
        if self.told.faults.is_empty() {
            let what = format!("{fault}: no force until `maulstick force rearm`");
            tracing::warn!("{}: {what}", self.settings.device.name);
            self.told.faults.push(what);
            self.latched = Some(fault);
            self.keep();
        }
    }

    /// Has what is ordered, and what is latched, hold though this daemon dies.
    fn keep(&self) {
        let orders = Orders {
            switch: self.wish.switch,
            strength: self.wish.strength,
            fault: self.latched,
        };
        if let Err(error) = self.standing.keep(&orders) {
            tracing::warn!("orders do not outlive this daemon: {error}");
        }
    }

    fn send(&mut self, now_ns: u64, event_ns: u64, sample: StylusSample) -> Result<(), Fault> {
        self.published_ns = event_ns;
        self.told.samples += 1;
        self.samples
            .send(Flags::NONE, Stamp { now_ns, event_ns }, &sample)?;
        self.newest = sample;
        Ok(())
    }

    /// What keeps the device without force, in words.
    fn fault(&self) -> String {
        match self.told.faults.is_empty() {
            true => self.told.trouble.clone(),
            false => self.told.faults.join("; "),
        }
    }
}
