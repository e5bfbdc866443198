//! Tablets on the desk.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;
use maulstick_device::pen::{End, Presence, Reading};
use maulstick_hid::tablet::Tablet;
use maulstick_num::geometry::rotation;
use maulstick_rig::config::{CanvasSection, DeviceSection};
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample, switch};
use proptest::prelude::*;

fn canvas() -> CanvasSection {
    CanvasSection {
        width_mm: 300.0,
        height_mm: 200.0,
        ..CanvasSection::default()
    }
}

fn fit(area_m: [f64; 2], change: impl FnOnce(&mut DeviceSection)) -> Tablet {
    let mut device = DeviceSection::new("pen", "pen", "main");
    change(&mut device);
    Tablet::fit(area_m, 0, &device, &canvas()).expect("fitted")
}

fn near(got: [f64; 2], wanted: [f64; 2]) {
    let off = (got[0] - wanted[0]).abs().max((got[1] - wanted[1]).abs());
    assert!(off < 1e-12, "{got:?} {wanted:?}");
}

fn touch() -> Reading {
    Reading {
        presence: Presence::Touching,
        pressure: 0.5,
        tilt_rad: Some([0.3, 0.0]),
        twist_rad: Some(3.0),
        switches: 1,
        ..Reading::AWAY
    }
}

fn parts(sample: &StylusSample) -> ([f64; 2], f64, f64) {
    match &sample.pose {
        StylusPose::Contact {
            tilt_rad,
            twist_rad,
            pressure,
            ..
        } => (*tilt_rad, *twist_rad, *pressure),
        StylusPose::Ferrule { .. } => panic!("a pen has no ferrule"),
    }
}

#[test]
fn a_tablet_covers_the_canvas_in_its_middle() {
    // 250 x 125 on 300 x 200: height decides, 1.6.
    let tablet = fit([0.25, 0.125], |_| {});
    near(tablet.place([0.125, 0.0625]), [0.0, 0.0]);
    near(tablet.place([0.0, 0.0]), [-0.2, -0.1]);
    near(tablet.place([0.25, 0.125]), [0.2, 0.1]);
    assert_eq!(tablet.workspace_m()[5], 0.0);
}

#[test]
fn a_turned_tablet_covers_the_canvas_too_and_its_tilts_turn() {
    let quarter = rotation(DVec3::Z, FRAC_PI_2).to_array();
    let tablet = fit([0.25, 0.125], |device| device.orientation = quarter);
    // Its height lies across the canvas: 300 of 125.
    near(tablet.place([0.125, 0.0625]), [0.0, 0.0]);
    near(tablet.place([0.0, 0.0]), [0.15, -0.3]);
    let (tilt, twist, _) = parts(&tablet.sample(&touch()));
    near(tilt, [0.0, 0.3]);
    assert!(
        (twist - (3.0 + FRAC_PI_2 - 2.0 * PI)).abs() < 1e-12,
        "{twist}"
    );
}

#[test]
fn a_scale_is_from_middle_to_middle() {
    let tablet = fit([0.2, 0.1], |device| {
        device.scale = Some(0.5);
        device.position_m = [0.05, -0.02, 0.01];
    });
    near(tablet.place([0.1, 0.05]), [0.05, -0.02]);
    near(tablet.place([0.2, 0.1]), [0.1, 0.005]);
    assert_eq!(tablet.workspace_m()[2], 0.01);
}

#[test]
fn three_touched_corners_are_those_of_the_canvas() {
    let corners = [[0.02, 0.03, 0.0], [0.17, 0.04, 0.0], [0.01, 0.13, 0.0]];
    let tablet = fit([0.2, 0.15], |device| {
        device.corners_m = Some(corners);
        device.scale = Some(3.0);
    });
    let wanted = [[-0.15, -0.1], [0.15, -0.1], [-0.15, 0.1]];
    for (corner, wanted) in corners.iter().zip(wanted) {
        near(tablet.place([corner[0], corner[1]]), wanted);
    }
}

