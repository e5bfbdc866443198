//! § 4.3: whole strokes of all stroking algorithms.

use maulstick_brush::HeadPose;
use maulstick_canvas::quantum::{CELL_MAX, SLOTS};
use maulstick_dab::dither::Dither;
use maulstick_dab::stroke::{Course, SLACK, Stroker, bend, between, places};
use maulstick_model::interface::{Handling, Sweep, Transfer};
use maulstick_num::fork_join::with_threads;

use crate::scene::{Bench, SIDE};

const STROKERS: [Stroker; 3] = [Stroker::Faster, Stroker::Better, Stroker::Spline];

/// A straight path of `cells` cells, in steps of `step` cells.
fn straight(bench: &Bench, cells: usize, step: f64) -> Vec<HeadPose> {
    let count = (cells as f64 / step) as usize;
    let place = |i: usize| [60.0 + step * i as f64, 100.0 + 0.2 * step * i as f64];
    (0..=count).map(|i| bench.pose(place(i))).collect()
}

/// A quarter of a circle of 50 cells radius in `steps` steps.
fn arc(bench: &Bench, steps: usize) -> Vec<HeadPose> {
    let place = |i: usize| {
        let angle = 1.5 * i as f64 / steps as f64;
        let (sine, cosine) = maulstick_num::sin_cos(angle);
        [60.0 + 50.0 * sine, 60.0 + 50.0 * cosine]
    };
    (0..=steps).map(|i| bench.pose(place(i))).collect()
}

#[test]
fn strokes_create_and_lose_no_quantum() {
    for stroker in STROKERS {
        for (film, step) in [
            (0.0, 1.0),
            (90_000.0, 1.0),
            (90_000.0, 4.0),
            (CELL_MAX as f32, 3.0),
        ] {
            let mut bench = Bench::new(stroker);
            bench.fill(7, film);
            let (before, load) = (bench.counts(), bench.load.total());
            bench.stroke(&straight(&bench, 60, step), true);
            assert_eq!(bench.counts(), before, "{stroker:?} {film} {step}");
            assert_ne!(bench.load.total(), load, "{stroker:?}: nothing happened");
            assert!(
                film == 0.0 || bench.load.counts()[7] > 0,
                "{stroker:?} takes paint up"
            );
            assert_eq!(*bench.reports.from_nowhere, [0; SLOTS]);
        }
    }
}

#[test]
fn what_modes_give_is_reported() {
    for (transfer, lasting) in [
        (Transfer::Sponge, false),
        (Transfer::Paint, true),
        (Transfer::Marker { flow: 1e-3 }, false),
    ] {
        let mut bench = Bench::new(Stroker::Better);
        bench.handling = Handling {
            transfer,
            ..Handling::default()
        };
        bench.lasting = lasting;
        bench.fill(7, 90_000.0);
        let before = bench.counts();
        bench.stroke(&straight(&bench, 30, 1.0), true);
        let after = bench.counts();
        let came: Vec<i64> = (0..SLOTS)
            .map(|slot| after[slot] as i64 - before[slot] as i64)
            .collect();
        assert_eq!(
            came,
            bench.reports.from_nowhere.to_vec(),
            "{transfer:?} {lasting}"
        );
        let counted = transfer == Transfer::Sponge || lasting;
        assert_eq!(
            came.iter().any(|count| *count != 0),
            counted,
            "{transfer:?}"
        );
    }
}

#[test]
fn a_resting_brush_moves_nothing() {
    let mut bench = Bench::new(Stroker::Better);
    bench.fill(7, 90_000.0);
    let before = bench.films();
    let pose = bench.pose([100.0, 100.0]);
    bench.stroke(&[pose.clone(), pose], true);
    assert!(bench.films() == before);
}

#[test]
fn what_else_a_window_holds_does_not_matter() {
    for stroker in STROKERS {
        let films = [true, false].map(|narrow| {
            let mut bench = Bench::new(stroker);
            bench.fill(7, 50_000.0);
            bench.stroke(&straight(&bench, 50, 2.0), narrow);
            bench.films()
        });
        assert!(films[0] == films[1], "{stroker:?}");
    }
}

#[test]
fn threads_change_no_byte() {
    for stroker in STROKERS {
        let painted = |threads: usize, seed: u64| {
            let mut bench = Bench::new(stroker);
            bench.load.disorder(seed);
            bench.fill(7, 50_000.0);
            let way = straight(&bench, 50, 3.0);
            with_threads(threads, || bench.stroke(&way, true));
            (bench.films(), bench.load)
        };
        let alone = painted(1, 2);
        for threads in [2, 3, 8] {
            assert!(
                painted(threads, 2) == alone,
                "{stroker:?}, {threads} threads"
            );
        }
        assert!(painted(1, 3) != alone, "a fault passes");
    }
}

