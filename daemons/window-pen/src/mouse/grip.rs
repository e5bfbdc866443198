//! Grip of the mouse on the brush.

use maulstick_types::quantity;
use maulstick_types::values::Quantity;
use serde::{Deserialize, Serialize};

quantity! {
    /// Pressure of a pressed button.
    pub MousePressure: "pressure", 0.05..=1.0, Self::RANGE, "",
    "Pressure while the button is down."
}
quantity! {
    /// Turn of the broad side, degrees counter-clockwise.
    pub MouseTurn: "turn", -180.0..=180.0, Self::RANGE, "°",
    "Angle from across the stroke, or from the horizontal if it does not follow."
}

/// Turn and pressure of the mouse's brush; a mouse senses neither.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Grip {
    /// True if the broad side of the brush stays across the stroke.
    pub follows: bool,
    /// Turn of the broad side, degrees counter-clockwise: from across the stroke if it follows, else from the desk's x
    /// axis.
    pub turn_deg: f64,
    /// Pressure of a pressed button, a [`MousePressure`].
    pub pressure: f64,
}

impl Default for Grip {
    fn default() -> Self {
        Self {
            follows: true,
            turn_deg: 0.0,
            pressure: 0.5,
        }
    }
}

impl Grip {
    /// The grip with defaults for what is out of range.
    #[must_use]
    pub fn sane(self) -> Self {
        let default = Self::default();
        Self {
            turn_deg: if self.turn_deg.is_finite() {
                self.turn_deg
            } else {
                default.turn_deg
            },
            pressure: if MousePressure::check(self.pressure).is_ok() {
                self.pressure
            } else {
                default.pressure
            },
            ..self
        }
    }

    /// Turns the brush by an angle, degrees; the turn stays within -180° to 180°.
    pub fn turn(&mut self, by_deg: f64) {
        let turned = self.turn_deg + by_deg + 180.0;
        self.turn_deg = turned.rem_euclid(360.0) - 180.0;
    }

    /// Presses harder by this, or lighter.
    pub fn press(&mut self, by: f64) {
        let pressed = ((self.pressure + by) * 100.0).round() / 100.0;
        self.pressure = pressed.clamp(*MousePressure::RANGE.start(), *MousePressure::RANGE.end());
    }
}
