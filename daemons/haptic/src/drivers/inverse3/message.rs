//! The messages of Haply's Inverse service (docs.haply.co, inverseSDK/service/realtime/websocket-protocol).
//!
//! Unused fields are not read, a missing or null field counts as not sent: versions differ.

use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

use super::axes::Basis;

/// A message of the service: its devices, all of them the first time, then their state.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct Update {
    /// Sent by services from 3.5.
    pub session_id: Option<u64>,
    #[serde(default)]
    inverse3: Option<Vec<Device>>,
    #[serde(default)]
    verse_grip: Option<Vec<Grip>>,
    #[serde(default)]
    wireless_verse_grip: Option<Vec<Grip>>,
}

/// An Inverse3.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct Device {
    /// Its id, such as "049D".
    #[serde(default)]
    pub device_id: String,
    config: Option<Config>,
    /// Its motion.
    pub state: Option<State>,
    /// Its readiness.
    pub status: Option<Status>,
}

#[derive(Clone, Debug, Default, Deserialize)]
struct Config {
    #[serde(rename = "type")]
    kind: Option<String>,
    basis: Option<Permutation>,
    /// Name of `basis` before 3.5.
    coordinate_system: Option<Permutation>,
}

#[derive(Clone, Debug, Default, Deserialize)]
struct Permutation {
    permutation: Option<String>,
}

/// Motion of an Inverse3, in the session's axes.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
pub struct State {
    /// m.
    pub cursor_position: Option<Vector>,
    /// m/s.
    pub cursor_velocity: Option<Vector>,
}

/// A vector of which parts may be left out.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
pub struct Vector {
    x: Option<f64>,
    y: Option<f64>,
    z: Option<f64>,
}

impl Vector {
    /// The vector; what is left out is as in `before`, and None where there is no before.
    #[must_use]
    pub fn over(self, before: Option<DVec3>) -> Option<DVec3> {
        let part = |told: Option<f64>, axis: usize| told.or(before.map(|before| before[axis]));
        let (x, y, z) = (part(self.x, 0)?, part(self.y, 1)?, part(self.z, 2)?);
        Some(DVec3::new(x, y, z))
    }
}

/// Readiness of an Inverse3; a missing flag is false.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
pub struct Status {
    calibrated: Option<bool>,
    /// True if a session uses it: in the first message one that is not ours.
    in_use: Option<bool>,
    power_supply: Option<bool>,
    ready: Option<bool>,
}

/// Obstacle to the use of a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hindrance {
    /// Its motors have no power.
    NoPower,
    /// It does not know where its arm is.
    NotCalibrated,
    /// It says no more than that it is not ready.
    NotReady,
    /// Its axes cannot be read, and a guess would push in the wrong direction.
    UnknownAxes,
}

impl Hindrance {
    /// The error, to follow "the Inverse3 …".
    #[must_use]
    pub fn what(self) -> &'static str {
        match self {
            Self::NoPower => "the Inverse3 has no power",
            Self::NotCalibrated => "the Inverse3 is not calibrated",
            Self::NotReady => "the Inverse3 is not ready",
            Self::UnknownAxes => "the Inverse3 speaks in axes that cannot be read",
        }
    }

    /// Advice.
    #[must_use]
    pub fn help(self) -> &'static str {
        match self {
            Self::NoPower => "plug its power supply in",
            Self::NotCalibrated => "put the grip into its rest, and wait until the light stays on",
            Self::NotReady => "wait a little, or look at it in Haply Hub",
            Self::UnknownAxes => "set its basis to XYZ in Haply Hub",
        }
    }
}

impl Status {
    /// Obstacle to the use of the device, if one is reported.
    #[must_use]
    pub fn hindrance(&self) -> Option<Hindrance> {
        [
            (self.power_supply, Hindrance::NoPower),
            (self.calibrated, Hindrance::NotCalibrated),
            (self.ready, Hindrance::NotReady),
        ]
        .into_iter()
        .find_map(|(told, hindrance)| (told == Some(false)).then_some(hindrance))
    }
}

impl Device {
    /// The axes of the session, if they are reported.
    ///
    /// # Errors
    /// If the reported axes are invalid.
    pub fn basis(&self) -> Result<Option<Basis>, Hindrance> {
        let told = self.config.as_ref().and_then(|config| {
            [&config.basis, &config.coordinate_system]
                .into_iter()
                .flatten()
                .find_map(|basis| basis.permutation.as_deref())
        });
        told.map(|told| Basis::read(told).ok_or(Hindrance::UnknownAxes))
            .transpose()
    }

    /// Kind, such as "inverse3" or "minverse", if it is reported.
    #[must_use]
    pub fn kind(&self) -> Option<&str> {
        self.config.as_ref()?.kind.as_deref()
    }

    /// True if a session uses it.
    #[must_use]
    pub fn is_in_use(&self) -> bool {
        self.status
            .is_some_and(|status| status.in_use == Some(true))
    }

