//! Torque of the brush about its ferrule, for devices that drive torque: the force acts at the undeformed point, where a
//! contact's depth is counted, so force and torque have one potential.
//!
//! It follows the force with all its limits, and changes no faster than that by its longest lever: a device that drives
//! torque has a lever to the ferrule of its own beside it.

use glam::DVec3;

use super::limits::Limits;

/// The torque now.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Torque {
    /// N·m.
    now: DVec3,
}

impl Torque {
    /// Torque of `force`, N, by the lever from the ferrule to where it acts, m, `dt` s after the tick before; N·m.
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
