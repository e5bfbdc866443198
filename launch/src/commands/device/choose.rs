//! `maulstick device use`: selects the painting device, its brush and its law of force, even while painting.

use std::str::FromStr;

use clap::Args;
use maulstick_device_setup::change::{DeviceChange, change};
use maulstick_rig::UserError;
use maulstick_rig::config::{ACTIONS, FORCES};

use crate::commands::client::Target;
use crate::commands::option_error::OptionError;
use crate::commands::say;

/// Options of `maulstick device use`.
#[derive(Args, Clone, Debug)]
pub struct UseOptions {
    /// Name of the device
    device: String,
    /// Brush that it moves from now on
    #[arg(long)]
    brush: Option<String>,
    /// Law of its force
    #[arg(long, value_parser = FORCES)]
    force: Option<String>,
    /// Priority [default: above all others that move its brush]
    #[arg(long, allow_negative_numbers = true)]
    priority: Option<i32>,
    /// Points (sensed, given) of a pen's pressure between which it goes in straight lines: "0,0 0.5,0.3 1,1"
    #[arg(long, value_name = "POINTS")]
    pressure_curve: Option<PressureCurve>,
    /// What each switch does, the first switch first: "pick,undo"
    #[arg(long, value_name = "ACTIONS", value_delimiter = ',', value_parser = ACTIONS)]
    switches: Option<Vec<String>>,
    /// Largest force, N
    #[arg(long, value_name = "N")]
    max_force: Option<f64>,
    /// Factor on the drag of the paint, 0 to 10
    #[arg(long, value_name = "TIMES")]
    paint_drag: Option<f64>,
    /// Height of the relief that the hand feels by its true height, 0 to 1
    #[arg(long, value_name = "SHARE")]
    relief: Option<f64>,
    #[command(flatten)]
    target: Target,
}

/// A pressure curve as typed.
#[derive(Clone, Debug, PartialEq)]
struct PressureCurve(Vec<[f64; 2]>);

impl FromStr for PressureCurve {
    type Err = OptionError;

    fn from_str(text: &str) -> Result<Self, OptionError> {
        let point = |word: &str| {
            let (sensed, given) = word.split_once(',')?;
            Some([sensed.parse().ok()?, given.parse().ok()?])
        };
        let point = |word| {
            let expected = "a point as in \"0,0 0.5,0.3 1,1\"";
            point(word).ok_or_else(|| OptionError::unexpected(word, expected))
        };
        text.split_whitespace()
            .map(point)
            .collect::<Result<_, _>>()
            .map(Self)
    }
}

/// Changes a device.
///
/// # Errors
/// A [`UserError`] where there is no such device, or the change does not fit.
pub(super) fn run(options: &UseOptions) -> Result<i32, UserError> {
    let curve = options.pressure_curve.as_ref();
    let wanted = DeviceChange {
        device: options.device.clone(),
        brush: options.brush.clone(),
        force: options.force.clone(),
        priority: options.priority,
        pressure_curve: curve.map(|PressureCurve(points)| points.clone()),
        switches: options.switches.clone(),
        max_force_n: options.max_force,
        paint_drag: options.paint_drag,
        relief: options.relief,
    };
    let changed = change(&wanted, options.target.rig())?;
    let device = &changed.device;
    say!(
        "'{}' moves '{}' with priority {}; its force is {}",
        device.name,
        device.brush,
        device.priority,
        device.force
    );
    if !changed.is_running {
        say!("the rig does not run: `maulstick up` starts it so");
    }
    Ok(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pressure_curve_is_typed_point_by_point() {
        let curve = |text: &str| text.parse::<PressureCurve>().map(|curve| curve.0);
        let points = vec![[0.0, 0.0], [0.5, 0.3], [1.0, 1.0]];
        assert_eq!(curve("0,0 0.5,.3  1,1"), Ok(points));
        for wrong in ["0,0 1", "0,0 a,1", "0;0"] {
            assert!(curve(wrong).is_err(), "{wrong}");
        }
    }
}
