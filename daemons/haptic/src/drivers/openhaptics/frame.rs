//! Values of a frame, converted to our frames and units.
//!
//! HD's base frame is right-handed: x right, y up, z toward the user; it is our device frame as it is,
//! and for a device before an upright canvas the desk frame too. The stylus's own z axis points from
//! its tip to the far end of the hand, and a brush has its bristles along −z: so the stylus's axes are
//! the brush frame as they are, and its x axis, which turns with the fingers, is the brush's.
//! The sensed point is the intersection of the gimbal's axes.

use glam::{DMat3, DQuat, DVec3};
use maulstick_haptics::contact::HandleState;
use maulstick_num::geometry::canonical;

use super::model::DeadMan;
use crate::device::driver::{Reading, Wrench};

/// Millimetres to metres, and mN·m to N·m.
pub const MILLI: f64 = 1e-3;
/// No arm reaches farther, m.
pub const FARTHEST_M: f64 = 2.0;
/// No hand is faster, m/s.
pub const FASTEST_M_S: f64 = 50.0;
/// Axes of the stylus are of length 1 and across each other within this.
const SKEW: f64 = 0.1;
/// Bits of the stylus's buttons.
const BUTTONS: i32 = 0b1111;

/// A frame's values as the library gives them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Stylus to base, column by column, mm.
    pub transform: [f64; 16],
    /// mm/s.
    pub velocity: [f64; 3],
    /// A bit a button.
    pub buttons: i32,
    /// Not 0 while the stylus is in its inkwell.
    pub inkwell: u8,
    /// The safety switch: not 0 is on.
    pub safety: u8,
    /// Temperatures of the motors, 0 cold to 1 hot; those are 0 that it has not.
    pub temperatures: [f64; 6],
}

impl Frame {
    /// The reading; None where the numbers are no place, no rotation or no speed of any arm.
    #[must_use]
    pub fn reading(&self, dead_man: DeadMan) -> Option<Reading> {
        let column = |place: usize| DVec3::from_slice(&self.transform[4 * place..4 * place + 3]);
        let position = column(3) * MILLI;
        let velocity = DVec3::from_array(self.velocity) * MILLI;
        let within = |vector: DVec3, bound: f64| vector.is_finite() && vector.length() <= bound;
        if !within(position, FARTHEST_M) || !within(velocity, FASTEST_M_S) {
            return None;
        }
        let handle = HandleState {
            position,
            orientation: rotation([column(0), column(1), column(2)])?,
            velocity,
        };
        Some(Reading {
            handle,
            switches: (self.buttons & BUTTONS) as u32,
            in_range: self.inkwell == 0,
            is_permitted: dead_man == DeadMan::Absent || self.safety != 0,
            motor_temperature: hottest(&self.temperatures),
        })
    }
}

/// The rotation whose axes are nearest to three that are nearly across each other; the stylus's own
/// axis, z, stays as it is.
fn rotation(axes: [DVec3; 3]) -> Option<DQuat> {
    let [x, y, z] = axes;
    let unit = |axis: DVec3| (axis.length() - 1.0).abs() <= SKEW;
    let across = |a: DVec3, b: DVec3| a.dot(b).abs() <= SKEW;
    let is_frame = axes.iter().all(|axis| axis.is_finite() && unit(*axis))
        && across(x, y)
        && across(y, z)
        && across(z, x)
        && x.cross(y).dot(z) > 0.0;
    if !is_frame {
        return None;
    }
    let z = z.normalize();
    let x = (x - z * x.dot(z)).normalize();
    let turn = DMat3::from_cols(x, z.cross(x), z);
    Some(canonical(DQuat::from_mat3(&turn)))
}

/// The hottest motor, 0 to 1; a temperature that is no number counts as hot.
fn hottest(temperatures: &[f64; 6]) -> f64 {
    let hot = |temperature: &f64| {
        if temperature.is_nan() {
            1.0
        } else {
            temperature.clamp(0.0, 1.0)
        }
    };
    temperatures.iter().map(hot).fold(0.0, f64::max)
}

/// A wrench that the device can give: nothing where it is no number, else its direction within the
/// device's largest force, N, and torque, N·m.
#[must_use]
pub fn bounded(wrench: Wrench, max_force_n: f64, max_torque_nm: f64) -> Wrench {
    if !wrench.force.is_finite() || !wrench.torque.is_finite() {
        return Wrench::ZERO;
    }
    Wrench {
        force: wrench.force.clamp_length_max(max_force_n),
        torque: wrench.torque.clamp_length_max(max_torque_nm),
    }
}

#[cfg(test)]
mod tests {
    use maulstick_num::geometry;
    use proptest::prelude::*;

    use super::*;

    /// A stylus with these axes at a place, mm.
    fn stylus(axes: [DVec3; 3], place: DVec3) -> Frame {
        let [x, y, z] = axes.map(|axis| axis.extend(0.0).to_array());
        let columns = [x, y, z, place.extend(1.0).to_array()].concat();
        Frame {
            transform: columns.try_into().expect("sixteen"),
            velocity: [0.0; 3],
            buttons: 0,
            inkwell: 0,
            safety: 1,
            temperatures: [0.0; 6],
        }
    }

