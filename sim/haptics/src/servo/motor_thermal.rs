//! Thermal model of the motors, which bounds the force: motors bear several times their continuous force
//! for a moment.
//!
//! The rule of the vendor's own example for Phantoms, by time instead of ticks: above .7 the largest force falls by a
//! thousandth each millisecond, to the continuous one; below .5 it rises as fast.
//!
//! Not every device reports its motors' temperature, so the servo also estimates it: the heat of the coils is
//! proportional to the square of the force, and at the continuous force they settle between warm and cool. The warmer
//! of the two counts. A Phantom with .88 N continuous thus gives 3.3 N for five seconds.

use super::limits::Limits;

/// Temperature above which the motors are warm.
const WARM: f64 = 0.7;
/// Temperature below which they have cooled.
const COOL: f64 = 0.5;
/// Relative rate at which the largest force falls and rises, 1/s.
const RATE: f64 = 1.0;

/// Steady temperature at the continuous force.
const STEADY: f64 = 0.6;
/// Time constant, s; a lower bound for motors as small as a stylus's.
const WARMING_S: f64 = 60.0;

/// Thermal state of the motors, and the largest force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotorThermal {
    temperature: f64,
    reckoned: f64,
    cap_n: f64,
}

impl MotorThermal {
    /// Cold motors with a peak force of `peak_n`.
    #[must_use]
    pub fn cold(peak_n: f64) -> Self {
        Self {
            temperature: 0.0,
            reckoned: 0.0,
            cap_n: peak_n,
        }
    }

    /// Updates the temperature of the hottest motor, 0 cold to 1 hot.
    pub fn measure(&mut self, temperature: f64) {
        self.temperature = temperature;
    }

    /// Heats the motors by `dt` s of this force.
    pub fn warm(&mut self, force_n: f64, continuous_n: f64, dt: f64) {
        let load = if continuous_n > 0.0 {
            force_n / continuous_n
        } else {
            0.0
        };
        self.reckoned += (STEADY * load * load - self.reckoned) * (dt / WARMING_S).clamp(0.0, 1.0);
    }

    /// False if the device reported NaN or infinity.
    #[must_use]
    pub fn is_known(&self) -> bool {
        self.temperature.is_finite()
    }

    /// Replaces a temperature that is not finite by 0, until the next report.
    pub fn forget_unknown(&mut self) {
        if !self.is_known() {
            self.temperature = 0.0;
        }
    }

    /// Largest force, N, after `dt` s of this force, at rest, or after a fault.
    pub fn follow(&mut self, force_n: f64, limits: &Limits, dt: f64) -> f64 {
        let dt = if dt.is_finite() { dt.max(0.0) } else { 0.0 };
        self.warm(force_n, limits.continuous_force_n, dt);
        self.cap_n(limits.max_force_n, limits.continuous_force_n, dt)
    }

    /// Largest force, N, `dt` s later.
    pub fn cap_n(&mut self, peak_n: f64, continuous_n: f64, dt: f64) -> f64 {
        let temperature = self.temperature.max(self.reckoned);
        if temperature > WARM {
            self.cap_n *= (1.0 - RATE * dt).max(0.0);
        } else if temperature < COOL {
            self.cap_n *= 1.0 + RATE * dt;
        }
        // Written so that limits that are NaN bound nothing upward.
        self.cap_n = self.cap_n.max(continuous_n.min(peak_n)).min(peak_n);
        self.cap_n
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest force after some seconds at a temperature.
    fn after(thermal: &mut MotorThermal, temperature: f64, seconds: u32) -> f64 {
        thermal.measure(temperature);
        (0..1000 * seconds).fold(0.0, |_, _| thermal.cap_n(3.0, 0.88, 1e-3))
    }

    #[test]
    fn warm_motors_come_down_to_what_they_bear_and_cool_ones_come_back() {
        let mut thermal = MotorThermal::cold(3.0);
        assert_eq!(after(&mut thermal, 0.6, 10), 3.0);
        // 3·(1 − 10⁻³)¹⁰⁰⁰.
        assert!((after(&mut thermal, 0.8, 1) - 1.103).abs() < 1e-3);
        assert_eq!(after(&mut thermal, 0.8, 1), 0.88);
        assert_eq!(
            after(&mut thermal, 0.6, 10),
            0.88,
            "not before it has cooled"
        );
        assert!(after(&mut thermal, 0.4, 1) > 2.3);
        assert_eq!(after(&mut thermal, 0.4, 1), 3.0);
    }

    #[test]
    fn motors_of_which_nothing_is_said_are_reckoned_warm_by_their_force() {
        // From cold 60·ln(8.44/(8.44 − .7)) s until they are warm, a second more to the continuous force.
        let mut thermal = MotorThermal::cold(3.3);
        let (mut cap_n, mut seconds) = (3.3, 0.0_f64);
        while cap_n > 0.88 {
            thermal.warm(cap_n, 0.88, 1e-3);
            cap_n = thermal.cap_n(3.3, 0.88, 1e-3);
            seconds += 1e-3;
        }
        assert!((seconds - 5.2 - 1.3).abs() < 0.3, "{seconds} s");
        // At the continuous force they neither warm nor cool; at rest they cool and the full force returns.
        for _ in 0..600_000 {
            thermal.warm(0.88, 0.88, 1e-3);
            assert_eq!(thermal.cap_n(3.3, 0.88, 1e-3), 0.88);
        }
        (0..60_000).for_each(|_| thermal.warm(0.0, 0.88, 1e-3));
        (0..5000).for_each(|_| cap_n = thermal.cap_n(3.3, 0.88, 1e-3));
        assert_eq!(cap_n, 3.3);
    }

    #[test]
    fn a_device_that_bears_its_peak_for_ever_is_not_derated() {
        let mut thermal = MotorThermal::cold(2.0);
        thermal.measure(1.0);
        assert_eq!(
            (0..10_000).fold(0.0, |_, _| thermal.cap_n(2.0, 5.0, 1e-3)),
            2.0
        );
    }
}
