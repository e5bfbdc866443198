//! Assertions on the runs over relief, and the faults that they must find.

use maulstick_haptics::plant::Hand;

use super::*;
use crate::tests::SEVENTH;

fn went(runs: impl IntoIterator<Item = ReliefRun>) -> Vec<(ReliefRun, ReliefOutcome)> {
    let go = |run: ReliefRun| (run, run.go().expect("a wall"));
    runs.into_iter().map(go).collect()
}

fn most(all: &[(ReliefRun, ReliefOutcome)], of: impl Fn(&ReliefOutcome) -> f64) -> f64 {
    all.iter().map(|(_, it)| of(it)).fold(0.0, f64::max)
}

/// Goes through the runs over a ground in strides, of which as many must be good.
fn every_hand_is_still(ground: Ground, stride: usize, count: usize) {
    let runs = relief_grid(Path::Servo).into_iter();
    let all = went(runs.filter(|run| run.ground == ground).step_by(stride));
    let bad: Vec<_> = all.iter().filter(|(run, it)| !run.is_good(it)).collect();
    for (run, outcome) in bad.iter().take(10) {
        println!("{run:?}: {outcome:?}");
    }
    let soft = |(run, it): &(ReliefRun, ReliefOutcome)| match run.run.stiffness {
        k if k < super::super::BOUND_N_M => (it.share - 1.0).abs(),
        _ => 0.0,
    };
    let moved: Vec<_> = all
        .iter()
        .filter(|(run, _)| run.friction == 0.0)
        .copied()
        .collect();
    println!(
        "{ground:?}: {} runs, {} bad: wobble {:.3} mm, energy {:.3} µJ, {:.3} µJ from some time on, force off by {:.2} %, {:.2} N across at most",
        all.len(),
        bad.len(),
        most(&all, |it| it.wobble_m) * 1e3,
        most(&all, |it| it.net_j) * 1e6,
        most(&moved, |it| it.rise_j) * 1e6,
        all.iter().map(soft).fold(0.0, f64::max) * 1e2,
        most(&all, |it| it.across_n)
    );
    assert_eq!((all.len(), bad.len()), (count, 0), "{ground:?}");
}

#[test]
fn every_hand_is_still_on_rough_ground_and_gets_no_energy_of_it() {
    every_hand_is_still(Ground::Rough, SEVENTH, 97);
}

#[test]
fn every_hand_is_still_on_a_ridge_and_gets_no_energy_of_it() {
    every_hand_is_still(Ground::Ridge, SEVENTH, 97);
}

#[test]
fn every_hand_is_still_at_an_edge_and_gets_no_energy_of_it() {
    every_hand_is_still(Ground::Edge, SEVENTH, 97);
}

#[test]
#[ignore = "long: 2,025 runs"]
fn every_hand_of_all_runs_is_still_on_every_ground() {
    for ground in [Ground::Rough, Ground::Ridge, Ground::Edge] {
        every_hand_is_still(ground, 1, 675);
    }
}

fn some(stiffness: f64, ground: Ground, path: Path) -> impl Iterator<Item = ReliefRun> {
    let runs = relief_grid(path).into_iter();
    runs.filter(move |it| (it.run.stiffness, it.ground, it.friction) == (stiffness, ground, 0.0))
}

/// The seeded faults: a force sent over a network shakes a fingertip here too, and a servo without force is detected.
#[test]
fn a_force_from_afar_and_none_are_found_out() {
    for ground in [Ground::Rough, Ground::Ridge, Ground::Edge] {
        let sent =
            went(some(500.0, ground, Path::Sent).filter(|it| it.run.hand == Hand::FINGERTIP));
        assert!(sent.iter().all(|(run, it)| !run.is_good(it)), "{ground:?}");
        let nothing = some(300.0, ground, Path::Nothing);
        let still = went(nothing.filter(|it| it.run.motion == Motion::Still));
        assert!(still.len() > 20);
        for (run, outcome) in &still {
            assert!(!run.is_good(outcome), "{run:?}: {outcome:?}");
        }
    }
}

/// The other seeded fault: a force that is not tilted by the slope, without the friction of the device that would hide it.
#[test]
fn an_upright_force_on_relief_gives_energy() {
    for ground in [Ground::Rough, Ground::Ridge, Ground::Edge] {
        let without_friction = |tilt| {
            let runs = some(300.0, ground, Path::Servo).map(move |it| ReliefRun {
                tilt,
                coulomb_n: 0.0,
                ..it
            });
            let still = runs.filter(|it| it.run.motion == Motion::Still);
            let all = went(still);
            most(&all, |it| it.rise_j)
        };
        let [tilted_j, upright_j] = [Tilt::BySlope, Tilt::Upright].map(without_friction);
        println!(
            "{ground:?}: tilted {:.2} µJ, upright {:.0} µJ",
            tilted_j * 1e6,
            upright_j * 1e6
        );
        assert!(tilted_j <= NO_ENERGY_J && upright_j > 10.0 * NO_ENERGY_J);
    }
}
