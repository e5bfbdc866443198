//! A stroke of a script: the points that a hand goes through, as samples of a stylus.

use std::f64::consts::PI;

use maulstick_num::{atan2, powf, sin_cos};
use maulstick_types::stylus::{StylusPose, StylusSample, axes};

const RATE_HZ: f64 = 250.0;
/// A dab, from the first touch to the last, s.
const DAB_S: f64 = 0.3;
/// Pieces of the curve between two points.
const PIECES: usize = 16;
/// Length to either side over which the direction of the path is averaged, mm.
const LOOK_MM: f64 = 1.5;
/// Points nearer to each other than this are one, mm.
const NEAR_MM: f64 = 1e-3;

/// Turn of a brush about its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turn {
    /// Degrees from its broad side across the path.
    Way(f64),
    /// Degrees from its broad side from left to right.
    Canvas(f64),
}

/// A stroke.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// Points from the canvas's lower left corner, mm, with the pressure, 0 to 1; a single one is a dab.
    pub points: Vec<[f64; 3]>,
    /// Lean of the handle from upright, degrees.
    pub lean_deg: f64,
    /// Direction to which the handle's end leans, degrees from the right, counter-clockwise; along the path if absent.
    pub toward_deg: Option<f64>,
    /// Turn of the brush.
    pub turn: Turn,
    /// Speed along the path, mm/s.
    pub speed_mm_s: f64,
}

fn radians(degrees: f64) -> f64 {
    degrees * PI / 180.0
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    let (x, y) = (b[0] - a[0], b[1] - a[1]);
    (x * x + y * y).sqrt()
}

/// Between two of four points: a centripetal Catmull-Rom spline by Barry and Goldman's pyramid (Yuksel, Schaefer and
/// Keyser 2011), which neither loops nor overshoots where points are spaced unevenly. Pressure is interpolated
/// linearly.
fn spline(points: [[f64; 3]; 4], share: f64) -> [f64; 3] {
    let mut knots = [0.0; 4];
    for i in 1..4 {
        let way = distance(points[i - 1], points[i]).max(NEAR_MM);
        knots[i] = knots[i - 1] + way.sqrt();
    }
    let at = knots[1] + share * (knots[2] - knots[1]);
    let mut pyramid = points;
    for level in 1..4 {
        for i in 0..4 - level {
            // The last level is over the middle span alone.
            let (from, to) = match level {
                3 => (1, 2),
                2 => (i, i + 2),
                _ => (i, i + 1),
            };
            let t = (at - knots[from]) / (knots[to] - knots[from]);
            pyramid[i] = [0, 1, 2].map(|k| (1.0 - t) * pyramid[i][k] + t * pyramid[i + 1][k]);
        }
    }
    let pressure = (1.0 - share) * points[1][2] + share * points[2][2];
    [pyramid[0][0], pyramid[0][1], pressure]
}

impl Stroke {
    /// The curve through the points, and the path length to each point of it, mm.
    fn curve(&self) -> (Vec<[f64; 3]>, Vec<f64>) {
        let mut points = self.points.clone();
        points.dedup_by(|next, before| distance(*before, *next) < NEAR_MM);
        let last = points.len() - 1;
        let mut curve = vec![points[0]];
        for i in 0..last {
            let ends = [i.saturating_sub(1), i, i + 1, (i + 2).min(last)];
            let mut four = ends.map(|end| points[end]);
            // Beyond its ends the curve continues straight.
            if i == 0 {
                four[0] = [0, 1, 2].map(|k| 2.0 * four[1][k] - four[2][k]);
            }
            if i + 1 == last {
                four[3] = [0, 1, 2].map(|k| 2.0 * four[2][k] - four[1][k]);
            }
            curve.extend((1..=PIECES).map(|piece| spline(four, piece as f64 / PIECES as f64)));
        }
        let mut ways = vec![0.0];
        for pair in curve.windows(2) {
            ways.push(ways[ways.len() - 1] + distance(pair[0], pair[1]));
        }
        (curve, ways)
    }

    /// Length, s.
    #[must_use]
    pub fn seconds(&self) -> f64 {
        let way = self.curve().1.last().copied().unwrap_or_default();
        if way > 0.0 {
            way / self.speed_mm_s
        } else {
            DAB_S
        }
    }

    /// Samples over a canvas of this size, mm, each with its time since the first, ns. The last is lifted.
    #[must_use]
    pub fn samples(&self, size_mm: [f64; 2]) -> Vec<(u64, StylusSample)> {
        let (curve, ways) = self.curve();
        let whole = ways[ways.len() - 1];
        let at = |way: f64| {
            let next = ways
                .partition_point(|end| *end < way)
                .clamp(1, ways.len().max(2) - 1);
            if curve.len() < 2 {
                return curve[0];
            }
            let share = (way - ways[next - 1]) / (ways[next] - ways[next - 1]);
            let share = share.clamp(0.0, 1.0);
            [0, 1, 2].map(|k| curve[next - 1][k] + share * (curve[next][k] - curve[next - 1][k]))
        };
        let count = (self.seconds() * RATE_HZ).ceil().max(2.0) as usize;
        let mut samples = Vec::with_capacity(count + 2);
        for i in 0..=count {
            let share = i as f64 / count as f64;
            let way = share * whole;
            let point = at(way);
            let (behind, ahead) = (at(way - LOOK_MM), at(way + LOOK_MM));
            // A dab goes upward.
            let heading = if whole > 0.0 {
                atan2(ahead[1] - behind[1], ahead[0] - behind[0])
            } else {
                0.5 * PI
            };
            let swell = if whole > 0.0 {
                1.0
            } else {
                1.0 - powf(2.0 * share - 1.0, 2.0)
            };
            samples.push(self.sample(point, heading, swell * point[2], size_mm));
            if i == count {
                samples.push(self.sample(point, heading, 0.0, size_mm));
            }
        }
        let time = |i: usize| (i as f64 * 1e9 / RATE_HZ) as u64;
        let timed = samples.into_iter().enumerate();
        timed.map(|(i, sample)| (time(i), sample)).collect()
    }

    fn sample(
        &self,
        point: [f64; 3],
        heading: f64,
        pressure: f64,
        size_mm: [f64; 2],
    ) -> StylusSample {
        let desk = |i: usize| 1e-3 * (point[i] - 0.5 * size_mm[i]);
        let toward = self.toward_deg.map_or(heading, radians);
        let (lean, (sine, cosine)) = (sin_cos(radians(self.lean_deg)), sin_cos(toward));
        let twist_rad = match self.turn {
            Turn::Way(degrees) => heading - 0.5 * PI + radians(degrees),
            Turn::Canvas(degrees) => radians(degrees),
        };
        StylusSample {
            senses: axes::POSITION | axes::PRESSURE,
            in_range: true,
            pose: StylusPose::Contact {
                point_m: [desk(0), desk(1), 0.0],
                tilt_rad: [cosine, sine].map(|part| atan2(lean.0 * part, lean.1)),
                twist_rad,
                pressure: pressure.clamp(0.0, 1.0),
            },
            ..StylusSample::away()
        }
    }
}

#[cfg(test)]
mod tests;
