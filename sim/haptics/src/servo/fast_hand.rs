//! A fast hand: as it nears the speed at which force latches off, it is given less force, and none before that speed. So
//! a quick stroke is no fault, and a hand that the device drives is let go.
//!
//! In contact the share only falls. A wall that grew hard again while the hand is in it would give more on the way out
//! than it took on the way in; in the air it costs nothing.

use super::oscillation::Touch;

/// Speeds from which force falls and from which there is none, by the speed of the fault.
const FALLS: [f64; 2] = [0.6, 0.9];

/// Share of the force that a fast hand is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FastHand {
    softness: f64,
}

impl Default for FastHand {
    fn default() -> Self {
        Self { softness: 1.0 }
    }
}

impl FastHand {
    /// The hand has a speed, by that of the fault.
    pub fn follow(&mut self, speed: f64, in_contact: Touch) {
        let [from, to] = FALLS;
        let share = ((to - speed) / (to - from)).clamp(0.0, 1.0);
        self.softness = match in_contact {
            Touch::Contact if self.softness < share => self.softness,
            _ => share,
        };
    }

    /// Force by that asked for, 0 to 1.
    #[must_use]
    pub fn softness(&self) -> f64 {
        self.softness
    }
}
