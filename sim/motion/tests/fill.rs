//! Outlines filled by example, and measures of examples.

mod hands;

use std::f64::consts::PI;

use glam::DVec2;
use hands::{HEAD_M, along, hatching, pen, six_dof};
use maulstick_motion::example::{Kind, Pass};
use maulstick_motion::{Example, Fill, MotionError, Outline, TakeSample, filled, strokes};
use maulstick_num::{cos, sin};
use maulstick_types::stylus::StylusSample;

const FILL: Fill = Fill {
    seed: 1,
    clearance_m: 0.002,
    head_m: HEAD_M,
};

/// A square of 80 mm with a slanted corner, and a hole in it.
fn outline() -> Outline {
    let outer = vec![
        [-0.04, -0.04],
        [0.04, -0.04],
        [0.04, 0.02],
        [0.02, 0.04],
        [-0.04, 0.04],
    ];
    let hole = vec![[-0.02, -0.01], [0.0, -0.015], [-0.005, 0.01]];
    Outline::new(&[outer, hole]).expect("an area")
}

fn pass(motion: &[TakeSample]) -> Pass {
    let mut passes = Example::of(motion, 0.004, HEAD_M).expect("measured").passes;
    assert_eq!(passes.len(), 1);
    passes.remove(0)
}

/// Dabs on a grid, somewhat beside their places.
fn dabs(hand: impl Fn([f64; 2], f64) -> StylusSample) -> Vec<TakeSample> {
    let places = (0..5).flat_map(|y| (0..6).map(move |x| [x, y]));
    let ways: Vec<[[f64; 2]; 2]> = places
        .map(|[x, y]| {
            let (x, y) = (f64::from(x), f64::from(y));
            let at = [
                0.006 * (x + 0.1 * sin(7.0 * x + 3.0 * y)),
                0.006 * (y + 0.1 * cos(5.0 * x - 4.0 * y)),
            ];
            [at, [at[0] + 0.0004, at[1]]]
        })
        .collect();
    along(&ways, 0.0, hand)
}

#[test]
fn spacing_direction_and_order_of_hatching_are_found_whatever_its_turn() {
    for turn in [0.0, 0.4, 1.2, -0.7] {
        let found = pass(&hatching(8, 0.03, 0.0035, turn));
        assert_eq!(found.kind, Kind::Hatches);
        assert!(
            (found.spacing_m - 0.0035).abs() < 2e-4,
            "{turn}: {}",
            found.spacing_m
        );
        let along = found.frame.to_desk(DVec2::X);
        let off = along.perp_dot(DVec2::new(cos(turn), sin(turn))).abs();
        assert!(off < 0.03, "{turn}: {along}");
        assert!(found.gap_m.is_none() && found.spread_m < 0.001, "{found:?}");
        // In either direction the hand continues as before.
        let forth = along.dot(DVec2::new(cos(turn), sin(turn))) > 0.0;
        assert!(found.marks.iter().all(|mark| mark.forth == forth));
        assert_eq!(found.upward, forth);
    }
}

#[test]
fn dabs_and_rows_of_short_strokes_and_crossed_hatching_are_told_apart() {
    let found = pass(&dabs(pen));
    assert_eq!(found.kind, Kind::Dabs);
    assert!(
        (found.spacing_m - 0.006).abs() < 4e-4,
        "{}",
        found.spacing_m
    );
    assert!(
        (1e-4..1.2e-3).contains(&found.spread_m),
        "{}",
        found.spread_m
    );
    let row = |y: i32| (0..4).map(move |x| [x, y]);
    let ways: Vec<[[f64; 2]; 2]> = (0..4)
        .flat_map(row)
        .map(|[x, y]| {
            let at = [0.012 * f64::from(x), 0.004 * f64::from(y)];
            [at, [at[0] + 0.009, at[1]]]
        })
        .collect();
    let short = pass(&along(&ways, 0.0, pen));
    assert_eq!(short.kind, Kind::Hatches);
    let gap = short.gap_m.expect("rows of several");
    assert!(
        (gap - 0.003).abs() < 2e-4 && (short.spacing_m - 0.004).abs() < 2e-4,
        "{short:?}"
    );
    let crossed = [hatching(5, 0.03, 0.004, 0.0), hatching(5, 0.03, 0.004, 1.3)];
    let crossed = maulstick_motion::joined(&[&crossed[0], &crossed[1]], 0.3).expect("joined");
    let passes = Example::of(&crossed, 0.004, HEAD_M)
        .expect("measured")
        .passes;
    assert_eq!(
        passes
            .iter()
            .map(|pass| pass.marks.len())
            .collect::<Vec<_>>(),
        [5, 5]
    );
}

/// Distance of the deepest touch from the edge, below 0 outside: by walking around each point.
fn least_clearance(motion: &[TakeSample], outline: &Outline) -> f64 {
    let touching = motion.iter().filter(|taken| taken.press(HEAD_M) > 0.0);
    let clear = |taken: &TakeSample| {
        let [x, y, _] = taken.point(HEAD_M);
        let at = DVec2::new(x, y);
        let around = |radius: f64| {
            (0..16).all(|step| {
                let angle = PI * f64::from(step) / 8.0;
                outline.holds(at + DVec2::new(cos(angle), sin(angle)) * radius, 0.0)
            })
        };
        let radii = (0..40).map(|step| f64::from(step) * 1e-4);
        radii
            .take_while(|radius| around(*radius))
            .last()
            .unwrap_or(-1.0)
    };
    touching.map(clear).fold(f64::INFINITY, f64::min)
}

