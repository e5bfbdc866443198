//! A device whose frame is smaller or larger than the desk. The servo works on the desk, the hand is at the device, and
//! stability is that of an unscaled device.

use glam::DVec3;
use maulstick_types::haptics::ForceLaw;

use super::{DT, Extent, HANDS, HEAD_M, STILL_M, unguarded};
use crate::contact::tests::model;
use crate::contact::{Contact, HandleState};
use crate::plant::{Hand, Plant};
use crate::servo::Servo;
use crate::servo::limits::Limits;
use crate::servo::tick::Sender;

const SCALES: [f64; 4] = [0.5, 1.0, 2.0, 4.0];

/// Conversion of the desk's force to the device's.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    /// Divided by the scale.
    Scaled,
    AsItIs,
}

/// Outcome of a run.
#[derive(Clone, Copy, Debug)]
struct Outcome {
    /// Movement of the hand in the last half second, peak to peak, m of the device.
    wobble_m: f64,
    /// Largest force on the hand, N.
    most_n: f64,
    /// Largest change of the force within a tick, N.
    jump_n: f64,
}

/// A hand presses 3 mm into a wall that jumps by 3 mm every 100 ms from .6 s to 2 s, lengths of the
/// device, and holds still until the fifth second.
fn press(hand: Hand, stiffness_n_m: f64, scale: f64, limits: Limits, way: Way) -> Outcome {
    let mut servo = Servo::new(limits);
    let mut plant = Plant::omni(hand, DVec3::Z * 0.001);
    let mut force = DVec3::ZERO;
    let mut extent = Extent::NONE;
    let (mut most_n, mut jump_n) = (0.0f64, 0.0f64);
    for tick in 0..5000 {
        if tick % 4 == 0 {
            let up = (600..2000).contains(&tick) && (tick / 100) % 2 == 1;
            let mut wall = model(ForceLaw::Rigid { stiffness_n_m });
            wall.plane_point_m[2] = if up { 0.003 * scale } else { 0.0 };
            wall.recovery_ns = 15_000_000;
            servo.receive(Contact::new(&wall).expect("a model"), Sender::Same);
        }
        let on_desk = plant.read_position() * scale + DVec3::Z * HEAD_M;
        let handle = HandleState {
            velocity: plant.read_velocity() * scale,
            ..HandleState::upright(on_desk)
        };
        let (on_desk, told) = servo.step(&handle, DT);
        assert_eq!(told.fault, None, "{hand:?} {stiffness_n_m} {scale}");
        let on_hand = match way {
            Way::Scaled => on_desk / scale,
            Way::AsItIs => on_desk,
        };
        jump_n = jump_n.max((on_hand - force).length());
        most_n = most_n.max(on_hand.length());
        force = on_hand;
        plant.advance(force, DVec3::Z * -0.003, DT);
        if tick >= 4500 {
            extent.include(plant.true_position());
        }
    }
    Outcome {
        wobble_m: extent.peak_to_peak_m(),
        most_n,
        jump_n,
    }
}

/// A device of .3 N: the wall asks for more.
fn device() -> Limits {
    Limits {
        max_force_n: 0.3,
        continuous_force_n: 0.3,
        max_stiffness_n_m: 500.0,
        damping_n_s_m: 0.3,
        slew_n_s: 50.0,
        ..Limits::default()
    }
}

#[test]
fn a_scaled_device_moves_as_one_that_is_not_and_keeps_its_own_limits() {
    for hand in HANDS {
        for stiffness in [50.0, 200.0, 400.0] {
            let run = |scale| press(hand, stiffness, scale, device().scaled(scale), Way::Scaled);
            let plain = run(1.0);
            for scale in SCALES {
                let scaled = run(scale);
                let told = format!("{hand:?} {stiffness} N/m × {scale}: {scaled:?} {plain:?}");
                assert!(scaled.wobble_m < STILL_M, "{told}");
                assert!((scaled.wobble_m - plain.wobble_m).abs() < 1e-9, "{told}");
                assert!((scaled.most_n - plain.most_n).abs() < 1e-6, "{told}");
                assert!(
                    scaled.most_n <= 0.3 + 1e-9 && scaled.jump_n <= 0.05 + 1e-9,
                    "{told}"
                );
            }
        }
    }
}

#[test]
fn a_wall_beyond_the_bound_shakes_a_fingertip_at_every_scale_alike() {
    let run = |scale| {
        let limits = unguarded().scaled(scale);
        press(Hand::FINGERTIP, 1200.0, scale, limits, Way::Scaled).wobble_m
    };
    for scale in SCALES {
        assert!(run(scale) > 1e-3 && (run(scale) / run(1.0) - 1.0).abs() < 0.05);
    }
}

/// The seeded fault: a force not divided by the scale is a wall as many times as stiff.
#[test]
fn a_force_that_is_handed_on_as_it_is_shakes_a_fingertip_at_four_times() {
    let run = |limits, way| press(Hand::FINGERTIP, 300.0, 4.0, limits, way).wobble_m;
    let scaled = run(unguarded().scaled(4.0), Way::Scaled);
    let as_it_is = run(unguarded(), Way::AsItIs);
    println!("{:.3} mm, {:.2} mm", scaled * 1e3, as_it_is * 1e3);
    assert!(scaled < STILL_M && as_it_is > 1e-3, "{scaled} {as_it_is}");
}

/// The other seeded fault: limits that are not the desk's give a hand another force.
#[test]
fn limits_that_are_not_scaled_are_those_of_another_device() {
    let hand = Hand::PEN_GRIP;
    let plain = press(hand, 400.0, 1.0, device(), Way::Scaled);
    let wrong = press(hand, 400.0, 0.5, device(), Way::Scaled);
    assert!(
        plain.most_n < 0.3 + 1e-9 && wrong.most_n > 0.33,
        "{wrong:?}"
    );
}
