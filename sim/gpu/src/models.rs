//! The paint models that a device computes: the one place that names them.

use maulstick_model::interface::PaintModel;
use maulstick_stokes_paint::StokesPaint;

use crate::device::{Choice, Device, GpuError};
use crate::steps::model::{GpuModel, MakeModel};
use crate::stokes::GpuBrushFlow;

/// What of a paint model a device computes.
#[derive(Clone, Copy, Debug)]
pub enum DeviceModel {
    /// Whole steps, which are settled later.
    Steps(MakeModel),
    /// The flow around a brush, in `stokes`.
    Flow,
}

impl DeviceModel {
    /// That of the model of this name; none where no device computes it.
    #[must_use]
    pub fn of(name: &str) -> Option<Self> {
        match name {
            "impasto" => Some(Self::Steps(GpuModel::impasto)),
            "dab" => Some(Self::Steps(GpuModel::dab)),
            "stokes" => Some(Self::Flow),
            _ => None,
        }
    }

    /// Makes the model on a device. Where the choice is [`Choice::Auto`] the processor keeps what it does sooner.
    ///
    /// # Errors
    /// A [`GpuError`] where the driver does not take the shaders.
    pub fn make(self, gpu: Device, choice: Choice) -> Result<Box<dyn PaintModel>, GpuError> {
        Ok(match self {
            Self::Steps(make) => Box::new(make(gpu)?),
            Self::Flow => Box::new(StokesPaint::on(Box::new(GpuBrushFlow::new(gpu, choice)?))),
        })
    }
}
