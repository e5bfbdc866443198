//! The glossy reflection of a lamp in rough paint: a microfacet model in the space of slopes.
//!
//! Facets have the mean slope s of the relief and the covariance ½A about it. One of slope h̃ reflects the lamp to a
//! viewer straight above; their number is GGX's density of slopes (Walter et al. 2007, *Microfacet models for
//! refraction through rough surfaces*; Heitz 2014, *Understanding the masking-shadowing function*):
//!
//! ```text
//! P(s) = 1/(π·√|A|·(1 + (h̃ − s)ᵀ·A⁻¹·(h̃ − s))²)
//! A    = (α² + w²/8)·1 + 2Σ
//! L/E  = F·P(s)·G/(4·b_z⁴·l_z),   G = 1/(1 + Λ),  Λ = (√(1 + α²·tan²θ_l) − 1)/2
//! ```
//!
//! α is the paint's own roughness. Σ is the covariance of slopes that a cell does not resolve: with it, bristle marks
//! narrower than a cell give a broad sheen without grain (Toksvig 2005, *Mipmapping normal maps*; Olano and Baker 2010,
//! *LEAN mapping*). w²/8 is twice the variance of the slopes that mirror some part of the lamp's disc, of half-angle w
//! (half of it in the half vector).

/// Roughness α of the glossiest film, and of the most matte ground.
pub const ROUGHNESS: [f32; 2] = [0.1, 0.7];

/// Gloss g of oil paint: from `dry` at `wetness` 0 to .75 at 1, stiff paint from the tube, whose pigment roughens the
/// surface; the share of thinner raises both to 1, a level film. All arguments are 0 to 1.
#[must_use]
pub fn gloss(dry: f32, thinner_share: f32, wetness: f32) -> f32 {
    let own = dry + (0.75 - dry) * wetness.clamp(0.0, 1.0);
    own + (1.0 - own) * thinner_share.clamp(0.0, 1.0)
}

/// Gloss of dry paint with this share of oil: .3, an eggshell, at .6; lean paint is more matt.
#[must_use]
pub fn dry_gloss(oil_share: f64) -> f32 {
    (0.3 + 0.8 * (oil_share - 0.6)).clamp(0.0, 1.0) as f32
}

/// Roughness α of a surface of this gloss, 0 to 1.
#[inline]
#[must_use]
pub fn roughness(gloss: f32) -> f32 {
    let dull = 1.0 - gloss;
    ROUGHNESS[0] + (ROUGHNESS[1] - ROUGHNESS[0]) * dull * dull
}

/// Gloss of one surface in place of several of the mean squared roughness `square`, whose slopes have
/// the variance `spread` along an axis: the inverse of [`roughness`], after Toksvig.
#[must_use]
pub fn merged_gloss(square: f32, spread: f32) -> f32 {
    let rough = (square + 2.0 * spread)
        .sqrt()
        .clamp(ROUGHNESS[0], ROUGHNESS[1]);
    1.0 - ((rough - ROUGHNESS[0]) / (ROUGHNESS[1] - ROUGHNESS[0])).sqrt()
}

/// π·P, GGX's density of slopes `off` the mean, for A = `own`·1 + 2Σ with Σ = (xx, xy, yy).
#[inline]
#[must_use]
pub fn density(own: f32, spread: [f32; 3], off: [f32; 2]) -> f32 {
    let [xx, xy, yy] = [
        own + 2.0 * spread[0],
        2.0 * spread[1],
        own + 2.0 * spread[2],
    ];
    let determinant = xx * yy - xy * xy;
    let far = off[0] * off[0] * yy - 2.0 * off[0] * off[1] * xy + off[1] * off[1] * xx;
    let tail = 1.0 + far / determinant;
    1.0 / (determinant.sqrt() * tail * tail)
}

