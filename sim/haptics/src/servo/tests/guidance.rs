//! The servo with a guide: begin, change and end of its force.

use glam::DVec3;
use maulstick_types::haptics::GuideModel;

use super::DT;
use crate::contact::HandleState;
use crate::guide::Guide;
use crate::guide::tests::{at, model};
use crate::servo::Servo;
use crate::servo::engagement::CALM_TICKS;
use crate::servo::fault::Fault;
use crate::servo::limits::Limits;
use crate::servo::tick::{Sender, Switch};

/// A straight guide along x through y.
fn line(y: f64) -> Guide {
    piece(y, -0.05)
}

/// A piece of it of 10 cm, from x on.
fn piece(y: f64, x: f64) -> Guide {
    Guide::new(&model(&[
        [x, y, 0.0],
        [x + 0.04, y, 0.0],
        [x + 0.1, y, 0.0],
    ]))
    .expect("a guide")
}

fn hand(x: f64, y: f64) -> HandleState {
    at(DVec3::new(x, y, 0.01), DVec3::ZERO)
}

/// A servo that holds a hand, 5 mm from its guide, with .4 N.
fn held(limits: Limits) -> Servo {
    let mut servo = Servo::new(limits);
    for _ in 0..CALM_TICKS {
        servo.receive_guide(line(0.0), Sender::Same);
        assert_eq!(servo.step(&hand(0.0, 0.0), DT).0, DVec3::ZERO);
    }
    let mut force = DVec3::ZERO;
    for _ in 0..1000 {
        servo.receive_guide(line(0.0), Sender::Same);
        force = servo.step(&hand(0.0, 0.005), DT).0;
    }
    assert!((force - DVec3::Y * -0.4).length() < 1e-9, "{force}");
    servo
}

#[test]
fn a_guide_is_felt_without_a_contact_model_from_nothing_on() {
    let mut servo = Servo::new(Limits::default());
    let mut last = 0.0;
    for _ in 0..CALM_TICKS {
        servo.receive_guide(line(0.0), Sender::Same);
        servo.step(&hand(0.0, 0.0), DT);
    }
    for _ in 0..700 {
        servo.receive_guide(line(0.0), Sender::Same);
        let (force, tick) = servo.step(&hand(0.0, 0.005), DT);
        assert!(tick.guided && !tick.contact && force.y <= last + 1e-12);
        assert!(last - force.y < 0.4 * DT / 0.5 + 1e-9, "a ramp");
        last = force.y;
    }
    assert!((last + 0.4).abs() < 1e-9, "{last}");
}

#[test]
fn a_hand_aside_of_the_path_at_the_start_is_not_pulled_until_it_has_come_to_it() {
    let mut servo = Servo::new(Limits::default());
    let mut run = |y: f64| {
        let mut most = 0.0f64;
        for _ in 0..1000 {
            servo.receive_guide(line(0.0), Sender::Same);
            most = most.max(servo.step(&hand(0.0, y), DT).0.length());
        }
        most
    };
    assert_eq!(run(0.01), 0.0);
    assert!(run(0.001) > 0.07);
    assert!(run(0.01) > 0.59);
}

#[test]
fn without_strength_or_guidance_there_is_none() {
    for (strength, guidance) in [(0.0, 1.0), (1.0, 0.0), (1.0, f64::NAN), (f64::NAN, 1.0)] {
        let mut servo = held(Limits::default());
        servo.set_strength(strength);
        servo.set_guidance(guidance);
        let mut force = DVec3::ZERO;
        for _ in 0..300 {
            servo.receive_guide(line(0.0), Sender::Same);
            force = servo.step(&hand(0.0, 0.005), DT).0;
        }
        assert_eq!(force, DVec3::ZERO, "{strength} {guidance}");
    }
    let mut servo = held(Limits::default());
    servo.set_guidance(0.5);
    let mut last = servo.force;
    for _ in 0..300 {
        servo.receive_guide(line(0.0), Sender::Same);
        let force = servo.step(&hand(0.0, 0.005), DT).0;
        assert!((force - last).length() <= 0.6 * DT / 0.2 + 1e-9, "no knock");
        last = force;
    }
    assert!((last.y + 0.2).abs() < 1e-9);
}

