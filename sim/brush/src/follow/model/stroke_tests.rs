//! Strokes of a press, and of a pointer that leaps.

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

#[test]
fn a_leap_is_followed_all_the_way_in_a_bounded_number_of_solves() {
    let leapt = |way_m: f64, zoom: f64| {
        let mut model = brush();
        let mut scene = scene();
        scene.surfaces[0].zoom = zoom;
        model.set_scene(&scene);
        let mut solves = Vec::new();
        for (ms, x) in [(1000, 0.0), (1008, 1e-3), (1016, way_m)] {
            solves = model.follow(DEVICE, ms * MS, &pen(x, 0.0, 0.4));
        }
        solves
    };
    let solves = leapt(0.3, 1.0);
    let places = solves.iter().map(|solve| solve.pose.position_m[0]);
    let places: Vec<f64> = places.collect();
    let widest = places.windows(2).map(|two| (two[1] - two[0]).abs());
    assert!(widest.fold(0.0, f64::max) < 2e-3, "{places:?}");
    let many = leapt(10.0, 0.01).len();
    assert!(many > 1000 && many <= 4 * 1024 + 1, "{many} solves");
}
