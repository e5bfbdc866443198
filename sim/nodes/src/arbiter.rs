//! Which of several devices moves the brush: of those in range the one of highest priority, and
//! another one only between strokes.

use std::collections::BTreeMap;

use maulstick_types::Origin;

/// A device that is silent for this long is out of range, ns.
const SILENCE_NS: u64 = 500_000_000;

/// The devices of a brush.
#[derive(Clone, Debug, Default)]
pub struct Arbiter {
    devices: BTreeMap<Origin, Device>,
    active: Option<Origin>,
}

#[derive(Clone, Copy, Debug)]
struct Device {
    priority: i32,
    in_range: bool,
    heard_ns: u64,
}

impl Arbiter {
    /// A sample came; whether its device moves the brush. `touching` says that a stroke is going on.
    pub fn hear(
        &mut self,
        origin: Origin,
        priority: i32,
        in_range: bool,
        now_ns: u64,
        touching: bool,
    ) -> bool {
        self.devices.retain(|other, device| {
            (other.source != origin.source || *other == origin)
                && now_ns < device.heard_ns.saturating_add(SILENCE_NS)
        });
        self.devices.insert(
            origin,
            Device {
                priority,
                in_range,
                heard_ns: now_ns,
            },
        );
        let held = self
            .active
            .filter(|active| self.devices.contains_key(active));
        let keeps = touching && held.is_some_and(|active| self.devices[&active].in_range);
        if !keeps {
            let best = self
                .devices
                .iter()
                .filter(|(_, device)| device.in_range)
                .max_by_key(|(other, device)| (device.priority, Some(**other) == self.active));
            // The last device stays until another one comes: it may still have to lift the brush.
            self.active = best.map(|(other, _)| *other).or(held).or(Some(origin));
        }
        self.active == Some(origin)
    }

    /// The device that moves the brush.
    #[must_use]
    pub fn active(&self) -> Option<Origin> {
        self.active
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOUSE: Origin = Origin {
        source: 1,
        epoch: 1,
    };
    const PEN: Origin = Origin {
        source: 2,
        epoch: 1,
    };

    #[test]
    fn the_highest_priority_in_range_paints() {
        let mut arbiter = Arbiter::default();
        assert!(arbiter.hear(MOUSE, -100, true, 0, false));
        assert!(!arbiter.hear(PEN, 10, false, 1, false), "out of range");
        assert!(arbiter.hear(PEN, 10, true, 2, false));
        assert!(!arbiter.hear(MOUSE, -100, true, 3, false));
        assert!(
            arbiter.hear(PEN, 10, false, 4, false) || arbiter.hear(MOUSE, -100, true, 5, false)
        );
    }

    #[test]
    fn nobody_takes_over_in_a_stroke() {
        let mut arbiter = Arbiter::default();
        assert!(arbiter.hear(MOUSE, -100, true, 0, false));
        assert!(!arbiter.hear(PEN, 10, true, 1, true));
        assert!(arbiter.hear(MOUSE, -100, true, 2, true));
        assert!(
            !arbiter.hear(MOUSE, -100, true, 3, false),
            "the stroke is over"
        );
    }

    #[test]
    fn a_silent_device_loses_the_brush() {
        let mut arbiter = Arbiter::default();
        assert!(arbiter.hear(PEN, 10, true, 0, false));
        assert!(arbiter.hear(MOUSE, -100, true, SILENCE_NS, true));
    }

    #[test]
    fn a_restarted_device_is_the_same_device() {
        let mut arbiter = Arbiter::default();
        assert!(arbiter.hear(PEN, 10, true, 0, false));
        assert!(arbiter.hear(Origin { epoch: 2, ..PEN }, 10, true, 1, true));
    }
}
