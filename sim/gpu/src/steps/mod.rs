//! Steps of a brush on the device, whatever the paint model.
//!
//! Window and load are on the device from the first step until they are settled; nothing is read back in between.
//! Unsettled steps are kept, and repeated by the processor if the device is lost.
//!
//! | module | holds |
//! | --- | --- |
//! | `kernels` | stages as pipelines, and those that all models share |
//! | `record` | a step in the layout of the shaders |
//! | `device_layout` | a window and a load while they are on the device |
//! | `workspace` | the buffers; upload, steps, read-back |
//! | `kept` | steps that are on the device alone |
//! | `traffic` | bytes that steps move |
//! | `probing` | a step as far as a stage |
//! | `model` | the paint model that defers its steps to the device |

pub mod device_layout;
mod kept;
pub mod kernels;
pub mod model;
pub mod probing;
pub mod record;
pub mod traffic;
pub mod workspace;
