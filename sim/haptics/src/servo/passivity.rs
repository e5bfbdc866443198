//! Passivity observer and controller (Hannaford and Ryu 2002): a sampled wall returns more energy than was put into it;
//! the observer sums the excess, the controller removes it by damping.
//!
//! The energy of a step is the force that was **held** over it times its motion:
//!
//! ```text
//! E += f(k−1)·(x(k) − x(k−1))
//! ```
//!
//! With the force newly computed at x(k) the leak has the other sign, and the observer never fires. Subtracted are the
//! work of the same models without sampling (the mean of their forces at both ends of the motion), and the loss to the
//! device's own damping. So a hand that rides on a moving plane, a plane that rises below a hand at rest and a
//! stiffness that changes count as zero; and where the device damps more than sampling adds, b > K·T/2, the controller
//! never acts.

use glam::DVec3;

/// Greatest damping of the controller, N·s/m: more, on a velocity in encoder steps, would shake by itself.
const MOST_DAMPING: f64 = 0.8;

/// The energy of the steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Passivity {
    /// Energy given to the hand in excess and not yet removed, J; never negative, so that an earlier surplus of damping
    /// cannot mask later gains.
    given_j: f64,
    way: DVec3,
}

impl Passivity {
    /// Ends a step: `held` was on the motors over the motion `way`, m, in `dt` s; `models` is the mean request of the
    /// models at its ends, N; `damping` is that of the device, N·s/m.
    pub fn observe(&mut self, held: DVec3, models: DVec3, way: DVec3, damping: f64, dt: f64) {
        let taken = if dt > 0.0 {
            damping * way.length_squared() / dt
        } else {
            0.0
        };
        self.given_j = (self.given_j + (held - models).dot(way) - taken).max(0.0);
        self.way = way;
    }

    /// Force that removes the excess, N, at the velocity of the step that ended.
    #[must_use]
    pub fn brake(&self, dt: f64) -> DVec3 {
        let square = self.way.length_squared();
        if self.given_j <= 0.0 || square <= 0.0 || dt <= 0.0 {
            return DVec3::ZERO;
        }
        let damping = (self.given_j * dt / square).min(MOST_DAMPING);
        self.way * (-damping / dt)
    }

    /// Excess energy not yet removed, J.
    #[must_use]
    pub fn given_j(&self) -> f64 {
        self.given_j
    }

    /// Resets the excess, in free motion.
    pub fn forgive(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 1e-3;
    const WALL: f64 = 500.0;

    /// A hand that goes in and out of a wall at 1 kHz: the excess at the end; `late` pairs the motion with the force at
    /// its end.
    fn owed(damping: f64, late: bool) -> f64 {
        let mut passivity = Passivity::default();
        let force = |x: f64| DVec3::X * (-WALL * x).max(0.0);
        let place = |i: i32| 1e-3 * maulstick_num::sin(0.1 * f64::from(i));
        for i in 0..1000 {
            let (from, to) = (place(i), place(i + 1));
            let held = force(if late { to } else { from });
            let models = (force(from) + force(to)) * 0.5;
            passivity.observe(held, models, DVec3::X * (to - from), damping, DT);
        }
        passivity.given_j()
    }

    #[test]
    fn the_leak_of_a_sampled_wall_is_seen_where_the_device_does_not_take_it() {
        let way: f64 = (0..1000)
            .map(|i| 1e-3 * 0.1 * maulstick_num::cos(0.1 * f64::from(i)))
            .map(|way| way * way)
            .sum();
        // ½·K·Σ(Δx)² over the half of the time spent in the wall.
        let leak = 0.25 * WALL * way;
        assert!(
            (owed(0.0, false) / leak - 1.0).abs() < 0.05,
            "{} J",
            owed(0.0, false)
        );
        // b = K·T/2 is .25 N·s/m.
        assert_eq!(owed(0.26, false), 0.0);
        assert!(owed(0.2, false) > 0.0);
    }

    /// The seeded fault.
    #[test]
    fn paired_with_the_newly_computed_force_it_never_fires() {
        assert!(owed(0.0, true) < 1e-3 * owed(0.0, false));
    }

    #[test]
    fn the_brake_takes_what_is_owed_and_no_more_than_it_may() {
        let mut passivity = Passivity::default();
        let way = DVec3::X * 1e-4;
        passivity.observe(DVec3::X * 0.05, DVec3::ZERO, way, 0.0, DT);
        assert!((passivity.given_j() - 5e-6).abs() < 1e-18);
        let brake = passivity.brake(DT);
        assert!(
            (brake.x + 0.05).abs() < 1e-12,
            "at the same speed it takes it in a step"
        );
        passivity.observe(brake, DVec3::ZERO, way, 0.0, DT);
        assert!(passivity.given_j() < 1e-18);
        passivity.observe(DVec3::X, DVec3::ZERO, way, 0.0, DT);
        assert!(
            (passivity.brake(DT).x + 0.08).abs() < 1e-12,
            ".8 N·s/m by .1 m/s"
        );
        passivity.forgive();
        assert_eq!(passivity.brake(DT), DVec3::ZERO);
    }

    #[test]
    fn a_plane_that_carries_the_hand_gives_nothing() {
        let mut passivity = Passivity::default();
        for _ in 0..1000 {
            let force = DVec3::X * 0.5;
            passivity.observe(force, force, DVec3::X * 1e-5, 0.0, DT);
        }
        assert_eq!(passivity.given_j(), 0.0);
    }
}
