//! Force on the hand over the last seconds, in bounded memory at any sample rate.

use std::collections::VecDeque;

use maulstick_types::stylus::{StylusPose, StylusSample};

/// Length of the history, s.
pub const KEPT_S: f64 = 5.0;
/// Length of a span, ns, and how many there are at most.
const SPAN_NS: u64 = 20_000_000;
const SPANS: usize = 250;
/// Silence after which a device counts as away, ns.
const SILENCE_NS: u64 = 500_000_000;

/// Least and greatest force of a fiftieth of a second, N.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Span {
    number: u64,
    least_n: f64,
    greatest_n: f64,
}

/// The newest sample of a device.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Newest {
    arrived_ns: u64,
    in_range: bool,
    place_m: [f64; 3],
    force_n: [f64; 3],
}

/// Force history of a device.
#[derive(Clone, Debug, Default)]
pub struct ForceHistory {
    spans: VecDeque<Span>,
    newest: Option<Newest>,
}

impl ForceHistory {
    /// Adds a sample.
    pub fn add(&mut self, arrived_ns: u64, sample: &StylusSample) {
        if sample.fault().is_some() {
            return;
        }
        let place_m = match &sample.pose {
            StylusPose::Contact { point_m, .. } => *point_m,
            StylusPose::Ferrule { pose } => pose.position_m,
        };
        self.newest = Some(Newest {
            arrived_ns,
            in_range: sample.in_range,
            place_m,
            force_n: sample.force_n,
        });
        let (number, size_n) = (arrived_ns / SPAN_NS, size(sample.force_n));
        match self.spans.back_mut() {
            Some(span) if span.number >= number => {
                span.least_n = span.least_n.min(size_n);
                span.greatest_n = span.greatest_n.max(size_n);
            }
            _ => {
                if self.spans.len() >= SPANS {
                    self.spans.pop_front();
                }
                self.spans.push_back(Span {
                    number,
                    least_n: size_n,
                    greatest_n: size_n,
                });
            }
        }
    }

    /// The force of the last seconds as a line: seconds before `now_ns`, below 0, and N; the least and the
    /// greatest of each span.
    #[must_use]
    pub fn line(&self, now_ns: u64) -> Vec<[f64; 2]> {
        let mut line = Vec::with_capacity(2 * self.spans.len());
        for span in &self.spans {
            let ago_s = (span.number * SPAN_NS) as f64 * 1e-9 - now_ns as f64 * 1e-9;
            if ago_s >= -KEPT_S {
                line.push([ago_s, span.least_n]);
                line.push([ago_s + 0.5e-9 * SPAN_NS as f64, span.greatest_n]);
            }
        }
        line
    }

    /// The force on the hand now, N; `None` while the device is silent.
    #[must_use]
    pub fn force_n(&self, now_ns: u64) -> Option<[f64; 3]> {
        let newest = self.newest.as_ref()?;
        let heard = now_ns < newest.arrived_ns.saturating_add(SILENCE_NS);
        heard.then_some(newest.force_n)
    }

    /// True while the newest sample is near the desk and not old, or never grows old.
    pub(crate) fn is_near(&self, now_ns: u64, aging: Aging) -> bool {
        self.newest.as_ref().is_some_and(|newest| {
            let heard = now_ns < newest.arrived_ns.saturating_add(SILENCE_NS);
            newest.in_range && (heard || aging == Aging::Never)
        })
    }

    /// Point on the desk of the newest sample, m.
    pub(crate) fn place_m(&self) -> Option<[f64; 3]> {
        self.newest.as_ref().map(|newest| newest.place_m)
    }
}

/// Aging of a device's newest sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Aging {
    /// A silent device is away.
    Silence,
    /// The window's own mouse sends only its moves.
    Never,
}

/// Length of a force, N.
#[must_use]
pub fn size(force_n: [f64; 3]) -> f64 {
    force_n.iter().map(|part| part * part).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(force_n: [f64; 3]) -> StylusSample {
        StylusSample {
            force_n,
            in_range: true,
            ..StylusSample::away()
        }
    }

    #[test]
    fn a_kilohertz_for_a_minute_is_five_seconds_of_extremes() {
        let mut forces = ForceHistory::default();
        for ms in 0..60_000u64 {
            // A spike of one sample.
            let force = if ms == 59_000 { 3.0 } else { 1.0 };
            forces.add(ms * 1_000_000, &sample([0.0, 0.0, force]));
        }
        forces.add(60_000_000_000, &sample([f64::NAN, 0.0, 0.0]));
        assert!(forces.spans.len() <= SPANS, "{}", forces.spans.len());
        let line = forces.line(60_000_000_000);
        let peak = line.iter().max_by(|a, b| a[1].total_cmp(&b[1]));
        let peak = peak.expect("a line");
        assert!(peak[1] == 3.0 && (peak[0] + 1.0).abs() < 0.03, "{peak:?}");
        assert!(
            line.iter().all(|at| (-KEPT_S..0.0).contains(&at[0])),
            "{line:?}"
        );
        assert_eq!(line.iter().filter(|at| at[1] == 3.0).count(), 1);
        assert_eq!(forces.force_n(60_000_000_000), Some([0.0, 0.0, 1.0]));
        assert_eq!(forces.force_n(61_000_000_000), None, "it is silent");
    }
}
