//! A fast hand: as it nears the speed at which force latches off, it gets less force, and none from nine tenths of that
//! speed on. So a quick stroke is no fault, and a hand that the device drives is released.
//!
//! In contact the share only falls: a wall that grew hard again under the hand would return more energy on the way out
//! than it absorbed on the way in. In the air recovery costs nothing.

use super::oscillation::Touch;

/// Speeds from which force falls and from which it is zero, as shares of the fault's speed.
const FALLS: [f64; 2] = [0.6, 0.9];

/// Share of the force for a fast hand.
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
    /// Updates the share for a speed, as a share of the fault's.
    pub fn follow(&mut self, speed: f64, in_contact: Touch) {
        let [from, to] = FALLS;
        let share = ((to - speed) / (to - from)).clamp(0.0, 1.0);
        self.softness = match in_contact {
            Touch::Contact if self.softness < share => self.softness,
            _ => share,
        };
    }

    /// Share of the requested force, 0 to 1.
    #[must_use]
    pub fn softness(&self) -> f64 {
        self.softness
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use crate::servo::Servo;
    use crate::servo::limits::Limits;
    use crate::servo::tests::guards::pressed;
    use crate::servo::tests::{DT, handle};

    /// The force at each speed, N, of a hand at constant depth.
    fn at_speeds(servo: &mut Servo, speeds: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut forces = Vec::new();
        for speed in speeds {
            let mut moving = handle(0.0025);
            moving.velocity.x = speed;
            let (force, tick) = servo.step(&moving, DT);
            assert_eq!(tick.fault, None, "{speed} m/s");
            forces.push(force.z);
        }
        forces
    }

    #[test]
    fn a_hand_that_grows_fast_feels_less_and_latches_nothing() {
        for scale in [0.5, 1.0, 2.0] {
            let limits = Limits {
                max_speed_m_s: 1.5 * scale,
                ..Limits::default()
            };
            let mut servo = pressed(limits);
            // Up to 2 m/s, at 20 m/s².
            let up = |tick: u32| 0.02 * scale * f64::from(tick);
            let forces = at_speeds(&mut servo, (0..100).map(up));
            assert!(forces[..45].iter().all(|force| (force - 1.0).abs() < 1e-9));
            assert!(forces.is_sorted_by(|before, after| before >= after));
            assert!((forces[56] - 0.5).abs() < 0.05, "{}", forces[56]);
            assert!(forces[68..].iter().all(|force| *force == 0.0));
            // The share does not recover while the hand is in the wall, and does in the air.
            let slower = at_speeds(&mut servo, (0..100).rev().map(up));
            assert!(slower.iter().all(|force| *force == 0.0));
            servo.step(&handle(-0.001), DT);
            let again = at_speeds(&mut servo, std::iter::repeat_n(0.0, 1000));
            assert!((again[999] - 1.0).abs() < 1e-9, "{}", again[999]);
        }
    }

    /// Work done on a hand that goes 7 mm into a wall and out again, less the losses to the device's own friction, J.
    fn in_and_out(in_m_s: f64, out_m_s: f64) -> f64 {
        let mut servo = pressed(Limits::default());
        for _ in 0..20 {
            servo.step(&handle(-0.001), DT);
        }
        let (mut place, mut speed, mut work) = (-0.001, in_m_s, 0.0);
        let mut force = DVec3::ZERO;
        while place >= -0.001 {
            let way = speed * DT;
            place += way;
            work -= force.z * way + Limits::default().damping_n_s_m * speed * way;
            if place > 0.007 {
                speed = -out_m_s;
            }
            let mut moving = handle(place);
            moving.velocity.z = -speed;
            force = servo.step(&moving, DT).0;
        }
        work
    }

    #[test]
    fn a_wall_gives_a_hand_that_came_fast_and_goes_slowly_nothing() {
        for in_m_s in [0.02, 0.2, 0.8, 1.0, 1.2, 1.4] {
            for out_m_s in [0.05, 0.2, 1.0] {
                let given = in_and_out(in_m_s, out_m_s);
                assert!(given <= 1e-9, "{in_m_s} in, {out_m_s} out: {given} J");
            }
        }
    }
}
