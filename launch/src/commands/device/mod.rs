//! Commands of devices: what is attached, calibration, force.

pub mod calibrate;
pub mod devices;
pub mod force;
pub mod force_order;
