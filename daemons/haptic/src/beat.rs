//! One beat of the servo: read the device, take in what has come, step, write, tell.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use glam::DVec3;
use maulstick_haptics::contact::Contact;
use maulstick_haptics::{Kept, Limits, Sender, Servo, Switch, Tick};
use maulstick_types::Origin;

use crate::driver::{Reading, Trouble};
use crate::pace::monotonic_ns;
use crate::placed::Placed;
use crate::wish::Wish;

/// A tick as it goes to the publisher.
#[derive(Clone, Copy, Debug)]
pub struct Ticked {
    /// When the device was read, `CLOCK_MONOTONIC`, ns.
    pub monotonic_ns: u64,
    /// What was read, desk frame.
    pub reading: Reading,
    /// The force on the hand, N, in the desk's axes.
    pub force: DVec3,
    /// How late the wake-up was, ns.
    pub late_ns: u64,
    /// How long the tick took, ns.
    pub spent_ns: u64,
    /// What the servo did; its largest force is that on the hand.
    pub tick: Tick,
    /// The [`Wish`]'s armings that it has done.
    pub armings: u64,
}

/// A model on its way to the servo.
#[derive(Clone, Copy, Debug, Default)]
pub struct Delivery {
    /// The model.
    pub contact: Option<Contact>,
    /// Who sent it.
    pub sender: Option<Origin>,
    /// Counts deliveries.
    pub number: u64,
}

/// What a servo knows of the one before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Before {
    /// Its fault and its heat.
    pub kept: Kept,
    /// The [`Wish`]'s armings that it had done.
    pub armings: u64,
}

/// What the servo shares with the thread that talks to the rig.
pub struct Channels {
    /// Ticks go out here.
    pub ticks: rtrb::Producer<Ticked>,
    /// The newest model.
    pub models: triple_buffer::Output<Delivery>,
    /// The newest wish.
    pub wishes: triple_buffer::Output<Wish>,
    /// Set when it is time to end.
    pub stop: Arc<AtomicBool>,
    /// Counts ticks that did not fit.
    pub dropped: Arc<AtomicU64>,
}

/// A servo over a device. Nothing in it allocates, locks or calls the system, but the device's own
/// driver.
pub struct Beat {
    device: Placed,
    servo: Servo,
    longest_s: f64,
    channels: Channels,
    seen: u64,
    sender: Option<Origin>,
    followed: Wish,
    amplifiers: Switch,
    read_ns: u64,
    trouble: Option<Trouble>,
}

impl Beat {
    /// A servo that has not ticked yet, in the place of another.
    #[must_use]
    pub fn new(device: Placed, limits: Limits, before: Before, channels: Channels) -> Self {
        Self {
            device,
            servo: Servo::after(limits, before.kept),
            longest_s: limits.longest_tick_s,
            channels,
            seen: 0,
            sender: None,
            // What was armed before was another servo: its fault is to outlast it.
            followed: Wish {
                armings: before.armings,
                ..Wish::default()
            },
            amplifiers: Switch::On,
            read_ns: monotonic_ns(),
            trouble: None,
        }
    }

    /// What the next servo over the device is to know.
    #[must_use]
    pub fn kept(&self) -> Before {
        Before {
            kept: self.servo.kept(),
            armings: self.followed.armings,
        }
    }

    /// Why the device is lost, if it is.
    #[must_use]
    pub fn trouble(&self) -> Option<Trouble> {
        self.trouble
    }

    /// A beat, `late_ns` after it was due. It breaks off where the device is lost, and where it is time
    /// to end: after a last beat without force.
    pub fn beat(&mut self, late_ns: u64) -> ControlFlow<()> {
        let beaten = match self.channels.stop.load(Ordering::Relaxed) {
            true => self.last(),
            false => self.tick(late_ns),
        };
        beaten.unwrap_or_else(|trouble| {
            self.trouble = Some(trouble);
            ControlFlow::Break(())
        })
    }

    fn last(&mut self) -> Result<ControlFlow<()>, Trouble> {
        self.device.read(0.0)?;
        self.device.write(DVec3::ZERO)?;
        Ok(ControlFlow::Break(()))
    }

    fn tick(&mut self, late_ns: u64) -> Result<ControlFlow<()>, Trouble> {
        let now_ns = monotonic_ns();
        let dt = now_ns.saturating_sub(self.read_ns) as f64 * 1e-9;
        self.take_in();
        let Some(reading) = self.device.read(dt)? else {
            if dt > self.longest_s {
                self.device.write(DVec3::ZERO)?;
            }
            return Ok(ControlFlow::Continue(()));
        };
        self.read_ns = now_ns;
        self.servo.measure(reading.motor_temperature);
        self.servo.permit(match reading.is_permitted {
            true => Switch::On,
            false => Switch::Off,
        });
        let (force, mut tick) = self.servo.step(&reading.held, dt);
        self.device.write(force)?;
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
        let ticked = Ticked {
            monotonic_ns: now_ns,
            reading,
            force: self.device.on_hand(force),
            late_ns,
            spent_ns: monotonic_ns().saturating_sub(now_ns),
            tick,
            armings: self.followed.armings,
        };
        if self.channels.ticks.push(ticked).is_err() {
            self.channels.dropped.fetch_add(1, Ordering::Relaxed);
        }
        Ok(ControlFlow::Continue(()))
    }

    /// The newest model and the newest wish.
    fn take_in(&mut self) {
        let delivery = *self.channels.models.read();
        if delivery.number != self.seen
            && let Some(contact) = delivery.contact
        {
            let whose = match delivery.sender == self.sender {
                true => Sender::Same,
                false => Sender::Another,
            };
            self.servo.receive(contact, whose);
            (self.seen, self.sender) = (delivery.number, delivery.sender);
        }
        let wish = *self.channels.wishes.read();
        self.followed.follow(wish, &mut self.servo);
    }
}
