//! The grain of the canvas: a small tangential texture of a narrow band of wavelengths.
//!
//! f = −a·(λ/2π)·∇Φ with Φ a sum of plane waves between λ and √2·λ in directions and phases from the seed: a potential,
//! so a closed path gains nothing. Its stiffness a·2π/λ is kept below a fifth of the device's bound (Choi and Tan 2004:
//! textures shake first). The waves fade where the hand is so fast that the servo would sample them coarsely.

use glam::DVec3;
use maulstick_num::sin_cos;
use maulstick_types::haptics::Grain;

/// Number of plane waves.
const WAVES: usize = 6;
/// Shortest wavelength, m: four steps of a coarse encoder.
const FINEST_M: f64 = 2e-4;
/// Stiffness of the texture as a share of the device's greatest.
const STIFFNESS_SHARE: f64 = 0.2;
/// Frequency of passing waves above which they vanish, Hz: a tenth of the servo's rate.
const FASTEST_HZ: f64 = 100.0;

/// The waves, ready for the servo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Texture {
    amplitude: f64,
    wavelength_m: f64,
    /// Wave vector along two axes across the normal, by 2π/λ, and phase.
    waves: [[f64; 3]; WAVES],
}

/// SplitMix64 (Steele, Lea and Flood 2014).
fn next(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

impl Texture {
    /// Converts a grain.
    ///
    /// # Errors
    /// The value out of range: the amplitude must be 0 to 1, the wavelength .2 mm at least.
    pub fn new(grain: &Grain) -> Result<Self, &'static str> {
        let known = grain.amplitude.is_finite() && grain.wavelength_m.is_finite();
        if !known || !(0.0..=1.0).contains(&grain.amplitude) || grain.wavelength_m < FINEST_M {
            return Err("the grain's amplitude or wavelength is out of range");
        }
        let mut state = grain.seed;
        let mut waves = [[0.0; 3]; WAVES];
        for (place, wave) in waves.iter_mut().enumerate() {
            // Spread all around, so that each direction has a wave.
            let turn = (place as f64 + next(&mut state)) / WAVES as f64 * std::f64::consts::PI;
            let (sine, cosine) = sin_cos(turn);
            // From λ to √2·λ.
            let number = 1.0 - next(&mut state) * (1.0 - std::f64::consts::FRAC_1_SQRT_2);
            let phase = 2.0 * std::f64::consts::PI * next(&mut state);
            *wave = [number * cosine, number * sine, phase];
        }
        Ok(Self {
            amplitude: grain.amplitude,
            wavelength_m: grain.wavelength_m,
            waves,
        })
    }

    /// Greatest stiffness of the texture, N/m, on a device with this greatest stiffness.
    #[must_use]
    pub fn stiffness(&self, max_stiffness: f64) -> f64 {
        if self.amplitude > 0.0 {
            STIFFNESS_SHARE * max_stiffness
        } else {
            0.0
        }
    }

    /// Force at a place relative to the plane's point, m, on a hand at the velocity `across` the normal, m/s; its
    /// magnitude is at most the amplitude times `normal_n`.
    #[must_use]
    pub fn force(
        &self,
        place: DVec3,
        normal: DVec3,
        across: DVec3,
        normal_n: f64,
        max_stiffness: f64,
    ) -> DVec3 {
        if self.amplitude == 0.0 || normal_n <= 0.0 {
            return DVec3::ZERO;
        }
        let number = 2.0 * std::f64::consts::PI / self.wavelength_m;
        let passing_hz = across.length() / self.wavelength_m;
        let fade = (1.0 - passing_hz / FASTEST_HZ).max(0.0);
        let size = (self.amplitude * normal_n).min(STIFFNESS_SHARE * max_stiffness / number) * fade;
        let (u, v) = normal.any_orthonormal_pair();
        let at = [u.dot(place) * number, v.dot(place) * number];
        let mut slope = [0.0; 2];
        for [x, y, phase] in self.waves {
            let (sine, _) = sin_cos(x * at[0] + y * at[1] + phase);
            slope = [slope[0] + x * sine, slope[1] + y * sine];
        }
        (u * slope[0] + v * slope[1]) * (size / WAVES as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAMBDA: f64 = 1e-3;

    fn texture(amplitude: f64, seed: u64) -> Texture {
        Texture::new(&Grain {
            amplitude,
            wavelength_m: LAMBDA,
            seed,
        })
        .expect("a grain")
    }

    fn along_x(texture: &Texture, x: f64, max_stiffness: f64) -> DVec3 {
        texture.force(
            DVec3::new(x, 0.3e-3, 0.0),
            DVec3::Z,
            DVec3::ZERO,
            0.5,
            max_stiffness,
        )
    }

    #[test]
    fn it_is_across_the_normal_small_and_of_its_seed() {
        let grain = texture(0.05, 1);
        let mut most: f64 = 0.0;
        for step in 0..5000 {
            let force = along_x(&grain, f64::from(step) * 1e-5, 1e9);
            assert!(force.z == 0.0 && force.length() <= 0.05 * 0.5);
            most = most.max(force.length());
        }
        assert!(most > 0.2 * 0.05 * 0.5, "{most} N can be felt");
        assert_ne!(
            along_x(&grain, 0.0, 1e9),
            along_x(&texture(0.05, 2), 0.0, 1e9)
        );
        assert_eq!(along_x(&texture(0.0, 1), 0.0, 1e9), DVec3::ZERO);
    }

    #[test]
    fn its_stiffness_stays_below_a_share_of_the_devices() {
        let grain = texture(1.0, 1);
        let mut steepest: f64 = 0.0;
        for step in 0..20_000 {
            let x = f64::from(step) * 1e-6;
            let (here, there) = (along_x(&grain, x, 400.0), along_x(&grain, x + 1e-6, 400.0));
            steepest = steepest.max((there - here).length() / 1e-6);
        }
        assert!(steepest <= 80.0 * (1.0 + 1e-6), "{steepest} N/m");
        assert!(steepest > 10.0, "{steepest} N/m");
    }

    /// Power of the texture along a line at a wavelength, by correlation.
    fn power(grain: &Texture, wavelength: f64) -> f64 {
        let (mut cosine, mut sine) = (0.0, 0.0);
        for step in 0..20_000 {
            let x = f64::from(step) * 1e-5;
            let (s, c) = sin_cos(2.0 * std::f64::consts::PI * x / wavelength);
            let force = along_x(grain, x, 1e9).x;
            (cosine, sine) = (cosine + c * force, sine + s * force);
        }
        cosine * cosine + sine * sine
    }

    #[test]
    fn no_wave_is_finer_than_its_wavelength() {
        let grain = texture(0.05, 3);
        let within = |from: f64, to: f64| {
            let place = |i: i32| from * maulstick_num::powf(to / from, f64::from(i) / 200.0);
            (0..200)
                .map(|i| power(&grain, place(i)))
                .fold(0.0, f64::max)
        };
        let (fine, own) = (
            within(0.2 * LAMBDA, 0.93 * LAMBDA),
            within(LAMBDA, 4.0 * LAMBDA),
        );
        assert!(fine < 0.05 * own, "{fine} {own}");
    }

    #[test]
    fn round_a_closed_way_it_gives_nothing() {
        let grain = texture(0.05, 4);
        let steps = 20_000;
        let at = |i: i32| {
            let (s, c) = sin_cos(2.0 * std::f64::consts::PI * f64::from(i) / f64::from(steps));
            DVec3::new(c, s, 0.0) * 2e-3
        };
        let (mut given, mut gone): (f64, f64) = (0.0, 0.0);
        for i in 0..steps {
            let (from, to) = (at(i), at(i + 1));
            let force = grain.force((from + to) * 0.5, DVec3::Z, DVec3::ZERO, 0.5, 1e9);
            given += force.dot(to - from);
            gone += force.dot(to - from).abs();
        }
        assert!(given.abs() < 1e-6 * gone, "{given} of {gone} J");
    }

    #[test]
    fn a_fast_hand_feels_none() {
        let grain = texture(0.05, 1);
        let at = |speed: f64| grain.force(DVec3::ZERO, DVec3::Z, DVec3::X * speed, 0.5, 1e9);
        assert!(at(0.05).length() > 0.0);
        assert_eq!(at(0.11), DVec3::ZERO);
    }

    #[test]
    fn bad_grains_are_refused() {
        for (amplitude, wavelength_m) in [
            (-0.1, 1e-3),
            (1.1, 1e-3),
            (f64::NAN, 1e-3),
            (0.1, 1e-5),
            (0.1, f64::INFINITY),
        ] {
            let grain = Grain {
                amplitude,
                wavelength_m,
                seed: 1,
            };
            assert!(Texture::new(&grain).is_err(), "{grain:?}");
        }
    }
}
