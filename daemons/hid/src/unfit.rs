//! Devices that cannot be read as the kind that is asked for.

use maulstick_rig::UserError;

use crate::descriptor::{DescriptorError, describe};
use crate::device_source::Identity;

/// A device and why it cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnfitDevice {
    /// The device.
    pub identity: Identity,
    /// The reason.
    pub why: Unfit,
}

/// The reason why a device cannot be read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unfit {
    /// A tablet is asked for, and the outermost collections have these usages.
    NoPen(Vec<(u16, u16)>),
    /// A 6-DOF mouse is asked for, and the outermost collections have these usages.
    NoMouse(Vec<(u16, u16)>),
    /// A pen whose reports have no position.
    NoPlace,
    /// A 6-DOF mouse whose reports are not known.
    UnknownMaker,
    /// No event device.
    NoEvents,
    /// An event device without axes of a pen.
    NoAxes,
    /// Its report descriptor cannot be read.
    Descriptor(DescriptorError),
}

impl From<DescriptorError> for Unfit {
    fn from(error: DescriptorError) -> Self {
        Self::Descriptor(error)
    }
}

/// A tablet, in errors.
pub(crate) const TABLET_WORD: &str = "pen tablet";
/// A 6-DOF mouse, in errors.
pub(crate) const MOUSE_WORD: &str = "6-DOF mouse";
/// Advice on a device that is of another kind.
const OTHER: &str = "choose another device by `address` in rig.toml";
/// Advice on a HID device that is no tablet.
const TABLET: &str = "choose another device by `address`; if it is a tablet, its reports are in a format of its \
    maker's own, which the kernel may know: take `driver = \"evdev\"`; or record it with \
    `maulstick node hid --record` and send us that";
/// Advice on an event device that is no tablet.
const LISTED: &str = "choose another device by `address` in rig.toml: `maulstick device list` lists those with a pen";

impl From<UnfitDevice> for UserError {
    fn from(UnfitDevice { identity, why }: UnfitDevice) -> Self {
        let other = |usages: &[(u16, u16)], no: &str| {
            let is = describe(usages);
            format!("{identity} is {is}, no {no}")
        };
        match why {
            Unfit::NoPen(usages) => Self::failure(other(&usages, TABLET_WORD)).help(TABLET),
            Unfit::NoPlace => {
                let what = format!("{identity} is a pen whose reports do not say where it is");
                Self::failure(what).help(TABLET)
            }
            Unfit::NoMouse(usages) => Self::failure(other(&usages, MOUSE_WORD)).help(OTHER),
            Unfit::UnknownMaker => {
                let what = format!("{identity} is a 6-DOF mouse of an unknown maker");
                Self::failure(what).help(OTHER)
            }
            Unfit::NoEvents => {
                let what = format!("{identity} is no event device: its driver is `pen`");
                Self::failure(what).help(LISTED)
            }
            Unfit::NoAxes => Self::failure(format!(
                "{identity} has no pen with X and Y axes of more than one value, as its events go"
            ))
            .help(LISTED),
            Unfit::Descriptor(error) => Self::failure(format!(
                "{identity} describes itself wrongly: {error}"
            ))
            .help(format!(
                "{OTHER}; the kernel may read a pen all the same: take `driver = \"evdev\"`"
            )),
        }
    }
}
