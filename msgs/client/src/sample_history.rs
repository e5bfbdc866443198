//! What a device sensed over the last seconds, in bounded memory, and how evenly its samples came.

use std::collections::VecDeque;

use maulstick_types::stylus::{StylusPose, StylusSample};

/// Length of the history, ns.
const KEPT_NS: u64 = 5_000_000_000;
/// Most samples that are kept: 5 s at 1 kHz.
const MOST: usize = 5000;
/// Length of the part from which the rate is computed, ns.
const RATED_NS: u64 = 1_000_000_000;

/// One sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensedSample {
    /// Its event time, ns.
    pub event_ns: u64,
    /// The tip, or the ferrule of a 6-DOF device, m.
    pub place_m: [f64; 3],
    /// Pressure and tilt, rad, of a pen.
    pub pen: Option<(f64, [f64; 2])>,
    /// A bit a pressed switch.
    pub switches: u32,
    /// True if the stylus was in range.
    pub in_range: bool,
}

/// How evenly the samples of the last second came.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleTiming {
    /// Samples a second.
    pub rate_hz: f64,
    /// Standard deviation of the times between samples, ms.
    pub jitter_ms: f64,
    /// The longest of these times, ms.
    pub longest_ms: f64,
}

/// The samples of a device.
#[derive(Clone, Debug, Default)]
pub struct SampleHistory(VecDeque<SensedSample>);

impl SampleHistory {
    /// Adds a sample that came at `now_ns`. One of the time of the newest is a repetition, and one of a time to come is
    /// of another clock.
    pub fn add(&mut self, now_ns: u64, event_ns: u64, sample: &StylusSample) {
        let newest_ns = self.0.back().map(|newest| newest.event_ns);
        let is_old = newest_ns.is_some_and(|newest_ns| event_ns <= newest_ns);
        if sample.fault().is_some() || is_old || event_ns > now_ns.saturating_add(RATED_NS) {
            return;
        }
        let (place_m, pen) = match &sample.pose {
            StylusPose::Contact {
                point_m,
                pressure,
                tilt_rad,
                ..
            } => (*point_m, Some((*pressure, *tilt_rad))),
            StylusPose::Ferrule { pose } => (pose.position_m, None),
        };
        self.0.push_back(SensedSample {
            event_ns,
            place_m,
            pen,
            switches: sample.switches,
            in_range: sample.in_range,
        });
        let kept_ns = event_ns.saturating_sub(KEPT_NS);
        let is_old = |oldest: &SensedSample| oldest.event_ns < kept_ns;
        while self.0.len() > MOST || self.0.front().is_some_and(is_old) {
            self.0.pop_front();
        }
    }

    /// The newest sample, if it is not from another time.
    pub fn newest(&self, now_ns: u64) -> Option<&SensedSample> {
        let newest = self.0.back()?;
        (now_ns < newest.event_ns.saturating_add(KEPT_NS)).then_some(newest)
    }

    /// A quantity as a line: seconds before `now_ns`, below 0, and its value.
    pub fn line(&self, now_ns: u64, value: impl Fn(&SensedSample) -> Option<f64>) -> Vec<[f64; 2]> {
        let at = |sample: &SensedSample| {
            let is_kept = sample.event_ns.saturating_add(KEPT_NS) >= now_ns;
            let ago_s = (sample.event_ns as f64 - now_ns as f64) * 1e-9;
            Some([ago_s, value(sample).filter(|_| is_kept)?])
        };
        self.0.iter().filter_map(at).collect()
    }

    /// The timing of the last second of samples; `None` of less than three.
    pub fn timing(&self) -> Option<SampleTiming> {
        let since_ns = self.0.back()?.event_ns.saturating_sub(RATED_NS);
        let times = self.0.iter().map(|sample| sample.event_ns);
        let times: Vec<u64> = times.filter(|event_ns| *event_ns >= since_ns).collect();
        let gaps_ms: Vec<f64> = times
            .windows(2)
            .map(|pair| (pair[1] - pair[0]) as f64 * 1e-6)
            .collect();
        if gaps_ms.len() < 2 {
            return None;
        }
        let mean_ms = gaps_ms.iter().sum::<f64>() / gaps_ms.len() as f64;
        let squares = gaps_ms
            .iter()
            .map(|gap_ms| (gap_ms - mean_ms) * (gap_ms - mean_ms));
        Some(SampleTiming {
            rate_hz: 1e3 / mean_ms,
            jitter_ms: (squares.sum::<f64>() / gaps_ms.len() as f64).sqrt(),
            longest_ms: gaps_ms.iter().copied().fold(0.0, f64::max),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rate_jitter_and_the_longest_gap_are_those_of_the_plan() {
        let mut history = SampleHistory::default();
        let mut event_ns = 1_000_000_000;
        // 4 and 6 ms in turns: 200 Hz, 1 ms off the mean.
        for number in 0..400u64 {
            event_ns += if number % 2 == 0 {
                4_000_000
            } else {
                6_000_000
            };
            history.add(event_ns, event_ns, &StylusSample::away());
        }
        let timing = history.timing().expect("samples");
        assert!((timing.rate_hz - 200.0).abs() < 1.0, "{timing:?}");
        assert!((timing.jitter_ms - 1.0).abs() < 0.01, "{timing:?}");
        assert!((timing.longest_ms - 6.0).abs() < 1e-9, "{timing:?}");
        history.add(
            event_ns + 30_000_000,
            event_ns + 30_000_000,
            &StylusSample::away(),
        );
        let late = history.timing().expect("samples");
        assert!((late.longest_ms - 30.0).abs() < 1e-9, "{late:?}");
    }

    #[test]
    fn a_kilohertz_for_a_minute_is_kept_for_five_seconds() {
        let mut history = SampleHistory::default();
        for ms in 1..60_000u64 {
            for _ in 0..2 {
                history.add(ms * 1_000_000, ms * 1_000_000, &StylusSample::away());
            }
        }
        assert!(history.0.len() <= MOST);
        let line = history.line(60_000_000_000, |sample| Some(sample.place_m[0]));
        assert!(line.iter().all(|at| (-5.01..0.0).contains(&at[0])));
        assert!(history.newest(60_000_000_000).is_some());
        assert!(history.newest(66_000_000_000).is_none(), "it is silent");
        let line = history.line(66_000_000_000, |sample| Some(sample.place_m[0]));
        assert_eq!(line, [[0.0; 2]; 0], "and long ago");
        let before = history.0.len();
        history.add(60_000_000_000, 90_000_000_000, &StylusSample::away());
        assert_eq!(history.0.len(), before, "of another clock");
    }
}
