//! Words of the window for changes of devices and steps of a fit.

use maulstick_device::corner_calibration::{Corner, TouchRejection};
use maulstick_device_setup::fit::{FitEvent, Gesture};

use super::Made;

/// A change that was made.
pub(super) fn made(made: &Made) -> String {
    match made {
        Made::Allowed => tr!("You may use the devices of this machine now").to_owned(),
        Made::Added(added) => tr!(
            "The device '{name}' ({driver}) is added",
            name = added.name,
            driver = added.driver
        ),
        Made::Used(name) => tr!("The device '{name}' is changed", name),
        Made::Renamed { device, name } => tr!("'{device}' is called '{name}' now", device, name),
        Made::Removed(name) => tr!("The device '{name}' is removed", name),
    }
}

/// A step of a fit.
pub(crate) fn fit_event(event: &FitEvent) -> String {
    match event {
        FitEvent::DefaultCanvas {
            size_mm: [width, height],
        } => tr!(
            "No rig runs: this is for a canvas of {width} × {height} mm",
            width,
            height
        ),
        FitEvent::Opened { device, what } => format!("{device}: {what}"),
        FitEvent::Touch { corner, gesture } => {
            let corner = corner_words(*corner);
            match gesture {
                Gesture::Pen => tr!(
                    "Touch the {corner} corner of the canvas with the pen on its tablet",
                    corner
                ),
                Gesture::Ferrule => tr!(
                    "Touch the {corner} corner of the canvas with the ferrule, and keep still for a second or press the first switch",
                    corner
                ),
            }
        }
        FitEvent::Found { corner, place_m } => {
            let [x, y, z] = (*place_m * 1e3).to_array();
            format!("{}: {x:.1}, {y:.1}, {z:.1} mm", corner_words(*corner))
        }
        FitEvent::Rejected(TouchRejection::Moved) => {
            tr!("The hand moved: touch the corner again and keep still").to_owned()
        }
        FitEvent::Rejected(TouchRejection::SamePlace) => {
            tr!("This is the corner before: go on to the next").to_owned()
        }
        FitEvent::Stretched([width, height]) => tr!(
            "The canvas is {width} times as wide and {height} times as high",
            width = format_args!("{width:.2}"),
            height = format_args!("{height:.2}")
        ),
        FitEvent::Fitted(fit) => tr!(
            "Width by height is {percent} % of the canvas's, the angle {angle}°",
            percent = format_args!("{:.1}", 100.0 * fit.ratio),
            angle = format_args!("{:.1}", fit.angle_rad.to_degrees())
        ),
        FitEvent::Scaled { scale, off_m } => tr!(
            "The canvas is {scale} times as large; at worst a corner is off by {off} mm",
            scale = format_args!("{scale:.2}"),
            off = format_args!("{:.1}", 1e3 * off_m)
        ),
        FitEvent::Written(path) => tr!("Written into {file}", file = path.display()),
        FitEvent::Unwritten => tr!("Nothing is written").to_owned(),
        FitEvent::NotTakenBack { device, what } => tr!(
            "The rig does not take '{device}' back: {what}",
            device,
            what
        ),
    }
}

fn corner_words(corner: Corner) -> &'static str {
    match corner {
        Corner::LowerLeft => tr!("lower left"),
        Corner::LowerRight => tr!("lower right"),
        Corner::UpperLeft => tr!("upper left"),
    }
}
