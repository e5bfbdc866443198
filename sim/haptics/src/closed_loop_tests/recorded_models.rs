//! Contact models recorded with one hand and replayed to it and to others: at every stiffness, rate and loss of the
//! grid the force stays within the servo's bounds, and hands come to rest.

use glam::{DQuat, DVec3};
use maulstick_num::sin;
use maulstick_types::Pose;
use maulstick_types::haptics::{ContactModel, ForceLaw};

use super::{DT, Extent, HANDS, HEAD_M, MOST_N, MOST_SLEW_N_S, STILL_M, device};
use crate::closed_loop_tests::random;
use crate::contact::Contact;
use crate::contact::tests::model;
use crate::plant::Plant;
use crate::servo::Servo;
use crate::servo::limits::Limits;
use crate::servo::tick::Sender;

const TICKS: usize = 3000;
/// Ticks in which the hand presses on and then holds still.
const STILL_TICKS: std::ops::Range<usize> = 2500..TICKS;

/// Kind of a recorded model.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Wall,
    /// A brush whose stiffness follows the recorded hand's pressure.
    Brush,
    /// A force linearised at the recorded hand's position.
    Local,
}

/// Targets of a hand: it strokes and presses, with a lag and an additional depth.
#[derive(Clone, Copy, Debug)]
struct Wish {
    late_s: f64,
    deeper_m: f64,
    aside_m: f64,
}

const RECORDED: Wish = Wish {
    late_s: 0.0,
    deeper_m: 0.0,
    aside_m: 0.0,
};
const ANOTHER: Wish = Wish {
    late_s: 0.23,
    deeper_m: 0.004,
    aside_m: 0.01,
};

impl Wish {
    fn ferrule(&self, tick: usize) -> DVec3 {
        let s = (tick as f64 * DT - self.late_s).clamp(0.0, 2.0);
        let depth = match s {
            s if s < 0.3 => -0.005,
            s => 0.003 + self.deeper_m + 0.003 * sin(9.0 * s),
        };
        DVec3::new(0.03 * sin(4.0 * s) + self.aside_m, 0.0, HEAD_M - depth)
    }
}

/// A model of a kind for a hand at a place.
fn felt(kind: Kind, stiffness: f64, place: DVec3) -> ContactModel {
    let depth = (HEAD_M - place.z).max(0.0);
    let law = match kind {
        Kind::Wall => ForceLaw::Rigid {
            stiffness_n_m: stiffness,
        },
        Kind::Brush => ForceLaw::Linear {
            k1_n: stiffness * HEAD_M * (0.4 + 60.0 * depth),
            k2_n: 6.0,
        },
        Kind::Local => ForceLaw::Local {
            pose: Pose {
                position_m: place.to_array(),
                orientation: DQuat::IDENTITY.to_array(),
            },
            force_n: [20.0 * place.x, 0.0, stiffness * depth],
            stiffness_n_m: [[-50.0, 0.0, 0.0], [0.0; 3], [0.0, 0.0, -stiffness]],
        },
    };
    ContactModel {
        // The plane of a moving canvas passes through the contact of the brush.
        plane_point_m: [0.0, 0.0, 2e-4 * sin(40.0 * place.x)],
        // Six of the longest periods, as in the grid, so that lost models do not fade.
        time_to_live_ns: 200_000_000,
        recovery_ns: 15_000_000,
        ..model(law)
    }
}

/// Outcome of a hand and its models.
#[derive(Debug)]
struct Went {
    models: Vec<(usize, ContactModel)>,
    forces: Vec<DVec3>,
    most_n: f64,
    most_slew_n_s: f64,
    wobble_m: f64,
    is_faulty: bool,
}

/// Runs a hand on the models that arrive at each tick.
fn go(
    hand: usize,
    wish: Wish,
    limits: Limits,
    mut next: impl FnMut(usize, DVec3) -> Option<ContactModel>,
) -> Went {
    let mut servo = Servo::new(limits);
    let mut plant = Plant::omni(HANDS[hand], wish.ferrule(0));
    let mut went = Went {
        models: Vec::new(),
        forces: Vec::new(),
        most_n: 0.0,
        most_slew_n_s: 0.0,
        wobble_m: 0.0,
        is_faulty: false,
    };
    let (mut extent, mut last) = (Extent::NONE, DVec3::ZERO);
    for tick in 0..TICKS {
        let handle = plant.handle();
        if let Some(model) = next(tick, handle.position) {
            servo.receive(Contact::new(&model).expect("a model"), Sender::Same);
            went.models.push((tick, model));
        }
        let (force, told) = servo.step(&handle, DT);
        went.is_faulty |= told.fault.is_some();
        went.most_n = went.most_n.max(force.length());
        went.most_slew_n_s = went.most_slew_n_s.max((force - last).length() / DT);
        went.forces.push(force);
        last = force;
        plant.advance(force, wish.ferrule(tick), DT);
        if STILL_TICKS.contains(&tick) {
            extent.include(plant.true_position());
        }
    }
    went.wobble_m = extent.peak_to_peak_m();
    went
}

