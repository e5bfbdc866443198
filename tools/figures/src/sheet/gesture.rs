//! Gestures of a hand: a path of the point with pressure, tilt and turn over time.

use std::f64::consts::PI;

use maulstick_painting::EditError;
use maulstick_session::Offline;
use maulstick_types::stylus::{StylusPose, StylusSample, axes};

const RATE_HZ: f64 = 250.0;
/// Pause between two gestures, s: longer than the gap within a stroke.
const PAUSE_S: f64 = 0.3;

/// State of the hand at a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Moment {
    /// Point of the brush, mm from the lower left corner of the sheet.
    pub(crate) at: [f64; 2],
    /// Pressure, 0 to 1.
    pub(crate) pressure: f64,
    /// Lean of the handle from upright, degrees: to the right, and up.
    pub(crate) tilt_deg: [f64; 2],
    /// Turn of the brush about its axis, degrees: at 0 a flat is broad from left to right.
    pub(crate) twist_deg: f64,
}

/// A gesture: a moment for each share of its time, 0 to 1.
pub(crate) struct Gesture {
    /// Duration, s.
    pub(crate) seconds: f64,
    /// Motion of the hand over time.
    pub(crate) hand: Box<dyn Fn(f64) -> Moment>,
}

/// From 0 to 1 without a jerk (minimum jerk, Flash and Hogan 1985).
pub(crate) fn ease(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * t * (10.0 + t * (6.0 * t - 15.0))
}

/// 0 at both ends, 1 between, with shoulders of this share.
pub(crate) fn swell(t: f64, shoulder: f64) -> f64 {
    ease(t / shoulder) * ease((1.0 - t) / shoulder)
}

/// A point on a polyline whose pieces take equal time, smoothed (Catmull and Rom 1974).
pub(crate) fn along(points: &[[f64; 2]], t: f64) -> [f64; 2] {
    let last = points.len() - 1;
    let place = t.clamp(0.0, 1.0) * last as f64;
    let i = (place as usize).min(last.saturating_sub(1));
    let f = place - i as f64;
    let at = |j: isize| points[(i as isize + j).clamp(0, last as isize) as usize];
    let (a, b, c, d) = (at(-1), at(0), at(1), at(2));
    [0, 1].map(|k| {
        0.5 * (2.0 * b[k]
            + (c[k] - a[k]) * f
            + (2.0 * a[k] - 5.0 * b[k] + 4.0 * c[k] - d[k]) * f * f
            + (3.0 * b[k] - a[k] - 3.0 * c[k] + d[k]) * f * f * f)
    })
}

/// A hand at an easel of `size_mm`, with a clock of its own.
#[derive(Debug)]
pub(crate) struct Hand {
    size_mm: [f64; 2],
    now_s: f64,
}

impl Hand {
    /// A hand over a canvas of this size.
    pub(crate) fn over(size_mm: [f64; 2]) -> Self {
        Self {
            size_mm,
            now_s: 1.0,
        }
    }

    /// Paints a gesture.
    ///
    /// # Errors
    /// [`EditError`] where the painting refuses it.
    pub(crate) fn paint(&mut self, on: &mut Offline, gesture: &Gesture) -> Result<(), EditError> {
        let samples = (gesture.seconds * RATE_HZ).ceil().max(2.0) as usize;
        for i in 0..=samples {
            let moment = (gesture.hand)(i as f64 / samples as f64);
            self.sample(on, &moment)?;
        }
        let lifted = Moment {
            pressure: 0.0,
            ..(gesture.hand)(1.0)
        };
        self.sample(on, &lifted)?;
        self.now_s += PAUSE_S;
        Ok(())
    }

    fn sample(&mut self, on: &mut Offline, moment: &Moment) -> Result<(), EditError> {
        let desk = |i: usize| 1e-3 * (moment.at[i] - 0.5 * self.size_mm[i]);
        let radians = |degrees: f64| degrees * PI / 180.0;
        let sample = StylusSample {
            senses: axes::POSITION | axes::PRESSURE,
            in_range: true,
            pose: StylusPose::Contact {
                point_m: [desk(0), desk(1), 0.0],
                tilt_rad: moment.tilt_deg.map(radians),
                twist_rad: radians(moment.twist_deg),
                pressure: moment.pressure.clamp(0.0, 1.0),
            },
            ..StylusSample::away()
        };
        on.sample((self.now_s * 1e9) as u64, &sample)?;
        self.now_s += 1.0 / RATE_HZ;
        Ok(())
    }
}
