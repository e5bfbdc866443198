//! Speed limit of a touching brush: twenty metres a second, which no hand exceeds.
//!
//! The path between two samples is solved step by step, so samples too far apart would take more work than there is
//! time. Speed is measured over a frame, not between two samples, because a device with delayed reports, or a late
//! window, gives several at once.

/// Greatest speed of a handle in contact, m/s.
pub const FASTEST_M_S: f64 = 20.0;
/// Time over which the speed is measured, s: a frame of a window.
const FRAME_S: f64 = 0.016;

/// Remaining path of a handle, a bucket that fills by [`FASTEST_M_S`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpeedLimit {
    spare_m: f64,
}

impl Default for SpeedLimit {
    fn default() -> Self {
        Self {
            spare_m: FASTEST_M_S * FRAME_S,
        }
    }
}

impl SpeedLimit {
    /// Lets `time_ns` pass in which the handle moves by `way_m`, 0 in the air; false where that is too fast or not
    /// finite. Such a move empties the bucket, so that nothing of a flood passes until it is as slow as a hand.
    pub fn passes(&mut self, way_m: f64, time_ns: u64) -> bool {
        let room_m = self.spare_m + FASTEST_M_S * 1e-9 * time_ns as f64;
        let passes = way_m <= room_m;
        let left_m = if passes { room_m - way_m } else { 0.0 };
        self.spare_m = left_m.min(FASTEST_M_S * FRAME_S);
        passes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: u64 = 1_000_000;

    /// Number of samples that pass, out of `count` that are `way_m` and `time_ns` apart.
    fn passing(count: u32, way_m: f64, time_ns: u64) -> u32 {
        let mut limit = SpeedLimit::default();
        let mut passing = 0;
        for _ in 0..count {
            passing += u32::from(limit.passes(way_m, time_ns));
        }
        passing
    }

    #[test]
    fn a_hand_passes_at_every_rate_of_samples_and_a_flood_goes_no_faster_than_the_limit() {
        assert_eq!(passing(1000, 0.019, MS), 1000, "19 m/s at 1 kHz");
        assert_eq!(passing(60, 0.3, 16 * MS), 60, "19 m/s at 60 Hz");
        // 200 mm/s at 1 kHz, played two hundred times as fast.
        let passed = passing(100_000, 0.0002, MS / 200);
        let gone_m = f64::from(passed) * 0.0002;
        assert!(
            (0.63..0.65).contains(&gone_m),
            "{gone_m} m: a frame's, filled up meanwhile"
        );
    }

    #[test]
    fn samples_that_come_together_pass_and_a_leap_across_a_canvas_too() {
        let mut limit = SpeedLimit::default();
        assert!((0..16).all(|_| limit.passes(0.01, 1)), "a late frame");
        assert!(limit.passes(0.0, 20 * MS));
        assert!(limit.passes(0.3, MS), "a pointer that leaps");
        assert!(!limit.passes(0.3, MS), "but not again and again");
        assert!(!limit.passes(0.4, MS));
        assert!(limit.passes(0.019, MS), "a hand again");
    }

    #[test]
    fn what_is_not_finite_is_too_fast_and_forgotten() {
        let mut limit = SpeedLimit::default();
        for way_m in [f64::NAN, f64::INFINITY, f64::MAX] {
            assert!(!limit.passes(way_m, u64::MAX / 2_000_000));
        }
        assert!(limit.passes(0.001, MS));
    }
}
