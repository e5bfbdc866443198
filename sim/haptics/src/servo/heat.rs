//! The largest force by the temperature of the motors: what they bear for a moment is several times
//! what they bear for long.
//!
//! The rule of the vendor's own example for Phantoms, by time instead of ticks: above .7 the largest
//! force falls by a part in a thousand each millisecond, to the continuous one; below .5 it comes
//! back as fast.

/// Above this the motors are warm.
const WARM: f64 = 0.7;
/// Below this they have cooled.
const COOL: f64 = 0.5;
/// How fast the largest force falls and comes back, by itself, 1/s.
const RATE: f64 = 1.0;

/// The largest force as the motors warm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heat {
    temperature: f64,
    cap_n: f64,
}

impl Heat {
    /// Cold motors that bear `peak_n`.
    #[must_use]
    pub fn cold(peak_n: f64) -> Self {
        Self {
            temperature: 0.0,
            cap_n: peak_n,
        }
    }

    /// What the device says: 0 cold to 1 hot, the hottest of its motors.
    pub fn measure(&mut self, temperature: f64) {
        self.temperature = temperature;
    }

    /// Whether what the device said is a number.
    #[must_use]
    pub fn is_known(&self) -> bool {
        self.temperature.is_finite()
    }

    /// What is known of the motors stays; a temperature that is no number is cold until the next.
    pub fn forget_unknown(&mut self) {
        if !self.is_known() {
            self.temperature = 0.0;
        }
    }

    /// The largest force, N, `dt` s later.
    pub fn cap_n(&mut self, peak_n: f64, continuous_n: f64, dt: f64) -> f64 {
        if self.temperature > WARM {
            self.cap_n *= (1.0 - RATE * dt).max(0.0);
        } else if self.temperature < COOL {
            self.cap_n *= 1.0 + RATE * dt;
        }
        // Written so that limits that are no numbers bound nothing upward.
        self.cap_n = self.cap_n.max(continuous_n.min(peak_n)).min(peak_n);
        self.cap_n
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest force after so many seconds at a temperature.
    fn after(heat: &mut Heat, temperature: f64, seconds: u32) -> f64 {
        heat.measure(temperature);
        (0..1000 * seconds).fold(0.0, |_, _| heat.cap_n(3.0, 0.88, 1e-3))
    }

    #[test]
    fn warm_motors_come_down_to_what_they_bear_and_cool_ones_come_back() {
        let mut heat = Heat::cold(3.0);
        assert_eq!(after(&mut heat, 0.6, 10), 3.0);
        // 3·(1 − 10⁻³)¹⁰⁰⁰.
        assert!((after(&mut heat, 0.8, 1) - 1.103).abs() < 1e-3);
        assert_eq!(after(&mut heat, 0.8, 1), 0.88);
        assert_eq!(after(&mut heat, 0.6, 10), 0.88, "not before it has cooled");
        assert!(after(&mut heat, 0.4, 1) > 2.3);
        assert_eq!(after(&mut heat, 0.4, 1), 3.0);
    }

    #[test]
    fn a_device_that_bears_its_peak_for_ever_is_not_derated() {
        let mut heat = Heat::cold(2.0);
        heat.measure(1.0);
        assert_eq!(
            (0..10_000).fold(0.0, |_, _| heat.cap_n(2.0, 5.0, 1e-3)),
            2.0
        );
    }
}