/// G, the share of the facets that the lamp reaches: `square` is α², `graze` tan²θ_l.
#[inline]
#[must_use]
pub fn unmasked(square: f32, graze: f32) -> f32 {
    2.0 / (1.0 + (1.0 + square * graze).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integral over a square of slopes, `half` each way, of `f` of the offset.
    fn over_slopes(half: f64, steps: usize, f: impl Fn([f32; 2]) -> f32) -> f64 {
        let step = 2.0 * half / steps as f64;
        let at = |i: usize| (-half + (i as f64 + 0.5) * step) as f32;
        let row = |y: usize| {
            (0..steps)
                .map(|x| f64::from(f([at(x), at(y)])))
                .sum::<f64>()
        };
        (0..steps).map(row).sum::<f64>() * step * step
    }

    #[test]
    fn every_facet_has_a_slope() {
        // For isotropic GGX the share 1/(1 + (r/α)²) is steeper than r.
        for (own, spread) in [
            (0.02f32, [0.0; 3]),
            (0.05, [0.04, -0.03, 0.03]),
            (0.3, [0.1, 0.0, 0.0]),
        ] {
            let all =
                over_slopes(12.0, 2400, |off| density(own, spread, off)) / std::f64::consts::PI;
            println!("{own} {spread:?}: {all:.4}");
            assert!((all - 1.0).abs() < 6e-3, "{all}");
        }
    }

    /// Light sent to all sides by facets that reflect everything, for a lamp at the elevation of sine `lamp_z`,
    /// including those that reach other facets: ∫ P·G·max(l·b, 0)/(l_z·b_z) d²s, which is 1 for the G that belongs to P
    /// (Heitz 2014, eq. 88, the weak white furnace).
    fn furnace(alpha: f32, lamp_z: f32, unmasked: impl Fn(f32, f32) -> f32) -> f64 {
        let across = (1.0 - lamp_z * lamp_z).sqrt();
        let square = alpha * alpha;
        let graze = across * across / (lamp_z * lamp_z);
        let sum = over_slopes(40.0, 4000, |s| {
            // l·b/b_z for facets of slope s.
            let facing = (lamp_z - s[0] * across).max(0.0);
            density(square, [0.0; 3], s) * facing / lamp_z
        });
        sum * f64::from(unmasked(square, graze)) / std::f64::consts::PI
    }

    #[test]
    fn a_white_furnace_is_neither_lost_nor_gained() {
        for lamp_z in [1.0, 0.7, 0.4] {
            let sums = [0.1, 0.4, 0.7].map(|alpha| furnace(alpha, lamp_z, unmasked));
            println!("lamp at {lamp_z}: {sums:.4?}");
            // Facets steeper than 40 are left out.
            assert!(sums.iter().all(|sum| (sum - 1.0).abs() < 0.025), "{sums:?}");
        }
        let fault = furnace(0.7, 0.4, |_, _| 1.0);
        assert!(
            fault > 1.1,
            "without shadows light would be gained: {fault}"
        );
        assert_eq!(unmasked(0.5, 0.0), 1.0);
    }

    #[test]
    fn unresolved_slopes_widen_the_lobe_as_much_as_they_blur_it() {
        // Bumps of Gaussian slopes with the variance .045 along each axis, of facets of roughness α. In
        // the limit of mirrors the peak is 1/(2σ²), which is GGX's own with α² = 2σ².
        let variance = 0.045f32;
        let gauss = |s: [f32; 2]| {
            let square = s[0] * s[0] + s[1] * s[1];
            maulstick_num::exp_f32(-0.5 * square / variance)
                / (2.0 * std::f32::consts::PI * variance)
        };
        for (own, off) in [(1e-3f32, 0.04), (0.01, 0.2), (0.04, 0.3)] {
            for at in [0.0f32, 0.2] {
                let mean = over_slopes(1.5, 1200, |s| {
                    gauss(s) * density(own, [0.0; 3], [at - s[0], -s[1]])
                });
                let one = f64::from(density(own, [variance, 0.0, variance], [at, 0.0]));
                let sharp = f64::from(density(own, [0.0; 3], [at, 0.0]));
                println!("α² {own}, {at} off: {mean:.3}, as one lobe {one:.3}, sharp {sharp:.3}");
                if at == 0.0 {
                    assert!((one / mean - 1.0).abs() < off, "{one} {mean}");
                }
                assert!((one / mean - 1.0).abs() < 0.5 * (sharp / mean - 1.0).abs());
            }
        }
        // Without unresolved slopes gloss is unchanged; with many it vanishes.
        for gloss in [0.0, 0.3, 0.75, 1.0] {
            let square = roughness(gloss) * roughness(gloss);
            assert!((merged_gloss(square, 0.0) - gloss).abs() < 1e-3);
            assert!(merged_gloss(square, 1.0) == 0.0 && merged_gloss(square, 0.02) <= gloss);
        }
    }

    #[test]
    fn paint_is_dull_when_it_is_dry_and_level_when_it_is_thin() {
        let of = |thinner, wetness| gloss(0.3, thinner, wetness);
        assert_eq!([of(0.0, 1.0), of(0.0, 0.0)], [0.75, 0.3]);
        assert_eq!([of(1.0, 1.0), of(1.0, 0.0)], [1.0, 1.0]);
        assert!(of(0.5, 0.5) > of(0.2, 0.5) && of(0.2, 0.6) > of(0.2, 0.5));
        assert_eq!(of(-1.0, 2.0), 0.75);
        assert!(gloss(0.2, 0.0, 0.0) < of(0.0, 0.0) && gloss(0.2, 0.0, 1.0) == 0.75);
        assert!([0.45, 0.6, 0.75].map(dry_gloss).is_sorted_by(|a, b| a < b));
        assert!(
            [0.0, 0.3, 0.75, 1.0]
                .map(roughness)
                .is_sorted_by(|a, b| a > b)
        );
        assert_eq!([0.0, 1.0].map(roughness), [ROUGHNESS[1], ROUGHNESS[0]]);
    }
}
