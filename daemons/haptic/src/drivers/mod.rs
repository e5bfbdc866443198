//! Drivers, one module for each family of devices.

pub mod force_dimension;
pub mod inverse3;
pub mod openhaptics;
pub mod openxr;
pub mod polhem;
pub mod simulated;
pub mod vendor_library;
