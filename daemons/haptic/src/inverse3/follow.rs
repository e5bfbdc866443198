//! What is known of an Inverse3 from the service's messages so far.

use glam::{DQuat, DVec3};

use super::basis::Basis;
use super::message::{Hindrance, Update};

/// No cursor is farther from its origin along an axis, m.
pub const FARTHEST_M: f64 = 1.0;
/// No hand moves a cursor faster along an axis, m/s.
pub const FASTEST_M_S: f64 = 20.0;

/// How a device and its grip are held, in the device frame; all numbers are finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The cursor, m, each part within [`FARTHEST_M`].
    pub position: DVec3,
    /// m/s, each part within [`FASTEST_M_S`]; None where the service does not tell it.
    pub velocity: Option<DVec3>,
    /// Of the brush, which is held as the grip is; without a grip it points away from the user.
    pub orientation: DQuat,
    /// A bit a pressed button.
    pub switches: u32,
}

/// What a message says of a device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Seen {
    /// How it is held.
    Pose(Pose),
    /// Nothing, or numbers that no device sends.
    Nothing,
    /// It cannot be used now.
    Hindered(Hindrance),
}

/// Follows a device and the grip that is held with it.
#[derive(Clone, Debug)]
pub struct Follower {
    device: String,
    grip: Option<String>,
    basis: Basis,
    /// In the session's axes: messages may leave out what has not changed.
    position: Option<DVec3>,
    velocity: Option<DVec3>,
    orientation: DQuat,
    switches: u32,
}

impl Follower {
    /// Follows the device of that id, and the grip of that id or the first.
    #[must_use]
    pub fn new(device: &str, grip: Option<&str>) -> Self {
        Self {
            device: device.to_owned(),
            grip: grip.map(str::to_owned),
            basis: Basis::HAPLY,
            position: None,
            velocity: None,
            orientation: DQuat::IDENTITY,
            switches: 0,
        }
    }

    /// The device's id.
    #[must_use]
    pub fn device(&self) -> &str {
        &self.device
    }

    /// The axes that the session speaks in.
    #[must_use]
    pub fn basis(&self) -> Basis {
        self.basis
    }

    /// Takes in a message.
    pub fn take(&mut self, update: &Update) -> Seen {
        let Some(device) = update.device(&self.device) else {
            return Seen::Nothing;
        };
        if let Some(hindrance) = device.status.and_then(|status| status.hindrance()) {
            return Seen::Hindered(hindrance);
        }
        if let Some(basis) = device.basis() {
            self.basis = basis;
        }
        if let Some(grip) = update
            .grip(self.grip.as_deref())
            .and_then(|grip| grip.state)
        {
            let turned = grip.orientation.and_then(|turned| turned.unit());
            self.orientation = turned.unwrap_or(self.orientation);
            self.switches = grip.switches().unwrap_or(self.switches);
        }
        let Some(state) = device.state else {
            return Seen::Nothing;
        };
        let told = state.cursor_position.unwrap_or_default();
        let Some(position) = told
            .over(self.position)
            .filter(|position| is_within(*position, FARTHEST_M))
        else {
            return Seen::Nothing;
        };
        self.position = Some(position);
        let velocity = state.cursor_velocity.unwrap_or_default();
        self.velocity = velocity
            .over(self.velocity)
            .filter(|velocity| is_within(*velocity, FASTEST_M_S));
        Seen::Pose(Pose {
            position: self.basis.to_device(position),
            velocity: self.velocity.map(|v| self.basis.to_device(v)),
            orientation: self.basis.orientation(self.orientation),
            switches: self.switches,
        })
    }
}

fn is_within(vector: DVec3, most: f64) -> bool {
    vector
        .to_array()
        .iter()
        .all(|part| (-most..=most).contains(part))
}