    fn turned(turn: DQuat) -> [DVec3; 3] {
        [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| turn * axis)
    }

    #[test]
    fn columns_are_the_stylus_s_axes_and_the_last_its_place() {
        let turn = geometry::rotation(DVec3::new(0.48, 0.6, 0.64), 1.1);
        let reading = stylus(turned(turn), DVec3::new(10.0, -20.0, 30.0)).reading(DeadMan::Absent);
        let handle = reading.expect("a place").handle;
        assert!((handle.position - DVec3::new(0.01, -0.02, 0.03)).length() < 1e-15);
        assert!(handle.orientation.angle_between(turn) < 1e-7);
        // Rows taken for columns would turn it the other way.
        assert!(handle.orientation.angle_between(turn.conjugate()) > 1.0);
        let bristles = handle.orientation * DVec3::NEG_Z;
        assert!(
            (bristles + turn * DVec3::Z).length() < 1e-12,
            "from the hand to the tip"
        );
    }

    #[test]
    fn axes_that_are_a_little_skew_become_a_rotation_and_others_none() {
        let turn = geometry::rotation(DVec3::Y, 0.7);
        let [x, y, z] = turned(turn);
        let skew = stylus(
            [x * 1.01 + y * 0.02, y * 0.99 + z * 0.02, z * 1.02],
            DVec3::ZERO,
        );
        let got = skew
            .reading(DeadMan::Absent)
            .expect("nearly")
            .handle
            .orientation;
        assert!((got.length() - 1.0).abs() < 1e-12 && got.angle_between(turn) < 0.03);
        for axes in [
            [x, y, -z],
            [x, x, z],
            [x * 2.0, y, z],
            [DVec3::ZERO; 3],
            [x, y, DVec3::NAN],
        ] {
            assert_eq!(stylus(axes, DVec3::ZERO).reading(DeadMan::Absent), None);
        }
    }

    #[test]
    fn only_a_dead_man_s_switch_that_senses_forbids_force() {
        let mut frame = stylus(turned(DQuat::IDENTITY), DVec3::ZERO);
        let permitted = |frame: &Frame, dead_man| frame.reading(dead_man).map(|r| r.is_permitted);
        assert_eq!(permitted(&frame, DeadMan::Senses), Some(true));
        frame.safety = 0;
        assert_eq!(permitted(&frame, DeadMan::Senses), Some(false));
        assert_eq!(permitted(&frame, DeadMan::Absent), Some(true));
    }

    #[test]
    fn the_hottest_motor_counts_and_no_number_is_hot() {
        assert_eq!(hottest(&[0.1, 0.2, 0.9, 0.3, 0.0, 0.4]), 0.9);
        assert_eq!(hottest(&[0.1, f64::NAN, 0.0, 0.0, 0.0, 0.0]), 1.0);
        assert_eq!(hottest(&[7.0, -3.0, 0.0, 0.0, 0.0, 0.0]), 1.0);
        assert_eq!(hottest(&[-3.0; 6]), 0.0);
    }

    #[test]
    fn a_wrench_is_cut_in_its_direction_and_no_number_is_nothing() {
        let asked = Wrench {
            force: DVec3::new(3.0, 0.0, -4.0),
            torque: DVec3::new(0.0, 0.3, 0.0),
        };
        let cut = bounded(asked, 2.5, 0.1);
        assert!((cut.force - DVec3::new(1.5, 0.0, -2.0)).length() < 1e-12);
        assert!((cut.torque - DVec3::new(0.0, 0.1, 0.0)).length() < 1e-12);
        assert_eq!(bounded(asked, 9.0, 1.0), asked);
        let wild = Wrench {
            torque: DVec3::new(0.0, f64::NAN, 0.0),
            ..asked
        };
        assert_eq!(bounded(wild, 9.0, 1.0), Wrench::ZERO);
    }

    /// Any double, the odd ones too.
    fn double() -> impl Strategy<Value = f64> {
        any::<u64>().prop_map(f64::from_bits)
    }

    proptest! {
        #[test]
        fn no_bytes_make_a_phantom_s_frame_panic_or_read_out_of_range(
            wild in proptest::collection::vec((0..26usize, double()), 0..6),
            angle in -7.0..7.0f64,
            flags in any::<(i32, u8, u8)>(),
        ) {
            let turn = geometry::rotation(DVec3::new(0.6, 0.0, 0.8), angle);
            let mut frame = stylus(turned(turn), DVec3::new(50.0, 20.0, -30.0));
            (frame.buttons, frame.inkwell, frame.safety) = flags;
            for (place, value) in wild {
                match place {
                    0..16 => frame.transform[place] = value,
                    16..19 => frame.velocity[place - 16] = value,
                    19..25 => frame.temperatures[place - 19] = value,
                    _ => {}
                }
            }
            if let Some(reading) = frame.reading(DeadMan::Senses) {
                let handle = reading.handle;
                prop_assert!(handle.position.length() <= FARTHEST_M);
                prop_assert!(handle.velocity.length() <= FASTEST_M_S);
                prop_assert!((handle.orientation.length() - 1.0).abs() < 1e-9);
                prop_assert!((0.0..=1.0).contains(&reading.motor_temperature));
                prop_assert!(reading.switches < 16);
            }
        }
    }
}
