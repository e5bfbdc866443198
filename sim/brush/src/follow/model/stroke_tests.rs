//! Strokes of a press, and of a pointer that leaps.

use maulstick_types::brush::{Solve, solve_flags};

use super::tests::{DEVICE, MS, brush, pen, scene};

#[test]
fn a_press_that_touches_nothing_for_long_and_then_again_is_one_stroke() {
    let drawn = |lifts: bool| {
        let mut model = brush();
        let mut strokes = Vec::new();
        for step in 0..120_u32 {
            // .6 s of it so lightly that the head is clear of the canvas.
            let pressure = match step {
                60..90 if lifts => 0.0,
                40..115 => 1e-6,
                _ => 0.5,
            };
            let ns = (1000 + 8 * u64::from(step)) * MS;
            for solve in model.follow(DEVICE, ns, &pen(1e-4 * f64::from(step), 0.0, pressure)) {
                strokes.push(solve.stroke);
            }
        }
        strokes.dedup();
        strokes
    };
    let (stays, lifts) = (drawn(false), drawn(true));
    assert!(stays.contains(&0), "it touches all along");
    assert_eq!(stays.iter().max(), Some(&1), "{stays:?}");
    assert_eq!(lifts.last(), Some(&2), "{lifts:?}");
}

/// The solves of a leap of a touching pen, and how often its brush was too fast.
fn leapt(way_m: f64, after_ms: u64, zoom: f64) -> (Vec<Solve>, u64) {
    let mut model = brush();
    let mut scene = scene();
    scene.surfaces[0].zoom = zoom;
    model.set_scene(&scene);
    let mut solves = Vec::new();
    for (ms, x) in [(1000, 0.0), (1008, 1e-3), (1008 + after_ms, way_m)] {
        solves = model.follow(DEVICE, ms * MS, &pen(x, 0.0, 0.4));
    }
    (solves, model.too_fast())
}

#[test]
fn a_leap_is_followed_all_the_way_in_a_bounded_number_of_solves() {
    let (solves, _) = leapt(0.3, 8, 1.0);
    let places = solves.iter().map(|solve| solve.pose.position_m[0]);
    let places: Vec<f64> = places.collect();
    let widest = places.windows(2).map(|two| (two[1] - two[0]).abs());
    assert!(widest.fold(0.0, f64::max) < 2e-3, "{places:?}");
    let (solves, too_fast) = leapt(5.9, 290, 0.01);
    let many = solves.len();
    assert!(many > 1000 && many <= 4 * 1024 + 1, "{many} solves");
    assert_eq!(too_fast, 0);
}

#[test]
fn a_hand_that_is_too_fast_begins_the_brush_anew_at_its_place() {
    let restarts = |way_m: f64, after_ms: u64| {
        let (solves, too_fast) = leapt(way_m, after_ms, 1.0);
        let restarted = solves[0].flags & solve_flags::RESTARTED != 0;
        assert_eq!(restarted, too_fast == 1, "{way_m} m");
        assert!(!restarted || solves.len() == 1, "{} solves", solves.len());
        restarted
    };
    assert!(restarts(0.6, 8) && restarts(9.0, 290));
    // As in the takes of public reports.
    assert!(!restarts(0.05, 8) && !restarts(0.125, 8));
}

/// Samples of an ordinary stroke that come two hundred times as fast, from the far end of a loop too.
#[test]
fn a_flood_of_samples_is_no_more_work_than_the_fastest_hand() {
    let mut model = brush();
    let (mut solves, mut ns) = (0, 1000 * MS);
    const SAMPLES: u64 = 4000;
    for number in 0..SAMPLES {
        ns += MS / 200;
        let x = 2e-4 * (number % 500) as f64;
        solves += model.follow(DEVICE, ns, &pen(x, 0.0, 0.4)).len();
    }
    // 20 m/s over 20 ms and a frame's .32 m: .72 m in steps of .175 mm, some halved twice; and one solve a sample.
    let most = 4 * (0.72 / 0.175e-3) as usize + SAMPLES as usize;
    assert!(solves <= most, "{solves} solves");
    assert!(model.too_fast() > 100, "{}", model.too_fast());
    let after = model.follow(DEVICE, ns + 8 * MS, &pen(0.0, 0.0, 0.0));
    let lifted = after.last().is_some_and(|last| last.contacts.is_empty());
    assert!(lifted, "it is lifted");
    let mut painted = Vec::new();
    for ms in 0..20 {
        let x = 1e-4 * ms as f64;
        painted = model.follow(DEVICE, ns + (16 + ms) * MS, &pen(x, 0.0, 0.4));
    }
    assert!(painted[0].flags & solve_flags::RESTARTED == 0 && !painted[0].contacts.is_empty());
}
