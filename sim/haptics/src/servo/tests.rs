//! Behaviour of the servo: ramps, recovery, faults, limits.

pub(super) mod guards;
mod guidance;
mod relief;

use maulstick_types::haptics::ForceLaw;
use proptest::prelude::*;

use super::engagement::CALM_TICKS;
use super::tick::Switch;
use super::*;
use crate::contact::tests::{linear, model};

pub(super) use crate::closed_loop_tests::DT;
use crate::closed_loop_tests::HEAD_M;

/// An upright brush whose tip is `depth` m below the plane z = 0.
pub(super) fn handle(depth: f64) -> HandleState {
    HandleState::upright(DVec3::Z * (HEAD_M - depth))
}

fn contact(law: ForceLaw) -> Contact {
    Contact::new(&model(law)).expect("a model")
}

fn rigid(stiffness_n_m: f64, z: f64) -> Contact {
    let mut model = model(ForceLaw::Rigid { stiffness_n_m });
    model.plane_point_m[2] = z;
    Contact::new(&model).expect("a model")
}

/// A servo whose hand is above the plane of a model, so that force may begin.
fn begun(limits: Limits) -> Servo {
    let mut servo = Servo::new(limits);
    for _ in 0..CALM_TICKS {
        servo.receive(contact(linear()), Sender::Same);
        servo.step(&handle(-0.001), DT);
    }
    servo
}

/// A servo at full force at `depth`, kept alive by a model a tick.
fn engaged(depth: f64) -> Servo {
    let mut servo = begun(Limits::default());
    for _ in 0..1000 {
        servo.receive(contact(linear()), Sender::Same);
        servo.step(&handle(depth), DT);
    }
    servo
}

#[test]
fn the_force_comes_up_over_the_ramp_and_reaches_the_model() {
    let mut servo = begun(Limits::default());
    let mut last = 0.0;
    for tick in 1..=600 {
        servo.receive(contact(linear()), Sender::Same);
        let (force, _) = servo.step(&handle(0.0125), DT);
        assert!(force.z >= last - 1e-12 && force.z <= 0.4 * f64::from(tick) * DT / 0.5 + 1e-9);
        last = force.z;
    }
    assert!((last - 0.4).abs() < 1e-9);
}

#[test]
fn a_silent_sender_loses_its_force_within_time_to_live_and_fade() {
    let mut servo = engaged(0.0125);
    let mut ticks = 0;
    loop {
        ticks += 1;
        let (force, tick) = servo.step(&handle(0.0125), DT);
        // The newest model came a tick before the first of these, so the 49th ends its 50 ms.
        assert!(ticks == 49 || tick.stale == (ticks > 49), "{ticks}");
        if force == DVec3::ZERO {
            break;
        }
    }
    assert!(ticks <= 126, "{ticks} ms");
}

/// The linear law above a plane at `z` m that recovers in 15 ms, as the brush node sends it.
fn plane_at(z: f64) -> Contact {
    let mut model = model(linear());
    model.plane_point_m[2] = z;
    model.recovery_ns = 15_000_000;
    Contact::new(&model).expect("a model")
}

#[test]
fn a_jump_of_the_plane_is_spread_over_the_recovery_time_whatever_the_rate_of_models() {
    // The plane rises by 10 mm: 0.4 N become 0.72 N.
    for period in [1, 4, 16, 1000] {
        let mut servo = engaged(0.0125);
        let mut last = servo.force.z;
        for tick in 0..=15 {
            if tick % period == 0 {
                servo.receive(plane_at(0.01), Sender::Same);
            }
            let (force, _) = servo.step(&handle(0.0125), DT);
            let change = force.z - last;
            assert!(
                (-1e-12..=0.32 / 15.0 + 1e-9).contains(&change),
                "a model every {period} ticks, tick {tick}: {change} N at once"
            );
            last = force.z;
        }
        assert!((last - 0.72).abs() < 1e-9, "{period}: {last} N");
    }
}

#[test]
fn a_jump_ends_in_its_time_though_every_model_differs_a_little() {
    let mut servo = engaged(0.0125);
    for tick in 0..=15 {
        if tick % 4 == 0 {
            let shiver = if tick % 8 == 0 { 1e-5 } else { -1e-5 };
            servo.receive(plane_at(0.01 + shiver), Sender::Same);
        }
        servo.step(&handle(0.0125), DT);
    }
    assert!((servo.force.z - 0.72).abs() < 1e-3, "{} N", servo.force.z);
}

