//! The thread that talks to the rig: samples and status out, contact models and force orders in.

mod connection;
mod force_inlets;
mod force_settings;
mod orders;
mod output;

use std::sync::Arc;
use std::time::Duration;

use maulstick_bus::Bus;
use maulstick_device::actions::{Actions, Actor};
use maulstick_device::device_missing::report_missing;
use maulstick_device::registration::Registration;
use maulstick_haptics::Fault;
use maulstick_rig::{NodeHandle, UserError};
use maulstick_types::node::NodeWork;

use connection::{Attempt, Connection};
use force_inlets::ForceInlets;
use force_settings::ForceSettings;
use orders::Orders;
use output::Output;

use crate::device::open::HapticSettings;
use crate::force_state_file::ForceStateFile;
use crate::servo::channels::TickRecord;
use crate::servo::servo_thread::Ended;

/// Runs a device in the rig of `member`.
///
/// # Errors
/// [`UserError`] if the device or the rig cannot be used.
pub fn run(member: &mut NodeHandle, settings: &HapticSettings) -> Result<(), UserError> {
    let mut daemon = Daemon::new(member, settings)?;
    member.ready()?;
    member.run(|| {
        let wait = daemon.poll()?;
        member.work.set(daemon.work());
        Ok(wait)
    })
}

struct Daemon {
    bus: Arc<dyn Bus>,
    connection: Connection,
    /// Actions of the switches except the clutch; ended after the servo, for it may wait for the paint node.
    actor: Actor,
    inlets: ForceInlets,
    orders: Orders,
    force: ForceSettings,
    output: Output,
}

impl Daemon {
    fn new(member: &NodeHandle, settings: &HapticSettings) -> Result<Self, UserError> {
        let device = &settings.device;
        let (bus, topics, wake) = (&*member.bus, &member.topics, &member.wake);
        let registration = Registration::of(device, &member.config.canvas)?;
        if let Some(warning) = registration.warning() {
            let name = &device.name;
            tracing::warn!("{name}: {warning}; touch them again: `maulstick device fit {name}`");
        }
        let actor = Actor::start(
            member.bus.clone(),
            topics,
            &device.brush,
            Actions::of(device),
        )?;
        let offset_ns = member.clock.offset_ns();
        let origin = member.origin(&device.name);
        let output = Output::new(bus, topics, (&device.name, origin), offset_ns, wake)?;
        let file = ForceStateFile::of(&member.folder, &device.name, offset_ns);
        let (force, fault) = ForceSettings::read(file);
        let mut daemon = Self {
            connection: Connection::new(member.config.clone(), settings.clone(), registration),
            actor,
            inlets: ForceInlets::new(bus, topics, device, output.origin(), wake)?,
            orders: Orders::new(bus.serve(&topics.force(&device.name), 16, wake)?),
            force,
            output,
            bus: member.bus.clone(),
        };
        daemon.force.report(daemon.output.status_mut());
        if let Some(fault) = fault {
            daemon.latch(fault, 0);
        }
        Ok(daemon)
    }

    fn poll(&mut self) -> Result<Duration, UserError> {
        let now_ns = self.bus.now_ns();
        if self.connection.is_due(now_ns) {
            self.open(now_ns)?;
        }
        self.serve_orders(now_ns);
        let servo = self.connection.servo_mut();
        self.inlets.deliver(servo, self.output.status_mut(), now_ns);
        while let Some(record) = self.connection.next_tick() {
            self.on_tick(&record, now_ns)?;
        }
        if let Some(ended) = self.connection.poll_end(now_ns)? {
            self.on_lost(ended, now_ns)?;
        }
        self.output.serve(self.connection.dropped(), now_ns)?;
        Ok(Duration::from_millis(1))
    }

    /// Work since the start.
    fn work(&self) -> NodeWork {
        let status = self.output.status();
        NodeWork {
            produced: status.samples,
            lost: status.dropped,
            refused: status.foreign_models + status.refused_senders,
            ..NodeWork::default()
        }
    }

    /// Tries to open the device.
    fn open(&mut self, now_ns: u64) -> Result<(), UserError> {
        match self.connection.open(&self.force, now_ns)? {
            Attempt::Opened(info) => self.output.announce(&info, now_ns)?,
            Attempt::Missing(fault) => self.report_missing(&fault),
        }
        Ok(())
    }

    fn report_missing(&mut self, fault: &UserError) {
        report_missing(self.connection.name(), fault, self.output.status_mut());
    }

    /// Publishes a tick of the servo.
    fn on_tick(&mut self, record: &TickRecord, now_ns: u64) -> Result<(), UserError> {
        if let Some(fault) = record.tick.fault {
            self.latch(fault, record.rearms);
        }
        let sample = self.output.note(record, self.connection.senses());
        self.actor.receive(&sample);
        self.output.publish(sample, record.monotonic_ns, now_ns)?;
        Ok(())
    }

    /// Lifts the brush of a device that its servo has lost.
    fn on_lost(&mut self, ended: Ended, now_ns: u64) -> Result<(), UserError> {
        let Ended { error, previous } = ended;
        if let Some(fault) = previous.memory.fault {
            self.latch(fault, previous.rearms);
        }
        let away = self.output.lift(now_ns)?;
        self.actor.receive(&away);
        self.report_missing(&UserError::failure(error.to_string()).help(error.help));
        Ok(())
    }

    /// Latches a fault of the servo, and reports it once.
    fn latch(&mut self, fault: Fault, rearms: u64) {
        if self.force.latch(fault, rearms) {
            let commands = match fault {
                Fault::UnknownState => {
                    "`maulstick device force on` and `maulstick device force rearm`"
                }
                _ => "`maulstick device force rearm`",
            };
            let what = format!("{fault}: no force until {commands}");
            tracing::warn!("{}: {what}", self.connection.name());
            self.output.status_mut().faults.push(what);
        }
    }
}