/// The largest change of force in a tick, N, and the force at the end, of a hand that moves along while pieces arrive.
fn along(mut next: impl FnMut(u32) -> Option<Guide>, y: impl Fn(u32) -> f64) -> (f64, DVec3) {
    let mut servo = held(Limits::default());
    let (mut last, mut most) = (servo.force, 0.0f64);
    for tick in 0..2000 {
        if let Some(guide) = next(tick) {
            servo.receive_guide(guide, Sender::Same);
        }
        let x = 1e-4 * f64::from(tick);
        let force = servo.step(&hand(x, y(tick)), DT).0;
        most = most.max((force - last).length());
        last = force;
    }
    (most, last)
}

#[test]
fn pieces_of_one_path_join_without_a_change_of_force() {
    let next = |tick: u32| {
        let x = 1e-4 * f64::from(tick) - 0.03;
        tick.is_multiple_of(10).then(|| piece(0.0, x))
    };
    let (most, last) = along(next, |_| 0.005);
    assert!(most < 1e-9, "{most} N");
    assert!((last.y + 0.4).abs() < 1e-9);
}

#[test]
fn another_path_takes_over_without_a_knock() {
    let next = |tick: u32| {
        tick.is_multiple_of(10)
            .then(|| line(if tick < 500 { 0.0 } else { 0.012 }))
    };
    let (most, last) = along(next, |_| 0.005);
    // .4 N one way becomes .56 N the other way.
    assert!((last.y - 0.56).abs() < 1e-9, "{last}");
    assert!(most < 0.0031, "{most} N");
}

#[test]
fn a_hand_across_a_bend_changes_sides_without_a_knock() {
    // Inside of a right angle the nearest point jumps from one leg to the other.
    let bend = [[-0.2, 0.0, 0.0], [0.1, 0.0, 0.0], [0.1, 0.3, 0.0]];
    let guide = Guide::new(&model(&bend)).expect("a guide");
    let (most, last) = along(
        |tick| tick.is_multiple_of(10).then_some(guide),
        |tick| 0.005 + 1e-5 * f64::from(tick.min(500)),
    );
    // It has moved beyond the second leg, out of reach.
    assert_eq!(last, DVec3::ZERO);
    // .08 N/mm by .1 mm, and the correction.
    assert!(most < 0.015, "{most} N");
}

#[test]
fn a_guide_that_comes_no_more_fades_within_its_time() {
    let mut servo = held(Limits::default());
    let (mut last, mut ticks) = (servo.force.length(), 0);
    while last > 0.0 {
        ticks += 1;
        let (force, _) = servo.step(&hand(0.0, 0.005), DT);
        assert!(
            force.length() <= last && last - force.length() < 0.01,
            "{ticks}"
        );
        last = force.length();
    }
    // 50 ms of life, 75 of fading.
    assert!((100..=126).contains(&ticks), "{ticks}");
    servo.receive_guide(line(0.0), Sender::Same);
    let (force, tick) = servo.step(&hand(0.0, 0.005), DT);
    assert!(tick.guided && force == DVec3::ZERO, "it begins anew");
}

#[test]
fn force_off_a_dead_mans_switch_and_a_fault_end_it_at_once() {
    let end = |change: fn(&mut Servo)| {
        let mut servo = held(Limits::default());
        change(&mut servo);
        servo.step(&hand(0.0, 0.005), DT).0
    };
    assert_eq!(end(|servo| servo.switch(Switch::Off)), DVec3::ZERO);
    assert_eq!(end(|servo| servo.permit(Switch::Off)), DVec3::ZERO);
    assert_eq!(end(|servo| servo.measure(f64::NAN)), DVec3::ZERO);
    let mut servo = held(Limits::default());
    let fast = at(DVec3::new(0.0, 0.005, 0.01), DVec3::X * 1.6);
    let (force, tick) = servo.step(&fast, DT);
    assert_eq!((force, tick.fault), (DVec3::ZERO, Some(Fault::TooFast)));
    for _ in 0..100 {
        servo.receive_guide(line(0.0), Sender::Another);
        assert_eq!(servo.step(&hand(0.0, 0.005), DT).0, DVec3::ZERO, "latched");
    }
    servo.rearm();
    for _ in 0..1000 {
        servo.receive_guide(line(0.0), Sender::Same);
        let force = servo.step(&hand(0.0, 0.005), DT).0;
        assert_eq!(force, DVec3::ZERO, "until it has come to the path");
    }
}

