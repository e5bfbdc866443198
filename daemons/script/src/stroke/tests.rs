use maulstick_types::stylus::StylusPose;

use super::*;

const SIZE_MM: [f64; 2] = [100.0, 80.0];

fn stroke(points: &[[f64; 3]]) -> Stroke {
    Stroke {
        points: points.to_vec(),
        lean_deg: 30.0,
        toward_deg: None,
        turn: Turn::Way(0.0),
        speed_mm_s: 100.0,
    }
}

/// Places from the lower left corner, mm, and what else is held: tilts, twist in degrees, pressure.
fn held(stroke: &Stroke) -> Vec<([f64; 2], [f64; 2], f64, f64)> {
    let samples = stroke.samples(SIZE_MM);
    let held = samples.iter().map(|(_, sample)| match sample.pose {
        StylusPose::Contact {
            point_m,
            tilt_rad,
            twist_rad,
            pressure,
        } => (
            [0, 1].map(|i| 1e3 * point_m[i] + 0.5 * SIZE_MM[i]),
            tilt_rad.map(f64::to_degrees),
            twist_rad.to_degrees(),
            pressure,
        ),
        StylusPose::Ferrule { .. } => panic!("a pen"),
    });
    held.collect()
}

#[test]
fn a_straight_stroke_goes_evenly_from_end_to_end_and_is_lifted() {
    let held = held(&stroke(&[[10.0, 20.0, 0.2], [60.0, 20.0, 0.6]]));
    // 50 mm at 100 mm/s, 250 samples a second.
    assert_eq!(held.len(), 125 + 2);
    for (i, (at, tilt, twist, pressure)) in held[..126].iter().enumerate() {
        let share = i as f64 / 125.0;
        assert!((at[0] - 10.0 - 50.0 * share).abs() < 1e-6, "{at:?}");
        assert!((at[1] - 20.0).abs() < 1e-9, "{at:?}");
        assert!((tilt[0] - 30.0).abs() < 1e-6 && tilt[1].abs() < 1e-6);
        assert!((twist + 90.0).abs() < 1e-6, "across the way: {twist}");
        assert!((pressure - 0.2 - 0.4 * share).abs() < 1e-6);
    }
    assert_eq!(held[126].3, 0.0);
}

#[test]
fn a_curve_goes_through_its_points_and_does_not_overshoot() {
    let points = [
        [10.0, 10.0, 0.5],
        [12.0, 10.0, 0.5],
        [60.0, 40.0, 0.5],
        [61.0, 70.0, 0.5],
    ];
    let held = held(&stroke(&points));
    for [x, y, _] in points {
        let near = held.iter().map(|(at, ..)| {
            let (dx, dy) = (at[0] - x, at[1] - y);
            (dx * dx + dy * dy).sqrt()
        });
        let nearest = near.fold(f64::MAX, f64::min);
        assert!(nearest < 0.25, "{nearest} mm from {x}, {y}");
    }
    for pair in held.windows(2) {
        assert!(pair[1].0[1] >= pair[0].0[1] - 0.2, "{pair:?}");
    }
}

#[test]
fn the_handle_and_the_brush_may_be_held_one_way() {
    let mut fixed = stroke(&[[10.0, 20.0, 0.5], [60.0, 50.0, 0.5]]);
    fixed.toward_deg = Some(90.0);
    fixed.turn = Turn::Canvas(15.0);
    for (_, tilt, twist, _) in held(&fixed) {
        assert!(tilt[0].abs() < 1e-6 && (tilt[1] - 30.0).abs() < 1e-6);
        assert!((twist - 15.0).abs() < 1e-6);
    }
}

#[test]
fn one_point_is_a_dab() {
    for points in [&[[10.0, 20.0, 0.6]][..], &[[10.0, 20.0, 0.6]; 3]] {
        let dab = stroke(points);
        assert!((dab.seconds() - DAB_S).abs() < 1e-9);
        let held = held(&dab);
        assert!(held.iter().all(|(at, ..)| (at[0] - 10.0).abs() < 1e-9));
        let most = held.iter().map(|(.., pressure)| *pressure);
        let most = most.fold(0.0, f64::max);
        assert!((most - 0.6).abs() < 0.01, "{most}");
        assert_eq!(held[0].3, 0.0);
        assert_eq!(held[held.len() - 1].3, 0.0);
    }
}