#[test]
fn corners_in_another_order_or_on_a_line_are_refused() {
    let sound = [[0.0, 0.0, 0.0], [0.2, 0.0, 0.0], [0.0, 0.1, 0.0]];
    let [a, b, c] = sound;
    let on_edge = [a, b, [0.1, 0.0, 0.1]];
    for (corners, is_sound) in [(sound, true), ([a, c, b], false), (on_edge, false)] {
        let mut device = DeviceSection::new("pen", "pen", "main");
        device.corners_m = Some(corners);
        let fitted = Tablet::fit([0.2, 0.1], 0, &device, &canvas());
        assert_eq!(fitted.is_ok(), is_sound, "{corners:?}");
    }
}

#[test]
fn pressure_follows_its_curve() {
    let curve = vec![[0.0, 0.0], [0.25, 0.0], [0.5, 0.8], [1.0, 1.0]];
    let tablet = fit([0.2, 0.1], |device| device.pressure_curve = curve);
    let given = |pressure| {
        parts(&tablet.sample(&Reading {
            pressure,
            ..touch()
        }))
        .2
    };
    for (sensed, wanted) in [
        (0.0, 0.0),
        (0.25, 0.0),
        (0.375, 0.4),
        (0.5, 0.8),
        (0.75, 0.9),
        (1.0, 1.0),
    ] {
        assert!(
            (given(sensed) - wanted).abs() < 1e-12,
            "{sensed}: {} {wanted}",
            given(sensed)
        );
    }
}

#[test]
fn an_eraser_is_a_switch_and_a_pen_without_tilts_leans_as_a_hand_does() {
    let tablet = fit([0.2, 0.1], |_| {});
    let reading = Reading {
        end: End::Eraser,
        tilt_rad: None,
        twist_rad: None,
        ..touch()
    };
    let sample = tablet.sample(&reading);
    assert_eq!(sample.switches, switch::ERASER | 1);
    assert_eq!(parts(&sample).0, DEFAULT_TILT_RAD);
    assert_eq!(tablet.sample(&touch()).switches, 1);
    assert!(!tablet.sample(&Reading::AWAY).in_range);
}

proptest! {
    #[test]
    fn the_whole_canvas_can_be_reached_however_a_tablet_is_turned(
        width in 0.05..0.6_f64, height in 0.05..0.6_f64, angle in -PI..PI,
        x in -0.15..=0.15_f64, y in -0.1..=0.1_f64,
    ) {
        let tablet = fit([width, height], |device| {
            device.orientation = rotation(DVec3::Z, angle).to_array();
        });
        // The map is affine: its inverse follows from three points.
        let [o, u, v] = [[0.0, 0.0], [width, 0.0], [0.0, height]].map(|at| tablet.place(at));
        let (u, v) = ([u[0] - o[0], u[1] - o[1]], [v[0] - o[0], v[1] - o[1]]);
        let det = u[0] * v[1] - u[1] * v[0];
        let [a, b] = [x - o[0], y - o[1]];
        let (s, t) = ((a * v[1] - b * v[0]) / det, (u[0] * b - u[1] * a) / det);
        prop_assert!((-1e-9..=1.0 + 1e-9).contains(&s) && (-1e-9..=1.0 + 1e-9).contains(&t), "{s} {t}");
    }

    #[test]
    fn every_fit_gives_samples_in_range(
        area in [0.01..2.0_f64, 0.01..2.0_f64],
        at in [0.0..=1.0_f64, 0.0..=1.0_f64],
        tilt in [-1.48..1.48_f64, -1.48..1.48_f64],
        twist in -10.0..10.0_f64,
        scale in prop::option::of(0.05..20.0_f64),
        position in [-9.0..9.0_f64, -9.0..9.0_f64, -9.0..9.0_f64],
        angle in -PI..PI,
    ) {
        let tablet = fit(area, |device| {
            device.scale = scale;
            device.position_m = position;
            device.orientation = rotation(DVec3::Z, angle).to_array();
        });
        let reading = Reading {
            point_m: [at[0] * area[0], at[1] * area[1]],
            tilt_rad: Some(tilt),
            twist_rad: Some(twist),
            height_m: 0.01,
            ..touch()
        };
        prop_assert_eq!(tablet.sample(&reading).fault(), None);
    }
}
