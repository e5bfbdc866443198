//! The internal reflectance of a layer, with its derivatives by ln κ and ln σ.
//!
//! κ = ΣK·c·d and σ = ΣS·c·d are the optical absorption and scattering of the layer; an opaque one
//! depends on their ratio alone. Logarithms, because R∞ is smooth in ln q (dR/d ln q =
//! −R(1−R)/(1+R), from Baxter 2004, eq. 7.6) where its derivative by q has no bound at q = 0.

use maulstick_num::exp;

/// A value with its derivatives by ln κ and ln σ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slopes {
    /// The value.
    pub value: f64,
    /// ∂/∂ ln κ.
    pub by_ln_k: f64,
    /// ∂/∂ ln σ.
    pub by_ln_s: f64,
}

/// An opaque layer.
#[must_use]
pub fn opaque(k: f64, s: f64) -> Slopes {
    let r = maulstick_optics::km::opaque(k, s);
    let slope = -r * (1.0 - r) / (1.0 + r);
    Slopes {
        value: r,
        by_ln_k: slope,
        by_ln_s: -slope,
    }
}

/// A film over a ground of internal reflectance `ground` (Baxter 2004, eq. 7.8-7.11).
///
/// With z = κ(κ+2σ), C = cosh √z and H = sinh √z/√z, which are smooth in z, and D = (κ+σ)H + C:
/// R = σH/D and T = 1/D; dC/dz = H/2, dH/dz = (C − H)/2z. All are kept times e^(−√z).
#[must_use]
pub fn film_over(kd: f64, sd: f64, ground: f64) -> Slopes {
    let z = kd * (kd + 2.0 * sd);
    let t = z.sqrt();
    let e = exp(-t);
    let (c, h, h_slope) = hyperbolic(z, t, e);
    let c_slope = 0.5 * h;
    let (z_by_k, z_by_s) = (2.0 * (kd + sd), 2.0 * kd);
    let d = (kd + sd) * h + c;
    let (r, through) = (sd * h / d, e / d);
    let inner = 1.0 - r * ground;
    let value = r + through * through * ground / inner;
    let slope = |z_slope: f64, sd_slope: f64| {
        let d_slope = h + ((kd + sd) * h_slope + c_slope) * z_slope;
        let r_slope = (sd_slope * h + sd * h_slope * z_slope - r * d_slope) / d;
        let through_slope = -through * d_slope / d;
        r_slope
            + ground / inner * through * (2.0 * through_slope + through * ground * r_slope / inner)
    };
    Slopes {
        value,
        by_ln_k: kd * slope(z_by_k, 0.0),
        by_ln_s: sd * slope(z_by_s, 1.0),
    }
}

/// C, H and dH/dz, each times e^(−t); by series below z = ¼, where differences lose digits.
fn hyperbolic(z: f64, t: f64, e: f64) -> (f64, f64, f64) {
    let c = 0.5 * (1.0 + e * e);
    if z >= 0.25 {
        let h = 0.5 * (1.0 - e * e) / t;
        return (c, h, 0.5 * (c - h) / z);
    }
    // H = Σ zⁿ/(2n+1)!, dH/dz = Σ n·zⁿ⁻¹/(2n+1)!.
    let (mut h, mut h_slope) = (1.0, 0.0);
    let (mut power, mut factorial) = (1.0, 1.0);
    for n in 1..12 {
        let order = f64::from(n);
        factorial *= 2.0 * order * (2.0 * order + 1.0);
        h_slope += order * power / factorial;
        power *= z;
        h += power / factorial;
    }
    (c, e * h, e * h_slope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use maulstick_optics::km;

    fn decade(i: i32) -> f64 {
        exp(f64::from(i) * 0.5 * std::f64::consts::LN_10)
    }

    #[test]
    fn values_are_those_of_the_films_that_paintings_use() {
        for i in -10..6 {
            for j in -10..6 {
                let (k, s) = (decade(i), decade(j));
                assert!((opaque(k, s).value - km::opaque(k, s)).abs() < 1e-15);
                for ground in [0.0, 0.3, 0.95] {
                    let want = km::over(km::film(k, s), ground);
                    assert!(
                        (film_over(k, s, ground).value - want).abs() < 1e-12,
                        "{k} {s}"
                    );
                }
            }
        }
    }

    #[test]
    fn slopes_agree_with_central_differences() {
        let step = 1e-5;
        let (up, down) = (exp(step), exp(-step));
        let (mut worst, mut worst_fault) = (0.0f64, 0.0f64);
        let mut check = |f: &dyn Fn(f64, f64) -> Slopes, k: f64, s: f64| {
            let by_k = (f(k * up, s).value - f(k * down, s).value) / (2.0 * step);
            let by_s = (f(k, s * up).value - f(k, s * down).value) / (2.0 * step);
            let got = f(k, s);
            worst = worst
                .max((got.by_ln_k - by_k).abs())
                .max((got.by_ln_s - by_s).abs());
            worst_fault = worst_fault.max((got.by_ln_k * 1.000_01 - by_k).abs());
        };
        for i in -10..8 {
            for j in -10..8 {
                let (k, s) = (decade(i), decade(j));
                check(&opaque, k, s);
                for ground in [0.0, 0.4, 0.97] {
                    check(&|k, s| film_over(k, s, ground), k, s);
                }
            }
        }
        assert!(worst < 1e-8, "{worst:e}");
        assert!(worst_fault > 1e-8, "a fault of 1e-5 would pass");
    }
}
