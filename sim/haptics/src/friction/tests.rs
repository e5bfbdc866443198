//! Friction opposes motion, and nothing creeps at rest.

use proptest::prelude::*;

use super::*;

proptest! {
    #[test]
    fn friction_opposes_motion_within_its_bound(
        x in -2.0..2.0f64, y in -2.0..2.0f64, bound in 0.0..3.0f64,
    ) {
        let across = DVec3::new(x, y, 0.0);
        let force = friction(across, bound);
        prop_assert!(force.dot(across) <= 0.0 && force.length() <= bound * (1.0 + 1e-12));
        prop_assert!(across.length() < FULL_SPEED || force.length() >= bound * (1.0 - 1e-12));
    }
}

/// Known answers: .12 N hold at rest; after half a millimetre of sliding .08 N, and again .12 N after 50 ms of rest.
#[test]
fn a_hand_at_rest_breaks_away_later_than_one_that_moves() {
    let grip = Grip {
        still_n: 0.12,
        moving_n: 0.08,
        ..GRIP
    };
    let mut stiction = Stiction::default();
    let mut pulled = |x: f64, ticks: usize| {
        (0..ticks).for_each(|_| stiction.follow(DVec3::X * x, Some(&grip), 1e-3));
        -stiction.force(DVec3::X * x, &grip).x
    };
    assert_eq!(pulled(0.0, 1), 0.0);
    // .12 N by 80 N/m is 1.5 mm.
    for (x, force) in [(1e-3, 0.08), (1.4e-3, 0.112), (1.5e-3, 0.12)] {
        assert!((pulled(x, 1) - force).abs() < 1e-12, "{x}");
    }
    let slid = pulled(4e-3, 2);
    assert!((slid - 0.08).abs() < 1e-9, "{slid}");
    // A little back, and it sticks: its slip force is higher again.
    assert!((pulled(3.9e-3, 50) - 0.072).abs() < 1e-9);
    assert!((pulled(4.3e-3, 1) - 0.104).abs() < 1e-9);
}

const GRIP: Grip = Grip {
    normal: DVec3::Z,
    still_n: 0.1,
    moving_n: 0.1,
    stiffness_n_m: 80.0,
};
const STEP_S: f64 = 1e-4;

/// Position, m, of a mass of 50 g pulled along x for ten seconds, after five of them and at the end; the pull rises for
/// two seconds, then stays at `pull_n`; `damping` brakes it, N·s/m.
fn pulled(
    pull_n: f64,
    damping: f64,
    mut force: impl FnMut(&mut Stiction, DVec3) -> DVec3,
) -> [f64; 2] {
    let (mut stiction, mut place, mut velocity) = (Stiction::default(), DVec3::ZERO, DVec3::ZERO);
    let mut halfway = 0.0;
    for step in 0..100_000 {
        let held = force(&mut stiction, place);
        let pull = DVec3::X * (pull_n * (f64::from(step) / 20_000.0).min(1.0));
        velocity += (held + pull - velocity * damping) * (STEP_S / 0.05);
        place += velocity * STEP_S;
        if step == 50_000 {
            halfway = place.x;
        }
    }
    [halfway, place.x]
}

fn stuck(stiction: &mut Stiction, place: DVec3) -> DVec3 {
    stiction.follow(place, Some(&GRIP), STEP_S);
    stiction.force(place, &GRIP)
}

/// Known answers: below the breakaway of .1 N the mass hangs on its spring, F/k away; above it slides at (F − .1 N)/b.
#[test]
fn a_hand_that_pulls_by_less_than_the_breakaway_does_not_creep_and_by_more_it_slides() {
    for pull in [0.02, 0.05, 0.09] {
        let [halfway, end] = pulled(pull, 1.0, stuck);
        println!(
            "{pull} N: {:.6} mm, expected {:.6}",
            end * 1e3,
            pull / 80.0 * 1e3
        );
        assert!((end - pull / 80.0).abs() < 1e-9, "{end} m at {pull} N");
        assert!((end - halfway).abs() < 1e-9, "it creeps");
    }
    let [halfway, end] = pulled(0.15, 1.0, stuck);
    assert!(
        ((end - halfway) / 5.0 - 0.05).abs() < 1e-3,
        "{halfway} {end}"
    );
}

