//! Guidance of a hand: the piece of the recorded stroke ahead of it, a hundred times a second.

use std::time::Duration;

use maulstick_bus::typed::{Receiver, Sender};
use maulstick_bus::{Qos, Queue};
use maulstick_rig::NodeHandle;
use maulstick_types::haptics::GuideModel;
use maulstick_types::stylus::StylusSample;
use tokio::task::block_in_place;
use tokio::time::Instant;

use super::Brush;
use super::traced::Traced;
use crate::error::RecorderError;
use crate::replay::consent::Consent;
use crate::replay::driven::Driven;
use crate::replay::playback::{Controls, REPORT_PERIOD};
use crate::replay::report::{Guiding, ReplayReport};
use crate::replay::transport::Order;

/// Time between two guides.
const PERIOD: Duration = Duration::from_millis(10);
/// Lifetime of a guide: ten periods.
const TIME_TO_LIVE_NS: u64 = 100_000_000;
/// Stiffness, damping and largest force of a guide at full strength.
const STIFFNESS_N_M: f64 = 100.0;
const DAMPING_N_S_M: f64 = 0.5;
const MOST_N: f64 = 0.6;
/// A brush that is higher above the canvas is let go, m.
const NEAR_M: f64 = 0.03;

/// A strength within 0 to 1; one that is not a number has no force.
fn bounded(strength: f64) -> f64 {
    if strength > 0.0 {
        strength.min(1.0)
    } else {
        0.0
    }
}

/// Guidance of one hand.
pub(super) struct Guidance<'a> {
    member: &'a NodeHandle,
    device: Driven,
    brush: Brush,
    traced: Traced,
    samples: Receiver<StylusSample>,
    guides: Sender<GuideModel>,
    consent: Consent,
    controls: Controls,
    strength: f64,
    paused: bool,
    /// When the next report is due.
    report: Instant,
}

/// Course of the guidance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Course {
    GoesOn,
    /// All strokes are traced.
    AllTraced,
}

impl<'a> Guidance<'a> {
    pub(super) fn new(
        member: &'a NodeHandle,
        (device, brush, traced): (Driven, Brush, Traced),
        strength: f64,
        controls: Controls,
    ) -> Result<Self, RecorderError> {
        let (bus, topics) = (&*member.bus, &member.topics);
        let sample = topics.sample(&device.name);
        let topic = topics.guide(&device.name);
        let me = member.origin(&member.node);
        let consent = block_in_place(|| Consent::ask(member, &device.name, me))?;
        Ok(Self {
            samples: Receiver::new(bus, &sample, Qos::RealTime, Queue::Ring(16), &member.wake)?,
            guides: Sender::new(bus, &topic, Qos::RealTime, me)?,
            consent,
            member,
            device,
            brush,
            traced,
            controls,
            strength: bounded(strength),
            paused: false,
            report: Instant::now(),
        })
    }

    /// Guides until all strokes are traced, again and again where it `repeats`, or until it is asked to stop.
    pub(super) async fn guide(&mut self, repeats: bool) -> Result<(), RecorderError> {
        let mut due = Instant::now();
        while !self.member.stop.requested() {
            while let Some(order) = self.controls.next() {
                if order == Order::End {
                    return Ok(());
                }
                self.obey(order);
            }
            let now = Instant::now();
            if now >= due {
                due = now + PERIOD;
                match self.follow(now)? {
                    Course::AllTraced if repeats => self.traced.seek(0),
                    Course::AllTraced => return Ok(()),
                    Course::GoesOn => {}
                }
            }
            let left = due.saturating_duration_since(now);
            self.controls.wait(&self.member.wake, left).await;
        }
        Ok(())
    }

    /// Follows the hand and sends its guide.
    fn follow(&mut self, now: Instant) -> Result<Course, RecorderError> {
        self.consent.renew(self.member)?;
        let Some(sample) = self.samples.newest() else {
            return Ok(Course::GoesOn);
        };
        // It may have been started anew.
        self.device.origin = sample.header.origin();
        let (tip, touch) = self.brush.tip(&sample.message);
        self.traced.follow(tip, touch);
        let [count, traced] = self.traced.counts();
        if count == traced {
            self.report(now);
            return Ok(Course::AllTraced);
        }
        if !self.paused && self.strength > 0.0 {
            let is_near = sample.message.in_range && tip.z < NEAR_M;
            self.send(if is_near { self.strength } else { 0.0 })?;
        }
        if now >= self.report {
            self.report(now);
        }
        Ok(Course::GoesOn)
    }

    fn obey(&mut self, order: Order) {
        match order {
            Order::Pause => self.paused = !self.paused,
            Order::Strength(strength) => self.strength = bounded(strength),
            Order::Stronger(by) => self.strength = bounded(self.strength + by),
            Order::Seek(s) => self.traced.seek((s.max(0.0) * 1e9) as u64),
            Order::Skip(by_s) => {
                let s = self.traced.position_ns().unwrap_or(0) as f64 * 1e-9 + by_s;
                self.traced.seek((s.max(0.0) * 1e9) as u64);
            }
            // The hand's own pace is the rate.
            Order::Step | Order::Rate(_) | Order::Faster(_) | Order::End => {}
        }
        self.report = Instant::now();
    }

    fn send(&mut self, strength: f64) -> Result<(), RecorderError> {
        let Some(points_m) = self.traced.piece() else {
            return Ok(());
        };
        let now_ns = self.member.bus.now_ns();
        let model = GuideModel {
            device: self.device.origin.source,
            device_epoch: self.device.origin.epoch,
            points_m,
            normal: [0.0, 0.0, 1.0],
            head_length_m: self.brush.head_length_m,
            stiffness_n_m: STIFFNESS_N_M * strength,
            damping_n_s_m: DAMPING_N_S_M * strength,
            max_force_n: MOST_N * strength,
            time_to_live_ns: TIME_TO_LIVE_NS,
        };
        self.guides.send(now_ns, now_ns, &model)?;
        Ok(())
    }

    /// Reports how far the hand has come.
    fn report(&mut self, now: Instant) {
        self.report = now + REPORT_PERIOD;
        let [strokes, traced] = self.traced.counts();
        self.controls.report(ReplayReport::Guiding(Guiding {
            position_s: self.traced.position_ns().map(|ns| ns as f64 * 1e-9),
            strokes,
            traced,
            strength: self.strength,
            paused: self.paused,
        }));
    }
}

#[cfg(test)]
mod tests {
    use super::bounded;

    #[test]
    fn no_strength_gives_more_than_the_full_force_of_a_guide() {
        for (asked, given) in [
            (0.5, 0.5),
            (7.0, 1.0),
            (-1.0, 0.0),
            (f64::NAN, 0.0),
            (f64::INFINITY, 1.0),
        ] {
            assert_eq!(bounded(asked), given, "{asked}");
        }
    }
}
