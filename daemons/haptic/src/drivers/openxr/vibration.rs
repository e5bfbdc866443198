//! From a force to a vibration. A hand that nothing holds up feels what changes: the touch as a tap, the grain of the
//! canvas as a hum, a brush at rest hardly at all.

use glam::DVec3;

/// Ticks between two orders to the controller, and so many more does an order last.
pub const EVERY: u32 = 16;
/// Share of the force that goes into its mean, a tick: 10 Hz.
const FOLLOWS: f64 = 0.06;
/// Share of a steady force that is felt.
const STEADY: f64 = 0.3;
/// Share of a change that is felt.
const CHANGE: f64 = 2.0;
/// Below this there is no vibration.
const LEAST: f64 = 0.02;

/// The vibration of a controller.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vibration {
    mean: DVec3,
    /// Strongest since the last order.
    strongest: f64,
    ticks: u32,
    is_on: bool,
}

impl Vibration {
    /// Takes in a force, as a share of the full one; an amplitude of 0 to 1 where it is time to give an order.
    pub fn follow(&mut self, force: DVec3) -> Option<f64> {
        self.mean += (force - self.mean) * FOLLOWS;
        let felt = STEADY * force.length() + CHANGE * (force - self.mean).length();
        // No force is none at once.
        let felt = if force == DVec3::ZERO { 0.0 } else { felt };
        self.strongest = self.strongest.max(felt);
        self.ticks += 1;
        if self.ticks < EVERY {
            return None;
        }
        let amplitude = if self.strongest > LEAST {
            self.strongest.min(1.0)
        } else {
            0.0
        };
        (self.ticks, self.strongest) = (0, 0.0);
        let was_on = std::mem::replace(&mut self.is_on, amplitude > 0.0);
        (was_on || self.is_on).then_some(amplitude)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Orders under a force by the tick.
    fn orders(ticks: u32, force: impl Fn(u32) -> f64) -> Vec<f64> {
        let mut vibration = Vibration::default();
        (0..ticks)
            .filter_map(|tick| vibration.follow(DVec3::Z * force(tick)))
            .collect()
    }

    #[test]
    fn a_touch_is_stronger_than_rest_and_no_force_ends_it_once() {
        let given = orders(1600, |tick| {
            if (800..1200).contains(&tick) {
                0.3
            } else {
                0.0
            }
        });
        let [tap, rest] = [given[0], given[20]];
        assert!(tap > 0.5 && (rest - 0.09).abs() < 1e-3, "{tap} {rest}");
        assert_eq!(given.len(), 400 / EVERY as usize + 1);
        assert_eq!(given.last(), Some(&0.0));
    }

    #[test]
    fn grain_hums_and_nothing_is_stronger_than_all() {
        let hum = |tick: u32| 0.2 + 0.05 * f64::from(tick % 10);
        let grain = orders(800, hum);
        let steady = orders(800, |_| 0.425);
        assert!(grain[40] > 2.0 * steady[40], "{} {}", grain[40], steady[40]);
        assert!(
            orders(160, |_| 9.0)
                .iter()
                .all(|amplitude| *amplitude <= 1.0)
        );
        assert!(orders(800, |_| 0.0).is_empty());
    }
}