#[test]
fn models_that_say_the_same_add_no_lag() {
    let mut often = engaged(0.0125);
    let mut once = often;
    let mut endless = contact(linear());
    endless.time_to_live_s = f64::INFINITY;
    once.receive(endless, Sender::Same);
    for tick in 0..200 {
        often.receive(contact(linear()), Sender::Same);
        let handle = handle(0.0125 + 0.005 * (f64::from(tick) / 40.0).fract());
        assert_eq!(
            often.step(&handle, DT).0,
            once.step(&handle, DT).0,
            "{tick}"
        );
    }
}

#[test]
fn a_sender_that_was_silent_gives_no_force_to_a_hand_that_has_stayed_deep() {
    let mut servo = engaged(0.0125);
    while servo.force != DVec3::ZERO {
        servo.step(&handle(0.0125), DT);
    }
    for tick in 0..1000 {
        servo.receive(plane_at(0.0), Sender::Same);
        let (force, told) = servo.step(&handle(0.0125), DT);
        assert!(force == DVec3::ZERO && told.waiting, "{tick}: {force}");
    }
    let mut last = 0.0;
    for tick in 0..1000 {
        servo.receive(plane_at(0.0), Sender::Same);
        let depth = if tick < 100 { -0.001 } else { 0.0125 };
        last = servo.step(&handle(depth), DT).0.z;
    }
    assert!((last - 0.4).abs() < 1e-9, "once it has come up: {last} N");
}

#[test]
fn what_is_kept_of_a_servo_latches_the_next_and_its_motors_stay_warm() {
    let mut servo = engaged(0.0125);
    let mut fast = handle(0.0125);
    fast.velocity.x = 2.0;
    servo.step(&fast, DT);
    assert_eq!(servo.memory().fault, Some(Fault::TooFast));
    let mut next = Servo::after(Limits::default(), servo.memory().cooled(1.0));
    assert_ne!(
        next.memory().thermal,
        ServoMemory::fresh(Limits::default()).thermal
    );
    for depth in [-0.001, 0.0125] {
        for _ in 0..100 {
            next.receive(contact(linear()), Sender::Same);
            let (force, tick) = next.step(&handle(depth), DT);
            assert_eq!((force, tick.fault), (DVec3::ZERO, Some(Fault::TooFast)));
        }
    }
    next.rearm();
    next.receive(contact(linear()), Sender::Same);
    assert_eq!(next.step(&handle(0.0), DT).1.fault, None);
}

#[test]
fn motors_cool_at_rest_and_after_a_fault() {
    let mut warm = Servo::new(Limits {
        continuous_force_n: 0.1,
        ..Limits::default()
    });
    for tick in 0..10_000 {
        warm.receive(contact(linear()), Sender::Same);
        warm.step(&handle(if tick < 10 { 0.0 } else { 0.0125 }), DT);
    }
    let rests: [fn(&mut Servo); 2] = [
        |servo| servo.switch(Switch::Off),
        |servo| servo.fault = Some(Fault::Oscillation),
    ];
    for rest in rests {
        let mut servo = warm;
        rest(&mut servo);
        servo.step(&handle(0.0), DT);
        let before = servo.thermal;
        servo.step(&handle(0.0), 60.0);
        assert_ne!(servo.thermal, before);
    }
}

#[test]
fn a_number_that_is_none_latches_the_fault() {
    let whole = handle(0.0125);
    let broken = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(|none| {
        let (mut position, mut velocity, mut orientation) = (whole, whole, whole);
        position.position.z = none;
        velocity.velocity.x = none;
        orientation.orientation.w = none;
        [position, velocity, orientation]
    });
    for (handle, dt) in broken
        .into_iter()
        .flatten()
        .map(|handle| (handle, DT))
        .chain([(whole, f64::NAN), (whole, f64::INFINITY)])
    {
        let mut servo = engaged(0.0125);
        let (force, tick) = servo.step(&handle, dt);
        assert!(
            tick.fault == Some(Fault::NotANumber) && force == DVec3::ZERO,
            "{handle:?} {dt}: {force}"
        );
        for _ in 0..100 {
            servo.receive(contact(linear()), Sender::Another);
            assert_eq!(servo.step(&whole, DT).0, DVec3::ZERO, "latched");
        }
        servo.rearm();
        assert_eq!(servo.step(&whole, DT).0, DVec3::ZERO, "nothing is kept");
        servo.receive(contact(linear()), Sender::Another);
        assert!(servo.step(&whole, DT).0.z < 0.01, "and engages anew");
    }
}

