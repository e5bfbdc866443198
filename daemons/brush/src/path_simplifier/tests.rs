//! Samples that are joined, dropped and begun anew.

use proptest::prelude::*;

use super::*;

impl PathSimplifier {
    fn take(&mut self) -> Vec<Waiting> {
        std::iter::from_fn(|| self.pop().map(|(_, waiting)| waiting)).collect()
    }
}

fn sample(seq: u64, x: f64, y: f64, pressure: f64) -> Waiting {
    let pose = StylusPose::Contact {
        point_m: [x, y, 0.0],
        tilt_rad: [0.0; 2],
        twist_rad: 0.0,
        pressure,
    };
    Waiting {
        origin: Origin {
            source: 1,
            epoch: 1,
        },
        seq,
        event_ns: seq * 1_000_000,
        place: if pressure > 0.0 {
            Place::Surface
        } else {
            Place::Air
        },
        sample: StylusSample {
            pose,
            in_range: true,
            ..StylusSample::away()
        },
    }
}

#[test]
fn a_straight_line_becomes_its_ends() {
    let mut backlog = PathSimplifier::new(0.025);
    (0..40).for_each(|i| assert!(backlog.push(sample(i, 1e-4 * i as f64, 0.0, 0.5))));
    let seqs: Vec<u64> = backlog.take().iter().map(|w| w.seq).collect();
    assert_eq!(seqs, vec![0, 39]);
}

#[test]
fn in_the_air_the_newest_is_enough_but_a_touch_is_kept() {
    let mut backlog = PathSimplifier::new(0.025);
    for (seq, pressure) in [0.0, 0.0, 0.3, 0.0, 0.0].into_iter().enumerate() {
        backlog.push(sample(seq as u64, 0.01 * seq as f64, 0.0, pressure));
    }
    let seqs: Vec<u64> = backlog.take().iter().map(|w| w.seq).collect();
    assert_eq!(seqs, vec![1, 2, 4]);
}

/// A 6-DOF stylus whose ferrule stays and whose tip swings.
fn swung(seq: u64, angle: f64) -> Waiting {
    let (sin, cos) = (libm::sin(0.5 * angle), libm::cos(0.5 * angle));
    let pose = StylusPose::Ferrule {
        pose: maulstick_types::Pose {
            position_m: [0.0, 0.0, 0.02],
            orientation: [sin, 0.0, 0.0, cos],
        },
    };
    let mut waiting = sample(seq, 0.0, 0.0, 1.0);
    waiting.sample.pose = pose;
    waiting
}

#[test]
fn a_brush_that_turns_on_the_spot_keeps_its_tips_path() {
    let mut backlog = PathSimplifier::new(0.025);
    // There and back: the chord of the ends is a point, far from the path.
    for (seq, angle) in [0.0, 0.1, 0.2, 0.1, 0.0].into_iter().enumerate() {
        backlog.push(swung(seq as u64, angle));
    }
    let kept = backlog.take();
    assert!(
        kept.iter().any(|w| w.seq == 2),
        "the tip's path is cut short"
    );
    (0..5).for_each(|seq| assert!(backlog.push(swung(seq, 0.1))));
    assert_eq!(backlog.take().len(), 2, "a brush that rests is joined");
}

#[test]
fn a_six_dof_stylus_in_the_air_is_joined() {
    let mut backlog = PathSimplifier::new(0.025);
    for seq in 0..5 {
        let mut waiting = swung(seq, 0.3 * (seq % 2) as f64);
        waiting.place = Place::Air;
        backlog.push(waiting);
    }
    assert_eq!(backlog.take().len(), 1);
}

#[test]
fn time_that_runs_backward_is_kept() {
    let mut backlog = PathSimplifier::new(0.025);
    for (seq, event_ns) in [(0, 5_000_000), (1, 6_000_000), (2, 1_000_000)] {
        let waiting = sample(seq, 1e-5 * seq as f64, 0.0, 0.5);
        backlog.push(Waiting {
            event_ns,
            ..waiting
        });
    }
    assert_eq!(backlog.take().len(), 3);
}

