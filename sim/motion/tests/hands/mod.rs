//! Motions of hands that tests move.

use glam::{DQuat, DVec3};
use maulstick_motion::TakeSample;
use maulstick_num::geometry::Rigid;
use maulstick_num::{cos, sin};
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample, axes};

/// Length of the head of the 6-DOF hands, m.
pub(crate) const HEAD_M: f64 = 0.03;

/// A pen at a place, m.
pub(crate) fn pen(at: [f64; 2], pressure: f64) -> StylusSample {
    StylusSample {
        senses: axes::POSITION | axes::PRESSURE | axes::TILT,
        pose: StylusPose::Contact {
            point_m: [at[0], at[1], 0.0],
            tilt_rad: DEFAULT_TILT_RAD,
            twist_rad: 0.2,
            pressure,
        },
        in_range: true,
        ..StylusSample::away()
    }
}

/// A 6-DOF stylus, leaning, whose point is at a place, m; below 0 it touches.
pub(crate) fn six_dof(at: [f64; 3]) -> StylusSample {
    let rotation = DQuat::from_xyzw(0.2, -0.1, 0.3, 0.9).normalize();
    let point = DVec3::from_array(at);
    let pose = Rigid {
        rotation,
        translation: point + rotation * DVec3::Z * HEAD_M,
    };
    StylusSample {
        senses: axes::POSITION | axes::ORIENTATION,
        pose: StylusPose::Ferrule {
            pose: pose.to_pose(),
        },
        in_range: true,
        ..StylusSample::away()
    }
}

/// Strokes along straight paths, each with a slight bow and a pressure that swells; `hand` makes their samples from
/// place and pressure.
pub(crate) fn along(
    ways: &[[[f64; 2]; 2]],
    bow: f64,
    hand: impl Fn([f64; 2], f64) -> StylusSample,
) -> Vec<TakeSample> {
    let mut motion = Vec::new();
    let mut time_ns = 7_000;
    for [from, to] in ways {
        for step in -50..=50 {
            let u = f64::from(step.clamp(-25, 25) + 25) / 50.0;
            let way = [to[0] - from[0], to[1] - from[1]];
            let swell = sin(std::f64::consts::PI * u);
            let at = [
                from[0] + u * way[0] - bow * swell * way[1],
                from[1] + u * way[1] + bow * swell * way[0],
            ];
            let is_down = (-25..=25).contains(&step);
            let pressure = if is_down { 0.1 + 0.6 * swell } else { 0.0 };
            motion.push(TakeSample {
                time_ns,
                sample: hand(at, pressure),
            });
            time_ns += 8_000_000;
        }
    }
    motion
}

/// Hatching: rows from below, each drawn to the right, of this length and distance, m, all turned about the origin.
pub(crate) fn hatching(
    rows: usize,
    length_m: f64,
    spacing_m: f64,
    turn_rad: f64,
) -> Vec<TakeSample> {
    let turned = |[x, y]: [f64; 2]| {
        let (s, c) = (sin(turn_rad), cos(turn_rad));
        [c * x - s * y, s * x + c * y]
    };
    let way = |row: usize| {
        let y = spacing_m * row as f64;
        // A hand is nowhere exact.
        let off = 0.04 * length_m * sin(row as f64 * 2.4);
        let wobble = 0.08 * spacing_m * sin(row as f64 * 5.1);
        [[off, y + wobble], [off + length_m, y - wobble]].map(turned)
    };
    along(&(0..rows).map(way).collect::<Vec<_>>(), 0.02, pen)
}
