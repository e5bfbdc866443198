//! Samples in, solves out.

use maulstick_types::Pose;
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose};
use proptest::prelude::*;

use super::*;
use crate::file::library::LIBRARY;
use crate::spine::SpineShape;

#[path = "../../../tests/desk/mod.rs"]
mod desk;
pub(super) use desk::scene;

pub(super) const DEVICE: Origin = Origin {
    source: 1,
    epoch: 1,
};
pub(super) const MS: u64 = 1_000_000;

pub(super) fn brush() -> BrushModel {
    let mut model = BrushModel::new(BrushFile::library("round").expect("round"), 0.5);
    model.set_scene(&scene());
    model
}

pub(super) fn pen(x: f64, y: f64, pressure: f64) -> StylusSample {
    let pose = StylusPose::Contact {
        point_m: [x, y, 0.0],
        tilt_rad: DEFAULT_TILT_RAD,
        twist_rad: 0.0,
        pressure,
    };
    StylusSample {
        pose,
        in_range: true,
        ..StylusSample::away()
    }
}

#[test]
fn a_zoom_in_a_stroke_begins_the_brush_anew_on_its_surface_and_a_move_does_not() {
    let mut model = brush();
    let mut at_ms = 0_u32;
    let mut press = |model: &mut BrushModel| {
        at_ms += 8;
        let x = 2e-4 * f64::from(at_ms);
        let solves = model.follow(
            DEVICE,
            1_000 * MS + u64::from(at_ms) * MS,
            &pen(x, 0.0, 0.4),
        );
        let painted = solves
            .iter()
            .filter(|solve| solve.flags & solve_flags::PREVIEW == 0);
        let restarts = painted.filter(|solve| solve.flags & solve_flags::RESTARTED != 0);
        (restarts.count(), solves[0].surface, solves[0].zoom)
    };
    press(&mut model);
    assert_eq!(press(&mut model), (1, CANVAS, 1.0), "it is set down");
    assert_eq!(press(&mut model), (0, CANVAS, 1.0));
    let mut moved = scene();
    moved.surfaces[0].pose.position_m[1] -= 1e-3;
    model.set_scene(&moved);
    assert_eq!(press(&mut model), (0, CANVAS, 1.0));
    moved.surfaces[0].zoom = 1.5;
    model.set_scene(&moved);
    assert_eq!(press(&mut model), (0, CANVAS, 1.5), "it waits");
    assert_eq!(press(&mut model), (1, CANVAS, 1.5));
    assert_eq!(press(&mut model), (0, CANVAS, 1.5));
}

#[test]
fn strokes_are_numbered_by_the_gap_rule() {
    let mut model = brush();
    let mut stroke = |ms: u64, pressure: f64| {
        model
            .follow(DEVICE, ms * MS, &pen(0.0, 0.0, pressure))
            .last()
            .expect("a solve")
            .stroke
    };
    assert_eq!(stroke(1000, 0.0), 0);
    assert_eq!((stroke(1010, 0.3), stroke(1020, 0.3)), (1, 1));
    assert_eq!(stroke(1090, 0.0), 0);
    assert_eq!(
        stroke(1169, 0.3),
        1,
        "149 ms without contact is the same stroke"
    );
    assert_eq!(stroke(1250, 0.0), 0);
    assert_eq!(stroke(1319, 0.3), 2, "150 ms is a new one");
}

#[test]
fn time_that_stands_still_or_jumps_restarts_the_solver() {
    let mut model = brush();
    let mut restarted = |ms: u64| {
        let solve = model.follow(DEVICE, ms * MS, &pen(0.0, 0.0, 0.3));
        let solve = solve.last().expect("a solve");
        solve.flags & solve_flags::RESTARTED != 0
    };
    assert!(restarted(1000));
    assert!(!restarted(1010) && !restarted(1310));
    assert!(restarted(1310), "no time has passed");
    assert!(restarted(1300), "time runs backward");
    assert!(restarted(1601), "over .3 s has passed");
}

