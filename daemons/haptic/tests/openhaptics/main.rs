//! Phantoms: the driver as it is, over a libHD of our own with a simulated device and scripted faults.

#[path = "../../../../sim/num/tests/counting/mod.rs"]
mod counting;

mod bench;
mod calibration;
mod ending;
mod errors;
mod frames;
mod opening;