#[test]
fn time_that_stands_still_is_not_too_fast() {
    let mut backlog = PathSimplifier::new(0.025);
    for seq in 0..5 {
        let waiting = sample(seq, 1e-5 * seq as f64, 0.0, 0.5);
        backlog.push(Waiting {
            event_ns: 5_000_000,
            ..waiting
        });
    }
    assert_eq!(backlog.superseded(), 0);
    let kept = std::iter::from_fn(|| backlog.pop()).map(|(start, w)| (start, w.seq));
    let kept: Vec<(Start, u64)> = kept.collect();
    assert_eq!(kept, [(Start::GoesOn, 0), (Start::AfterLoss, 4)]);
}

#[test]
fn what_is_too_fast_leaves_its_newest_sample_and_the_rest_goes_on_from_there() {
    let mut backlog = PathSimplifier::new(0.025);
    // A metre each millisecond, there and back; then a hand of 1 m/s that turns off.
    for seq in 0..50 {
        assert!(backlog.push(sample(seq, (seq % 2) as f64, 0.0, 0.5)));
    }
    assert_eq!((backlog.len(), backlog.superseded()), (2, 48));
    for seq in 50..53 {
        let y = 1e-3 * (seq - 49) as f64;
        assert!(backlog.push(sample(seq, 1.0, y, 0.5)));
    }
    let kept = std::iter::from_fn(|| backlog.pop()).map(|(start, w)| (start, w.seq));
    let kept: Vec<(Start, u64)> = kept.collect();
    let [goes_on, anew] = [Start::GoesOn, Start::AfterLoss];
    assert_eq!(kept, [(goes_on, 0), (anew, 49), (goes_on, 52)]);
}

#[test]
fn a_flood_is_bounded_and_its_lift_is_kept() {
    let mut backlog = PathSimplifier::new(0.025);
    // 15 m/s, zigzag, for as long as it likes.
    let (mut room, mut seq) = (0, 0);
    while seq < 20_000 {
        let x = 0.015 * (seq % 2) as f64;
        room += usize::from(backlog.push(sample(seq, x, 1e-3 * (seq % 7) as f64, 0.5)));
        seq += 1;
    }
    assert!(backlog.len() <= MOST_KEPT && backlog.way_m <= LONGEST_M + 0.32);
    assert_eq!(backlog.dropped(), seq - room as u64);
    assert!(backlog.dropped() > 0);
    assert!(backlog.push(sample(seq, 0.0, 0.0, 0.0)), "the lift");
    let mut last = None;
    while let Some(popped) = backlog.pop() {
        last = Some(popped);
    }
    assert_eq!(
        last.map(|(start, w)| (start, w.seq)),
        Some((Start::AfterLoss, seq))
    );
    assert!(backlog.push(sample(seq + 1, 0.0, 0.0, 0.5)), "room again");
    assert_eq!(backlog.pop().map(|(start, _)| start), Some(Start::GoesOn));
}

proptest! {
    /// Whatever was drawn, no sample lies farther than half a cell from what is kept.
    #[test]
    fn the_path_is_kept(moves in prop::collection::vec((-5e-4..5e-4f64, -5e-4..5e-4f64), 2..80)) {
        let mut backlog = PathSimplifier::new(0.025);
        let (mut x, mut y) = (0.0, 0.0);
        let mut drawn = Vec::new();
        for (i, (dx, dy)) in moves.into_iter().enumerate() {
            (x, y) = (x + dx, y + dy);
            drawn.push([x, y, 0.0]);
            backlog.push(sample(i as u64, x, y, 0.5));
        }
        let kept: Vec<[f64; 3]> = backlog.take().iter().map(|w| points(&w.sample, 0.0)[0]).collect();
        prop_assert_eq!(kept.last(), drawn.last());
        for p in drawn {
            let nearest = kept.windows(2).map(|c| off_chord(p, c[0], c[1])).fold(f64::MAX, f64::min);
            prop_assert!(nearest <= TOLERANCE_M * TOLERANCE_M * (1.0 + 1e-9));
        }
    }
}
