//! Haptic devices, independent of their makers: the driver interface, the mounting on the desk, and
//! readings without a rig.

pub mod driver;
pub mod mounted_device;
pub mod open;
pub mod probe;
pub mod velocity;
