//! Assertions on the grid, and the faults that they must find.

use super::*;

/// All runs of the grid and how they went.
fn went(path: Path) -> Vec<(Run, Outcome)> {
    let go = |run: Run| (run, run.go().expect("a wall"));
    grid(path).into_iter().map(go).collect()
}

#[test]
fn every_hand_is_still_gets_no_energy_and_feels_its_wall() {
    let all = went(Path::Servo);
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
    assert_eq!((worst.runs, worst.fails), (1080, 0));
}

/// The seeded fault: were a force that is sent over a network good, the grid could not fail. The
/// light fingertip shows it; hands with damping hide it.
#[test]
fn a_force_sent_60_times_a_second_shakes_a_fingertip() {
    let all = went(Path::Sent);
    let mut least_m = f64::MAX;
    for (run, outcome) in &all {
        // At 100 N/m the friction of the device still holds it.
        if run.hand == Hand::FINGERTIP && run.stiffness >= 200.0 {
            assert!(!run.is_good(outcome), "{run:?}: {outcome:?}");
            least_m = least_m.min(outcome.wobble_m);
        }
    }
    let of = HANDS.map(|hand| Worst::of(all.iter().filter(|(run, _)| run.hand == hand)));
    println!(
        "{:?} of 360 each are bad; fingertips shake by {:.1} mm at least",
        of.map(|worst| worst.fails),
        least_m * 1e3
    );
    assert!(least_m > 1e-3);
    assert_eq!(of[2].fails, 0, "the arm hides it");
}

/// The other seeded fault: a servo without force is still and gives nothing.
#[test]
fn a_servo_that_does_nothing_is_found_out() {
    for (run, outcome) in went(Path::Nothing) {
        // Independent of the models.
        if run.stiffness < BOUND_N_M && run.jitter == 0.0 && run.rate_hz == 60.0 {
            assert!(!run.is_good(&outcome), "{run:?}");
        }
    }
}

/// The guided runs and how they went.
fn guided(change: impl Fn(Run) -> Run) -> Vec<(Run, Outcome)> {
    let go = |run: Run| {
        let run = change(run);
        (run, run.go().expect("a wall"))
    };
    guided_grid().into_iter().map(go).collect()
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

#[test]
fn a_guide_beside_the_wall_shakes_no_hand_and_gives_no_energy() {
    let all = guided(|run| run);
    let bad = all.iter().filter(|(run, outcome)| !run.is_good(outcome));
    for (run, outcome) in bad.take(20) {
        println!("{run:?}: {outcome:?}");
    }
    let worst = Worst::of(&all);
    print(&worst);
    assert_eq!((worst.runs, worst.fails), (2160, 0));
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
