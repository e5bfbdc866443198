//! All forces at once: a hand paints along a guide, through thick paint, over relief, and is pulled across the guide and kicked.
//!
//! Hands, grounds, motions of the plane, and time constant and rate of the film are each combined with each; of the
//! other axes a run has one of the worst values, drawn by a seed. Criteria are those of the other parts of the grid.
//! Sticking bristles store up to (μ_s·f_n)²/2k, which the ledger lacks, so with them the energy is judged from the
//! beginning.

use glam::DVec3;

use super::fluid::{Film, Telling};
use super::link::random;
use super::relief::{COULOMB_N, Ground, ReliefOutcome, ReliefRun, Tilt};
use super::{GuideLine, HANDS, Motion, NO_ENERGY_J, Path, Run};

/// Drag of the film, as much as there may be, N·s/m.
const DRAG_N_S_M: f64 = 0.8;
/// Friction, at rest half as much again.
const FRICTION: f64 = 0.2;

/// All runs, 324, by one path of the force and with a solver that sends forces.
#[must_use]
pub fn painting_grid(path: Path, telling: Telling) -> Vec<ReliefRun> {
    let tilted = DVec3::new(1.0, 0.0, 1.0).normalize();
    let mut state = 1;
    let mut one_of = |count: usize| (random(&mut state) * count as f64) as usize;
    let mut runs = Vec::new();
    for hand in HANDS {
        for ground in [Ground::Rough, Ground::Ridge, Ground::Edge] {
            for motion in [
                Motion::Still,
                Motion::Tilting,
                Motion::Sliding,
                Motion::Stiffening,
            ] {
                for carried_s in [0.0, 0.05, 0.2] {
                    for rate_hz in [15.0, 30.0, 60.0] {
                        let normal = [DVec3::Z, tilted][one_of(2)];
                        let guide = GuideLine::strongest(normal, [0.0, 0.8][one_of(2)]);
                        let run = Run {
                            hand,
                            stiffness: [300.0, 500.0, 1000.0][one_of(3)],
                            rate_hz: 30.0,
                            jitter: 0.2,
                            motion,
                            guide: Some(guide),
                            path,
                        };
                        let film = Film {
                            drag: DRAG_N_S_M,
                            carried_s,
                            rate_hz,
                            jitter: 0.5,
                            telling,
                        };
                        runs.push(ReliefRun {
                            run,
                            ground,
                            tilt: Tilt::BySlope,
                            friction: [0.0, 0.0, FRICTION][one_of(3)],
                            coulomb_n: COULOMB_N,
                            film: Some(film),
                        });
                    }
                }
            }
        }
    }
    runs
}

/// True if the hand is still and feels its wall, gets no energy without a source, and the force stays within `most_n`,
/// N, and `slew_n_s`, N/s.
#[must_use]
pub fn is_good(run: &ReliefRun, outcome: &ReliefOutcome, most_n: f64, slew_n_s: f64) -> bool {
    run.is_good(outcome)
        && (run.friction > 0.0 || outcome.rise_j <= NO_ENERGY_J)
        && outcome.most_n <= most_n * (1.0 + 1e-9)
        && outcome.slew_n_s <= slew_n_s * (1.0 + 1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::BOUND_N_M;
    use crate::tests::SEVENTH;
    use maulstick_haptics::plant::Hand;

    /// Bounds of the device, N and N/s: literals, because the servo's own are under test.
    const MOST_N: f64 = 3.3;
    const MOST_SLEW_N_S: f64 = 400.0;

    fn went(runs: impl IntoIterator<Item = ReliefRun>) -> Vec<(ReliefRun, ReliefOutcome)> {
        let go = |run: ReliefRun| (run, run.go().expect("a wall, a guide and a film"));
        runs.into_iter().map(go).collect()
    }

    fn bad(all: &[(ReliefRun, ReliefOutcome)]) -> Vec<&(ReliefRun, ReliefOutcome)> {
        let is_bad =
            |(run, it): &&(ReliefRun, ReliefOutcome)| !is_good(run, it, MOST_N, MOST_SLEW_N_S);
        all.iter().filter(is_bad).collect()
    }

    /// Goes through the grid in strides, of which as many runs must be good.
    fn every_hand_is_still(stride: usize, count: usize) {
        let runs = painting_grid(Path::Servo, Telling::True).into_iter();
        let all = went(runs.step_by(stride));
        let bad = bad(&all);
        for (run, outcome) in bad.iter().take(10) {
            println!("{run:?}: {outcome:?}");
        }
        let most = |of: fn(&ReliefOutcome) -> f64| {
            let all = all.iter().map(|(_, it)| of(it));
            all.fold(0.0, f64::max)
        };
        let smooth = all.iter().filter(|(run, _)| run.friction == 0.0);
        let soft = all.iter().filter(|(run, _)| run.run.stiffness < BOUND_N_M);
        println!(
            "{} runs, {} bad: wobble {:.3} mm, energy {:.3} µJ, {:.3} µJ from some time on, force off by {:.2} %, {:.2} N and {:.0} N/s at most",
            all.len(),
            bad.len(),
            most(|it| it.wobble_m) * 1e3,
            most(|it| it.net_j) * 1e6,
            smooth.map(|(_, it)| it.rise_j).fold(0.0, f64::max) * 1e6,
            soft.map(|(_, it)| (it.share - 1.0).abs())
                .fold(0.0, f64::max)
                * 1e2,
            most(|it| it.most_n),
            most(|it| it.slew_n_s),
        );
        assert_eq!((all.len(), bad.len()), (count, 0));
    }

    #[test]
    fn a_hand_that_paints_along_a_guide_over_relief_is_still_and_gets_no_energy() {
        every_hand_is_still(SEVENTH, 47);
    }

    #[test]
    #[ignore = "long: 324 runs"]
    fn every_hand_of_all_runs_that_paints_along_a_guide_is_still() {
        every_hand_is_still(1, 324);
    }

    /// The seeded faults: forces sent 60 times a second shake every fingertip, a force of paint held without its
    /// Jacobian adds energy, and a servo without force is not felt.
    #[test]
    fn a_force_from_afar_one_that_is_held_and_none_are_found_out() {
        let sent = painting_grid(Path::Sent, Telling::True).into_iter();
        let sent = sent.filter(|it| it.run.hand == Hand::FINGERTIP);
        let sent = went(sent.step_by(SEVENTH));
        assert_eq!(bad(&sent).len(), sent.len());
        let standing = |it: &ReliefRun| it.film.is_some_and(|film| film.carried_s == 0.0);
        let held = painting_grid(Path::Servo, Telling::Held).into_iter();
        let held = went(held.filter(standing));
        println!(
            "{} of {} are bad with a force that is held",
            bad(&held).len(),
            held.len()
        );
        assert!(4 * bad(&held).len() > held.len());
        let nothing = painting_grid(Path::Nothing, Telling::True).into_iter();
        let nothing = went(nothing.filter(|it| it.run.stiffness < BOUND_N_M && standing(it)));
        assert_eq!(bad(&nothing).len(), nothing.len());
    }
}
