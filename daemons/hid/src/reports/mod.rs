//! Reports of HID devices: descriptors, layouts, the devices of this machine, recordings.

pub mod descriptor;
pub mod device_source;
pub mod hidraw;
pub mod layout;
mod number;
pub(crate) mod recorded;
pub mod recorder;
pub mod recording;
pub mod report_stream;
pub mod units;
pub mod wacom;
