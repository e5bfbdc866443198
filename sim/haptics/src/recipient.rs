//! Whom a model is for. Nobody else may feel it: another device stands elsewhere, a device that was
//! started anew may be held otherwise, and another brush is another hand's.

use maulstick_types::Origin;
use maulstick_types::haptics::ContactModel;

/// A device as it is now, and its brush.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recipient {
    /// The device and its epoch, as in its samples.
    pub device: Origin,
    /// Its brush as in `rig.toml`.
    pub brush: String,
}

impl Recipient {
    /// Whether a model is for it.
    #[must_use]
    pub fn accepts(&self, model: &ContactModel) -> bool {
        model.device == self.device.source
            && model.device_epoch == self.device.epoch
            && model.brush == self.brush
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
