//! Hands on a guide in the air, without the servo's other guards: stability, and distance from the path while moving
//! along it.
//!
//! The bound is that of a wall (`walls`): a guide of stiffness K with a delay `delay` at a period T needs damping b >
//! K·(T/2 + delay).

use glam::DVec3;
use maulstick_num::sin;
use maulstick_types::haptics::GuideModel;

use super::{DT, Extent, HANDS, STILL_M};
use crate::guide::{Guide, GuideBounds};
use crate::plant::{Hand, Plant};
use crate::servo::Servo;
use crate::servo::limits::Limits;
use crate::servo::tick::Sender;

/// Ticks between two guides.
const GUIDE_TICKS: usize = 10;

fn guide(points_m: Vec<[f64; 3]>, stiffness_n_m: f64) -> Guide {
    Guide::new(&GuideModel {
        device: 0,
        device_epoch: 0,
        points_m,
        normal: [0.0, 0.0, 1.0],
        head_length_m: 0.0,
        stiffness_n_m,
        damping_n_s_m: 0.0,
        max_force_n: 3.3,
        time_to_live_ns: 100_000_000,
    })
    .expect("a guide")
}

/// Limits of the bare guide.
fn unguarded() -> Limits {
    let limits = super::unguarded();
    Limits {
        guide: GuideBounds {
            stiffness_n_m: 1e9,
            force_n: 3.3,
            reach_m: 1.0,
            ..limits.guide
        },
        ..limits
    }
}

/// A hand that is kicked across a straight guide.
#[derive(Clone, Copy, Debug)]
struct Hold {
    hand: Hand,
    stiffness: f64,
    /// Ticks from the reading to the force.
    delay: usize,
}

impl Hold {
    /// From .7 s to 2 s the hand's target jumps by 4 mm every 100 ms. Movement of the tip, peak to peak, in the last
    /// half second of five, m.
    fn wobble(&self, limits: Limits) -> f64 {
        let mut servo = Servo::new(limits);
        let mut plant = Plant::omni(self.hand, DVec3::ZERO);
        let mut under_way = vec![DVec3::ZERO; self.delay + 1];
        let line = guide(vec![[0.0, -0.1, 0.0], [0.0, 0.1, 0.0]], self.stiffness);
        let mut extent = Extent::NONE;
        for tick in 0..5000 {
            if tick % GUIDE_TICKS == 0 {
                servo.receive_guide(line, Sender::Same);
            }
            under_way.rotate_left(1);
            under_way[self.delay] = servo.step(&plant.handle(), DT).0;
            let aside = match tick {
                0..700 => 0.0,
                700..2000 if (tick / 100) % 2 == 1 => 0.007,
                _ => 0.003,
            };
            plant.advance(under_way[0], DVec3::X * aside, DT);
            if tick >= 4500 {
                extent.include(plant.true_position());
            }
        }
        extent.peak_to_peak_m()
    }
}

#[test]
fn every_hand_is_still_on_every_guide_that_may_be_four_ticks_late() {
    for hand in HANDS {
        for delay in 0..=4 {
            for stiffness in [20.0, 50.0, 100.0] {
                let hold = Hold {
                    hand,
                    stiffness,
                    delay,
                };
                let wobble = hold.wobble(unguarded());
                assert!(wobble < STILL_M, "{hold:?}: {wobble} m");
            }
        }
    }
}

#[test]
fn within_the_bound_of_its_damping_a_guide_is_still_at_any_delay() {
    let hand = Hand::FINGERTIP;
    let plant = Plant::omni(hand, DVec3::ZERO);
    for delay in [0, 1, 2, 4, 8, 15] {
        let bound = (plant.damping + hand.damping) / (DT * (0.5 + delay as f64));
        for share in [0.25, 0.5, 0.75, 0.95] {
            let hold = Hold {
                hand,
                stiffness: share * bound,
                delay,
            };
            let wobble = hold.wobble(unguarded());
            assert!(wobble < STILL_M, "{hold:?}: {wobble} m");
        }
    }
}

/// The seeded faults: if these were still, the tests above could not fail.
#[test]
fn a_guide_that_is_too_stiff_or_late_shakes_a_fingertip_and_the_servo_makes_it_soft() {
    for (stiffness, delay) in [(2000.0, 0), (2000.0, 1), (400.0, 4), (100.0, 16)] {
        let hold = Hold {
            hand: Hand::FINGERTIP,
            stiffness,
            delay,
        };
        let wobble = hold.wobble(unguarded());
        println!("{hold:?}: {:.1} mm", wobble * 1e3);
        assert!(wobble > 1e-3, "{hold:?}: {wobble} m");
        if delay <= 4 {
            let mut bounded = unguarded();
            bounded.guide.stiffness_n_m = Limits::default().guide.stiffness_n_m;
            let wobble = hold.wobble(bounded);
            assert!(wobble < STILL_M, "{hold:?}: {wobble} m");
        }
    }
}

/// Point of a wavy path, m.
fn wave(x: f64) -> DVec3 {
    DVec3::new(x, 0.01 * sin(60.0 * x), 0.0)
}

/// Piece of the path about a place.
fn piece(x: f64, stiffness: f64) -> Guide {
    let points = (-5..11).map(|i| wave(x + 2e-3 * f64::from(i)).to_array());
    guide(points.collect(), stiffness)
}

/// Mean distance from the path, m, of a hand that aims 4 mm beside it and moves along at .1 m/s; movement of its tip,
/// peak to peak, in half a second after it has stopped, m; and the largest force, N.
fn stroke(hand: Hand, stiffness: f64) -> [f64; 3] {
    let limits = Limits {
        max_stiffness_n_m: 500.0,
        damping_n_s_m: 0.3,
        ..Limits::default()
    };
    let mut servo = Servo::new(limits);
    let mut plant = Plant::omni(hand, wave(0.0));
    let (mut sum, mut count, mut most) = (0.0, 0, 0.0f64);
    let mut extent = Extent::NONE;
    for tick in 0..4000_usize {
        if tick % GUIDE_TICKS == 0 {
            servo.receive_guide(piece(plant.read_position().x, stiffness), Sender::Same);
        }
        let (force, told) = servo.step(&plant.handle(), DT);
        assert_eq!(told.fault, None, "{hand:?}");
        most = most.max(force.length());
        let x = 1e-4 * tick.saturating_sub(500).min(2000) as f64;
        let aside = if tick < 500 { 0.0 } else { 0.004 };
        plant.advance(force, wave(x) + DVec3::Y * aside, DT);
        let place = plant.true_position();
        if (1000..2500).contains(&tick) {
            let near = |i: i32| (wave(place.x + 1e-4 * f64::from(i)) - place).length();
            sum += (-100..100).map(near).fold(f64::MAX, f64::min);
            count += 1;
        }
        if tick >= 3500 {
            extent.include(place);
        }
    }
    [sum / f64::from(count), extent.peak_to_peak_m(), most]
}

#[test]
fn a_guided_hand_stays_nearer_to_the_path_and_comes_to_rest() {
    for hand in HANDS {
        let (free, guided) = (stroke(hand, 0.0), stroke(hand, 100.0));
        println!(
            "{hand:?}: {:.2} mm from the path, guided {:.2} mm",
            free[0] * 1e3,
            guided[0] * 1e3
        );
        assert_eq!(free[2], 0.0);
        assert!(guided[0] < 0.85 * free[0], "{hand:?}: {guided:?} {free:?}");
        assert!(guided[1] < STILL_M && guided[2] <= 0.6 + 1e-9, "{guided:?}");
        // Nothing pulls along the path: the hand stops where a free one does, apart from the effect of bends.
    }
}
