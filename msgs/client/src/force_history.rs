//! Force on the hand over the last seconds, in bounded memory at any sample rate; and the device that paints.

use std::collections::VecDeque;

use maulstick_types::stylus::{StylusPose, StylusSample, axes};

use crate::state::{Device, LiveRig};

/// Length of the history, s.
pub const KEPT_S: f64 = 5.0;
/// Length of a span, ns, and how many there are at most.
const SPAN_NS: u64 = 20_000_000;
const SPANS: usize = 250;
/// Silence after which a device counts as away, ns; the window's own mouse sends only its moves.
const SILENCE_NS: u64 = 500_000_000;
/// The mouse as a device.
const POINTER: &str = "pointer";
/// Smallest force that is shown, N.
const LEAST_N: f64 = 0.02;

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
}

/// Length of a force, N.
#[must_use]
pub fn size(force_n: [f64; 3]) -> f64 {
    force_n.iter().map(|part| part * part).sum::<f64>().sqrt()
}

fn is_near(device: &Device, now_ns: u64) -> bool {
    let is_pointer = device.info.as_ref().is_some_and(|it| it.driver == POINTER);
    device.forces.newest.as_ref().is_some_and(|newest| {
        let heard = now_ns < newest.arrived_ns.saturating_add(SILENCE_NS);
        newest.in_range && (heard || is_pointer)
    })
}

/// The device that moves a brush: of those near the desk the one of highest priority.
#[must_use]
pub fn active_device<'a>(rig: &'a LiveRig, brush: &str) -> Option<(&'a str, &'a Device)> {
    let near = rig.devices.iter().filter_map(|(name, device)| {
        let info = device.info.as_ref()?;
        let moves = info.brush == brush && is_near(device, rig.now_ns);
        moves.then_some((info.priority, name.as_str(), device))
    });
    let first = near.max_by_key(|(priority, ..)| *priority)?;
    Some((first.1, first.2))
}

/// Point on the desk where the force of the device that moves a brush acts, m, and that force, N; `None` if it is too small to
/// show.
#[must_use]
pub fn force_arrow(rig: &LiveRig, brush: &str) -> Option<([f64; 3], [f64; 3])> {
    let (_, device) = active_device(rig, brush)?;
    let drives = device.info.as_ref()?.drives & axes::FORCE != 0;
    let force_n = device.forces.force_n(rig.now_ns)?;
    let place_m = device.forces.newest.as_ref()?.place_m;
    (drives && size(force_n) >= LEAST_N).then_some((place_m, force_n))
}

#[cfg(test)]
mod tests {
    use maulstick_types::stylus::StylusInfo;

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

    #[test]
    fn of_those_near_the_one_of_highest_priority_paints_and_shows_its_arrow() {
        let mut rig = LiveRig::new("t");
        rig.now_ns = 10_000_000_000;
        for (name, driver, priority, drives) in [
            ("mouse", POINTER, -100, 0),
            ("pen", "pen", 5, 0),
            ("arm", "simulated", 10, axes::FORCE),
        ] {
            let device = rig.devices.entry(name.to_owned()).or_default();
            device.info = Some(StylusInfo {
                device: name.into(),
                driver: driver.into(),
                brush: "main".into(),
                priority,
                senses: 0,
                drives,
                rate_hz: 0.0,
                max_force_n: 0.0,
                max_stiffness_n_m: 0.0,
                workspace_m: [0.0; 6],
            });
            device.forces.add(9_900_000_000, &sample([0.0, 0.0, 0.5]));
        }
        let who = |rig: &LiveRig| active_device(rig, "main").map(|(name, _)| name.to_owned());
        assert_eq!(who(&rig).as_deref(), Some("arm"));
        let (_, force_n) = force_arrow(&rig, "main").expect("an arrow");
        assert_eq!(force_n, [0.0, 0.0, 0.5]);
        let arm = rig.devices.get_mut("arm").expect("an arm");
        arm.forces.add(9_950_000_000, &StylusSample::away());
        assert_eq!(who(&rig).as_deref(), Some("pen"));
        assert_eq!(force_arrow(&rig, "main"), None, "a pen gives no force");
        rig.now_ns += SILENCE_NS;
        assert_eq!(who(&rig).as_deref(), Some("mouse"), "it keeps still");
    }
}
