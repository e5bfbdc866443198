//! Surface correction: reflection of light that enters and leaves a film (Saunderson 1942).
//!
//! Kubelka-Munk films compose internal reflectances; the surface is applied once, at the outermost film. The surface's
//! reflection k₁ belongs to the gloss, which adds it when the picture is lit.

/// The surface's constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceCorrection {
    /// Share of the light that the surface reflects from outside.
    pub k1: f64,
    /// Share of the diffuse light that it reflects back from inside.
    pub k2: f64,
}

impl Default for SurfaceCorrection {
    fn default() -> Self {
        Self::STANDARD
    }
}

impl SurfaceCorrection {
    /// The constants with which the paints were measured (Berns 2016).
    pub const STANDARD: Self = Self { k1: 0.03, k2: 0.65 };

    /// Reflectance outside a film of internal reflectance `r`, without the gloss k₁.
    #[must_use]
    pub fn leaving(&self, r: f64) -> f64 {
        (1.0 - self.k1) * (1.0 - self.k2) * r / (1.0 - self.k2 * r)
    }

    /// Reading of a spectrometer: gloss and [`leaving`](Self::leaving).
    #[must_use]
    pub fn measured(&self, r: f64) -> f64 {
        self.k1 + self.leaving(r)
    }

    /// The internal reflectance of a reading; the inverse of [`measured`](Self::measured).
    #[must_use]
    pub fn internal(&self, reading: f64) -> f64 {
        let out = reading - self.k1;
        out / ((1.0 - self.k1) * (1.0 - self.k2) + self.k2 * out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_corrections_and_their_inverse() {
        let surface = SurfaceCorrection { k1: 0.04, k2: 0.6 };
        for (r, reading) in [
            (0.05, 0.059_793_814),
            (0.3, 0.180_487_805),
            (0.5, 0.314_285_714),
            (0.9, 0.791_304_348),
        ] {
            assert!((surface.measured(r) - reading).abs() < 1e-9);
            assert!((surface.internal(reading) - r).abs() < 1e-8);
            assert!(
                (surface.measured(r + 1e-7) - reading).abs() > 1e-9,
                "a fault would pass"
            );
        }
        let default = SurfaceCorrection::default();
        assert!((default.internal(default.measured(0.37)) - 0.37).abs() < 1e-15);
    }
}
