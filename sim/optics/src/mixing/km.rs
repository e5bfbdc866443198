//! Kubelka-Munk films in the form that never fails.
//!
//! With κ = K·d, σ = S·d, t = √(κ(κ+2σ)), E = e^(−2t), c = (1+E)/2 and g = (1−E)/(2t):
//!
//! R = σ·g / ((κ+σ)·g + c),  T = e^(−t) / ((κ+σ)·g + c).
//!
//! The same as Baxter 2004, eq. 7.8-7.10, without a division by S or t and without overflow:
//! S = 0 (Beer) and K = 0 come out exactly. Source: Kubelka 1948.

use maulstick_num::{Decay, decay_f32, exp};

/// Reflectance over black and transmittance of a film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film<T> {
    /// Reflectance over black.
    pub r: T,
    /// Transmittance.
    pub t: T,
}

/// The film of optical absorption `kd` = K·d and scattering `sd` = S·d, both ≥ 0.
#[must_use]
pub fn film(kd: f64, sd: f64) -> Film<f64> {
    let t = (kd * (kd + 2.0 * sd)).sqrt();
    let e = exp(-t);
    let c = 0.5 * (1.0 + e * e);
    let g = decay_mean(2.0 * t, e * e);
    let denominator = (kd + sd) * g + c;
    Film {
        r: sd * g / denominator,
        t: e / denominator,
    }
}

/// (1 − e^(−u))/u, given e^(−u): by its series below ½, where the difference loses digits.
fn decay_mean(u: f64, e: f64) -> f64 {
    if u >= 0.5 {
        return (1.0 - e) / u;
    }
    let mut term = 1.0;
    let mut sum = 1.0;
    for k in 2..16 {
        term *= -u / f64::from(k);
        sum += term;
    }
    sum
}

/// A film over a ground of reflectance `under` (Baxter 2004, eq. 7.11).
#[must_use]
pub fn over(film: Film<f64>, under: f64) -> f64 {
    film.r + film.t * film.t * under / (1.0 - film.r * under)
}

/// A film over a ground in f32 and without a branch, for loops over planes; its reflectance is n/m.
///
/// With f = 1 − R_g the textbook's R + T²R_g/(1 − R·R_g) of [`film`] and [`over`] becomes
///
/// n = σ·g·f + R_g·(c − κ·g),  m = (κ + σ·f)·g + c,
///
/// in which nothing cancels. g is (1 + e^(−t))/2 times the mean of e^(−x) over 0..t. Multiplied by t
/// they need no division by it either: one exponential, and with whatever follows one division a film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ratio {
    /// Numerator.
    pub n: f32,
    /// Denominator, above 0.
    pub m: f32,
}

/// The film of `kd` = K·d and `sd` = S·d, both ≥ 0, over a ground of reflectance `under`, 0 to 1.
#[must_use]
#[inline]
pub fn film_over_f32(kd: f32, sd: f32, under: f32) -> Ratio {
    let t = (kd * (kd + 2.0 * sd)).sqrt();
    let Decay { end, mean } = decay_f32(t);
    // g and c times two, and where t is not small times t as well.
    let near = t <= Decay::NEAR;
    let g = (1.0 + end) * if near { mean } else { 1.0 - end };
    let c = (1.0 + end * end) * if near { 1.0 } else { t };
    let free = 1.0 - under;
    Ratio {
        n: sd * g * free + under * (c - kd * g),
        m: (kd + sd * free) * g + c,
    }
}

/// Reflectance of a film over a ground, and how it changes with K·d and with S·d.
///
/// With u = κ(κ+2σ) = t² the functions e^(−t)·sinh(t)/t and e^(−t)·cosh(t) are g and c of
/// [`film_over_f32`], and their common factor cancels in n/m. Without it they are analytic in u, with
/// slopes (c − g)/(2u) and g/2, so nothing is divided by t.
#[must_use]
pub fn over_with_slopes(kd: f64, sd: f64, under: f64) -> [f64; 3] {
    let u = kd * (kd + 2.0 * sd);
    let t = u.sqrt();
    let e = exp(-t);
    let c = 0.5 * (1.0 + e * e);
    let g = decay_mean(2.0 * t, e * e);
    // Below t = .3 by its series Σ k·u^(k−1)/(2k+1)!, where the difference loses digits.
    let g_u = if u < 0.09 {
        e * (1.0 / 6.0 + u * (1.0 / 60.0 + u * (1.0 / 1680.0 + u / 90_720.0)))
    } else {
        0.5 * (c - g) / u
    };
    let c_u = 0.5 * g;
    let free = 1.0 - under;
    let denominator = (kd + sd * free) * g + c;
    let r = (sd * g * free + under * (c - kd * g)) / denominator;
    let slope = |u_by: f64, [n, m]: [f64; 2]| {
        let (g_by, c_by) = (g_u * u_by, c_u * u_by);
        let n = n + sd * free * g_by + under * (c_by - kd * g_by);
        let m = m + (kd + sd * free) * g_by + c_by;
        (n - r * m) / denominator
    };
    [
        r,
        slope(2.0 * (kd + sd), [-under * g, g]),
        slope(2.0 * kd, [free * g, free * g]),
    ]
}