#[test]
fn strokes_stay_within_the_outline_by_half_the_width_of_the_brush() {
    let hand = |at: [f64; 2], pressure: f64| six_dof([at[0], at[1], 0.003 - 0.01 * pressure]);
    let examples = [
        ("hatching", hatching(8, 0.03, 0.0035, 0.4)),
        ("dabs", dabs(pen)),
        ("dabs of a 6-DOF stylus", dabs(hand)),
    ];
    for (what, example) in examples {
        let motion = filled(&example, &outline(), &FILL).expect("filled");
        let clear = least_clearance(&motion, &outline());
        assert!(clear >= 0.0018, "{what}: {clear}");
        assert!(
            motion
                .windows(2)
                .all(|pair| pair[0].time_ns < pair[1].time_ns)
        );
        assert!(motion.iter().all(|taken| taken.sample.fault().is_none()));
        assert!(motion[0].sample.in_air() && motion[motion.len() - 1].sample.in_air());
        let wider = Fill {
            clearance_m: 0.001,
            ..FILL
        };
        let closer = filled(&example, &outline(), &wider).expect("filled");
        assert!(
            least_clearance(&closer, &outline()) < 0.0018,
            "{what}: a fault passes"
        );
    }
}

#[test]
fn the_area_is_covered_as_densely_as_the_example() {
    let area = 0.08 * 0.08 - 0.5 * 0.02 * 0.02 - 0.5 * (0.02 * 0.025 - 0.015 * 0.005);
    // Without clearance, for the density is that of the whole area.
    let bare = Fill {
        clearance_m: 0.0,
        ..FILL
    };
    let hatched = filled(&hatching(8, 0.03, 0.0035, 0.4), &outline(), &bare).expect("filled");
    let length: f64 = strokes(&hatched, HEAD_M)
        .iter()
        .map(|stroke| {
            let path = stroke.path(&hatched, HEAD_M);
            let ends = [path[0], path[path.len() - 1]];
            DVec2::new(ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]).length()
        })
        .sum();
    let density = length * 0.0035 / area;
    assert!((0.9..1.25).contains(&density), "hatching: {density}");
    let dabbed = filled(&dabs(pen), &outline(), &bare).expect("filled");
    let density = strokes(&dabbed, HEAD_M).len() as f64 * 0.006 * 0.006 / area;
    assert!((0.85..1.15).contains(&density), "dabs: {density}");
}

#[test]
fn each_stroke_has_the_pressures_of_one_of_the_example() {
    let example = hatching(8, 0.03, 0.0035, 0.4);
    let pressures = |motion: &[TakeSample]| -> Vec<Vec<u64>> {
        let strokes = strokes(motion, HEAD_M);
        let of = |stroke: &maulstick_motion::Stroke| {
            let path = stroke.path(motion, HEAD_M).into_iter();
            path.map(|[_, _, press]| press.to_bits()).collect()
        };
        strokes.iter().map(of).collect()
    };
    let known = pressures(&example);
    let laid = pressures(&filled(&example, &outline(), &FILL).expect("filled"));
    assert!(laid.len() > 20, "{}", laid.len());
    assert!(laid.iter().all(|own| known.contains(own)));
}

#[test]
fn a_seed_always_gives_the_same_and_another_one_another() {
    let example = hatching(8, 0.03, 0.0035, 0.4);
    let of = |seed| filled(&example, &outline(), &Fill { seed, ..FILL }).expect("filled");
    assert_eq!(of(1), of(1));
    assert_ne!(of(1), of(2));
}

#[test]
fn what_cannot_be_filled_is_said() {
    let example = hatching(8, 0.03, 0.0035, 0.0);
    let wide = Fill {
        clearance_m: 0.05,
        ..FILL
    };
    let narrow = filled(&example, &outline(), &wide).expect_err("no room");
    assert_eq!(narrow, MotionError::NoRoom { width_mm: 100.0 });
    let square = |half: f64| vec![[-half, -half], [half, -half], [half, half], [-half, half]];
    let field = Outline::new(&[square(9.0)]).expect("an area");
    let many = filled(&example, &field, &FILL).expect_err("too many");
    assert!(matches!(many, MotionError::TooMany { .. }), "{many:?}");
    let air: Vec<TakeSample> = example
        .iter()
        .filter(|taken| taken.sample.in_air())
        .cloned()
        .collect();
    assert_eq!(filled(&air, &outline(), &FILL), Err(MotionError::NoTouch));
    let one = hatching(1, 0.03, 0.0035, 0.0);
    let bare = Fill {
        clearance_m: 0.0,
        ..FILL
    };
    assert_eq!(filled(&one, &outline(), &bare), Err(MotionError::NoSpacing));
    let spaced = filled(&one, &outline(), &FILL).expect("by the width of the brush");
    assert!(strokes(&spaced, HEAD_M).len() > 20);
}
