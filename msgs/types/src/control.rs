//! Messages of the free hand's device: a 6-DOF mouse that moves the canvas while the other hand paints.

use crate::wire::define::message;

message! {
    /// One sample of a device for the free hand; `event_ns` of its header is the time of sampling.
    pub struct ControlSample [contract of hash 0x089e_d1b8, version 1, at most 256 bytes] {
        /// Push along each axis, from -1 to 1: right, up along the desk, out of it.
        pub push: [f64; 3],
        /// Turn about each of those axes, right-handed, from -1 to 1.
        pub turn: [f64; 3],
        /// A bit a pressed switch.
        pub switches: u64,
    }
}

impl ControlSample {
    /// Sample of a device that is not touched.
    #[must_use]
    pub fn at_rest() -> Self {
        Self {
            push: [0.0; 3],
            turn: [0.0; 3],
            switches: 0,
        }
    }

    /// Fault of the numbers, if there is one.
    #[must_use]
    pub fn fault(&self) -> Option<&'static str> {
        let mut all = self.push.iter().chain(&self.turn);
        let within = all.all(|value| (-1.0..=1.0).contains(value));
        (!within).then_some("push or turn is not within -1 and 1")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_beyond_the_stops_is_a_fault() {
        assert_eq!(ControlSample::at_rest().fault(), None);
        for value in [1.1, -2.0, f64::NAN, f64::INFINITY] {
            let mut sample = ControlSample::at_rest();
            sample.turn[1] = value;
            assert!(sample.fault().is_some(), "{value}");
        }
    }
}
