//! A hand that shakes against a wall: it reverses along the normal 10 to 60 times a second, by more than an encoder's
//! step, and does not come to rest as a kicked one does. No hand dabs that fast, and its tremor is finer.
//!
//! Each detection makes the force softer; soft enough, any device is still. If it is not, there is another fault.
//!
//! In contact the force only gets softer, as that of a fast hand does: a wall that grew hard again under a hand would
//! return more energy on the way out than it absorbed on the way in. It recovers while the hand is away.

/// Time between two reversals of a shaking hand, s: half a period of 60 Hz and of 10 Hz.
const HALF_PERIOD_S: [f64; 2] = [1.0 / 120.0, 1.0 / 20.0];
/// Ratio of successive swings below which a hand is coming to rest.
const DYING: f64 = 0.95;
/// Number of reversals that count as shaking, beyond those of a hand that comes to rest: three periods.
const TURNS: u32 = 6;
/// Time off the surface after which a hand does not shake against it, s.
const AWAY_S: f64 = 0.1;
/// Factor on the stiffness after each detection.
const SOFTER: f64 = 0.7;
/// Least share of the requested stiffness; shaking at this is a fault.
const SOFTEST: f64 = 0.15;
/// Rate at which stiffness recovers while the hand is away, 1/s.
const RECOVERY: f64 = 0.02;

/// Detector of an oscillating hand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillation {
    /// Share of the requested stiffness.
    softness: f64,
    /// Farthest place since the last reversal, m, and the direction toward it, 1 or −1.
    farthest: f64,
    way: f64,
    /// Place of the last reversal and the swing toward it, m.
    last_turn: f64,
    swing_m: f64,
    since_turn_s: f64,
    away_s: f64,
    turns: u32,
}

impl Default for Oscillation {
    fn default() -> Self {
        Self {
            softness: 1.0,
            farthest: 0.0,
            way: 1.0,
            last_turn: 0.0,
            swing_m: 0.0,
            since_turn_s: 0.0,
            away_s: 0.0,
            turns: 0,
        }
    }
}

impl Oscillation {
    /// Updates the detector with the hand's place along the normal, m, after `dt` s; a reversal is a return by
    /// `turn_m`. True if the hand shakes at the softest.
    pub fn watch(&mut self, place: f64, turn_m: f64, in_contact: Touch, dt: f64) -> bool {
        self.since_turn_s += dt;
        self.away_s = match in_contact {
            Touch::Contact => 0.0,
            Touch::Air => self.away_s + dt,
        };
        if (place - self.farthest) * self.way > 0.0 {
            self.farthest = place;
        } else if (self.farthest - place) * self.way > turn_m {
            self.turned(place);
        }
        if self.since_turn_s > HALF_PERIOD_S[1] {
            self.turns = 0;
            if in_contact == Touch::Air {
                self.softness = (self.softness + RECOVERY * dt).min(1.0);
            }
        }
        if self.turns < TURNS {
            return false;
        }
        self.turns = 0;
        self.softness *= SOFTER;
        self.softness < SOFTEST
    }

    fn turned(&mut self, place: f64) {
        let [least, most] = HALF_PERIOD_S;
        let swing_m = (self.farthest - self.last_turn).abs();
        let fast = (least..=most).contains(&self.since_turn_s) && self.away_s < AWAY_S;
        self.turns = match fast {
            true if swing_m >= DYING * self.swing_m => self.turns + 1,
            true => self.turns.saturating_sub(1),
            false => 0,
        };
        (self.last_turn, self.swing_m) = (self.farthest, swing_m);
        (self.farthest, self.way, self.since_turn_s) = (place, -self.way, 0.0);
    }

    /// Share of the requested stiffness.
    #[must_use]
    pub fn softness(&self) -> f64 {
        self.softness
    }
}

/// Contact of the head with a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Touch {
    /// The head touches a surface.
    Contact,
    /// The head is in the air.
    Air,
}

#[cfg(test)]
mod tests {
    use maulstick_num::sin;

    use super::*;

    const TURN_M: f64 = 3e-4;

    /// A hand that swings by `swing_m` to each side at `hz` for `seconds`.
    fn swing(hz: f64, swing_m: f64, touch: Touch, seconds: f64) -> (Oscillation, bool) {
        let mut oscillation = Oscillation::default();
        let mut fault = false;
        for tick in 0..(seconds * 1e3) as i32 {
            let turn = 2.0 * std::f64::consts::PI * hz * f64::from(tick) * 1e-3;
            fault |= oscillation.watch(swing_m * sin(turn), TURN_M, touch, 1e-3);
        }
        (oscillation, fault)
    }

    #[test]
    fn a_shaking_hand_is_found_at_each_frequency_within_a_third_of_a_second() {
        for hz in [12.0, 17.0, 21.0, 35.0, 55.0] {
            let (oscillation, _) = swing(hz, 1e-3, Touch::Contact, 0.34);
            assert!(oscillation.softness() < 1.0, "{hz} Hz");
            let (_, fault) = swing(hz, 1e-3, Touch::Contact, 3.0);
            assert!(fault, "{hz} Hz for three seconds");
        }
    }

    #[test]
    fn strokes_dabs_tremor_and_a_hand_in_the_air_are_none() {
        for (hz, swing_m, touch) in [
            (1.0, 0.02, Touch::Contact),
            (7.0, 5e-3, Touch::Contact),
            (10.0, 1e-4, Touch::Contact),
            (35.0, 1e-4, Touch::Contact),
            (100.0, 1e-3, Touch::Contact),
            (20.0, 5e-3, Touch::Air),
        ] {
            let (oscillation, _) = swing(hz, swing_m, touch, 3.0);
            assert_eq!(
                oscillation.softness(),
                1.0,
                "{hz} Hz, {swing_m} m, {touch:?}"
            );
        }
    }

    #[test]
    fn a_hand_that_rings_when_it_is_kicked_is_none() {
        let mut oscillation = Oscillation::default();
        for tick in 0..20_000 {
            // A kick each 300 ms; each reversal loses a twelfth, as for a fingertip on a stiff wall.
            let since = f64::from(tick % 300) * 1e-3;
            let swing = 3e-3 * maulstick_num::exp(-3.5 * since) * sin(120.0 * since);
            assert!(!oscillation.watch(swing, TURN_M, Touch::Contact, 1e-3));
        }
        assert_eq!(oscillation.softness(), 1.0);
    }

    #[test]
    fn a_hand_that_has_shaken_feels_its_wall_again_after_it_was_away() {
        let (mut oscillation, _) = swing(20.0, 1e-3, Touch::Contact, 0.5);
        let softened = oscillation.softness();
        assert!(softened < 0.8);
        for _ in 0..45_000 {
            oscillation.watch(0.0, TURN_M, Touch::Contact, 1e-3);
        }
        assert_eq!(oscillation.softness(), softened);
        for _ in 0..45_000 {
            oscillation.watch(0.0, TURN_M, Touch::Air, 1e-3);
        }
        assert_eq!(oscillation.softness(), 1.0);
    }
}
