//! A pen is led so that the mark's middle lies under its point.

use glam::DVec2;
use maulstick_brush::file::library::LIBRARY;
use maulstick_num::sin_cos;

mod desk;
mod patch;
use patch::Bench;

/// Tilts of a pen that leans by `angle` toward the azimuth `toward`, rad.
fn tilts(angle: f64, toward: f64) -> [f64; 2] {
    let (sine, cosine) = sin_cos(angle);
    let (y, x) = sin_cos(toward);
    [x, y].map(|part| maulstick_num::atan2(part * sine, cosine))
}

fn middle(patch: &[DVec2]) -> DVec2 {
    patch.iter().sum::<DVec2>() / patch.len() as f64
}

const PRESSURES: [f64; 4] = [0.1, 0.3, 0.45, 0.8];

#[test]
fn the_mark_of_a_still_pen_lies_under_its_point() {
    let point = DVec2::splat(0.128);
    let mut all: f64 = 0.0;
    for (kind, _) in LIBRARY {
        let mut row = String::new();
        for angle in [0.0f64, 30.0, 60.0] {
            for toward in [0.9, -0.785] {
                let tilt = tilts(angle.to_radians(), toward);
                for pressure in PRESSURES {
                    let beside = |ramp: u32| {
                        let mut bench = Bench::new(kind);
                        let mut solve = bench.pen(point, tilt, 0.0);
                        for step in 1..=ramp + 5 {
                            let share = f64::from(step.min(ramp)) / f64::from(ramp);
                            solve = bench.pen(point, tilt, pressure * share);
                        }
                        let patch = bench.patch(&solve);
                        (middle(&patch) - point).length() * 1e3
                    };
                    let (at_once, slowly) = (beside(1), beside(40));
                    row += &format!(" {at_once:.2}/{slowly:.2}");
                    all = all.max(at_once).max(slowly);
                }
                row += " |";
            }
        }
        println!("{kind:8} {row}");
    }
    println!("{all:.2} mm");
}

#[test]
fn drag() {
    for (kind, _) in LIBRARY {
        let mut row = String::new();
        for angle in [0.0f64, 30.0, 60.0] {
            let tilt = tilts(angle.to_radians(), -0.785);
            for pressure in PRESSURES {
                let mut bench = Bench::new(kind);
                let mut at = DVec2::new(0.06, 0.128);
                let mut worst = 0.0f64;
                bench.pen(at, tilt, 0.0);
                let mut back: f64 = 0.0;
                for step in 0..160 {
                    let way = if step < 80 { 5e-4 } else { -5e-4 };
                    at.x += way;
                    let solve = bench.pen(at, tilt, pressure);
                    let patch = bench.patch(&solve);
                    let e = (middle(&patch) - at).length() * 1e3;
                    if step < 80 {
                        worst = worst.max(e)
                    } else {
                        back = back.max(e)
                    }
                }
                row += &format!(" {worst:.1}/{back:.1}");
            }
            row += " |";
        }
        println!("{kind:8} {row}");
    }
}

#[test]
fn trace() {
    for (kind, angle) in [
        ("fude", 0.0f64),
        ("fude", 30.0),
        ("liner", 30.0),
        ("round", 30.0),
    ] {
        let point = DVec2::splat(0.128);
        let tilt = tilts(angle.to_radians(), 0.0);
        let mut bench = Bench::new(kind);
        let mut solve = bench.pen(point, tilt, 0.0);
        for step in 1..=40 {
            solve = bench.pen(point, tilt, 0.3 * f64::from(step) / 40.0);
            if step % 3 == 1 {
                let patch = bench.patch(&solve);
                let m = (middle(&patch) - point) * 1e3;
                let xs = patch
                    .iter()
                    .map(|p| (p.x - point.x) * 1e3)
                    .fold((99.0f64, -99.0f64), |(a, b), v| (a.min(v), b.max(v)));
                let handle = maulstick_brush::mark::point_of(
                    &maulstick_num::geometry::Rigid::from(&solve.pose),
                ) - point;
                println!(
                    "T {kind} {angle} {step}: middle {:.2} {:.2}, x {:.1} to {:.1}, handle {:.2} {:.2}",
                    m.x,
                    m.y,
                    xs.0,
                    xs.1,
                    handle.x * 1e3,
                    handle.y * 1e3
                );
            }
        }
    }
}

#[test]
fn speed() {
    for kind in ["round", "fude", "mop"] {
        let mut bench = Bench::new(kind);
        let tilt = tilts(0.5, -0.785);
        let start = std::time::Instant::now();
        let mut at = DVec2::new(0.03, 0.128);
        let mut solves = 0;
        for i in 0..1600 {
            at.x += 1e-4;
            at.y += 1e-4 * maulstick_num::sin(0.02 * f64::from(i));
            bench.pen(at, tilt, 0.3);
            solves += 1;
        }
        println!(
            "{kind}: {:.1} us",
            start.elapsed().as_secs_f64() * 1e6 / f64::from(solves)
        );
    }
}
