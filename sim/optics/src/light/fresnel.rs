//! Fresnel's equations for a dielectric.

/// Share of unpolarised light that a surface reflects when it falls on it at the angle whose cosine is `cosine`, 0 to
/// 1; `normal`, the share k₁ at normal incidence, represents its material:
///
/// ```text
/// n = (1 + √k₁)/(1 − √k₁),  c = cos θ,  t = √(1 − (1 − c²)/n²)
/// F = ½·((c − n·t)/(c + n·t))² + ½·((n·c − t)/(n·c + t))²
/// ```
#[must_use]
pub fn fresnel(normal: f64, cosine: f64) -> f64 {
    let root = normal.sqrt();
    let n = (1.0 + root) / (1.0 - root);
    let c = cosine.clamp(0.0, 1.0);
    let t = (1.0 - (1.0 - c * c) / (n * n)).sqrt();
    let across = (c - n * t) / (c + n * t);
    let within = (n * c - t) / (n * c + t);
    0.5 * (across * across + within * within)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn glass_reflects_as_in_the_textbooks() {
        // n = 1.5: 4 % at normal incidence; at Brewster's angle, tan θ = n, the light in the plane is
        // not reflected and the other half is by ((n² − 1)/(n² + 1))²; all of it at grazing incidence.
        let brewster: f64 = 1.0 / (1.0f64 + 1.5 * 1.5).sqrt();
        let across: f64 = (1.5 * 1.5 - 1.0) / (1.5 * 1.5 + 1.0);
        for (cosine, share) in [(1.0, 0.04), (brewster, 0.5 * across * across), (0.0, 1.0)] {
            let got = fresnel(0.04, cosine);
            println!("{got:.6} expected {share:.6}");
            assert!((got - share).abs() < 1e-12);
            assert!((fresnel(0.041, cosine) - share).abs() > 1e-12 || cosine == 0.0);
        }
        let angles = (0..=100).map(|i| fresnel(0.03, f64::from(i) / 100.0));
        assert!(angles.collect::<Vec<_>>().is_sorted_by(|a, b| a >= b));
    }
}
