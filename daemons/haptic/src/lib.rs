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
//! | [`openhaptics`] | Phantoms, through the vendor's library |
//! | [`showing`] | a device without a rig, in a hand that shows places |
//! | [`simulated`] | a device and a hand, simulated |
//! | [`polhem`] | WoodenHaptics and Polhem styluses, at a serial port |
//! | [`inverse3`] | Haply's Inverse3, by its service |
//! | [`velocity`] | velocity of devices that say only where they are |
//! | [`beat`] | one tick of the servo over a device |
//! | [`pace`] | our own clock, which calls it |
//! | [`host`] | the real-time thread |
//! | [`standing`] | what holds of a device's force though its daemon died |
//! | [`wish`] | what a painter wants of the force |
//! | [`daemon`] | the thread that talks to the rig |

pub mod beat;
pub mod daemon;
pub mod driver;
pub mod host;
pub mod inverse3;
pub mod open;
pub mod openhaptics;
pub mod pace;
pub mod placed;
pub mod polhem;
pub mod showing;
pub mod simulated;
pub mod standing;
pub mod velocity;
pub mod wish;

pub use driver::Driver;
pub use placed::Placed;
