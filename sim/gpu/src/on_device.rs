//! Paint models on a device, as their entries in the registry make them.

use std::sync::Arc;

use maulstick_model::interface::PaintModel;

use crate::device::{Choice, Device, GpuError};
use crate::steps::model::GpuModel;
use crate::steps::traffic::Traffic;

/// Constructor of a model on a device. With [`Choice::Auto`] the processor keeps the work that it does faster. Fails
/// with a [`GpuError`] where the driver rejects the shaders.
pub type MakeModel = fn(Device, Choice) -> Result<OnDevice, GpuError>;

/// A paint model on a device.
pub struct OnDevice {
    /// Paint model.
    pub model: Box<dyn PaintModel>,
    /// Traffic of its steps, where whole steps run on the device.
    pub traffic: Option<Arc<Traffic>>,
}

impl From<GpuModel> for OnDevice {
    fn from(model: GpuModel) -> Self {
        Self {
            traffic: Some(model.traffic()),
            model: Box::new(model),
        }
    }
}
