//! Settings of a device, changed while painting: its brush, priority, law of force, pressure curve and switches.

use maulstick_rig::config::{DeviceSection, PEN_PRIORITY};

use crate::error::SetupError;
use crate::running::{Devices as _, Running, is_same, put_in_both};
use crate::user_file::UserFile;

/// A change of a device; what is absent stays as it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeviceChange {
    /// Its name.
    pub device: String,
    /// Brush that it moves.
    pub brush: Option<String>,
    /// Law of its force.
    pub force: Option<String>,
    /// Priority; above all others that move its brush if absent.
    pub priority: Option<i32>,
    /// Points (sensed, given) of a pen's pressure.
    pub pressure_curve: Option<Vec<[f64; 2]>>,
    /// Action of each switch.
    pub switches: Option<Vec<String>>,
    /// Largest force, N.
    pub max_force_n: Option<f64>,
    /// Factor on the drag of the paint.
    pub paint_drag: Option<f64>,
    /// Height of the relief that the hand feels by its true height.
    pub relief: Option<f64>,
}

/// A device that was changed.
#[derive(Clone, Debug, PartialEq)]
pub struct Changed {
    /// It, as it is now.
    pub device: DeviceSection,
    /// True if it is one of a rig that runs.
    pub is_running: bool,
}

/// Changes a device of this user, and of the rig of this name if it runs.
///
/// # Errors
/// A [`SetupError`] where there is no such device, or the change does not fit; all is as it was then.
pub fn change(change: &DeviceChange, rig: &str) -> Result<Changed, SetupError> {
    let mut file = UserFile::read()?;
    let mut rig = Running::open(rig)?;
    let name = &change.device;
    let in_rig = rig.all()?;
    let own = file.device(name, &in_rig).cloned();
    let is_own = own.is_ok();
    // A studio's device is one of the rig alone.
    let running = in_rig.iter().find(|device| device.name == *name);
    let device = own.or_else(|fault| running.cloned().ok_or(fault))?;
    is_same(&device, running)?;
    let brush = change.brush.clone();
    let brush = brush.unwrap_or_else(|| device.brush.clone());
    let others = file.devices.iter().chain(&in_rig);
    let others = others.filter(|other| other.name != *name && other.brush == brush);
    let highest = others.map(|other| other.priority).max();
    let force = change.force.clone();
    let curve = change.pressure_curve.clone();
    let changed = DeviceSection {
        priority: change
            .priority
            .unwrap_or_else(|| above(highest, device.priority)),
        force: force.unwrap_or_else(|| device.force.clone()),
        brush,
        pressure_curve: curve.unwrap_or_else(|| device.pressure_curve.clone()),
        switches: change.switches.clone().or(device.switches.clone()),
        max_force_n: change.max_force_n.unwrap_or(device.max_force_n),
        paint_drag: change.paint_drag.unwrap_or(device.paint_drag),
        relief: change.relief.unwrap_or(device.relief),
        ..device
    };
    let answer = if is_own {
        put_in_both(&mut rig, &mut file, &changed)?
    } else {
        rig.put(&changed)?
    };
    Ok(Changed {
        device: changed,
        is_running: answer.is_some(),
    })
}

/// The least priority above the others', the window's pen's among them, that is not below the device's own.
fn above(highest: Option<i32>, own: i32) -> i32 {
    let others = highest.unwrap_or(PEN_PRIORITY).max(PEN_PRIORITY);
    own.max(others.saturating_add(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_used_comes_before_all_others() {
        assert_eq!(above(None, 0), 0);
        assert_eq!(above(Some(10), 0), 11);
        assert_eq!(above(Some(10), 20), 20);
        assert_eq!(above(Some(10), 10), 11);
        assert_eq!(above(Some(-90), -80), PEN_PRIORITY + 1);
    }
}
