//! A motion that goes faster or slower.

use maulstick_brush::model::BRIDGED_NS;

use crate::MotionError;
use crate::error::within;
use crate::take_sample::{TakeSample, checked};

/// Rates by which a motion is retimed.
pub const RATES: std::ops::RangeInclusive<f64> = 0.01..=100.0;

/// Pace of a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pace {
    /// Factor on the speed.
    Rate(f64),
    /// To this length, s.
    Length(f64),
}

/// Retimes a motion with its velocities; its start stays.
///
/// # Errors
/// [`MotionError::OutOfRange`] of the rate; [`MotionError::Times`] where samples would coincide, and
/// [`MotionError::Torn`] where those of a stroke would be too far apart.
pub fn retimed(samples: &[TakeSample], pace: Pace) -> Result<Vec<TakeSample>, MotionError> {
    let begin_ns = samples.first().map_or(0, |first| first.time_ns);
    let length_ns = samples.last().map_or(0, |last| last.time_ns - begin_ns);
    let rate = match pace {
        Pace::Rate(rate) => rate,
        Pace::Length(seconds) => length_ns as f64 * 1e-9 / seconds,
    };
    within("a rate of", rate, RATES)?;
    let retimed: Vec<TakeSample> = samples
        .iter()
        .map(|taken| {
            let mut sample = taken.sample.clone();
            sample.velocity_m_s = sample.velocity_m_s.map(|v| v * rate);
            let since_ns = (taken.time_ns - begin_ns) as f64 / rate;
            TakeSample {
                time_ns: begin_ns + since_ns.round() as u64,
                sample,
            }
        })
        .collect();
    for (pair, before) in retimed.windows(2).zip(samples.windows(2)) {
        let apart_ns = |pair: &[TakeSample]| pair[1].time_ns.saturating_sub(pair[0].time_ns);
        let was_torn = apart_ns(before) > BRIDGED_NS;
        let touches = pair.iter().all(|taken| !taken.sample.in_air());
        if touches && !was_torn && apart_ns(pair) > BRIDGED_NS {
            return Err(MotionError::Torn {
                at_s: (before[0].time_ns - begin_ns) as f64 * 1e-9,
                apart_s: apart_ns(pair) as f64 * 1e-9,
                most_s: BRIDGED_NS as f64 * 1e-9,
            });
        }
    }
    checked(retimed)
}
