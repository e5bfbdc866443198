//! Hands, and the parts of each kind of controller that are used: paths of the interaction profiles of OpenXR 1.0.

use std::fmt;

use maulstick_rig::UserError;

/// The hand that holds the controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hand {
    /// The left one.
    Left,
    /// The right one.
    Right,
}

impl Hand {
    /// The hand of an address; the right one without.
    ///
    /// # Errors
    /// A [`UserError`] for any other word.
    pub fn named(address: Option<&str>) -> Result<Self, UserError> {
        match address {
            Some("left") => Ok(Self::Left),
            Some("right") | None => Ok(Self::Right),
            Some(other) => Err(UserError::usage(format!("'{other}' is no hand"))
                .help("`address` of an openxr device is `left` or `right`")),
        }
    }

    /// Its path.
    #[must_use]
    pub fn path(self) -> &'static str {
        match self {
            Self::Left => openxr::USER_HAND_LEFT,
            Self::Right => openxr::USER_HAND_RIGHT,
        }
    }
}

impl fmt::Display for Hand {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Left => "left",
            Self::Right => "right",
        })
    }
}

/// A kind of controller.
#[derive(Clone, Copy, Debug)]
pub struct Profile {
    /// Its interaction profile.
    pub path: &'static str,
    /// The part that is the trigger.
    pub trigger: &'static str,
    /// Input of the first switch: the whole hand, or the menu button.
    pub first: &'static str,
    /// The second switch, of the left and of the right hand, where there is one more.
    pub second: Option<[&'static str; 2]>,
}

/// Kinds of controllers; a runtime maps others onto these.
pub const PROFILES: [Profile; 5] = [
    Profile {
        path: "/interaction_profiles/khr/simple_controller",
        trigger: "input/select/click",
        first: "input/menu/click",
        second: None,
    },
    Profile {
        path: "/interaction_profiles/oculus/touch_controller",
        trigger: "input/trigger/value",
        first: "input/squeeze/value",
        second: Some(["input/x/click", "input/a/click"]),
    },
    Profile {
        path: "/interaction_profiles/valve/index_controller",
        trigger: "input/trigger/value",
        first: "input/squeeze/value",
        second: Some(["input/a/click", "input/a/click"]),
    },
    Profile {
        path: "/interaction_profiles/htc/vive_controller",
        trigger: "input/trigger/value",
        first: "input/squeeze/click",
        second: Some(["input/menu/click", "input/menu/click"]),
    },
    Profile {
        path: "/interaction_profiles/microsoft/motion_controller",
        trigger: "input/trigger/value",
        first: "input/squeeze/click",
        second: Some(["input/menu/click", "input/menu/click"]),
    },
];
/// Where each of them points.
pub const POSE: &str = "input/aim/pose";
/// Output that vibrates in each of them.
pub const MOTOR: &str = "output/haptic";
