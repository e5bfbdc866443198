//! Pens and 6-DOF mice over HID.
//!
//! A device says by its report descriptor where in its reports what is; only a few need tables. Everything
//! below the daemon is pure, and a recording plays like the device.
//!
//! | module | holds |
//! | --- | --- |
//! | [`source`] | what a device is to us |
//! | [`hidraw`] | the devices of this machine |
//! | [`recording`] | devices and their reports as text |
//! | [`recorder`] | what a device says, written as a recording |
//! | [`descriptor`] | report descriptors, made safe |
//! | [`units`] | the units in them |
//! | [`layout`] | the pen in the reports of a tablet |
//! | [`wacom`] | tablets that do not describe themselves |
//! | [`pen`] | away, hovering, touching |
//! | [`spacemouse`] | 6-DOF mice |
//! | [`tablet`] | a tablet on the desk |
//! | [`open`] | the device that `rig.toml` asks for |
//! | [`showing`] | a pen without a rig, in a hand that shows places |
//! | [`feed`] | reports with their times, live or played |
//! | [`stylus`] | a pen on the bus |
//! | [`free_hand`] | a 6-DOF mouse on the bus |
//! | [`daemon`] | the daemon |

pub mod daemon;
pub mod descriptor;
pub mod feed;
pub mod free_hand;
pub mod hidraw;
pub mod layout;
pub mod open;
pub mod pen;
pub mod recorder;
pub mod recording;
pub mod showing;
pub mod source;
pub mod spacemouse;
pub mod stylus;
pub mod tablet;
pub mod units;
pub mod wacom;
