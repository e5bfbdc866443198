//! Torque of the brush about its ferrule, for devices that drive torque: the force acts at the undeformed point, which
//! also defines a contact's depth, so force and torque have one potential.
//!
//! It follows the force with all its limits, and changes no faster than the force times its longest lever, because such
//! a device has its own lever to the ferrule.

use glam::DVec3;

use super::limits::Limits;

/// Current torque.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Torque {
    /// Torque, N·m.
    now: DVec3,
}

impl Torque {
    /// Torque of `force`, N, by the lever from the ferrule to its point of action, m, `dt` s after the previous tick;
    /// N·m.
    pub(super) fn follow(&mut self, lever: DVec3, force: DVec3, limits: &Limits, dt: f64) -> DVec3 {
        let wanted = lever.clamp_length_max(limits.lever_m).cross(force);
        let most = limits.slew_n_s * limits.lever_m * dt;
        self.now += (wanted - self.now).clamp_length_max(most.max(0.0));
        // No such number reaches the motors.
        if !self.now.is_finite() {
            self.now = DVec3::ZERO;
        }
        self.now
    }
}