fn record(hand: usize, kind: Kind, stiffness: f64) -> Went {
    go(hand, RECORDED, device(), |tick, place| {
        tick.is_multiple_of(4).then(|| felt(kind, stiffness, place))
    })
}

/// Replay of a recording: its models arrive at a given rate, delayed by up to a share of their period, and are lost at
/// that share too.
fn replay(
    recorded: &Went,
    hand: usize,
    wish: Wish,
    limits: Limits,
    every: usize,
    jitter: f64,
) -> Went {
    let mut state = 7;
    let mut due: Vec<(usize, ContactModel)> = Vec::new();
    for (tick, model) in recorded.models.iter().step_by(every) {
        let late = (jitter * random(&mut state) * 4.0 * every as f64) as usize;
        if random(&mut state) >= jitter || *tick == 0 {
            due.push((tick + late, model.clone()));
        }
    }
    let mut due = due.into_iter().peekable();
    go(hand, wish, limits, |tick, _| {
        let mut newest = None;
        while let Some((_, model)) = due.next_if(|(at, _)| *at <= tick) {
            newest = Some(model);
        }
        newest
    })
}

const KINDS: [Kind; 3] = [Kind::Wall, Kind::Brush, Kind::Local];

#[test]
fn recorded_models_keep_the_servos_bounds_with_the_recorded_hand_and_with_others() {
    let (mut runs, mut most_n, mut wobble_m) = (0, 0.0f64, 0.0f64);
    for kind in KINDS {
        for stiffness in (1..=10).map(|i| 100.0 * f64::from(i)) {
            let recorded = record(1, kind, stiffness);
            for hand in 0..HANDS.len() {
                for wish in [RECORDED, ANOTHER] {
                    // 250, 62 and 31 models a second.
                    for every in [1, 4, 8] {
                        for jitter in [0.0, 0.1, 0.2] {
                            let went = replay(&recorded, hand, wish, device(), every, jitter);
                            let told =
                                format!("{kind:?} {stiffness} {hand} {wish:?} {every} {jitter}");
                            assert!(!went.is_faulty, "{told}");
                            assert!(went.most_n <= MOST_N + 1e-9, "{told}: {} N", went.most_n);
                            assert!(went.most_slew_n_s <= MOST_SLEW_N_S + 1e-6, "{told}");
                            assert!(went.wobble_m < STILL_M, "{told}: {} m", went.wobble_m);
                            runs += 1;
                            most_n = most_n.max(went.most_n);
                            wobble_m = wobble_m.max(went.wobble_m);
                        }
                    }
                }
            }
        }
    }
    println!(
        "{runs} runs: {most_n:.2} N, wobble {:.3} mm at most",
        wobble_m * 1e3
    );
    assert_eq!(runs, 1620);
}

#[test]
fn the_recorded_hand_feels_what_it_felt() {
    for kind in KINDS {
        let recorded = record(1, kind, 300.0);
        let again = replay(&recorded, 1, RECORDED, device(), 1, 0.0);
        assert_eq!(again.forces, recorded.forces, "{kind:?}");
        let another = replay(&recorded, 1, ANOTHER, device(), 1, 0.0);
        assert_ne!(another.forces, recorded.forces, "{kind:?}");
    }
}

/// The seeded fault: a servo without bounds must exceed them.
#[test]
fn a_servo_without_bounds_is_found_out() {
    let unbounded = Limits {
        max_force_n: 1e9,
        continuous_force_n: 1e9,
        slew_n_s: 1e9,
        max_stiffness_n_m: 1e9,
        ..device()
    };
    for kind in KINDS {
        let recorded = record(1, kind, 1000.0);
        let went = replay(&recorded, 0, ANOTHER, unbounded, 4, 0.2);
        assert!(
            went.most_n > MOST_N && went.most_slew_n_s > MOST_SLEW_N_S,
            "{kind:?}: {} N, {} N/s",
            went.most_n,
            went.most_slew_n_s
        );
    }
}
