//! Tablets through the kernel's event devices, /dev/input/event*: whatever a driver makes of them there, those of the
//! vendors and of OpenTabletDriver among them. Codes and their meaning are those of Linux's `input-event-codes.h` and
//! `Documentation/input/event-codes.rst`.
//!
//! A tablet's axes and keys stand in the place of a report descriptor, and the events of one time in the place of a report:
//! so a daemon, a calibration and a recording have nothing to tell apart.
//!
//! | module | holds |
//! | --- | --- |
//! | [`capabilities`] | axes and keys of a device |
//! | [`frame`] | the events of one time as bytes |
//! | [`pen`] | the pen in them |
//! | [`ports`] | the event devices of this machine |
//! | [`grab`] | takes the event devices of a tablet away from the system |
//! | [`evemu`] | recordings of other programs |

pub mod capabilities;
pub mod evemu;
pub mod frame;
pub mod grab;
pub mod pen;
pub mod ports;
