//! The haptic daemon.
//!
//! A real-time thread runs the servo beside the device, a thousand times a second. It touches no
//! bus, no lock and no allocator: models come in through a triple buffer, samples go out through a
//! ring, and another thread talks to the rig.
//!
//! | module | holds |
//! | --- | --- |
//! | [`driver`] | what a device is to the servo |
//! | [`open`] | the device that `rig.toml` asks for |
//! | [`placed`] | a device where it stands on the desk |
//! | [`showing`] | a device without a rig, in a hand that shows places |
//! | [`simulated`] | a device and a hand, simulated |
//! | [`beat`] | one tick of the servo over a device |
//! | [`pace`] | our own clock, which calls it |
//! | [`host`] | the real-time thread |
//! | [`wish`] | what a painter wants of the force |
//! | [`daemon`] | the thread that talks to the rig |

pub mod beat;
pub mod daemon;
pub mod driver;
pub mod host;
pub mod open;
pub mod pace;
pub mod placed;
pub mod showing;
pub mod simulated;
pub mod wish;

pub use driver::Driver;
pub use placed::Placed;