    fn tells_basis(&self) -> bool {
        let config = self.config.as_ref();
        config.is_some_and(|config| config.basis.is_some())
    }
}

/// A VerseGrip, at a wire or without.
#[derive(Clone, Debug, Default, Deserialize)]
pub struct Grip {
    /// Its id, such as "61548".
    #[serde(default)]
    pub device_id: String,
    /// Its pose.
    pub state: Option<GripState>,
}

/// Pose of a grip.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
pub struct GripState {
    /// In the session's axes.
    pub orientation: Option<Quaternion>,
    /// The only button of a grip at a wire.
    button: Option<bool>,
    /// Those of a wireless one.
    buttons: Option<Buttons>,
}

/// A quaternion.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
pub struct Quaternion {
    x: Option<f64>,
    y: Option<f64>,
    z: Option<f64>,
    w: Option<f64>,
}

impl Quaternion {
    /// The unit quaternion; None where a part is left out or its length is not within a tenth of 1.
    #[must_use]
    pub fn unit(self) -> Option<DQuat> {
        let turned = DQuat::from_xyzw(self.x?, self.y?, self.z?, self.w?);
        ((turned.length() - 1.0).abs() <= 0.1).then(|| turned.normalize())
    }
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
struct Buttons {
    a: Option<bool>,
    b: Option<bool>,
    c: Option<bool>,
}

impl GripState {
    /// One bit per pressed button, the lowest for a; `None` if no button is reported.
    #[must_use]
    pub fn switches(&self) -> Option<u32> {
        let told = match (self.buttons, self.button) {
            (Some(buttons), _) => [buttons.a, buttons.b, buttons.c],
            (None, button) => [button, None, None],
        };
        let pressed = |place: usize| u32::from(told[place] == Some(true)) << place;
        told.iter()
            .any(Option::is_some)
            .then(|| pressed(0) | pressed(1) | pressed(2))
    }
}

impl Update {
    /// Reads a message.
    ///
    /// # Errors
    /// If it is invalid: not JSON, of other types, a number beyond every f64.
    pub fn read(bytes: &[u8]) -> Result<Self, serde_json::Error> {
        serde_json::from_slice(bytes)
    }

    /// The devices.
    #[must_use]
    pub fn devices(&self) -> &[Device] {
        self.inverse3.as_deref().unwrap_or_default()
    }

    /// The device of that id.
    #[must_use]
    pub fn device(&self, id: &str) -> Option<&Device> {
        self.devices().iter().find(|device| device.device_id == id)
    }

    /// The ids of all grips.
    pub fn grips(&self) -> impl Iterator<Item = &str> {
        [&self.wireless_verse_grip, &self.verse_grip]
            .into_iter()
            .flatten()
            .flatten()
            .map(|grip| grip.device_id.as_str())
    }

    /// The grip of that id; without an id the first wireless one, then the first at a wire.
    #[must_use]
    pub fn grip(&self, id: Option<&str>) -> Option<&Grip> {
        [&self.wireless_verse_grip, &self.verse_grip]
            .into_iter()
            .flatten()
            .flatten()
            .find(|grip| id.is_none_or(|id| grip.device_id == id))
    }

    /// Dialect of the service that sent this, its first message: from 3.5 it numbers sessions and has a `basis`.
    #[must_use]
    pub fn dialect(&self) -> Dialect {
        if self.session_id.is_some() || self.devices().iter().any(Device::tells_basis) {
            Dialect::Vector
        } else {
            Dialect::Values
        }
    }
}

/// Names of the components of a force in the service's messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dialect {
    /// `vector`, from 3.5.
    Vector,
    /// `values`, before.
    Values,
}

#[derive(Serialize)]
struct Request<'a> {
    inverse3: [Asked<'a>; 1],
}

#[derive(Serialize)]
struct Asked<'a> {
    device_id: &'a str,
    commands: Commands,
}

#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum Commands {
    SetCursorForce(Force),
}

#[derive(Serialize)]
#[serde(rename_all = "snake_case")]
enum Force {
    Vector(Parts),
    Values(Parts),
}

#[derive(Serialize)]
struct Parts {
    x: f64,
    y: f64,
    z: f64,
}

/// The message that asks a device for a force, N, in the session's axes. Also no force is one: a
/// service tells a grip at a wire to a session that commands its device, and before 3.5 it tells
/// nothing for less.
///
/// # Errors
/// Never, for numbers that are finite.
pub fn request(
    device_id: &str,
    force: DVec3,
    dialect: Dialect,
) -> Result<String, serde_json::Error> {
    let parts = Parts {
        x: force.x,
        y: force.y,
        z: force.z,
    };
    let force = match dialect {
        Dialect::Vector => Force::Vector(parts),
        Dialect::Values => Force::Values(parts),
    };
    serde_json::to_string(&Request {
        inverse3: [Asked {
            device_id,
            commands: Commands::SetCursorForce(force),
        }],
    })
}