/// Solves of a pen that goes 12 mm in .2 s, and 12 mm more in a pause of `pause_ms`.
fn paused(pause_ms: u64) -> Vec<Solve> {
    let mut model = brush();
    for i in 0..=50u32 {
        let x = 2.4e-4 * f64::from(i);
        model.follow(DEVICE, (1000 + 4 * u64::from(i)) * MS, &pen(x, 0.0, 0.4));
    }
    model.follow(DEVICE, (1200 + pause_ms) * MS, &pen(0.024, 0.0, 0.4))
}

#[test]
fn a_pause_in_contact_is_crossed_step_by_step_in_one_stroke() {
    for pause_ms in [40, 110, 250, 300] {
        let solves = paused(pause_ms);
        // Of 12 mm the last 11.5 are ways of .175 mm.
        assert!(solves.len() >= 65, "{pause_ms} ms: {} solves", solves.len());
        for pair in solves.windows(2) {
            let [from, to] = [0, 1].map(|i| pair[i].pose.position_m[0]);
            assert!(to > from - 1e-5 && to - from < 4e-4, "{from} {to}");
        }
        for solve in &solves {
            assert_eq!(solve.stroke, 1, "{pause_ms} ms");
            assert_eq!(solve.flags & solve_flags::RESTARTED, 0);
        }
    }
    let mut still = brush();
    for ms in [1000, 1004, 1280] {
        let solves = still.follow(DEVICE, ms * MS, &pen(0.0, 0.0, 0.4));
        assert_eq!(solves[0].stroke, 1, "a hand that rests goes on");
    }
}

