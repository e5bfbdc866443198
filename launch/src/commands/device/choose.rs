//! `maulstick device use`: which device paints, with what brush and what law of force, changed while painting.

use std::str::FromStr;

use clap::Args;
use maulstick_rig::UserError;
use maulstick_rig::config::{ACTIONS, DeviceSection, FORCES, PEN_PRIORITY};

use super::user_file::{UserFile, in_rig, is_same, put_in_rig};
use crate::commands::client::Target;
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
    /// Drag of the paint by its true size, 0 to 10
    #[arg(long, value_name = "TIMES")]
    paint_drag: Option<f64>,
    /// Height of the relief that the hand feels by its true height, 0 to 1
    #[arg(long, value_name = "SHARE")]
    relief: Option<f64>,
    #[command(flatten)]
    target: Target,
}

/// A pressure curve as it is typed.
#[derive(Clone, Debug, PartialEq)]
struct PressureCurve(Vec<[f64; 2]>);

impl FromStr for PressureCurve {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let point = |word: &str| {
            let (sensed, given) = word.split_once(',')?;
            Some([sensed.parse().ok()?, given.parse().ok()?])
        };
        let point = |word| {
            point(word).ok_or_else(|| format!("'{word}' is no point as in \"0,0 0.5,0.3 1,1\""))
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
    let mut file = UserFile::read()?;
    let name = &options.device;
    let in_rig = in_rig(&options.target)?;
    let own = file.device(name, &in_rig).cloned();
    let is_own = own.is_ok();
    // A studio's device is one of the rig alone.
    let running = in_rig.iter().find(|device| device.name == *name);
    let device = own.or_else(|fault| running.cloned().ok_or(fault))?;
    is_same(&device, running)?;
    let brush = options
        .brush
        .clone()
        .unwrap_or_else(|| device.brush.clone());
    let others = file.devices.iter().chain(&in_rig);
    let others = others.filter(|other| other.name != *name && other.brush == brush);
    let highest = others.map(|other| other.priority).max();
    let priority = options
        .priority
        .unwrap_or_else(|| above(highest, device.priority));
    let changed = DeviceSection {
        priority,
        force: options
            .force
            .clone()
            .unwrap_or_else(|| device.force.clone()),
        brush,
        pressure_curve: match &options.pressure_curve {
            Some(PressureCurve(points)) => points.clone(),
            None => device.pressure_curve.clone(),
        },
        switches: options.switches.clone().or(device.switches.clone()),
        max_force_n: options.max_force.unwrap_or(device.max_force_n),
        paint_drag: options.paint_drag.unwrap_or(device.paint_drag),
        relief: options.relief.unwrap_or(device.relief),
        ..device
    };
    let answer = put_in_rig(&options.target, &changed)?;
    if is_own {
        file.put(&changed)?;
    }
    say!(
        "'{name}' moves '{}' with priority {priority}; its force is {}",
        changed.brush,
        changed.force
    );
    if answer.is_none() {
        say!("the rig does not run: `maulstick up` starts it so");
    }
    Ok(0)
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

    #[test]
    fn a_pressure_curve_is_typed_point_by_point() {
        let curve = |text: &str| text.parse::<PressureCurve>().map(|curve| curve.0);
        let points = vec![[0.0, 0.0], [0.5, 0.3], [1.0, 1.0]];
        assert_eq!(curve("0,0 0.5,.3  1,1"), Ok(points));
        for wrong in ["0,0 1", "0,0 a,1", "0;0"] {
            assert!(curve(wrong).expect_err(wrong).contains("is no point"));
        }
    }
}
