//! Orders to the set-up of devices, and a fit in progress.

use maulstick_device::corner_calibration::Corner;
use maulstick_device_setup::add::NewDevice;
use maulstick_device_setup::change::DeviceChange;
use maulstick_device_setup::fit::FitEvent;

/// A request to the runner of changes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum DeviceOrder {
    /// A change, after those before it.
    Change(SetupChange),
    /// Fits a device to the canvas, by the hand's touches.
    Fit(String),
    /// Ends the fit in progress: nothing is written.
    StopFit,
}

/// A change of the devices.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum SetupChange {
    /// Lets the user at this machine use its devices.
    Allow,
    Add(NewDevice),
    Use(DeviceChange),
    /// Gives one another name.
    Rename {
        device: String,
        name: String,
    },
    Remove(String),
}

impl SetupChange {
    /// True if a later change of the same device sets all that this one sets.
    #[must_use]
    pub(crate) fn is_replaced_by(&self, later: &Self) -> bool {
        let (Self::Use(own), Self::Use(later)) = (self, later) else {
            return false;
        };
        let settings = |change: &DeviceChange| {
            [
                change.brush.is_some(),
                change.force.is_some(),
                change.pressure_curve.is_some(),
                change.switches.is_some(),
                change.max_force_n.is_some(),
                change.paint_drag.is_some(),
                change.relief.is_some(),
            ]
        };
        own.device == later.device
            && own.priority == later.priority
            && settings(own) == settings(later)
    }
}

/// A fit in progress.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct FitProgress {
    pub device: String,
    /// Its steps so far.
    pub events: Vec<FitEvent>,
}

impl FitProgress {
    /// The corner that is to be touched now.
    #[must_use]
    pub(crate) fn asked_corner(&self) -> Option<Corner> {
        let mut newest = self.events.iter().rev();
        newest.find_map(|event| match event {
            FitEvent::Touch { corner, .. } => Some(*corner),
            _ => None,
        })
    }
}
