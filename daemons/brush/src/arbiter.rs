//! Choice among several devices that move one brush: of those in range the one of highest priority, and another one
//! only between strokes. A brush at rest in the air stays with its device, which may say nothing; one in a stroke stays
//! with a device that says nothing for a while, as a window does whose frame is late.

use std::collections::BTreeMap;

/// A device that is silent for this long leaves its stroke to another that is in range, ns.
const SILENCE_NS: u64 = 500_000_000;
/// A device that is silent for this long is lost: whoever is heard lifts the brush out of its stroke, ns.
const LOST_NS: u64 = 5_000_000_000;

/// Distance of a stylus: in range or not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Range {
    /// It is.
    Near,
    /// It is away.
    Away,
}

/// State of the brush's stroke.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// It is in the air.
    None,
    /// It touches: a stroke is going on.
    GoesOn,
}

/// The devices of a brush, by name: a device that starts anew is the same device.
#[derive(Clone, Debug, Default)]
pub struct Arbiter {
    devices: BTreeMap<String, Device>,
    active: Option<String>,
}

#[derive(Clone, Copy, Debug)]
struct Device {
    priority: i32,
    range: Range,
    heard_ns: u64,
}

impl Device {
    /// True if it is in range and was heard lately.
    fn is_near(&self, now_ns: u64) -> bool {
        self.range == Range::Near && now_ns < self.heard_ns.saturating_add(SILENCE_NS)
    }
}

impl Arbiter {
    /// A sample came; whether its device moves the brush.
    pub fn admit(
        &mut self,
        name: &str,
        priority: i32,
        range: Range,
        stroke: Stroke,
        now_ns: u64,
    ) -> bool {
        self.devices
            .retain(|_, device| now_ns < device.heard_ns.saturating_add(LOST_NS));
        let device = Device {
            priority,
            range,
            heard_ns: now_ns,
        };
        self.devices.insert(name.to_owned(), device);
        // In the air silence is rest.
        let held = self
            .active
            .take()
            .filter(|active| stroke == Stroke::None || self.devices.contains_key(active));
        let keeps = stroke == Stroke::GoesOn
            && held.as_ref().is_some_and(|active| {
                let own = &self.devices[active];
                let mut near = self
                    .devices
                    .iter()
                    .filter(|(_, device)| device.is_near(now_ns));
                // Silent, it has no other beside it.
                own.range == Range::Near && (own.is_near(now_ns) || near.next().is_none())
            });
        self.active = if keeps {
            held
        } else {
            let best = self
                .devices
                .iter()
                .filter(|(_, device)| device.is_near(now_ns))
                .max_by_key(|(other, device)| (device.priority, Some(*other) == held.as_ref()))
                .map(|(other, _)| other.clone());
            // The last device stays until another one comes: it may still have to lift the brush.
            best.or(held).or_else(|| Some(name.to_owned()))
        };
        self.active.as_deref() == Some(name)
    }
}

#[cfg(test)]
mod tests {
    use super::Range::{Away, Near};
    use super::Stroke::{GoesOn, None};
    use super::*;

    const MOUSE: (&str, i32) = ("mouse", -100);
    const PEN: (&str, i32) = ("pen", 10);

    fn admit(
        arbiter: &mut Arbiter,
        (name, priority): (&str, i32),
        range: Range,
        stroke: Stroke,
        ms: u64,
    ) -> bool {
        arbiter.admit(name, priority, range, stroke, ms * 1_000_000)
    }

    #[test]
    fn the_highest_priority_in_range_paints() {
        let mut arbiter = Arbiter::default();
        assert!(admit(&mut arbiter, MOUSE, Near, None, 0));
        assert!(!admit(&mut arbiter, PEN, Away, None, 1), "out of range");
        assert!(admit(&mut arbiter, PEN, Near, None, 2));
        assert!(!admit(&mut arbiter, MOUSE, Near, None, 3));
        admit(&mut arbiter, PEN, Away, None, 4);
        assert!(
            admit(&mut arbiter, MOUSE, Near, None, 5),
            "the pen has left"
        );
    }

    #[test]
    fn nobody_takes_over_in_a_stroke() {
        let mut arbiter = Arbiter::default();
        assert!(admit(&mut arbiter, MOUSE, Near, None, 0));
        assert!(!admit(&mut arbiter, PEN, Near, GoesOn, 1));
        assert!(admit(&mut arbiter, MOUSE, Near, GoesOn, 2));
        let after = admit(&mut arbiter, MOUSE, Near, None, 3);
        assert!(!after, "the stroke is over");
    }

    #[test]
    fn a_mouse_at_rest_keeps_the_brush_until_another_device_is_in_range() {
        let mut arbiter = Arbiter::default();
        let later = 2 * SILENCE_NS / 1_000_000;
        assert!(admit(&mut arbiter, MOUSE, Near, None, 0));
        assert!(!admit(&mut arbiter, PEN, Away, None, later));
        assert!(admit(&mut arbiter, PEN, Near, None, later + 1));
    }

    #[test]
    fn a_silent_device_loses_the_brush() {
        let mut arbiter = Arbiter::default();
        assert!(admit(&mut arbiter, PEN, Near, None, 0));
        assert!(admit(
            &mut arbiter,
            MOUSE,
            Near,
            GoesOn,
            SILENCE_NS / 1_000_000
        ));
        let mut arbiter = Arbiter::default();
        assert!(admit(&mut arbiter, PEN, Near, None, 0));
        let lifts = admit(&mut arbiter, MOUSE, Away, GoesOn, LOST_NS / 1_000_000);
        assert!(lifts, "it lifts the brush");
    }

    /// A window may be late by seconds on a busy machine.
    #[test]
    fn a_stroke_outlasts_a_late_frame_whatever_rests_out_of_range() {
        let mut arbiter = Arbiter::default();
        assert!(admit(&mut arbiter, MOUSE, Near, None, 0));
        for ms in (100..4900).step_by(100) {
            assert!(!admit(&mut arbiter, PEN, Away, GoesOn, ms), "{ms} ms");
        }
        assert!(admit(&mut arbiter, MOUSE, Near, GoesOn, 4900));
    }
}
