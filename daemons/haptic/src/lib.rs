//! The haptic daemon.
//!
//! A real-time thread runs the servo beside the device, a thousand times a second. It touches no
//! bus, no lock and no allocator: models come in through a triple buffer, samples go out through a
//! ring, and another thread talks to the rig.
//!
//! | module | holds |
//! | --- | --- |
//! | [`driver`] | what a device is to the servo |
//! | [`simulated`] | a device and a hand, simulated |
//! | [`host`] | the real-time thread |
//! | [`wish`] | what a painter wants of the force |
//! | [`daemon`] | the thread that talks to the rig |

pub mod daemon;
pub mod driver;
pub mod host;
pub mod simulated;
pub mod wish;

pub use driver::Driver;
