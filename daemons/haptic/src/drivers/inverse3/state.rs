//! State of an Inverse3 from the service's messages so far.

use glam::{DQuat, DVec3};

use super::axes::Basis;
use super::message::{Hindrance, Update};

/// No cursor is farther from its origin along an axis, m.
pub const FARTHEST_M: f64 = 1.0;
/// No hand moves a cursor faster along an axis, m/s.
pub const FASTEST_M_S: f64 = 20.0;

/// Time without a message about the grip after which its buttons count as released, ns.
pub const LET_GO_NS: u64 = 100_000_000;
/// Time without a message about the grip after which the brush's orientation is unknown, ns.
pub const AWAY_NS: u64 = 1_000_000_000;

/// Pose of a device and its grip, in the device frame; all numbers are finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The cursor, m, each part within [`FARTHEST_M`].
    pub position: DVec3,
    /// m/s, each part within [`FASTEST_M_S`]; `None` if the service does not report it.
    pub velocity: Option<DVec3>,
    /// Orientation of the brush, which is that of the grip; without a grip it points away from the user.
    pub orientation: DQuat,
    /// A bit a pressed button.
    pub switches: u32,
    /// True while the grip, if there ever was one, reports its pose.
    pub in_range: bool,
}

/// Content of a message about a device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Seen {
    /// Its pose.
    Pose(Pose),
    /// Nothing.
    Nothing,
    /// A place where no cursor can be.
    Nowhere,
    /// It cannot be used now.
    Hindered(Hindrance),
}

/// Follows a device and its grip.
#[derive(Clone, Debug)]
pub struct DeviceTracker {
    device: String,
    /// The first that was there, if no id was given.
    grip: Option<String>,
    /// Time of the last message about the grip, `CLOCK_MONOTONIC`, ns.
    gripped_ns: Option<u64>,
    basis: Basis,
    /// In the session's axes: messages may leave out what has not changed.
    position: Option<DVec3>,
    velocity: Option<DVec3>,
    orientation: DQuat,
    switches: u32,
}

impl DeviceTracker {
    /// Follows the device of that id, and the grip of that id or the first.
    #[must_use]
    pub fn new(device: &str, grip: Option<&str>) -> Self {
        Self {
            device: device.to_owned(),
            grip: grip.map(str::to_owned),
            gripped_ns: None,
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

    /// Adds a message that came at `now_ns`, `CLOCK_MONOTONIC`.
    pub fn take(&mut self, update: &Update, now_ns: u64) -> Seen {
        let Some(device) = update.device(&self.device) else {
            return Seen::Nothing;
        };
        if let Some(hindrance) = device.status.and_then(|status| status.hindrance()) {
            return Seen::Hindered(hindrance);
        }
        match device.basis() {
            Ok(basis) => self.basis = basis.unwrap_or(self.basis),
            Err(hindrance) => return Seen::Hindered(hindrance),
        }
        self.grasp(update, now_ns);
        let Some(state) = device.state else {
            return Seen::Nothing;
        };
        let told = state.cursor_position.unwrap_or_default();
        let Some(position) = told
            .over(self.position)
            .filter(|position| is_within(*position, FARTHEST_M))
        else {
            return match told.over(self.position) {
                Some(_) => Seen::Nowhere,
                None => Seen::Nothing,
            };
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
            in_range: self
                .gripped_ns
                .is_none_or(|at_ns| now_ns.saturating_sub(at_ns) < AWAY_NS),
        })
    }

    /// Takes in the state of the grip, if it is reported.
    fn grasp(&mut self, update: &Update, now_ns: u64) {
        let grip = update.grip(self.grip.as_deref());
        if let Some((id, grip)) = grip.and_then(|grip| Some((&grip.device_id, grip.state?))) {
            // Lists may come in another order: one hand does not change its grip.
            if self.grip.is_none() {
                self.grip = Some(id.clone());
            }
            self.gripped_ns = Some(now_ns);
            let turned = grip.orientation.and_then(|turned| turned.unit());
            self.orientation = turned.unwrap_or(self.orientation);
            self.switches = grip.switches().unwrap_or(self.switches);
        } else if self
            .gripped_ns
            .is_none_or(|at_ns| now_ns.saturating_sub(at_ns) >= LET_GO_NS)
        {
            self.switches = 0;
        }
    }
}

fn is_within(vector: DVec3, most: f64) -> bool {
    vector
        .to_array()
        .iter()
        .all(|part| (-most..=most).contains(part))
}
