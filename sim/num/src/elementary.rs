//! Elementary functions.

/// Sine of `x` rad.
#[must_use]
pub fn sin(x: f64) -> f64 {
    libm::sin(x)
}

/// Cosine of `x` rad.
#[must_use]
pub fn cos(x: f64) -> f64 {
    libm::cos(x)
}

/// Sine and cosine of `x` rad.
#[must_use]
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// Angle in 0..π whose cosine is `x`; `x` is clamped to −1..1.
#[must_use]
pub fn acos(x: f64) -> f64 {
    libm::acos(x.clamp(-1.0, 1.0))
}

/// Angle of the point (x, y), −π..π.
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// e to the power `x`.
#[must_use]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// Natural logarithm.
#[must_use]
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// `x` to the power `y`.
#[must_use]
pub fn powf(x: f64, y: f64) -> f64 {
    libm::pow(x, y)
}

/// e^x in parts: (1 + r·mean)·power, with mean = (e^r − 1)/r.
struct Parts {
    r: f32,
    mean: f32,
    power: f32,
}

/// Splits x into n·ln 2 + r with |r| ≤ ½ ln 2 and takes the Taylor polynomial of degree 7 of e^r
/// (remainder below 2⁻²⁷). No branch and no call, so a loop over it vectorises.
#[inline]
fn parts(x: f32) -> Parts {
    /// Adding and subtracting this rounds to the nearest integer.
    const ROUND: f32 = 12_582_912.0;
    let shifted = x * std::f32::consts::LOG2_E + ROUND;
    let n = shifted - ROUND;
    // ln 2 in two parts: the first has few enough bits that n times it is exact.
    let r = x - n * 0.693_359_4 - n * -2.121_944_4e-4;
    let p = 1.0 / 5040.0;
    let p = p * r + 1.0 / 720.0;
    let p = p * r + 1.0 / 120.0;
    let p = p * r + 1.0 / 24.0;
    let p = p * r + 1.0 / 6.0;
    let p = p * r + 0.5;
    let mean = p * r + 1.0;
    // The integer n sits in the low bits of `shifted`: move it into the exponent.
    let power = f32::from_bits((shifted.to_bits() << 23).wrapping_add(0x3f80_0000));
    Parts { r, mean, power }
}

/// e to the power `x` for −87 ≤ x ≤ 88, relative error below 1.2e-7; below −87 it is 0.
#[must_use]
#[inline]
pub fn exp_f32(x: f32) -> f32 {
    let Parts { r, mean, power } = parts(x.clamp(-87.0, 88.0));
    if x < -87.0 {
        0.0
    } else {
        (mean * r + 1.0) * power
    }
}

/// e^(−t) and its mean over 0..t, (1 − e^(−t))/t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Decay {
    /// e^(−t), at least e^(−40): below that 1 + e^(−t) is 1, and slow subnormal numbers are avoided, also for its
    /// square.
    pub end: f32,
    /// (1 − e^(−t))/t where t ≤ [`Decay::NEAR`]; beyond it an arbitrary finite value.
    pub mean: f32,
}

impl Decay {
    /// Up to here, just below ½ ln 2, [`mean`](Self::mean) holds.
    pub const NEAR: f32 = 0.346;
}

/// The decay over `t` ≥ 0, both with a relative error below 1.5e-7: one polynomial gives both, since
/// that of [`exp_f32`] is 1 + r·(e^r − 1)/r, and up to ½ ln 2 its r is −t.
#[must_use]
#[inline]
pub fn decay_f32(t: f32) -> Decay {
    let Parts { r, mean, power } = parts(-t.min(40.0));
    Decay {
        end: (mean * r + 1.0) * power,
        mean,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Greatest relative errors of both over 0..40; `fault` is added to t.
    fn decay_off(fault: f32) -> [f64; 2] {
        let mut worst = [0.0f64; 2];
        for step in 1..=1_000_000 {
            let share = step as f32 / 1e6;
            for t in [40.0 * share, share, 1e-3 * share, 1e-9 * share] {
                let (got, exact) = (decay_f32(t * (1.0 + fault)), exp(-f64::from(t)));
                worst[0] = worst[0].max((f64::from(got.end) / exact - 1.0).abs());
                if t <= Decay::NEAR {
                    let mean = -libm::expm1(-f64::from(t)) / f64::from(t);
                    worst[1] = worst[1].max((f64::from(got.mean) / mean - 1.0).abs());
                }
            }
        }
        worst
    }

    #[test]
    fn a_decay_is_within_its_bound() {
        let worst = decay_off(0.0);
        assert!(worst.iter().all(|worst| *worst < 1.5e-7), "{worst:?}");
        let fault = decay_off(1e-5);
        assert!(fault.iter().all(|worst| *worst > 1.5e-7), "would pass");
        assert_eq!((decay_f32(0.0).end, decay_f32(0.0).mean), (1.0, 1.0));
        assert!(decay_f32(f32::INFINITY).end < 1e-17);
    }

    #[test]
    fn exp_f32_is_within_its_bound() {
        let mut worst = 0.0f64;
        for step in 0..=1_000_000 {
            let x = -87.0 + 175.0 * (step as f32 / 1e6);
            let (got, want) = (f64::from(exp_f32(x)), exp(f64::from(x)));
            worst = worst.max(((got - want) / want).abs());
        }
        assert!(worst < 1.2e-7, "{worst:e}");
        assert_eq!(
            (exp_f32(0.0), exp_f32(-100.0), exp_f32(f32::NEG_INFINITY)),
            (1.0, 0.0, 0.0)
        );
    }

    #[test]
    fn a_wrong_exp_would_be_found() {
        let perturbed = |x: f32| exp_f32(x) * (1.0 + 1.2e-6);
        let worst = (0..1000)
            .map(|step| -10.0 + 0.02 * step as f32)
            .map(|x| (f64::from(perturbed(x)) / exp(f64::from(x)) - 1.0).abs())
            .fold(0.0, f64::max);
        assert!(worst > 1.2e-7, "{worst:e}");
    }

    #[test]
    fn known_values() {
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
        assert_eq!(acos(2.0), 0.0);
        assert!((acos(-1.0) - std::f64::consts::PI).abs() < 1e-15);
        assert!((powf(2.0, 0.5) - std::f64::consts::SQRT_2).abs() < 1e-15);
        assert!((sin(1.0) - 0.841_470_984_8).abs() < 1e-10 && cos(0.0) == 1.0);
        assert!((atan2(1.0, 1.0) + ln(2.0) - 1.478_545_343_957_4).abs() < 1e-12);
    }
}
