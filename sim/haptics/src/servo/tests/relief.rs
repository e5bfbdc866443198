//! Relief, friction at rest and the brush's own torque in the servo: bounds, faults, known answers.

use glam::DVec3;
use maulstick_num::geometry::rotation;
use maulstick_num::sin;
use maulstick_types::haptics::{ContactModel, ForceLaw, HeightPatch};

use crate::closed_loop_tests::random;
use crate::closed_loop_tests::{DT, HEAD_M, MOST_N, MOST_SLEW_N_S, device};
use crate::contact::tests::{linear, model};
use crate::contact::{Contact, HandleState};
use crate::plant::{Hand, Plant};
use crate::relief::tests::{edge, ridge, rough};
use crate::servo::Servo;
use crate::servo::engagement::CALM_TICKS;
use crate::servo::limits::Limits;
use crate::servo::tick::Sender;

/// An upright brush with its tip at a place, m.
fn at(tip: DVec3) -> HandleState {
    HandleState::upright(tip + DVec3::Z * HEAD_M)
}

fn over(law: ForceLaw, relief: HeightPatch) -> ContactModel {
    ContactModel {
        recovery_ns: 15_000_000,
        relief,
        ..model(law)
    }
}

/// Largest force, N, and fastest change of it, N/s, of a hand that strokes over patches that jump at every model.
fn leaping(law: &ForceLaw, every: usize, limits: Limits) -> [f64; 2] {
    let mut servo = Servo::new(limits);
    let mut plant = Plant::omni(Hand::PEN_GRIP, DVec3::Z * (HEAD_M + 2e-3));
    let (mut state, mut last) = (every as u64, DVec3::ZERO);
    let (mut most_n, mut most_slew): (f64, f64) = (0.0, 0.0);
    for tick in 0..6000 {
        if tick % every == 0 {
            let sharp = random(&mut state);
            let mut patch = match (random(&mut state) * 4.0) as u32 {
                0 => rough(5000, tick as u64),
                1 => edge(if sharp < 0.5 { 5000 } else { -5000 }),
                2 => ridge(5000),
                _ => HeightPatch::flat(),
            };
            if !patch.is_flat() {
                let [x, y] = [0, 1].map(|_| 0.02 * random(&mut state) - 0.01);
                let turn = 6.0 * random(&mut state);
                patch.corner_m = [x, y, 3.0];
                patch.along = [maulstick_num::cos(turn), sin(turn), 0.0];
                patch.cell_m = 2.5e-4 * maulstick_num::powf(100.0, sharp);
            }
            let contact = Contact::new(&over(law.clone(), patch)).expect("a model");
            servo.receive(contact, Sender::Same);
        }
        let handle = plant.handle();
        let (force, told) = servo.step(&handle, DT);
        assert!(force.is_finite() && told.torque_n_m.is_finite());
        // A lever of the head, and the servo's share of a longer one for its change.
        assert!(told.torque_n_m.length() <= 0.05 * MOST_N + 1e-9);
        most_n = most_n.max(force.length());
        most_slew = most_slew.max((force - last).length() / DT);
        last = force;
        let s = f64::from(tick as u32) * DT;
        let depth = 2e-3 + 4e-3 * sin(9.0 * s);
        plant.advance(
            force,
            DVec3::new(0.01 * sin(7.0 * s), 0.0, HEAD_M - depth),
            DT,
        );
    }
    [most_n, most_slew]
}

#[test]
fn patches_that_leap_keep_the_servos_bounds() {
    let laws = [
        linear(),
        ForceLaw::Rigid {
            stiffness_n_m: 2000.0,
        },
    ];
    let (mut most_n, mut most_slew): (f64, f64) = (0.0, 0.0);
    for law in &laws {
        for every in [1, 4, 16, 33] {
            let [force, slew] = leaping(law, every, device());
            (most_n, most_slew) = (most_n.max(force), most_slew.max(slew));
        }
    }
    println!("{most_n:.3} N, {most_slew:.1} N/s at most");
    assert!(most_n > 0.2, "it felt something");
    assert!(most_n <= MOST_N + 1e-9 && most_slew <= MOST_SLEW_N_S + 1e-6);
    // The seeded fault: without the servo's bounds they would be exceeded.
    let unbounded = Limits {
        slew_n_s: 1e9,
        ..device()
    };
    let [_, slew] = leaping(&laws[1], 4, unbounded);
    assert!(slew > MOST_SLEW_N_S, "{slew} N/s");
}

/// A hand above the plane of a model, so that force may begin.
fn begun(limits: Limits, contact: Contact) -> Servo {
    let mut servo = Servo::new(limits);
    for _ in 0..CALM_TICKS {
        servo.receive(contact, Sender::Same);
        servo.step(&at(DVec3::Z * 1e-3), DT);
    }
    servo
}