#[test]
fn after_a_long_pause_another_stroke_begins_with_the_head_bent_as_it_was() {
    let bent = |pause_ms: u64| {
        let solve = paused(pause_ms).pop().expect("a solve");
        let angles: Vec<f64> = solve.angles_rad.iter().map(|a| f64::from(a[0])).collect();
        (solve, angles)
    };
    let (_, whole) = bent(40);
    let (solve, resumed) = bent(500);
    assert_eq!((solve.stroke, solve.contacts.is_empty()), (2, false));
    assert!(solve.flags & solve_flags::RESTARTED != 0);
    let mut landed = brush();
    let anew = landed.follow(DEVICE, 1000 * MS, &pen(0.024, 0.0, 0.4));
    let anew: Vec<f64> = anew[0].angles_rad.iter().map(|a| f64::from(a[0])).collect();
    let apart = |other: &[f64]| {
        let pairs = whole.iter().zip(other);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let (resumed, anew) = (apart(&resumed), apart(&anew));
    println!("bend beside that of the drawn head: {resumed:.3} rad resumed, {anew:.3} landed");
    assert!(resumed < 0.005 && anew > 0.03, "{resumed} {anew}");
}

#[test]
fn a_pressed_brush_bends_and_pushes_back() {
    let mut model = brush();
    let mut force = |ms: u64, pressure: f64| {
        model.follow(DEVICE, ms * MS, &pen(0.0, 0.0, pressure));
        model.force_n()
    };
    let (light, full) = (force(1000, 0.1), force(1010, 1.0));
    assert!(
        light > 0.0 && full > light && full < 3.0,
        "{light} N, {full} N"
    );
    assert_eq!(force(1020, 0.0), 0.0);
}

proptest! {
    // A leap is solved at up to 64 places for each of seven spines.
    #![proptest_config(ProptestConfig::with_cases(ProptestConfig::default().cases / 16))]

    #[test]
    fn no_sample_breaks_a_brush(
        kind in 0..LIBRARY.len(),
        samples in prop::collection::vec(
            (
                0u64..200,
                [-0.3..0.3f64, -0.3..0.3f64],
                0.0..=1.0f64,
                [-1.484..1.484f64, -1.484..1.484f64, -3.0..3.0f64],
                any::<[bool; 2]>(),
            ),
            1..40,
        )
    ) {
        let file = BrushFile::library(LIBRARY[kind].0).expect("a brush");
        let mut model = BrushModel::new(file, 0.5);
        model.set_scene(&scene());
        let mut ns = 1_000_000_000;
        for (dt, [x, y], pressure, [tilt_x, tilt_y, twist_rad], [in_range, held]) in samples {
            ns += dt * MS;
            let pose = if held {
                let orientation = crate::desk::pen_orientation([tilt_x, tilt_y], twist_rad);
                let position_m = [x, y, 0.05 * pressure - 0.01];
                let orientation = maulstick_num::geometry::canonical(orientation).to_array();
                StylusPose::Ferrule { pose: Pose { position_m, orientation } }
            } else {
                let (point_m, tilt_rad) = ([x, y, 0.0], [tilt_x, tilt_y]);
                StylusPose::Contact { point_m, tilt_rad, twist_rad, pressure }
            };
            let sample = StylusSample { pose, in_range, ..StylusSample::away() };
            let solves = model.follow(DEVICE, ns, &sample);
            prop_assert!(solves.last().is_some_and(|solve| solve.event_ns == ns));
            for solve in &solves {
                prop_assert!(solve.pose.is_valid());
                prop_assert!(solve.angles_rad.iter().flatten().all(|angle| angle.is_finite()));
            }
            if !in_range {
                prop_assert!(solves.last().is_some_and(|solve| solve.contacts.is_empty()));
            }
            let feel = model.stiffness().k1_n;
            prop_assert!(feel.is_finite() && feel > 0.0);
        }
        // A lifted brush that is put down again bends independently of what was before.
        let mut last = Vec::new();
        for (ms, pressure) in [(300, 0.0), (310, 0.3), (320, 0.3)] {
            last = model.follow(DEVICE, ns + ms * MS, &pen(0.0, 0.0, pressure));
        }
        let last = last.last().expect("a solve");
        prop_assert!(last.flags & solve_flags::NOT_CONVERGED == 0 && !last.contacts.is_empty());
    }

    #[test]
    fn tuning_forgets_what_was_before(first in 0.1..4.0f64, last in 0.1..4.0f64) {
        let tuned = |factors: &[f64]| {
            let mut model = brush();
            factors.iter().for_each(|factor| model.tune(*factor));
            model.tuft
        };
        prop_assert!(tuned(&[first, last]) == tuned(&[last]));
        prop_assert!(tuned(&[first]) != tuned(&[1.001 * first]));
    }
}

/// Leaps of decimetres with the brush flipped over: where no minimum is found a head keeps its bend and
/// says so, and that is rare.
#[test]
fn a_minimum_is_nearly_always_found() {
    let mut random = crate::head::place::Random::new(5);
    let (mut solves, mut kept) = (0, 0);
    for (kind, _) in LIBRARY {
        let mut model = BrushModel::new(BrushFile::library(kind).expect(kind), 0.5);
        model.set_scene(&scene());
        for step in 1..=10 {
            let mut range = |from: f64, to: f64| from + (to - from) * random.unit();
            let pose = StylusPose::Contact {
                point_m: [range(-0.1, 0.1), range(-0.1, 0.1), 0.0],
                tilt_rad: [range(-1.4, 1.4), range(-1.4, 1.4)],
                twist_rad: range(-3.0, 3.0),
                pressure: range(0.0, 1.0),
            };
            let sample = StylusSample {
                pose,
                in_range: true,
                ..StylusSample::away()
            };
            for solve in model.follow(DEVICE, step * 20 * MS, &sample) {
                solves += 1;
                kept += usize::from(solve.flags & solve_flags::NOT_CONVERGED != 0);
            }
        }
    }
    println!("{kept} of {solves} solves kept the bend before");
    assert!(kept * 200 < solves, "{kept} of {solves}");
}

/// A brush that is dragged along the canvas against the edge of the raised palette bends there: no
/// joint enters the board.
#[test]
fn the_edge_of_the_palette_holds_the_bristles() {
    let (edge, top) = (-0.138, 0.004);
    let mut scene = scene();
    let mut board = scene.surfaces[0].clone();
    board.id = maulstick_types::scene::PALETTE;
    board.pose.position_m = [edge - 0.256, -0.128, top];
    let drag = |scene: &Scene| {
        let mut model = brush();
        model.set_scene(scene);
        let roots = model.tuft.roots.clone();
        let mut deepest = 0.0f64;
        for step in 0..60u64 {
            let sample = pen(-0.12 - 4e-4 * step as f64, 0.0, 0.4);
            for solve in model.follow(DEVICE, (1000 + 8 * step) * MS, &sample) {
                assert_eq!(solve.flags & solve_flags::NOT_CONVERGED, 0);
                // The canvas begins at −128 mm.
                let held = Rigid::from(&solve.pose);
                let mut angles = &solve.angles_rad[..];
                for root in &roots {
                    let (own, others) = angles.split_at(root.spine.joints());
                    angles = others;
                    let at = root.frame(&held);
                    let shape = SpineShape::from_angles(at.translation, at.rotation, own);
                    for i in 0..root.spine.joints() {
                        let p = shape.joint(&root.spine, i) - glam::DVec3::splat(0.128);
                        let within = (edge - p.x).min(top - (p.z + 0.128));
                        deepest = deepest.max(within);
                    }
                }
            }
        }
        deepest
    };
    let through = drag(&scene);
    scene.surfaces.push(board);
    let held = drag(&scene);
    assert!(
        through > 2e-3,
        "without the board they would be there: {through}"
    );
    assert!(held < 1e-6, "{held}");
}

/// The desk with a palette 10 mm higher to the left of the canvas.
fn scene_with_palette() -> Scene {
    let mut scene = scene();
    let mut palette = scene.surfaces[0].clone();
    palette.id = 1;
    palette.pose.position_m = [-0.394, -0.128, 0.01];
    scene.surfaces.push(palette);
    scene
}

/// That desk with the canvas tilted about its lower edge by 20°.
fn tilted() -> Scene {
    let mut scene = scene_with_palette();
    let (sine, cosine) = maulstick_num::sin_cos(10_f64.to_radians());
    scene.surfaces[0].pose.orientation = [sine, 0.0, 0.0, cosine];
    scene
}

#[test]
fn a_pen_let_go_far_from_its_stroke_touches_nothing() {
    let mut model = brush();
    for i in 0..20_u32 {
        model.follow(DEVICE, (1000 + 8 * u64::from(i)) * MS, &pen(0.0, 0.0, 0.4));
    }
    // The pointer comes back far away.
    let mut solves = model.follow(DEVICE, 1168 * MS, &pen(0.07, 0.03, 0.0));
    solves.extend(model.follow(DEVICE, 1176 * MS, &pen(0.07, 0.03, 0.0)));
    assert!(solves.iter().all(|solve| solve.contacts.is_empty()));
}

#[test]
fn no_brush_of_any_size_touches_in_the_air() {
    let postures = [
        (0.0, DEFAULT_TILT_RAD),
        (1.2, [0.0, 1.0]),
        (2.8, [-1.0, 0.3]),
    ];
    for (kind, _) in LIBRARY {
        let file = BrushFile::library(kind).expect("a brush");
        for (width_mm, (twist_rad, tilt_rad)) in ends_mm(kind)
            .into_iter()
            .flat_map(|width_mm| postures.map(|posture| (width_mm, posture)))
        {
            let mut model = BrushModel::new(file.scaled_to(width_mm).expect("a size"), 0.5);
            // Over the canvas, its left edge, the gap, and the palette; then with a tilted canvas.
            for step in 0..24_u32 {
                let scene = if step < 12 {
                    scene_with_palette()
                } else {
                    tilted()
                };
                model.set_scene(&scene);
                let pose = StylusPose::Contact {
                    point_m: [-0.06 - 0.012 * f64::from(step % 12), 0.01, 0.0],
                    tilt_rad,
                    twist_rad,
                    pressure: 0.0,
                };
                let sample = StylusSample {
                    pose,
                    ..pen(0.0, 0.0, 0.0)
                };
                for solve in model.follow(DEVICE, (1000 + 8 * u64::from(step)) * MS, &sample) {
                    assert!(
                        solve.contacts.is_empty(),
                        "{kind} {width_mm} mm, step {step}, {tilt_rad:?}"
                    );
                }
            }
        }
    }
}

/// A window has the point of a pressed pointer on whatever is below it.
#[test]
fn a_stroke_over_the_edge_of_the_canvas_is_the_canvas_s_to_its_end() {
    let drawn = |lifts: bool| {
        let mut model = brush();
        model.set_scene(&scene_with_palette());
        let at = |step: u32| -0.1 - 4e-3 * f64::from(step);
        let (mut surfaces, mut strokes, mut anew) = (Vec::new(), Vec::new(), 0);
        for step in 0..30 {
            let pressure = if lifts && step == 12 { 0.0 } else { 0.5 };
            let mut sample = pen(at(step), 0.0, pressure);
            if let StylusPose::Contact { point_m, .. } = &mut sample.pose
                && at(step) < -0.138
            {
                point_m[2] = 0.01;
            }
            for solve in model.follow(DEVICE, (1000 + 8 * u64::from(step)) * MS, &sample) {
                surfaces.push(solve.surface);
                strokes.extend((solve.stroke > 0).then_some(solve.stroke));
                let is_painted = solve.flags & solve_flags::PREVIEW == 0;
                anew += u32::from(is_painted) * (solve.flags & solve_flags::RESTARTED);
            }
        }
        strokes.dedup();
        (surfaces.iter().all(|surface| *surface == 0), strokes, anew)
    };
    assert_eq!(drawn(false), (true, vec![1], 1));
    assert!(!drawn(true).0, "a pen that lifts goes to the palette");
}

/// Pressure, twist, rad, and samples of a circle: hands of 1 m/s, and of 8 m/s as a pointer that leaps.
const HANDS: [(f64, f64, u32); 4] = [(0.1, 0.0, 60), (0.2, 1.5, 60), (0.3, 0.7, 8), (0.5, 2.2, 8)];

/// Samples of a stroke at which a pressed brush touches nothing.
fn bare(kind: &str, width_mm: f64, (pressure, twist_rad, steps): (f64, f64, u32)) -> Vec<String> {
    let file = BrushFile::library(kind).expect("a brush");
    let mut model = BrushModel::new(file.scaled_to(width_mm).expect("a size"), 0.5);
    model.set_scene(&scene());
    let mut bare = Vec::new();
    for step in 0..steps {
        let t = f64::from(step) / f64::from(steps);
        let (sine, cosine) = maulstick_num::sin_cos(5.0 * t);
        let pose = StylusPose::Contact {
            point_m: [0.06 * cosine, 0.06 * sine * t, 0.0],
            tilt_rad: DEFAULT_TILT_RAD,
            twist_rad: twist_rad + 5.0 * t,
            pressure: if step == 0 { 0.0 } else { pressure },
        };
        let sample = StylusSample {
            pose,
            ..pen(0.0, 0.0, 0.0)
        };
        let solves = model.follow(DEVICE, (1000 + 8 * u64::from(step)) * MS, &sample);
        if step > 0 && solves.iter().any(|solve| solve.contacts.is_empty()) {
            bare.push(format!("{kind} {width_mm} mm at {pressure}, step {step}"));
        }
    }
    bare
}

/// Smallest and largest size of a kind, mm.
fn ends_mm(kind: &str) -> [f64; 2] {
    let sizes_mm = BrushFile::library(kind).expect("a brush").sizes_mm;
    [sizes_mm[0], sizes_mm[sizes_mm.len() - 1]]
}

#[test]
fn a_pressed_brush_of_any_kind_touches_all_along_its_stroke() {
    for (kind, _) in LIBRARY {
        for (hand, width_mm) in HANDS.into_iter().zip(ends_mm(kind).into_iter().cycle()) {
            assert_eq!(bare(kind, width_mm, hand), [""; 0]);
        }
    }
}

#[test]
#[ignore = "long: all sizes by all hands"]
fn a_pressed_brush_of_any_kind_and_size_touches_all_along_its_stroke() {
    for (kind, _) in LIBRARY {
        for width_mm in BrushFile::library(kind).expect("a brush").sizes_mm {
            for hand in HANDS {
                assert_eq!(bare(kind, width_mm, hand), [""; 0]);
            }
        }
    }
}
