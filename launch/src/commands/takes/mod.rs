//! Commands of takes: performances made, imported and painted.

pub mod demo;
pub mod import;
pub mod render;
pub mod take;