/// Reflectance of an opaque layer: 1/(1 + q + √(q² + 2q)), q = K/S; 0 where S = 0.
#[must_use]
pub fn opaque(k: f64, s: f64) -> f64 {
    if s <= 0.0 {
        return 0.0;
    }
    let q = k / s;
    1.0 / (1.0 + q + (q * q + 2.0 * q).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_films() {
        let rows = [
            (1.0, 1.0, 1.0, 0.260_146_717_028, 0.164_588_718_533),
            (1.0, 1.0, 0.5, 0.223_380_763_430, 0.395_443_942_614),
            (0.1, 1.0, 1.0, 0.461_033_623_277, 0.445_284_213_264),
            (0.0, 1.0, 1.0, 0.5, 0.5),
            (1.0, 0.0, 1.0, 0.0, 0.367_879_441_171),
            (0.05, 5.0, 0.2, 0.495_861_776, 0.494_204_526),
        ];
        for (k, s, d, r, t) in rows {
            let got = film(k * d, s * d);
            println!("{k} {s} {d}: {got:?}, expected {r} {t}");
            assert!((got.r - r).abs() < 1e-9 && (got.t - t).abs() < 1e-9);
            for ground in [0.0, 0.3, 1.0] {
                let single = film_over_f32((k * d) as f32, (s * d) as f32, ground);
                let exact = over(got, f64::from(ground));
                let error = (f64::from(single.n) / f64::from(single.m) - exact).abs();
                assert!(error < 1e-6, "{error:e}");
            }
            assert!((got.r + 1e-8 - r).abs() > 1e-9, "a fault would pass");
        }
    }

    #[test]
    fn a_sweep_over_eleven_decades_stays_finite() {
        // 59³ > 200,000 points over K, S in 1e-6..1e3 and d in 1e-4..1e2.
        let decades = |from: f64, to: f64, i: usize| {
            maulstick_num::exp((from + (to - from) * i as f64 / 58.0) * std::f64::consts::LN_10)
        };
        let mut worst = 0.0f64;
        for i in 0..59 {
            for j in 0..59 {
                for l in 0..59 {
                    let (k, s) = (decades(-6.0, 3.0, i), decades(-6.0, 3.0, j));
                    let d = decades(-4.0, 2.0, l);
                    let exact = film(k * d, s * d);
                    assert!(exact.r + exact.t <= 1.0 + 1e-12, "{k} {s} {d}: {exact:?}");
                    for ground in [0.0f32, 0.04, 0.5, 0.95, 1.0] {
                        let got = film_over_f32((k * d) as f32, (s * d) as f32, ground);
                        let r = got.n / got.m;
                        assert!(
                            r.is_finite() && (-1e-7..=1.0 + 3e-7).contains(&r),
                            "{got:?}"
                        );
                        let error = f64::from(r) - over(exact, f64::from(ground));
                        worst = worst.max(error.abs());
                    }
                }
            }
        }
        println!("worst {worst:e}");
        assert!(worst < 1e-6, "{worst:e}");
    }

    #[test]
    fn slopes_of_a_film_are_those_of_differences() {
        let mut worst = 0.0f64;
        for kd in [1e-6, 1e-3, 0.02, 0.3, 2.0, 30.0] {
            for sd in [1e-6, 1e-3, 0.05, 0.7, 4.0, 50.0] {
                for under in [0.0, 0.3, 0.95] {
                    let [r, by_k, by_s] = over_with_slopes(kd, sd, under);
                    let at = |kd: f64, sd: f64| over(film(kd, sd), under);
                    assert!((r - at(kd, sd)).abs() < 1e-13, "{kd} {sd} {under}");
                    let [dk, ds] = [kd, sd].map(|v| (1e-4 * v).max(2e-7));
                    let differences = [
                        (at(kd + dk, sd) - at(kd - dk, sd)) / (2.0 * dk),
                        (at(kd, sd + ds) - at(kd, sd - ds)) / (2.0 * ds),
                    ];
                    for (slope, difference) in [by_k, by_s].into_iter().zip(differences) {
                        let off = (slope - difference).abs() / (difference.abs() + 1e-4);
                        worst = worst.max(off);
                        let faulty = (1.001 * slope - difference).abs();
                        let seen = faulty / (difference.abs() + 1e-4) > 5e-5;
                        assert!(seen || slope.abs() < 1e-5, "a fault would pass");
                    }
                }
            }
        }
        println!("worst {worst:e}");
        assert!(worst < 5e-5, "{worst:e}");
    }

    #[test]
    fn two_half_films_are_the_whole_one() {
        for (k, s) in [(0.3, 1.2), (4.0, 0.1), (0.0, 7.0)] {
            let (half, whole) = (film(k / 2.0, s / 2.0), film(k, s));
            for ground in [0.0, 0.2, 0.9] {
                let layered = over(half, over(half, ground));
                assert!((layered - over(whole, ground)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_film_over_its_own_masstone_is_its_masstone() {
        let masstone = opaque(0.7, 2.0);
        for d in [1e-3, 0.1, 10.0] {
            assert!((over(film(0.7 * d, 2.0 * d), masstone) - masstone).abs() < 1e-12);
        }
        assert_eq!(opaque(1.0, 0.0), 0.0);
    }

    #[test]
    fn titanium_white_hides_black_as_measured() {
        for (um, r) in [(25.0, 0.79), (50.0, 0.88), (100.0, 0.94)] {
            assert!((film(0.0, 150_000.0 * um * 1e-6).r - r).abs() < 0.005);
        }
    }
}
