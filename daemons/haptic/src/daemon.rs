//! The thread that talks to the rig: samples and status out, models in.

use std::path::PathBuf;
use std::time::Duration;

use glam::DQuat;
use maulstick_bus::credit::Stamp;
use maulstick_bus::typed::{Reader, Receiver, Sender};
use maulstick_bus::{Class, CreditSender, Queue, Server};
use maulstick_device::{Take, brush_file};
use maulstick_haptics::contact::Contact;
use maulstick_haptics::{Address, Limits, Switch};
use maulstick_num::geometry::{Rigid, canonical};
use maulstick_rig::config::DeviceSection;
use maulstick_rig::{Fault, Member};
use maulstick_types::haptics::{ContactModel, ForceOrder, ForceReply, ForceRequest};
use maulstick_types::stylus::{StylusInfo, StylusPose, StylusSample, StylusStatus};
use maulstick_types::{Flags, encode};

use crate::driver::{Driver, Placed};
use crate::host::{BINS, Delivery, Host, Ticked, bin};
use crate::simulated::Simulated;
use crate::wish::Wish;

/// What a haptic daemon is told.
#[derive(Clone, Debug)]
pub struct HapticSettings {
    /// The device's section of `rig.toml`.
    pub device: DeviceSection,
    /// A take that a simulated hand follows.
    pub hand: Option<PathBuf>,
}

/// Time between two statuses, ns.
const STATUS_PERIOD_NS: u64 = 100_000_000;
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
    host: Host,
    senses: u32,
    address: Address,
    samples: CreditSender<StylusSample>,
    models: Receiver<ContactModel>,
    orders: Server,
    reader: Reader,
    wish: Wish,
    status: Sender<StylusStatus>,
    _info: Sender<StylusInfo>,
    /// From `CLOCK_MONOTONIC`, which stamps the ticks, to the rig's clock, ns.
    offset_ns: u64,
    told: StylusStatus,
    deliveries: u64,
    status_ns: u64,
    published_ns: u64,
    was_in_range: bool,
    /// Whether a bad model was told of.
    warned: bool,
}

/// Device frame to desk frame.
fn to_desk(device: &DeviceSection) -> Rigid {
    Rigid {
        rotation: canonical(DQuat::from_array(device.orientation)),
        translation: device.position_m.into(),
    }
}

fn driver(member: &Member, settings: &HapticSettings) -> Result<Box<dyn Driver>, Fault> {
    let Some(path) = settings.hand.as_ref().or(settings.device.hand.as_ref()) else {
        return Ok(Box::new(Simulated::at_rest()));
    };
    let take = Take::read(path)?;
    let section = member
        .config
        .brush_named(&settings.device.brush)
        .ok_or_else(|| Fault::usage(format!("no brush '{}'", settings.device.brush)))?;
    let file = brush_file(section)?;
    Ok(Box::new(Simulated::following(
        &take,
        file.length_m(),
        section.depth_share,
        &to_desk(&settings.device),
    )))
}

impl Daemon {
    fn new(member: &Member, settings: &HapticSettings) -> Result<Self, Fault> {
        let device = &settings.device;
        let placed = Placed::new(driver(member, settings)?, to_desk(device));
        let abilities = placed.abilities();
        let limits = Limits {
            max_force_n: device.max_force_n.min(abilities.max_force_n),
            continuous_force_n: device.max_force_n.min(abilities.continuous_force_n),
            max_stiffness_n_m: abilities.max_stiffness_n_m,
            damping_n_s_m: abilities.damping_n_s_m,
            ..Limits::default()
        };
        let host = Host::start(placed, limits)
            .map_err(|error| Fault::failure(format!("the servo cannot start: {error}")))?;
        for warning in &host.warnings {
            tracing::warn!("{}: {warning}", device.name);
        }
        let (bus, topics) = (&*member.bus, &member.topics);
        let origin = member.origin(&device.name);
        let now = bus.now_ns();
        let mut info = Sender::new(
            bus,
            &topics.stylus_info(&device.name),
            Class::Cached,
            origin,
        )?;
        let told = StylusInfo {
            device: device.name.clone(),
            driver: device.driver.clone(),
            brush: device.brush.clone(),
            priority: device.priority,
            senses: abilities.senses,
            drives: abilities.drives,
            rate_hz: 1000.0,
            max_force_n: limits.max_force_n,
            max_stiffness_n_m: limits.max_stiffness_n_m,
            workspace_m: abilities.workspace_m,
        };
        info.send(now, now, &told)?;
        let topic = topics.contact_model(&device.name);
        let samples = CreditSender::new(
            bus,
            topics,
            &topics.sample(&device.name),
            origin,
            &member.wake,
        )?;
        Ok(Self {
            senses: abilities.senses,
            address: Address {
                device: samples.origin(),
                brush: device.brush.clone(),
            },
            samples,
            models: Receiver::new(bus, &topic, Class::RealTime, Queue::Latest, &member.wake)?,
            orders: bus.serve(&topics.force(&device.name), 16, &member.wake)?,
            reader: Reader::default(),
            wish: Wish::default(),
            status: Sender::new(
                bus,
                &topics.stylus_status(&device.name),
                Class::Background,
                origin,
            )?,
            _info: info,
            offset_ns: member.clock.offset_ns(),
            told: StylusStatus {
                samples: 0,
                dropped: 0,
                faults: Vec::new(),
                lateness: vec![0; BINS],
                execution: vec![0; BINS],
                force_n: 0.0,
                foreign_models: 0,
            },
            deliveries: 0,
            status_ns: 0,
            published_ns: 0,
            was_in_range: false,
            warned: false,
            host,
            bus: member.bus.clone(),
        })
    }

    fn turn(&mut self) -> Result<Duration, Fault> {
        let now_ns = self.bus.now_ns();
        self.obey(now_ns);
        self.deliver();
        while let Ok(ticked) = self.host.ticks.pop() {
            self.publish(&ticked, now_ns)?;
        }
        if self.host.ticks.is_abandoned() {
            return Err(Fault::failure("the servo has ended by a fault of its own")
                .help("its own message above says why"));
        }
        // Nobody waits for credit on a live device; the ring is there for who missed something.
        self.samples.forgive();
        self.samples.serve(now_ns)?;
        if now_ns >= self.status_ns + STATUS_PERIOD_NS {
            self.status_ns = now_ns;
            self.told.dropped = self.host.dropped();
            self.status.send(now_ns, now_ns, &self.told)?;
        }
        Ok(Duration::from_millis(1))
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
                }
            }
            self.host.wishes.write(self.wish);
            let reply = ForceReply {
                is_on: self.wish.switch == Switch::On,
                strength: self.wish.strength,
                fault: self.told.faults.join("; "),
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
        match Contact::new(&model) {
            Ok(contact) => {
                self.deliveries += 1;
                self.host.models.write(Delivery {
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
        if let Some(fault) = ticked.tick.fault
            && self.told.faults.is_empty()
            && ticked.armings == self.wish.armings
        {
            let what = format!("{fault}: no force until `maulstick force rearm`");
            self.told.faults.push(what);
        }
        let event_ns = ticked.monotonic_ns + self.offset_ns;
        let reading = &ticked.reading;
        let left = self.was_in_range && !reading.in_range;
        self.was_in_range = reading.in_range;
        if !reading.in_range && !left && event_ns < self.published_ns + IDLE_PERIOD_NS {
            return Ok(());
        }
        self.published_ns = event_ns;
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
        self.told.samples += 1;
        self.samples
            .send(Flags::NONE, Stamp { now_ns, event_ns }, &sample)?;
        Ok(())
    }
}
