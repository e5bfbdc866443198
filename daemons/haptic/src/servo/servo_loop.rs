//! Servo loop over a device; a tick reads it, takes in models and settings, steps the servo, writes the
//! force and reports.

use std::ops::ControlFlow;
use std::sync::atomic::Ordering;

use glam::DVec3;
use maulstick_haptics::{Limits, Sender, Servo, ServoMemory, Switch};
use maulstick_types::Origin;

use super::channels::{Channels, Delivery, TickRecord};
use super::clock::monotonic_ns;
use super::force_control::ForceControl;
use crate::device::driver::DeviceError;
use crate::device::mounted_device::MountedDevice;

/// State of a servo that its successor over the same device takes over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PreviousServo {
    /// Fault and heat.
    pub memory: ServoMemory,
    /// The [`ForceControl::rearms`] that it had followed.
    pub rearms: u64,
}

/// A servo over a device. Nothing in it allocates, locks or calls the system, except the device's own
/// driver.
pub struct ServoLoop {
    device: MountedDevice,
    servo: Servo,
    longest_s: f64,
    channels: Channels,
    models: Seen,
    guides: Seen,
    fluids: Seen,
    followed: ForceControl,
    amplifiers: Switch,
    read_ns: u64,
    error: Option<DeviceError>,
}

impl ServoLoop {
    /// A loop before its first tick, in succession to `previous`.
    #[must_use]
    pub fn new(
        device: MountedDevice,
        limits: Limits,
        previous: PreviousServo,
        channels: Channels,
    ) -> Self {
        Self {
            device,
            servo: Servo::after(limits, previous.memory),
            longest_s: limits.longest_tick_s,
            channels,
            models: Seen::default(),
            guides: Seen::default(),
            fluids: Seen::default(),
            // Earlier re-armings were of another servo, whose fault is to outlast them.
            followed: ForceControl {
                rearms: previous.rearms,
                ..ForceControl::default()
            },
            amplifiers: Switch::On,
            read_ns: monotonic_ns(),
            error: None,
        }
    }

    /// State for the next servo over the device.
    #[must_use]
    pub fn memory(&self) -> PreviousServo {
        PreviousServo {
            memory: self.servo.memory(),
            rearms: self.followed.rearms,
        }
    }

    /// The error by which the device was lost, if it was.
    #[must_use]
    pub fn error(&self) -> Option<DeviceError> {
        self.error
    }

    /// Runs a tick, `late_ns` after it was due. Breaks off when the device is lost, and, after a last
    /// tick without force, when the loop is to stop.
    pub fn tick(&mut self, late_ns: u64) -> ControlFlow<()> {
        let flow = if self.channels.stop.load(Ordering::Relaxed) {
            self.last_tick()
        } else {
            self.step(late_ns)
        };
        flow.unwrap_or_else(|error| {
            self.error = Some(error);
            ControlFlow::Break(())
        })
    }

    fn last_tick(&mut self) -> Result<ControlFlow<()>, DeviceError> {
        self.device.read(0.0)?;
        self.device.write(DVec3::ZERO, DVec3::ZERO)?;
        Ok(ControlFlow::Break(()))
    }

    fn step(&mut self, late_ns: u64) -> Result<ControlFlow<()>, DeviceError> {
        let now_ns = monotonic_ns();
        let dt = now_ns.saturating_sub(self.read_ns) as f64 * 1e-9;
        self.drain_inputs();
        let Some(reading) = self.device.read(dt)? else {
            if dt > self.longest_s {
                self.device.write(DVec3::ZERO, DVec3::ZERO)?;
            }
            return Ok(ControlFlow::Continue(()));
        };
        self.read_ns = now_ns;
        self.servo.measure(reading.motor_temperature);
        self.servo.permit(if reading.is_permitted {
            Switch::On
        } else {
            Switch::Off
        });
        let (force, mut tick) = self.servo.step(&reading.handle, dt);
        self.device.write(force, tick.torque_n_m)?;
        tick.cap_n /= self.device.scale();
        // A clutch or a dead man's switch ends the force, but its amplifiers do not rest.
        let wanted = match (tick.fault, tick.resting, reading.is_permitted) {
            (Some(_), ..) | (None, true, true) => Switch::Off,
            (None, true, false) => self.amplifiers,
            (None, false, _) => Switch::On,
        };
        if wanted != self.amplifiers {
            self.amplifiers = wanted;
            self.device.switch(wanted);
        }
        let record = TickRecord {
            monotonic_ns: now_ns,
            reading,
            force: self.device.on_hand(force),
            late_ns,
            spent_ns: monotonic_ns().saturating_sub(now_ns),
            tick,
            rearms: self.followed.rearms,
        };
        if self.channels.ticks.push(record).is_err() {
            self.channels.dropped.fetch_add(1, Ordering::Relaxed);
        }
        Ok(ControlFlow::Continue(()))
    }

    /// Takes in the newest model, guide, force of paint and settings.
    fn drain_inputs(&mut self) {
        if let Some((contact, sender)) = self.models.newest(self.channels.models.read()) {
            self.servo.receive(contact, sender);
        }
        if let Some((guide, sender)) = self.guides.newest(self.channels.guides.read()) {
            self.servo.receive_guide(guide, sender);
        }
        if let Some((fluid, _)) = self.fluids.newest(self.channels.fluids.read()) {
            self.servo.receive_fluid(fluid);
        }
        let control = *self.channels.controls.read();
        self.followed.apply(control, &mut self.servo);
    }
}

/// Deliveries of a kind that the servo has seen.
#[derive(Default)]
struct Seen {
    number: u64,
    sender: Option<Origin>,
}

impl Seen {
    /// The delivery, if it is new.
    fn newest<M: Copy>(&mut self, delivery: &Delivery<M>) -> Option<(M, Sender)> {
        let model = delivery.model?;
        if delivery.number == self.number {
            return None;
        }
        let sender = if delivery.sender == self.sender {
            Sender::Same
        } else {
            Sender::Another
        };
        (self.number, self.sender) = (delivery.number, delivery.sender);
        Some((model, sender))
    }
}
