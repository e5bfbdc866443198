//! `[[device]]`: a stylus or mouse, and its registration on the desk.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::{RigConfig, toml_fault};
use crate::user_error::UserError;

/// Drivers of devices.
pub const DRIVERS: [&str; 9] = [
    "simulated",
    "openhaptics",
    "forcedimension",
    "openxr",
    "polhem",
    "inverse3",
    "pen",
    "evdev",
    "spacemouse",
];
/// Those of them that `maulstick-hid` serves; the others are `maulstick-haptic`'s.
pub const HID_DRIVERS: [&str; 3] = ["pen", "evdev", "spacemouse"];
/// Those of them that read a tablet.
pub const PEN_DRIVERS: [&str; 2] = ["pen", "evdev"];
/// Those of them that work through a vendor's library.
pub(super) const LIBRARY_DRIVERS: [&str; 3] = ["openhaptics", "forcedimension", "openxr"];
/// Force laws of a brush.
pub const FORCES: [&str; 5] = ["linear", "hermite", "local", "rigid", "none"];
/// Actions of a switch on a stylus.
pub const ACTIONS: [&str; 6] = ["none", "clutch", "pick", "palette", "undo", "clean"];

/// `[[device]]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DeviceSection {
    /// Name in the topics.
    pub name: String,
    /// One of [`DRIVERS`].
    pub driver: String,
    /// Address among several devices: the name that OpenHaptics gives it; the serial number of one of Force Dimension's; the
    /// `left` or `right` hand of OpenXR; a serial port; a WebSocket's URL with
    /// `#device+grip`; `vendor:product` of a HID device or of an event device in hexadecimal, or its path below /dev. The
    /// first that fits if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub address: Option<String>,
    /// The vendor's library of `openhaptics` or `forcedimension`, the loader of `openxr`, by another name than its usual ones,
    /// or by a whole path: in a folder of the system, or [allowed](RigConfig::allowed_libraries).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub library: Option<PathBuf>,
    /// A recording that is played in the place of a HID device or an event device, in the text format of hid-recorder or
    /// evemu.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub replay: Option<PathBuf>,
    /// Of devices in range the highest paints.
    #[serde(default)]
    pub priority: i32,
    /// The brush that it moves.
    pub brush: String,
    /// Device frame to desk frame, m.
    #[serde(default)]
    pub position_m: [f64; 3],
    /// Device frame to desk frame, a unit quaternion.
    #[serde(default = "no_turn")]
    pub orientation: [f64; 4],
    /// Desk lengths per device length. If absent 1; for a pen such that its tablet covers the canvas.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<f64>,
    /// Canvas's lower left, lower right and upper left corners in the device frame, m, as `maulstick device fit` finds
    /// them; then position, orientation and scale follow from these.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub corners_m: Option<[[f64; 3]; 3]>,
    /// From the point that a 6-DOF device senses to where head and ferrule meet, brush frame, m.
    #[serde(default)]
    pub ferrule_m: [f64; 3],
    /// Largest force, N.
    #[serde(default = "default_force")]
    pub max_force_n: f64,
    /// Factor on the drag of the paint on the hand (Baxter 2004, § 8.9.2), 0 to [`MOST_PAINT_DRAG`].
    #[serde(default = "default_paint_drag", skip_serializing_if = "is_true_size")]
    pub paint_drag: f64,
    /// Height of the relief that the hand feels, of dried and stiff paint, tooth and edges, by its true height, 0 to 1.
    #[serde(default = "default_relief", skip_serializing_if = "is_true_height")]
    pub relief: f64,
    /// One of [`FORCES`]: how the brush pushes back.
    #[serde(default = "default_law")]
    pub force: String,
    /// Points (sensed, given) from (0, 0) to (1, 1) between which pressure goes in straight lines.
    #[serde(default = "straight")]
    pub pressure_curve: Vec<[f64; 2]>,
    /// One of [`ACTIONS`] for each switch, the first switch first; the driver's own if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub switches: Option<Vec<String>>,
    /// A take that a simulated hand follows, feeling the canvas.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hand: Option<PathBuf>,
    /// Names of programs beside the brush whose contact models, forces of paint and guides move the hand.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub driven_by: Vec<String>,
}

