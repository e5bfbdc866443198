//! Extent of a tip's motion.

use glam::DVec3;

/// Smallest axis-aligned box around the places of a tip.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    low: DVec3,
    high: DVec3,
}

impl Extent {
    /// Extent of no place.
    pub const NONE: Self = Self {
        low: DVec3::MAX,
        high: DVec3::MIN,
    };

    /// Grows the box to include a place, m.
    pub fn include(&mut self, place: DVec3) {
        self.low = self.low.min(place);
        self.high = self.high.max(place);
    }

    /// Greatest movement along an axis, peak to peak, m.
    #[must_use]
    pub fn peak_to_peak_m(&self) -> f64 {
        (self.high - self.low).max_element()
    }
}