/// The seeded fault: with friction by velocity alone the hand creeps however gently it pulls.
#[test]
fn friction_without_a_spring_creeps() {
    let mut last = DVec3::ZERO;
    let [halfway, end] = pulled(0.05, 1.0, |_, place| {
        let velocity = (place - last) / STEP_S;
        last = place;
        friction(velocity, GRIP.moving_n)
    });
    assert!(end - halfway > 1e-3, "{halfway} {end}");
}

/// Energy that a hand gains round a circle of 20 mm, J; `keep` updates the bristles after each step, from one place to
/// the next.
fn given(mut keep: impl FnMut(&mut Stiction, [DVec3; 2])) -> f64 {
    const STEPS: usize = 20_000;
    let mut stiction = Stiction::default();
    let at = |i: usize| {
        let turn = 2.0 * std::f64::consts::PI * i as f64 / STEPS as f64;
        let (sine, cosine) = maulstick_num::sin_cos(turn);
        DVec3::new(cosine - 1.0, sine, 0.3 * sine) * RADIUS_M
    };
    stiction.follow(at(0), Some(&GRIP), STEP_S);
    let mut given = 0.0;
    for i in 0..STEPS {
        let (from, to) = (at(i), at(i + 1));
        let mean = (stiction.force(from, &GRIP) + stiction.force(to, &GRIP)) * 0.5;
        given += mean.dot(to - from);
        keep(&mut stiction, [from, to]);
    }
    given
}

const RADIUS_M: f64 = 0.02;

/// Along a closed path friction dissipates μ·f_n times its length, except what the bristles store, ½·F²/k.
#[test]
fn a_hand_that_goes_round_loses_what_friction_takes_and_gets_nothing() {
    let length = 2.0 * std::f64::consts::PI * RADIUS_M;
    let lost = given(|stiction, [_, to]| stiction.follow(to, Some(&GRIP), STEP_S));
    let stored = 0.5 * 0.1 * 0.1 / 80.0;
    println!("{lost} J, friction {} J, stored {stored} J", -0.1 * length);
    assert!(lost < 0.0 && (lost + 0.1 * length).abs() < 2.0 * stored);
    // Within reach of the bristles nothing slips: a small closed path loses nothing.
    let mut stiction = Stiction::default();
    stiction.follow(DVec3::ZERO, Some(&GRIP), STEP_S);
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::ZERO].map(|c| c * 5e-4);
    let round: f64 = corners
        .windows(2)
        .map(|pair| {
            let mean = stiction.force(pair[0], &GRIP) + stiction.force(pair[1], &GRIP);
            0.5 * mean.dot(pair[1] - pair[0])
        })
        .sum();
    assert!(round.abs() < 1e-15, "{round} J");
}

/// The seeded fault: bristles that adhere ahead of the hand drive it.
#[test]
fn bristles_that_lead_the_hand_would_give_energy() {
    let gained = given(|stiction, [from, to]| {
        *stiction = Stiction::default();
        stiction.follow(to + (to - from) * 5.0, Some(&GRIP), STEP_S);
    });
    assert!(gained > 1e-6, "{gained} J");
}

#[test]
fn a_lighter_hand_and_one_in_the_air_let_go() {
    let mut stiction = Stiction::default();
    stiction.follow(DVec3::ZERO, Some(&GRIP), STEP_S);
    let place = DVec3::new(1e-3, 0.0, 0.01);
    let force = stiction.force(place, &GRIP);
    assert!((force + DVec3::X * 0.08).length() < 1e-12, "{force}");
    let lighter = Grip {
        still_n: 0.02,
        moving_n: 0.02,
        ..GRIP
    };
    stiction.follow(place, Some(&lighter), STEP_S);
    assert!((stiction.force(place, &GRIP) + DVec3::X * 0.02).length() < 1e-12);
    stiction.follow(place, None, STEP_S);
    assert_eq!(stiction.force(place, &GRIP), DVec3::ZERO);
}
