//! Pens and 6-DOF mice over HID, and pens through the kernel's event devices.
//!
//! A report descriptor gives the layout of a device's reports; only a few devices need tables. Everything
//! below the daemon is pure, and a recording plays like the device.
//!
//! A pen that touches without pressure has 1/8192; turning it over counts as leaving and returning. While it is in range
//! the newest sample is repeated each 50 ms, so that a stroke at rest is not broken.
//!
//! | module | holds |
//! | --- | --- |
//! | [`device_source`] | interface to plugged-in devices |
//! | [`hidraw`] | the devices of this machine |
//! | [`recording`] | devices and their reports as text |
//! | [`recorder`] | writes a device's reports as a recording |
//! | [`descriptor`] | report descriptors, made safe |
//! | [`units`] | the units in them |
//! | [`layout`] | the pen in the reports of a tablet |
//! | [`wacom`] | tablets that do not describe themselves |
//! | [`spacemouse`] | 6-DOF mice |
//! | [`evdev`] | tablets through the kernel's event devices |
//! | [`tablet`] | a tablet on the desk |
//! | [`unfit`] | devices that cannot be read |
//! | [`open`] | the device that `rig.toml` asks for |
//! | [`probe`] | readings of a pen without a rig, for calibration |
//! | [`report_stream`] | reports with their times, live or played |
//! | [`stylus`] | a pen on the bus |
//! | [`spacemouse_node`] | a 6-DOF mouse on the bus |
//! | [`daemon`] | the daemon |
//!
//! A recording of a tablet, decoded as the tablet itself would be:
//!
//! ```
//! use maulstick_device::pen::Presence;
//! use maulstick_hid::layout::Layout;
//! use maulstick_hid::{descriptor, recording};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let text = include_str!("../../../docs/examples/pen.hid");
//! let tablet = recording::parse(text)?.remove(0);
//! let layout = Layout::of(&descriptor::read(&tablet.descriptor)?).ok_or("it has no pen")?;
//! let readings: Vec<_> = tablet.events.iter().filter_map(|event| layout.decode(&event.report)).collect();
//! let touching: Vec<_> = readings.iter().filter(|pen| pen.presence == Presence::Touching).collect();
//! let hardest = touching.iter().map(|pen| pen.pressure).fold(0.0, f64::max);
//! println!("{} of {} reports touch, {hardest:.2} at most", touching.len(), readings.len());
//! assert_eq!(readings.len(), tablet.events.len());
//! assert!(touching.iter().all(|pen| pen.point_m[0] <= layout.area_m()[0]) && hardest > 0.1);
//! # Ok(())
//! # }
//! ```
//!
//! # Notes
//!
//! A device is opened .1 s after its node appears or becomes readable (inotify), otherwise once a second. A tablet that
//! the rig reads is taken from the system and moves no pointer.

pub mod daemon;
pub mod evdev;
pub mod open;
pub mod probe;
mod reports;
pub mod spacemouse;
pub mod spacemouse_node;
pub mod stylus;
pub mod tablet;
pub mod unfit;

pub use reports::{
    descriptor, device_source, hidraw, layout, recorder, recording, report_stream, units, wacom,
};
