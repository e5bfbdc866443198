//! A seeded stroke: a hand that slides over the surface and all the while tilts, presses, turns and
//! wiggles.

use glam::DVec3;
use maulstick_brush::head::place::Random;
use maulstick_num::geometry::{Rigid, rotation};
use maulstick_num::sin;

/// Poses of a stroke.
pub(crate) const POSES: usize = 400;
/// Time between poses, s.
const STEP_S: f64 = 1e-3;

/// A movement to and fro: a sum of sines.
struct Sway([[f64; 3]; 3]);

impl Sway {
    /// Random motion of up to `most` either way, at frequencies up to `fastest` (Hz).
    fn new(random: &mut Random, most: f64, fastest: f64) -> Self {
        Self([1.0, 0.6, 0.3].map(|share| {
            let amplitude = most / 3.0 * (0.5 + random.unit());
            let frequency = fastest * share * (0.5 + 0.5 * random.unit());
            let turn = 2.0 * std::f64::consts::PI;
            [amplitude, frequency * turn, random.unit() * turn]
        }))
    }

    fn at(&self, t: f64) -> f64 {
        let parts = self.0.iter();
        parts
            .map(|[amplitude, rate, phase]| amplitude * sin(rate * t + phase))
            .sum()
    }
}

/// The stroke of a seed for a head of a length (m): at .2 m/s and 1 kHz, tilted by .35 to .85 rad, the
/// ferrule at .4 to .7 of the length above the surface.
pub(crate) fn stroke(seed: u64, length_m: f64) -> Vec<Rigid> {
    let mut random = Random::new(seed);
    let mut sway = |most: f64, fastest: f64| Sway::new(&mut random, most, fastest);
    let (tilt, turn) = (sway(0.25, 3.0), sway(0.6, 2.0));
    let (roll, press) = (sway(0.8, 2.0), sway(0.15, 3.0));
    let (along, across) = (sway(2e-3, 8.0), sway(2e-3, 8.0));
    (0..POSES)
        .map(|i| {
            let t = i as f64 * STEP_S;
            let lean = rotation(DVec3::Y, 0.6 + tilt.at(t));
            Rigid {
                rotation: rotation(DVec3::Z, turn.at(t)) * lean * rotation(DVec3::Z, roll.at(t)),
                translation: DVec3::new(
                    -0.2 * t + along.at(t),
                    across.at(t),
                    length_m * (0.55 + press.at(t)),
                ),
            }
        })
        .collect()
}
