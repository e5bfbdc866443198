//! A performance made from a seed: a flower on its stem before a few hills, as a hand would paint
//! it: minimum-jerk strokes, pressure that swells and fades, a slight tremor.

use std::f64::consts::{PI, TAU};

use maulstick_num::{cos, sin};
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample, axes};
use rand_pcg::Pcg32;

use crate::mark_sheet;
use crate::strokes::{Pressure, Stroke, Strokes};
use crate::take::{Take, TakeSample};

/// Samples a second.
const RATE_HZ: f64 = 250.0;
/// Pause between strokes, s: longer than the 150 ms that join them.
const PAUSE_S: f64 = 0.26;

fn flower(strokes: &mut Strokes) {
    let head = [strokes.about(0.0, 0.02), strokes.about(0.042, 0.008)];
    sky(strokes);
    hills(strokes);
    stem(strokes, head);
    petals(strokes, head);
}

/// Broad sweeps across the upper half.
fn sky(strokes: &mut Strokes) {
    for row in 0..3 {
        let y = 0.092 - 0.030 * f64::from(row);
        let points = (0..5)
            .map(|i| [-0.105 + 0.0525 * f64::from(i), strokes.about(y, 0.004)])
            .collect();
        let pressure = strokes.about(0.78, 0.06);
        strokes.stroke(points, pressure, 1.9);
    }
}

/// Rolling hills, each lower than the one before.
fn hills(strokes: &mut Strokes) {
    for row in 0..3 {
        let base = -0.030 - 0.030 * f64::from(row);
        let phase = TAU * strokes.chance();
        let points = (0..7)
            .map(|i| {
                let t = f64::from(i) / 6.0;
                [
                    -0.108 + 0.216 * t,
                    base + 0.010 * sin(phase + 1.4 * TAU * t),
                ]
            })
            .collect();
        let pressure = strokes.about(0.72, 0.06);
        strokes.stroke(points, pressure, 1.8);
    }
}

/// A stem with two leaves.
fn stem(strokes: &mut Strokes, head: [f64; 2]) {
    let lean = strokes.about(0.008, 0.006);
    let foot = [head[0] + 2.0 * lean, -0.098];
    strokes.stroke(vec![head, [head[0] + lean, -0.02], foot], 0.22, 1.2);
    for side in [-1.0, 1.0] {
        let y = strokes.about(-0.055, 0.008);
        let root = [head[0] + 1.3 * lean, y];
        let reach = strokes.about(0.034, 0.004);
        let tip = [root[0] + side * reach, y + 0.020];
        let middle = [root[0] + side * 0.45 * reach, y + 0.018];
        strokes.stroke(vec![root, middle, tip], 0.5, 0.8);
    }
}

/// Petals around a head: each pulled from the rim inward.
fn petals(strokes: &mut Strokes, head: [f64; 2]) {
    let count = 7;
    let first = TAU * strokes.chance();
    for petal in 0..count {
        let angle = first + TAU * f64::from(petal) / f64::from(count);
        let long = strokes.about(0.041, 0.003);
        let bend = strokes.about(0.18, 0.06);
        let at = |radius: f64, turn: f64| {
            [
                head[0] + radius * cos(angle + turn),
                head[1] + radius * sin(angle + turn),
            ]
        };
        let points = vec![
            at(long, bend),
            at(0.6 * long, 0.3 * bend),
            at(0.2 * long, 0.0),
        ];
        let pressure = strokes.about(0.55, 0.08);
        strokes.stroke(points, pressure, 0.75);
    }
    let ring = (0..8)
        .map(|i| {
            let angle = PI * f64::from(i) / 3.0;
            let radius = 0.0065 * (1.0 - f64::from(i) / 14.0);
            [head[0] + radius * cos(angle), head[1] + radius * sin(angle)]
        })
        .collect();
    strokes.stroke(ring, 0.45, 1.0);
}

/// Subject of a demo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// A flower before hills.
    Flower,
    /// A sheet of marks that shows what brush and paint can do.
    Marks,
}

/// The performance of a subject and a seed.
#[must_use]
pub fn performance(subject: Subject, seed: u64) -> Take {
    let mut strokes = Strokes::new(Pcg32::new(seed, 0x6465_6d6f));
    match subject {
        Subject::Flower => flower(&mut strokes),
        Subject::Marks => mark_sheet::marks(&mut strokes),
    }
    let mut samples = Vec::new();
    let mut time_s = 0.0;
    let drawn = strokes.take();
    let mut rest = drawn.first().map_or([0.0; 2], |stroke| stroke.points[0]);
    for stroke in &drawn {
        time_s = travel(&mut samples, time_s, rest, stroke.points[0]);
        time_s = draw(&mut strokes, &mut samples, time_s, stroke);
        rest = *stroke.points.last().unwrap_or(&rest);
    }
    travel(&mut samples, time_s, rest, rest);
    Take {
        setup: None,
        device: "demo".into(),
        samples,
    }
}

