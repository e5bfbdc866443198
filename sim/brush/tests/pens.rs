//! A pen is led so that the mark's middle lies under its point.

use glam::DVec2;
use maulstick_brush::file::library::LIBRARY;
use maulstick_num::sin_cos;

mod desk;
mod patch;
use patch::{Bench, middle};

const PRESSURES: [f64; 4] = [0.1, 0.3, 0.45, 0.8];
const POINT: DVec2 = DVec2::splat(0.128);

/// Tilts of a pen that leans by `lean` degrees toward the azimuth `toward`, rad.
fn tilts(lean: f64, toward: f64) -> [f64; 2] {
    let (sine, cosine) = sin_cos(lean.to_radians());
    let (y, x) = sin_cos(toward);
    [x, y].map(|part| maulstick_num::atan2(part * sine, cosine))
}

/// Distance of a resting pen's mark from its point, m, set down over a number of samples; `None` where it touches
/// nothing.
fn beside(bench: &mut Bench, tilt: [f64; 2], pressure: f64, samples: u32) -> Option<f64> {
    for _ in 0..3 {
        bench.pen(POINT, tilt, 0.0);
    }
    let mut solve = None;
    for sample in 1..=samples + 3 {
        let share = f64::from(sample.min(samples)) / f64::from(samples);
        solve = Some(bench.pen(POINT, tilt, pressure * share));
    }
    let patch = bench.patch(&solve.expect("a solve"));
    (!patch.is_empty()).then(|| (middle(&patch) - POINT).length())
}

#[test]
fn the_mark_of_a_still_pen_lies_under_its_point() {
    for (kind, _) in LIBRARY {
        let mut bench = Bench::new(kind);
        let mut worst = [0.0f64; 4];
        let leaning = [30.0, 60.0].map(|lean| [0.9, -0.785, 2.0].map(|toward| (lean, toward)));
        for (lean, toward) in leaning.into_iter().flatten().chain([(0.0, 0.0)]) {
            for pressure in PRESSURES {
                let mut at = |samples: u32| {
                    let tilt = tilts(lean, toward);
                    1e3 * beside(&mut bench, tilt, pressure, samples).unwrap_or(0.0)
                };
                let leans = 2 * usize::from(lean > 0.0);
                let (at_once, slowly) = (at(1), at(40));
                worst[leans] = worst[leans].max(at_once);
                worst[leans + 1] = worst[leans + 1].max(slowly);
            }
        }
        let [at_once, slowly, leaning, leaning_slowly] = worst;
        println!(
            "{kind:8} upright {at_once:.2} {slowly:.2}, leaning {leaning:.2} {leaning_slowly:.2} mm"
        );
        // The fan touches here and there; a head that is wide and upright swings round in a slow press.
        let [still, slow] = match kind {
            "fan" => [7.0; 2],
            "badger" | "chisel" => [1.8, 2.6],
            _ => [1.5, 1.2],
        };
        assert!(
            at_once < still && leaning < still && leaning_slowly < slow,
            "{kind}"
        );
    }
}

/// Greatest distance of a stroke's mark from the pen, there and back.
#[test]
fn the_mark_of_a_stroke_stays_under_the_pen() {
    for (kind, _) in LIBRARY {
        let mut bench = Bench::new(kind);
        let mut worst = [0.0f64; 2];
        let tilt = tilts(30.0, -0.785);
        for pressure in PRESSURES {
            let mut at = DVec2::new(0.06, 0.128);
            for _ in 0..3 {
                bench.pen(at, tilt, 0.0);
            }
            for step in 0..160 {
                let back = usize::from(step >= 80);
                at.x += [5e-4, -5e-4][back];
                let solve = bench.pen(at, tilt, pressure);
                let patch = bench.patch(&solve);
                worst[back] = worst[back].max((middle(&patch) - at).length() * 1e3);
            }
        }
        println!("{kind:8} there {:.2}, back {:.2} mm", worst[0], worst[1]);
        let most = if kind == "fan" { 6.0 } else { 1.5 };
        assert!(worst[0] < most && worst[1] < 2.5_f64.max(most), "{kind}");
    }
}