#[test]
fn another_patch_takes_over_without_a_jump_and_the_same_without_any_change() {
    let of = |relief| Contact::new(&over(linear(), relief)).expect("a model");
    let (ridge, bare) = (of(ridge(800)), of(HeightPatch::flat()));
    let tip = at(DVec3::new(1.5e-3, 0.0, -5e-3));
    let mut servo = begun(Limits::default(), bare);
    for _ in 0..1000 {
        servo.receive(bare, Sender::Same);
        servo.step(&tip, DT);
    }
    let before = servo.force;
    servo.receive(ridge, Sender::Same);
    let mut last = before;
    let mut most: f64 = 0.0;
    let after = ridge.force(&tip, 400.0);
    for tick in 0..40 {
        let (force, _) = servo.step(&tip, DT);
        most = most.max((force - last).length());
        assert!(
            tick < 16 || (force - after).length() < 1e-6,
            "{force} {after}"
        );
        last = force;
    }
    let change = (after - before).length();
    assert!(
        change > 0.01 && most <= change / 15.0 * 1.01,
        "{most} of {change} N"
    );
    // A patch with the same heights, shifted by a cell as it follows the hand, changes nothing.
    let level = |shift: f64| {
        let mut patch = crate::relief::tests::patch(|i, j| ((i + 2 * j) as i16) * 9);
        patch.corner_m = [-8e-3 + shift, -8e-3, 0.0];
        let lower = (shift * 1e3).round() as i16 * 9;
        let heights: Vec<i16> = maulstick_types::haptics::heights_um(&patch.heights_um).collect();
        patch.heights_um =
            maulstick_types::haptics::height_bytes(heights.iter().map(|um| um + lower));
        of(patch)
    };
    let [here, aside] = [0.0, 1e-3].map(|shift| level(shift).force(&tip, 400.0));
    assert!((here - aside).length() < 1e-9, "{here} {aside}");
}

/// A hand that presses by .5 N and is pulled along x: its position after three and after six seconds, m, and the
/// greatest energy given to it, J.
fn pulled(pull_n: f64, static_friction: f64) -> ([f64; 2], f64) {
    let wall = ContactModel {
        friction_static: static_friction,
        friction_kinetic: 0.2_f64.min(static_friction),
        ..over(
            ForceLaw::Rigid {
                stiffness_n_m: 400.0,
            },
            HeightPatch::flat(),
        )
    };
    let contact = Contact::new(&wall).expect("a model");
    let mut servo = begun(
        Limits {
            damping_n_s_m: 0.3,
            ..Limits::default()
        },
        contact,
    );
    // So soft that its pull is the same everywhere.
    let hand = Hand {
        stiffness: 1.0,
        ..Hand::PEN_GRIP
    };
    let mut plant = Plant::omni(hand, DVec3::Z * (HEAD_M + 1e-4));
    plant.coulomb_n = 0.0;
    let (mut places, mut most_j) = ([0.0; 2], f64::MIN);
    let mut begin_j = None;
    for tick in 0..8000 {
        if tick % 4 == 0 {
            servo.receive(contact, Sender::Same);
        }
        let handle = plant.handle();
        let (force, told) = servo.step(&handle, DT);
        assert_eq!(told.fault, None);
        // The hand presses, and pulls once that is at rest.
        let press = 0.5 * (f64::from(tick) * 1e-3).min(1.0);
        let pull = pull_n * ((f64::from(tick) - 2000.0) * 1e-3).clamp(0.0, 1.0);
        plant.advance(force, DVec3::new(pull, 0.0, HEAD_M - press), DT);
        if tick >= 2000 {
            let begin_j = *begin_j.get_or_insert(plant.given_j());
            most_j = most_j.max(plant.given_j() - begin_j);
        }
        match tick {
            5000 => places[0] = plant.true_position().x,
            7999 => places[1] = plant.true_position().x,
            _ => {}
        }
    }
    (places, most_j)
}

/// Known answers: below the breakaway of .3 · .5 N the hand hangs on its bristles of 80 N/m, above it slides.
#[test]
fn a_hand_that_pulls_by_less_than_the_breakaway_does_not_creep() {
    for pull in [0.05, 0.1, 0.13] {
        let ([early, late], given_j) = pulled(pull, 0.3);
        println!(
            "{pull} N: {:.3} mm, {:.3} mm; {given_j:.1e} J",
            early * 1e3,
            late * 1e3
        );
        assert!(
            (late - early).abs() < 1e-5,
            "it creeps by {} m",
            late - early
        );
        // Within the steps of the encoders.
        assert!((late - pull / 80.0).abs() < 6e-5, "{late}");
        assert!(given_j < 1e-6, "{given_j} J");
    }
    let ([early, late], given_j) = pulled(0.2, 0.3);
    assert!(late - early > 0.01, "{early} {late}");
    assert!(given_j < 1e-6, "{given_j} J");
    // The seeded fault: without friction at rest the gentlest pull moves it.
    let ([early, late], _) = pulled(0.05, 0.0);
    assert!(late - early > 1e-2, "{early} {late}");
}