#[test]
fn a_late_tick_has_none_and_another_sender_begins_anew() {
    let mut servo = held(Limits::default());
    let (force, tick) = servo.step(&hand(0.0, 0.005), 0.02);
    assert!(tick.late && force.length() < 0.01, "{force}");
    let mut servo = held(Limits::default());
    servo.receive_guide(line(0.0), Sender::Another);
    assert!(
        servo.step(&hand(0.0, 0.005), DT).0.length() < 0.4,
        "none is asked for"
    );
    for _ in 0..100 {
        servo.step(&hand(0.0, 0.005), DT);
    }
    assert_eq!(servo.force, DVec3::ZERO);
}

#[test]
fn on_a_scaled_device_the_hand_feels_no_more() {
    for scale in [0.5, 1.0, 4.0] {
        let mut servo = Servo::new(Limits::default().scaled(scale));
        let strong = GuideModel {
            max_force_n: 1e9,
            stiffness_n_m: 1e9,
            ..model(&[[0.0; 3], [0.1, 0.0, 0.0]])
        };
        let strong = Guide::new(&strong).expect("a guide");
        let mut most = 0.0f64;
        for tick in 0..3000 {
            servo.receive_guide(strong, Sender::Same);
            let y = f64::from(tick) * 1e-5;
            most = most.max(servo.step(&hand(0.0, y), DT).0.length() / scale);
        }
        assert!((most - 0.6).abs() < 1e-9, "{scale}: {most} N");
    }
    // Nor more than the motors' continuous force.
    let weak = Limits {
        continuous_force_n: 0.3,
        ..Limits::default()
    };
    assert!((weak.guide_bounds().force_n - 0.3).abs() < 1e-12);
}

#[test]
fn a_hand_that_shakes_on_its_guide_is_let_go() {
    let mut servo = held(Limits::default());
    let mut fault = None;
    for tick in 0..3000 {
        servo.receive_guide(line(0.0), Sender::Same);
        let y = 0.004 * maulstick_num::sin(130.0 * f64::from(tick) * DT);
        fault = fault.or(servo.step(&hand(0.0, y), DT).1.fault);
    }
    assert_eq!(fault, Some(Fault::Oscillation));
    let mut servo = held(Limits::default());
    for tick in 0..3000 {
        servo.receive_guide(line(0.0), Sender::Same);
        let y = 0.004 * maulstick_num::sin(30.0 * f64::from(tick) * DT);
        assert_eq!(
            servo.step(&hand(0.0, y), DT).1.fault,
            None,
            "a stroke that waves"
        );
    }
}

#[test]
fn a_fast_stroke_is_let_go_and_latches_nothing_until_it_crosses_the_path() {
    let mut servo = held(Limits::default());
    let mut go = |y: f64, speed: f64| {
        servo.receive_guide(line(0.0), Sender::Same);
        let hand = at(DVec3::new(0.0, y, 0.01), DVec3::X * speed);
        let (force, tick) = servo.step(&hand, DT);
        assert_eq!(tick.fault, None, "{speed} m/s");
        force.length()
    };
    let up = |tick: u32| 0.02 * f64::from(tick);
    let forces: Vec<f64> = (0..100).map(|tick| go(0.005, up(tick))).collect();
    assert!(forces.is_sorted_by(|before, after| before >= after));
    assert!(forces[68..].iter().all(|force| *force == 0.0));
    let slower = (0..100).rev().map(|tick| go(0.005, up(tick)));
    assert!(
        slower.fold(0.0, f64::max) == 0.0,
        "it would push a hand that slows down"
    );
    go(0.0, 0.0);
    assert!((0..600).map(|_| go(0.005, 0.0)).fold(0.0, f64::max) > 0.39);
}

#[test]
fn amplifiers_stay_on_while_a_guide_holds_the_hand_and_rest_beyond_its_reach() {
    let mut servo = held(Limits::default());
    let mut run = |y: f64| {
        let mut rests = false;
        for _ in 0..70_000 {
            servo.receive_guide(line(0.0), Sender::Same);
            rests = servo.step(&hand(0.0, y), DT).1.resting;
        }
        rests
    };
    assert!(!run(0.005));
    assert!(run(0.1));
    assert!(!run(0.005));
}
