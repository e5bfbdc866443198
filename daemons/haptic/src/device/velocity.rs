//! Velocity estimation for devices that report positions alone.

use glam::DVec3;

/// Corner of the filter, rad/s (60 Hz): between what the encoders' steps hide, a step of .05 mm each
/// millisecond being 50 mm/s, and the lag that makes damping of the servo destabilise.
const CORNER: f64 = 377.0;

/// Differences of positions through a first-order low-pass filter at 60 Hz, which lags by 2.7 ms; the
/// estimate that [`maulstick_haptics::Plant`] makes from its own encoders.
#[derive(Clone, Copy, Debug, Default)]
pub struct Velocity {
    before: Option<DVec3>,
    smooth: DVec3,
}

impl Velocity {
    /// Takes in a position, m, `dt` s after the previous one; returns the velocity, m/s. The first
    /// position, and one without a time step, leave the velocity unchanged.
    pub fn after(&mut self, position: DVec3, dt: f64) -> DVec3 {
        if let Some(before) = self.before
            && dt > 0.0
        {
            let raw = (position - before) / dt;
            self.smooth += (raw - self.smooth) * (CORNER * dt).min(1.0);
        }
        self.before = Some(position);
        self.smooth
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_steady_motion_is_read_as_it_is_and_a_sudden_one_within_milliseconds() {
        let mut velocity = Velocity::default();
        let mut reached = Vec::new();
        for tick in 0..50 {
            reached.push(velocity.after(DVec3::X * 1e-4 * f64::from(tick), 1e-3).x);
        }
        assert_eq!(reached[0], 0.0);
        assert!((reached[3] - 0.1).abs() > 0.01 && (reached[49] - 0.1).abs() < 1e-4);
    }

    #[test]
    fn no_time_and_a_standstill_of_a_second_leave_it_finite() {
        let mut velocity = Velocity::default();
        velocity.after(DVec3::ZERO, 1e-3);
        assert_eq!(velocity.after(DVec3::X, 0.0), DVec3::ZERO);
        assert!((velocity.after(DVec3::X * 2.0, 1.0) - DVec3::X).length() < 1e-12);
    }
}
