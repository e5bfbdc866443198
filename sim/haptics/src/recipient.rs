//! Recipient of a contact model: a model is accepted only by the device, session and brush it was computed for.

use maulstick_types::Origin;
use maulstick_types::haptics::{ContactModel, FluidForce, GuideModel};

/// A device in its current session, and its brush.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recipient {
    /// Device and epoch, as in its samples.
    pub device: Origin,
    /// Name of its brush in `rig.toml`.
    pub brush: String,
}

impl Recipient {
    /// True if a model is addressed to this recipient.
    #[must_use]
    pub fn accepts(&self, model: &ContactModel) -> bool {
        model.device == self.device.source
            && model.device_epoch == self.device.epoch
            && model.brush == self.brush
    }

    /// True if a guide is addressed to this recipient.
    #[must_use]
    pub fn accepts_guide(&self, guide: &GuideModel) -> bool {
        guide.device == self.device.source && guide.device_epoch == self.device.epoch
    }

    /// True if a force of paint is addressed to this device in its current session.
    #[must_use]
    pub fn accepts_fluid(&self, fluid: &FluidForce) -> bool {
        fluid.device == self.device.source && fluid.device_epoch == self.device.epoch
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::tests::{linear, model};

    #[test]
    fn device_epoch_and_brush_must_match() {
        let recipient = Recipient {
            device: Origin {
                source: 0,
                epoch: 0,
            },
            brush: "main".into(),
        };
        let taken = |change: fn(&mut ContactModel)| {
            let mut model = model(linear());
            change(&mut model);
            recipient.accepts(&model)
        };
        assert!(taken(|_| {}));
        assert!(!taken(|m| m.device = 2));
        assert!(!taken(|m| m.device_epoch = 2));
        assert!(!taken(|m| m.brush = "left".into()));
    }
}
