//! Assertions on the grid, and the faults that they must find.

use super::*;

/// Stride through a grid that shares no factor with the length of an axis: a seventh of the runs has every pair of values of any
/// two axes.
pub(crate) const SEVENTH: usize = 7;

/// Runs of the grid that are chosen, and how they went.
fn went(path: Path, is_chosen: impl Fn(&Run) -> bool) -> Vec<(Run, Outcome)> {
    let go = |run: Run| (run, run.go().expect("a wall"));
    grid(path).into_iter().filter(is_chosen).map(go).collect()
}

/// Goes through the grid in strides, of which as many runs must be good.
fn are_still(stride: usize, runs: usize) {
    let go = |run: Run| (run, run.go().expect("a wall"));
    let all: Vec<_> = (grid(Path::Servo).into_iter().step_by(stride).map(go)).collect();
    for (run, outcome) in &all {
        if !run.is_good(outcome) {
            println!("{run:?}: {outcome:?}");
        }
        // A reduced force is reported.
        let told = run.stiffness.min(MAX_STIFFNESS_N_M);
        assert!(
            (outcome.reported_n_m - told).abs() < 1e-9,
            "{run:?}: {outcome:?}"
        );
    }
    let worst = Worst::of(&all);
    print(&worst);
    assert_eq!((worst.runs, worst.fails), (runs, 0));
}

#[test]
fn every_hand_is_still_gets_no_energy_and_feels_its_wall() {
    are_still(SEVENTH, 155);
}

#[test]
#[ignore = "long: 1,080 runs"]
fn every_hand_of_all_runs_is_still_and_feels_its_wall() {
    are_still(1, 1080);
}

/// The seeded fault: were a force that is sent over a network good, the grid could not fail. The
/// light fingertip shows it; hands with damping hide it.
#[test]
fn a_force_sent_60_times_a_second_shakes_a_fingertip() {
    // At 100 N/m the friction of the device still holds it.
    let shakes = |run: &Run| run.hand == Hand::FINGERTIP && run.stiffness >= 200.0;
    let mut least_m = f64::MAX;
    for (run, outcome) in went(Path::Sent, shakes) {
        assert!(!run.is_good(&outcome), "{run:?}: {outcome:?}");
        least_m = least_m.min(outcome.wobble_m);
    }
    println!("fingertips shake by {:.1} mm at least", least_m * 1e3);
    assert!(least_m > 1e-3);
    let arms = went(Path::Sent, |run| run.hand == Hand::ARM);
    assert_eq!(Worst::of(&arms).fails, 0, "the arm hides it");
}

/// The other seeded fault: a servo without force is still and gives nothing.
#[test]
fn a_servo_that_does_nothing_is_found_out() {
    // Whatever the models say.
    let is_one = |run: &Run| run.stiffness < BOUND_N_M && run.jitter == 0.0 && run.rate_hz == 60.0;
    for (run, outcome) in went(Path::Nothing, is_one) {
        assert!(!run.is_good(&outcome), "{run:?}");
    }
}

fn print(worst: &Worst) {
    println!(
        "{} runs: wobble {:.3} mm, energy {:.3} µJ, force off by {:.2} % at most",
        worst.runs,
        worst.wobble_m * 1e3,
        worst.net_j * 1e6,
        worst.force_error * 1e2
    );
}

/// Goes through the guided runs in strides, of which as many must be good.
fn are_still_beside_a_guide(stride: usize, runs: usize) {
    let go = |run: Run| (run, run.go().expect("a wall"));
    let all: Vec<_> = guided_grid().into_iter().step_by(stride).map(go).collect();
    let bad = all.iter().filter(|(run, outcome)| !run.is_good(outcome));
    for (run, outcome) in bad.take(20) {
        println!("{run:?}: {outcome:?}");
    }
    let worst = Worst::of(&all);
    print(&worst);
    assert_eq!((worst.runs, worst.fails), (runs, 0));
}

#[test]
fn a_guide_beside_the_wall_shakes_no_hand_and_gives_no_energy() {
    are_still_beside_a_guide(SEVENTH, 309);
}

#[test]
#[ignore = "long: 2,160 runs"]
fn no_guide_of_all_runs_shakes_a_hand_or_gives_energy() {
    are_still_beside_a_guide(1, 2160);
}

/// The seeded fault: a wall of 100 N/m whose force is sent over a network the fingertip bears, but not one with a guide
/// that pulls along its normal.
#[test]
fn a_guide_sent_60_times_a_second_shakes_a_fingertip() {
    let sent = |guide| Run {
        hand: Hand::FINGERTIP,
        stiffness: 100.0,
        rate_hz: 250.0,
        jitter: 0.0,
        motion: Motion::Still,
        guide,
        path: Path::Sent,
    };
    let wobble_m = |run: Run| run.go().expect("a wall").wobble_m;
    let guide = GuideLine::strongest(DVec3::X, 0.0);
    assert!(wobble_m(sent(None)) < STILL_M);
    assert!(wobble_m(sent(Some(guide))) > 1e-3);
    // Nor is one found good that is as stiff as twenty.
    let stiff = GuideLine {
        stiffness: 20.0 * guide.stiffness,
        most_n: 3.0,
        ..guide
    };
    let run = sent(Some(stiff));
    let outcome = run.go().expect("a wall");
    assert!(!run.is_good(&outcome), "{outcome:?}");
}