/// Known answer of a brush that leans by 30° and presses: the lever of its head times the force.
#[test]
fn the_brush_turns_the_hand_by_its_lever_and_not_in_the_air() {
    let wall = ContactModel {
        friction_static: 0.0,
        friction_kinetic: 0.0,
        ..over(
            ForceLaw::Rigid {
                stiffness_n_m: 400.0,
            },
            HeightPatch::flat(),
        )
    };
    let contact = Contact::new(&wall).expect("a model");
    let leaning = rotation(DVec3::Y, 30.0_f64.to_radians());
    let handle = |depth: f64| HandleState {
        position: leaning * DVec3::Z * HEAD_M - DVec3::Z * depth,
        orientation: leaning,
        velocity: DVec3::ZERO,
    };
    let mut servo = Servo::new(Limits::default());
    let mut step = |depth: f64| {
        servo.receive(contact, Sender::Same);
        servo.step(&handle(depth), DT)
    };
    for _ in 0..100 {
        assert_eq!(step(-1e-3).1.torque_n_m, DVec3::ZERO);
    }
    let mut last = DVec3::ZERO;
    for _ in 0..1000 {
        let (force, tick) = step(2.5e-3);
        let change = (tick.torque_n_m - last).length() / DT;
        assert!(change <= 400.0 * 0.05 + 1e-9, "{change} N·m/s");
        assert!(tick.torque_n_m.length() <= HEAD_M * force.length() + 1e-12);
        last = tick.torque_n_m;
    }
    // 1 N up at 12.5 mm to the left and 21.7 mm below: about y.
    let expected = DVec3::new(0.0, 0.0125, 0.0);
    assert!((last - expected).length() < 1e-9, "{last}");
    // The work of force and torque is that of one potential: a small turn costs as much as a step to the same depth.
    let turn = rotation(DVec3::Y, 1e-6);
    let turned = HandleState {
        orientation: turn * leaning,
        ..handle(2.5e-3)
    };
    let deeper = contact.evaluate(&turned, 400.0).depth_m - 2.5e-3;
    assert!((deeper + last.y * 1e-6 / 1.0).abs() < 1e-12, "{deeper}");
    for _ in 0..100 {
        last = step(-1e-3).1.torque_n_m;
    }
    assert_eq!(last, DVec3::ZERO);
    let mut fast = handle(2.5e-3);
    fast.velocity = DVec3::X * 2.0;
    for _ in 0..1000 {
        step(2.5e-3);
    }
    servo.receive(contact, Sender::Same);
    let (force, tick) = servo.step(&fast, DT);
    assert!(tick.fault.is_some() && force == DVec3::ZERO && tick.torque_n_m == DVec3::ZERO);
}

/// A stylus of 20 g·cm² in light fingers that turn it about its ferrule: its remaining motion after a kick, rad.
fn turning(bears: f64, lever_m: f64) -> f64 {
    const INERTIA: f64 = 2e-6;
    const FINGERS: [f64; 2] = [0.02, 1e-4];
    let wall = over(
        ForceLaw::Rigid {
            stiffness_n_m: 5000.0,
        },
        ridge(800),
    );
    let contact = Contact::new(&wall).expect("a model");
    let limits = Limits {
        max_stiffness_n_m: bears,
        lever_m,
        ..device()
    };
    let mut servo = begun(limits, contact);
    let (mut angle, mut speed): (f64, f64) = (0.5, 0.0);
    let (mut low, mut high) = (f64::MAX, f64::MIN);
    for tick in 0..5000 {
        servo.receive(contact, Sender::Same);
        // The grip goes down to 1 mm and stays there.
        let height =
            HEAD_M * maulstick_num::cos(0.5) + 1e-3 - 2e-3 * (f64::from(tick) * 1e-3).min(1.0);
        let handle = HandleState {
            // The tip stands on the flank of the ridge.
            position: DVec3::new(HEAD_M * sin(0.5) + 1.3e-3, 0.0, height),
            orientation: rotation(DVec3::Y, angle),
            velocity: DVec3::ZERO,
        };
        let torque = servo.step(&handle, DT).1.torque_n_m.y;
        let rest = if (1500..1600).contains(&tick) {
            0.7
        } else {
            0.5
        };
        for _ in 0..20 {
            let held = FINGERS[0] * (rest - angle) - FINGERS[1] * speed;
            speed += (torque + held) / INERTIA * (DT / 20.0);
            angle += speed * (DT / 20.0);
        }
        if tick >= 4500 {
            (low, high) = (low.min(angle), high.max(angle));
        }
    }
    high - low
}

#[test]
fn a_stylus_that_is_turned_by_its_brush_comes_to_rest() {
    for bears in [100.0, 300.0, 500.0] {
        let still = turning(bears, 0.05);
        println!("{bears} N/m: {still:.1e} rad");
        assert!(still < 1e-3, "{bears} N/m: {still} rad");
    }
    // The seeded fault: a wall stiffer than any device allows turns it to and fro.
    let shaking = turning(4000.0, 0.05);
    assert!(shaking > 1e-2, "{shaking} rad");
}
