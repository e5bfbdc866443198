//! The haptic daemon.
//!
//! A real-time thread runs the servo beside the device, a thousand times a second. It touches no
//! bus, no lock and no allocator: contact models and forces of paint come in through triple buffers, tick
//! records go out through a ring, and another thread talks to the rig.
//!
//! | module | holds |
//! | --- | --- |
//! | [`servo`] | servo loop, real-time thread, clock, channels to the daemon, force control |
//! | [`device`] | driver interface, mounting on the desk, opening, probing, velocity estimation |
//! | [`drivers`] | simulated device, OpenHaptics (Phantom), Polhem and WoodenHaptics, Inverse3 |
//! | [`daemon`] | thread that talks to the rig |
//! | [`force_state_file`] | force settings and latched fault that survive a daemon restart |

pub mod daemon;
pub mod device;
pub mod drivers;
pub mod force_state_file;
mod inlet;
mod senders;
pub mod servo;

pub use device::driver::Driver;
pub use device::mounted_device::MountedDevice;
