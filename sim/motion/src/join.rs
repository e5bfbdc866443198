//! Consecutive motions, with a lifted path between them.

use glam::DQuat;
use maulstick_num::geometry::{Rigid, nlerp};
use maulstick_types::stylus::{StylusPose, StylusSample};

use crate::MotionError;
use crate::error::within;
use crate::take_sample::{TakeSample, checked, point};

/// Range of pauses between two motions, s: contacts less than .15 s apart would be one stroke.
pub const PAUSES_S: std::ops::RangeInclusive<f64> = 0.2..=60.0;
/// Default pause between two motions, s.
pub const PAUSE_S: f64 = 0.3;
/// Greatest speed of a hand between strokes, m/s.
const SPEED_M_S: f64 = 0.5;
/// Sample rate in the air, Hz.
const RATE_HZ: f64 = 100.0;

/// Joins motions. Between two of them the brush is lifted for `pause_s`, or longer for a long path, and paints nothing.
///
/// # Errors
/// [`MotionError::NoMotion`]; [`MotionError::OutOfRange`] of the pause.
pub fn joined(parts: &[&[TakeSample]], pause_s: f64) -> Result<Vec<TakeSample>, MotionError> {
    within("a pause of", pause_s, PAUSES_S)?;
    let mut all: Vec<TakeSample> = Vec::new();
    for part in parts.iter().filter(|part| !part.is_empty()) {
        append(&mut all, part, pause_s);
    }
    if all.is_empty() {
        Err(MotionError::NoMotion)
    } else {
        checked(all)
    }
}

/// Appends samples after a lifted path.
pub(crate) fn append(all: &mut Vec<TakeSample>, part: &[TakeSample], pause_s: f64) {
    let Some(first) = part.first() else {
        return;
    };
    let start_ns = match all.last().cloned() {
        None => 0,
        Some(last) => {
            let way = (point(&first.sample, 0.0) - point(&last.sample, 0.0)).length();
            let seconds = pause_s.max(way / SPEED_M_S);
            let steps = (seconds * RATE_HZ).ceil().max(2.0) as u64;
            let step_ns = (seconds * 1e9) as u64 / steps;
            for step in 1..steps {
                all.push(TakeSample {
                    time_ns: last.time_ns + step * step_ns,
                    sample: lifted(&last.sample, &first.sample, step as f64 / steps as f64),
                });
            }
            last.time_ns + steps * step_ns
        }
    };
    let begin_ns = first.time_ns;
    all.extend(part.iter().map(|sample| TakeSample {
        time_ns: start_ns + (sample.time_ns - begin_ns),
        sample: sample.sample.clone(),
    }));
}

/// The minimum-jerk course from 0 to 1 (Flash and Hogan 1985).
fn minimum_jerk(t: f64) -> f64 {
    t * t * t * (10.0 + t * (6.0 * t - 15.0))
}

/// A sample in the air between two: a pen hovers; a 6-DOF stylus, whose height would show its brush, is out of range,
/// like one that changes to the other kind.
fn lifted(from: &StylusSample, to: &StylusSample, share: f64) -> StylusSample {
    let s = minimum_jerk(share);
    let between = |a: f64, b: f64| a + s * (b - a);
    let (pose, in_range) = match (&from.pose, &to.pose) {
        (
            StylusPose::Contact {
                point_m: a,
                tilt_rad: tilt,
                twist_rad: twist,
                ..
            },
            StylusPose::Contact {
                point_m: b,
                tilt_rad: to_tilt,
                twist_rad: to_twist,
                ..
            },
        ) => {
            let pose = StylusPose::Contact {
                point_m: [0, 1, 2].map(|axis| between(a[axis], b[axis])),
                tilt_rad: [0, 1].map(|axis| between(tilt[axis], to_tilt[axis])),
                twist_rad: between(*twist, *to_twist),
                pressure: 0.0,
            };
            (pose, true)
        }
        (StylusPose::Ferrule { pose: a }, StylusPose::Ferrule { pose: b }) => {
            let [a, b] = [a, b].map(Rigid::from);
            let rotation: DQuat = nlerp(a.rotation, b.rotation, s);
            let between = Rigid {
                rotation,
                translation: a.translation.lerp(b.translation, s),
            };
            let pose = StylusPose::Ferrule {
                pose: between.to_pose(),
            };
            (pose, false)
        }
        _ => (from.pose.clone(), false),
    };
    StylusSample {
        senses: from.senses,
        pose,
        in_range,
        ..StylusSample::away()
    }
}

/// A sample above the one that is given, in the air.
pub(crate) fn above(sample: &StylusSample) -> StylusSample {
    lifted(sample, sample, 0.0)
}