/// A head that deforms is redrawn as often as keeps it within the slack; a rigid one is drawn once.
#[test]
fn one_drawing_serves_while_all_of_the_head_goes_the_same_way() {
    let bench = Bench::new(Stroker::Better);
    let from = bench.pose([60.0, 60.0]);
    let to = bench.pose([72.0, 63.0]);
    let mut opened = to.clone();
    let low: Vec<usize> = (0..to.z.len()).filter(|i| to.z[*i] < 3.0).collect();
    for i in &low {
        opened.x[*i] += 0.3 * (to.x[*i] - 72.0);
    }
    for (to, at_least, most) in [(&to, 1, 1), (&opened, 2, 12)] {
        let sweep = Sweep {
            before: None,
            from: &from,
            to,
        };
        let runs: Vec<_> = Course::of(&sweep, None).runs(12).collect();
        assert!((at_least..=most).contains(&runs.len()), "{}", runs.len());
        let parts: usize = runs.iter().map(|run| run.shifts.len()).sum();
        assert_eq!(parts, 12);
        // Place of each point in each part, and in the run's drawing.
        let mut worst = [0.0f32; 2];
        let mut part = 0;
        for run in &runs {
            let middle = 0.5 * (run.part[0] + run.part[1]);
            for shift in &run.shifts {
                let t = (part as f32 + 0.5) / 12.0;
                for i in &low {
                    let at = |t: f32| {
                        [
                            from.x[*i] + t * (to.x[*i] - from.x[*i]),
                            from.y[*i] + t * (to.y[*i] - from.y[*i]),
                        ]
                    };
                    let (own, drawn) = (at(t), at(middle));
                    for axis in 0..2 {
                        let off = (drawn[axis] + shift[axis] as f32 - own[axis]).abs();
                        worst[0] = worst[0].max(off);
                        worst[1] = worst[1].max((drawn[axis] - own[axis]).abs());
                    }
                }
                part += 1;
            }
        }
        // The slack, and half a cell of rounding.
        assert!(worst[0] <= SLACK + 0.51, "{worst:?}");
        assert!(
            worst[1] > SLACK + 0.51,
            "a drawing that stays passes: {worst:?}"
        );
    }
}

/// Difference of paint on cells, in thousandths of the paint of a finely stepped stroke.
fn off(films: &[f32], fine: &[f32]) -> f64 {
    let pairs = films.iter().zip(fine);
    let off: f64 = pairs.map(|(a, b)| f64::from((a - b).abs())).sum();
    let all: f64 = fine.iter().map(|film| f64::from(*film)).sum();
    off / all
}

fn painted(stroker: Stroker, steps: usize) -> Vec<f32> {
    let mut bench = Bench::new(stroker);
    bench.stroke(&arc(&bench, steps), true);
    bench.films()
}

/// On a curve with long steps the spline is closest to a stroke with short ones.
#[test]
fn long_steps_paint_what_short_ones_do_the_better_the_closer_the_way_is_followed() {
    let fine = painted(Stroker::Better, 80);
    let [faster, better, spline] = STROKERS.map(|stroker| off(&painted(stroker, 5), &fine));
    println!("off: faster {faster:.3}, better {better:.3}, spline {spline:.3}");
    assert!(
        spline < better && better < faster,
        "{faster} {better} {spline}"
    );
    let again = off(&painted(Stroker::Better, 40), &fine);
    println!("off in steps of twice the length: {again:.3}");
    assert!(again < 0.5 * better);
}

#[test]
fn a_stroke_has_no_gap() {
    for stroker in STROKERS {
        let mut bench = Bench::new(stroker);
        bench.stroke(&straight(&bench, 60, 12.0), true);
        let films = bench.films();
        let column = |x: usize| -> f64 {
            let cells = (0..SIDE as usize).map(|y| y * SIDE as usize + x);
            cells.map(|cell| f64::from(films[cell])).sum()
        };
        let painted: Vec<f64> = (0..SIDE as usize).map(column).collect();
        let first = painted.iter().position(|sum| *sum > 0.0).expect("painted");
        let last = painted.iter().rposition(|sum| *sum > 0.0).expect("painted");
        let gap = painted[first..last].contains(&0.0);
        assert!(last > first + 50 && !gap, "{stroker:?} {first} {last}");
    }
}

#[test]
fn a_parabola_goes_through_all_three_heads() {
    let bench = Bench::new(Stroker::Spline);
    let way = [[50.0, 60.0], [53.0, 60.5], [57.0, 62.0]].map(|place| bench.pose(place));
    let sweep = Sweep {
        before: Some(&way[0]),
        from: &way[1],
        to: &way[2],
    };
    let (before, ago) = bend(&sweep).expect("it moves");
    let mut pose = HeadPose::default();
    for (t, expected) in [(-ago, &way[0]), (0.0, &way[1]), (1.0, &way[2])] {
        between(&sweep, Some((before, ago)), t, &mut pose);
        let off = pose.x.iter().zip(&expected.x).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f32::max) < 1e-3, "at {t}");
    }
    between(&sweep, None, -ago, &mut pose);
    assert!(
        (pose.x[0] - way[0].x[0]).abs() > 0.1 || (pose.y[0] - way[0].y[0]).abs() > 0.1,
        "a chord would pass"
    );
}

#[test]
fn places_end_where_the_step_ends_and_leave_no_cell_out() {
    for way in [[0.0, 0.0], [0.4, -0.3], [5.2, 1.0], [-3.7, -8.9]] {
        let places: Vec<[i64; 2]> = places(way).collect();
        assert_eq!(places.last(), Some(&[0, 0]), "{way:?}");
        let near = |pair: &[[i64; 2]]| (0..2).all(|i| (pair[1][i] - pair[0][i]).abs() <= 1);
        assert!(places.windows(2).all(near), "{way:?} {places:?}");
    }
}

#[test]
fn another_seed_rounds_otherwise() {
    let at = |seed| Dither::new(seed, 3).at([9, 9]);
    assert!(at(1) != at(2) && at(1) == at(1));
}
