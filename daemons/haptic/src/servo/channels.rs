//! Channels between the servo and the daemon's thread, and the records that they carry.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64};

use glam::DVec3;
use maulstick_haptics::{Contact, Fluid, Guide, Tick};
use maulstick_types::Origin;

use super::force_control::ForceControl;
use crate::device::driver::Reading;

/// Record of a tick for the publisher.
#[derive(Clone, Copy, Debug)]
pub struct TickRecord {
    /// Time of the reading, `CLOCK_MONOTONIC`, ns.
    pub monotonic_ns: u64,
    /// Reading of the device, desk frame.
    pub reading: Reading,
    /// Force on the hand, N, in the desk's axes.
    pub force: DVec3,
    /// Lateness of the wake-up, ns.
    pub late_ns: u64,
    /// Duration of the tick, ns.
    pub spent_ns: u64,
    /// Report of the servo; its largest force is that on the hand.
    pub tick: Tick,
    /// The [`ForceControl::rearms`] that the servo has followed.
    pub rearms: u64,
}

/// A contact model or a guide for the servo.
#[derive(Clone, Copy, Debug)]
pub struct Delivery<M> {
    /// The model.
    pub model: Option<M>,
    /// Its sender.
    pub sender: Option<Origin>,
    /// Number of the delivery.
    pub number: u64,
}

impl<M> Default for Delivery<M> {
    fn default() -> Self {
        Self {
            model: None,
            sender: None,
            number: 0,
        }
    }
}

/// The servo's ends of the channels.
pub struct Channels {
    /// Tick records, out.
    pub ticks: rtrb::Producer<TickRecord>,
    /// Newest contact model, in.
    pub models: triple_buffer::Output<Delivery<Contact>>,
    /// Newest guide, in.
    pub guides: triple_buffer::Output<Delivery<Guide>>,
    /// Newest force of paint, in.
    pub fluids: triple_buffer::Output<Delivery<Fluid>>,
    /// Newest force settings, in.
    pub controls: triple_buffer::Output<ForceControl>,
    /// Request to end.
    pub stop: Arc<AtomicBool>,
    /// Number of tick records for which the ring had no room.
    pub dropped: Arc<AtomicU64>,
}