#[test]
fn a_model_beyond_all_numbers_latches_the_fault() {
    let mut servo = engaged(0.0125);
    let mut endless = model(linear());
    endless.viscous_n_s_m = f64::MAX;
    servo.receive(Contact::new(&endless).expect("a model"), Sender::Same);
    let mut fast = handle(0.0125);
    fast.velocity.x = 1.2;
    let (force, tick) = servo.step(&fast, DT);
    assert!(
        tick.fault == Some(Fault::NotANumber) && force == DVec3::ZERO,
        "{force}"
    );
}

#[test]
fn limits_that_make_no_sense_give_no_force() {
    let limits = |change: fn(&mut Limits)| {
        let mut limits = Limits::default();
        change(&mut limits);
        limits
    };
    for bad in [
        limits(|l| l.max_force_n = -1.0),
        limits(|l| l.slew_n_s = f64::NAN),
        limits(|l| l.engage_s = f64::NAN),
        limits(|l| l.engage_n = f64::NAN),
        limits(|l| l.max_stiffness_n_m = f64::NAN),
        limits(|l| l.fade_s = f64::NAN),
    ] {
        let mut servo = begun(bad);
        for _ in 0..600 {
            servo.receive(contact(linear()), Sender::Same);
            let (force, _) = servo.step(&handle(0.0125), DT);
            assert!(
                force.is_finite() && force.length() <= 3.0,
                "{bad:?}: {force}"
            );
        }
    }
    let mut servo = begun(limits(|l| l.max_force_n = -1.0));
    for _ in 0..600 {
        servo.receive(contact(linear()), Sender::Same);
        assert_eq!(servo.step(&handle(0.0), DT).0, DVec3::ZERO);
        assert_eq!(servo.step(&handle(0.0125), DT).0, DVec3::ZERO);
    }
}

#[test]
fn a_hard_press_is_cut_to_the_largest_force_and_slews_there() {
    let limits = Limits::default();
    let mut servo = engaged(0.0);
    let mut last = 0.0;
    for tick in 0..100 {
        servo.receive(rigid(400.0, 0.0), Sender::Same);
        let (force, told) = servo.step(&handle(0.02), DT);
        assert!(force.z - last <= limits.slew_n_s * DT + 1e-9, "{tick}");
        assert_eq!(
            told.clamped,
            tick >= 4,
            "8 N after the recovery, above 3 N from tick 4"
        );
        last = force.z;
    }
    assert!((last - 3.0).abs() < 1e-9, "{last} N");
}

#[test]
fn a_long_tick_drops_the_force() {
    let mut servo = engaged(0.0125);
    let (force, tick) = servo.step(&handle(0.0125), 0.2);
    assert!(tick.late && force.length() < 0.01, "{force}");
}

proptest! {
    #[test]
    fn force_and_its_change_stay_within_their_limits(
        moves in prop::collection::vec(
            (-0.06..0.06f64, -0.8..0.8f64, 0.0..0.02f64, 0u8..5, 0.0..2000.0f64), 1..200),
        engage_n in prop_oneof![Just(0.2), Just(f64::INFINITY)],
    ) {
        let limits = Limits { engage_n, ..Limits::default() };
        let mut servo = Servo::new(limits);
        let mut last = DVec3::ZERO;
        for (depth, speed, dt, kind, stiffness) in moves {
            match kind {
                0 => servo.receive(rigid(stiffness, 0.0), Sender::Same),
                1 => servo.receive(rigid(stiffness, 0.1 * speed), Sender::Same),
                2 => servo.receive(contact(linear()), Sender::Another),
                _ => {}
            }
            let handle = HandleState { velocity: DVec3::splat(speed), ..handle(depth) };
            let (force, tick) = servo.step(&handle, dt);
            prop_assert!(force.length() <= limits.max_force_n * (1.0 + 1e-12));
            if !tick.late {
                let change = (force - last).length();
                prop_assert!(change <= limits.slew_n_s * dt * (1.0 + 1e-9) + 1e-12);
            }
            last = force;
        }
    }
}
