//! Paint models on a device, as their entries in the registry make them.

use std::sync::Arc;

use maulstick_model::interface::PaintModel;

use crate::device::{Choice, Device, GpuError};
use crate::steps::model::GpuModel;
use crate::steps::traffic::Traffic;

/// Makes a model on a device. Where the choice is [`Choice::Auto`] the processor keeps what it does sooner. A [`GpuError`]
/// where the driver does not take the shaders.
pub type MakeModel = fn(Device, Choice) -> Result<OnDevice, GpuError>;

/// A paint model on a device.
pub struct OnDevice {
    /// The model.
    pub model: Box<dyn PaintModel>,
    /// What its steps move, where whole steps are the device's.
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