impl DeviceSection {
    /// A device of which nothing else is said.
    #[must_use]
    pub fn new(name: &str, driver: &str, brush: &str) -> Self {
        Self {
            name: name.to_owned(),
            driver: driver.to_owned(),
            address: None,
            library: None,
            replay: None,
            priority: 0,
            brush: brush.to_owned(),
            position_m: [0.0; 3],
            orientation: no_turn(),
            scale: None,
            corners_m: None,
            ferrule_m: [0.0; 3],
            max_force_n: default_force(),
            paint_drag: default_paint_drag(),
            relief: default_relief(),
            force: default_law(),
            pressure_curve: straight(),
            switches: None,
            hand: None,
            driven_by: Vec::new(),
        }
    }

    /// Reads a section without its head.
    ///
    /// # Errors
    /// A [`UserError`] that says what is wrong.
    pub fn parse(text: &str) -> Result<Self, UserError> {
        toml::from_str(text).map_err(|error| UserError {
            place: None,
            ..toml_fault(text, "", &error)
        })
    }

    /// True if `maulstick-hid` serves it.
    #[must_use]
    pub fn is_hid(&self) -> bool {
        HID_DRIVERS.contains(&self.driver.as_str())
    }

    /// Action of each switch, the first one first.
    #[must_use]
    pub fn actions(&self) -> Vec<&str> {
        match (&self.switches, self.driver.as_str()) {
            (Some(actions), _) => actions.iter().map(String::as_str).collect(),
            (None, driver) if PEN_DRIVERS.contains(&driver) => vec!["pick", "undo"],
            (None, "openhaptics" | "forcedimension" | "openxr" | "polhem" | "inverse3") => {
                vec!["clutch", "undo"]
            }
            (None, _) => Vec::new(),
        }
    }
}

impl RigConfig {
    /// The same rig with a device, in the place of the one with its name if there is one.
    ///
    /// # Errors
    /// A [`UserError`] where the device does not fit into the rig.
    pub fn with_device(&self, device: DeviceSection) -> Result<Self, UserError> {
        let mut config = self.clone();
        match config.device.iter_mut().find(|own| own.name == device.name) {
            Some(own) => *own = device,
            None => config.device.push(device),
        }
        // The line would be one that nobody wrote.
        let read = Self::parse(&config.to_toml()?, "").map_err(|fault| UserError {
            place: None,
            ..fault
        })?;
        Ok(Self {
            allowed_libraries: config.allowed_libraries,
            ..read
        })
    }

    /// The same rig without a device, and without the sections of nodes that are nobody's then.
    #[must_use]
    pub fn without_device(&self, name: &str) -> Self {
        let mut config = self.clone();
        config.device.retain(|device| device.name != name);
        while let Err((_, _, node)) = config.check_nodes() {
            config.node.remove(&node);
        }
        config
    }
}

fn no_turn() -> [f64; 4] {
    [0.0, 0.0, 0.0, 1.0]
}

fn default_force() -> f64 {
    3.0
}

/// Greatest [`DeviceSection::paint_drag`].
pub const MOST_PAINT_DRAG: f64 = 10.0;

fn default_paint_drag() -> f64 {
    1.0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands a reference")]
fn is_true_size(paint_drag: &f64) -> bool {
    *paint_drag == default_paint_drag()
}

fn default_relief() -> f64 {
    1.0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands a reference")]
fn is_true_height(relief: &f64) -> bool {
    *relief == default_relief()
}

fn default_law() -> String {
    FORCES[0].into()
}

fn straight() -> Vec<[f64; 2]> {
    vec![[0.0, 0.0], [1.0, 1.0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{DEFAULT, NodeSection};

    #[test]
    fn devices_come_and_go_with_the_sections_that_are_theirs_alone() {
        let text = DEFAULT.replace(
            "[node.paint]",
            "[node.arm]\nrestart = \"never\"\n[node.paint]",
        );
        let arm = |name: &str| DeviceSection::new(name, "polhem", "main");
        assert!(RigConfig::parse(&text, "rig.toml").is_err(), "no arm");
        let config = RigConfig::default()
            .with_device(arm("arm-left"))
            .expect("it fits");
        let mut config = config.with_device(arm("arm-right")).expect("it fits");
        config.node.insert("arm".into(), NodeSection::default());
        let fewer = config.without_device("arm-left");
        assert!(fewer.node.contains_key("arm") && fewer.device.len() == 2);
        let none = fewer.without_device("arm-right");
        assert!(!none.node.contains_key("arm") && none.node.contains_key("paint"));
        let again = RigConfig::parse(&none.to_toml().expect("text"), "rig.toml");
        assert_eq!(again, Ok(RigConfig::default()));
        let other = DeviceSection::new("arm", "polhem", "mian");
        let fault = RigConfig::default()
            .with_device(other)
            .expect_err("no such brush");
        assert!(fault.what.contains("'mian'") && fault.place.is_none());
    }
}
