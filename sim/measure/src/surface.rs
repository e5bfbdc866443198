//! Reading of the instrument for a film's internal reflectance.
//!
//! Saunderson's correction, with or without the gloss: an instrument at 60° or at 45°/0° leaves it
//! out (Baxter 2004, § 7.5), a sphere with its trap closed reads it.

use maulstick_optics::surface::SurfaceCorrection;

/// The surface of the samples, and whether the instrument reads its gloss.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// k₁ and k₂.
    pub correction: SurfaceCorrection,
    /// The share of the light that the reading holds as gloss: k₁, or 0 where it is left out.
    pub gloss: f64,
}

impl Default for Surface {
    fn default() -> Self {
        Self::with_gloss(SurfaceCorrection::default())
    }
}

impl Surface {
    /// Readings hold the gloss k₁.
    #[must_use]
    pub fn with_gloss(correction: SurfaceCorrection) -> Self {
        Self {
            correction,
            gloss: correction.k1,
        }
    }

    /// Readings leave the gloss out.
    #[must_use]
    pub fn without_gloss(correction: SurfaceCorrection) -> Self {
        Self {
            correction,
            gloss: 0.0,
        }
    }

    /// Readings are internal reflectances already.
    #[must_use]
    pub fn none() -> Self {
        Self::with_gloss(SurfaceCorrection { k1: 0.0, k2: 0.0 })
    }

    /// The reading of a film of internal reflectance `r`, and its derivative by `r`.
    #[must_use]
    pub fn reading(&self, r: f64) -> (f64, f64) {
        let SurfaceCorrection { k1, k2 } = self.correction;
        let inner = 1.0 - k2 * r;
        let slope = (1.0 - k1) * (1.0 - k2) / (inner * inner);
        (self.gloss + self.correction.leaving(r), slope)
    }

    /// The internal reflectance of a reading, which noise may put below 0 or above 1.
    #[must_use]
    pub fn internal(&self, reading: f64) -> f64 {
        self.correction
            .internal(reading - self.gloss + self.correction.k1)
    }
}

/// Internal reflectance of a ground from the reading of it bare.
pub(crate) fn internal_ground(reading: f64, surface: &Surface) -> f64 {
    surface.internal(reading).clamp(0.0, 0.999)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_and_internal_reflectances_are_inverse() {
        let saunderson = SurfaceCorrection::default();
        for surface in [
            Surface::default(),
            Surface::without_gloss(saunderson),
            Surface::none(),
        ] {
            for r in [0.001, 0.02, 0.5, 0.97] {
                let (reading, slope) = surface.reading(r);
                assert!((surface.internal(reading) - r).abs() < 1e-12);
                let (above, below) = (surface.reading(r + 1e-6).0, surface.reading(r - 1e-6).0);
                assert!(((above - below) / 2e-6 - slope).abs() < 1e-6 * slope);
            }
        }
        assert!((Surface::default().reading(0.4).0 - saunderson.measured(0.4)).abs() < 1e-15);
        assert!(
            (Surface::without_gloss(saunderson).reading(0.4).0 - saunderson.leaving(0.4)).abs()
                < 1e-15
        );
        assert_eq!(Surface::none().reading(0.4).0, 0.4);
    }
}