/// The minimum-jerk course from 0 to 1 (Flash and Hogan 1985).
fn minimum_jerk(t: f64) -> f64 {
    t * t * t * (10.0 + t * (6.0 * t - 15.0))
}

fn travel(samples: &mut Vec<TakeSample>, start_s: f64, from: [f64; 2], to: [f64; 2]) -> f64 {
    let steps = (PAUSE_S * RATE_HZ) as usize;
    for step in 0..steps {
        let s = minimum_jerk(step as f64 / steps as f64);
        let at = [
            from[0] + s * (to[0] - from[0]),
            from[1] + s * (to[1] - from[1]),
        ];
        samples.push(pen(start_s + step as f64 / RATE_HZ, at, 0.0));
    }
    start_s + steps as f64 / RATE_HZ
}

fn draw(
    strokes: &mut Strokes,
    samples: &mut Vec<TakeSample>,
    start_s: f64,
    stroke: &Stroke,
) -> f64 {
    let steps = (stroke.seconds * RATE_HZ) as usize;
    let phases = [TAU * strokes.chance(), TAU * strokes.chance()];
    for step in 0..=steps {
        let t = step as f64 / steps as f64;
        let s = minimum_jerk(t);
        let at = spline(&stroke.points, s);
        // The hand trembles at about 9 Hz by a tenth of a millimetre.
        let tremor = |phase: f64| 1e-4 * sin(phase + TAU * 9.0 * step as f64 / RATE_HZ);
        let at = [at[0] + tremor(phases[0]), at[1] + tremor(phases[1])];
        // The brush is set down and lifted while it moves: a press at rest would leave a hook.
        let shape = match stroke.course {
            Pressure::Swell => (6.0 * s).min(1.0),
            Pressure::Grow => s,
        };
        let swell = shape.min(4.0 * (1.0 - s)).max(0.0);
        let pressure = stroke.pressure * swell * (0.9 + 0.1 * cos(TAU * t));
        samples.push(pen(
            start_s + step as f64 / RATE_HZ,
            at,
            pressure.clamp(0.0, 1.0),
        ));
    }
    start_s + (steps + 1) as f64 / RATE_HZ
}

/// A Catmull-Rom curve through points, at `s` in 0..1.
fn spline(points: &[[f64; 2]], s: f64) -> [f64; 2] {
    let last = points.len() - 1;
    let x = s * last as f64;
    let i = (x as usize).min(last.saturating_sub(1));
    let t = x - i as f64;
    let at = |k: usize| points[k.min(last)];
    let before = if i == 0 { at(0) } else { at(i - 1) };
    let (p, q, after) = (at(i), at(i + 1), at(i + 2));
    std::array::from_fn(|c| {
        let (m, n) = (0.5 * (q[c] - before[c]), 0.5 * (after[c] - p[c]));
        let (t2, t3) = (t * t, t * t * t);
        p[c] * (2.0 * t3 - 3.0 * t2 + 1.0)
            + m * (t3 - 2.0 * t2 + t)
            + q[c] * (3.0 * t2 - 2.0 * t3)
            + n * (t3 - t2)
    })
}

fn pen(time_s: f64, at: [f64; 2], pressure: f64) -> TakeSample {
    let sample = StylusSample {
        senses: axes::POSITION | axes::PRESSURE | axes::TILT | axes::PROXIMITY,
        pose: StylusPose::Contact {
            point_m: [at[0], at[1], 0.0],
            tilt_rad: DEFAULT_TILT_RAD,
            twist_rad: 0.0,
            pressure,
        },
        in_range: true,
        ..StylusSample::away()
    };
    TakeSample {
        time_ns: (time_s * 1e9).round() as u64,
        sample,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_always_gives_the_same_valid_performance() {
        let take = performance(Subject::Flower, 1);
        assert_eq!(take, performance(Subject::Flower, 1));
        assert_ne!(take, performance(Subject::Flower, 2));
        assert!(
            take.samples
                .windows(2)
                .all(|pair| pair[0].time_ns < pair[1].time_ns)
        );
        assert!(take.samples.iter().all(|s| s.sample.fault().is_none()));
        let seconds = take.length_ns() as f64 * 1e-9;
        assert!((20.0..40.0).contains(&seconds), "{seconds} s");
    }

    #[test]
    fn it_stays_on_the_default_canvas() {
        let flowers = (0..50).map(|seed| performance(Subject::Flower, seed));
        for take in flowers.chain([performance(Subject::Marks, 1)]) {
            for TakeSample { sample, .. } in take.samples {
                if let StylusPose::Contact { point_m, .. } = sample.pose {
                    assert!(
                        point_m[0].abs() < 0.125 && point_m[1].abs() < 0.125,
                        "{point_m:?}"
                    );
                }
            }
        }
    }
}
