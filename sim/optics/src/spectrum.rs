//! The wavelength grid: 101 samples, 380 to 780 nm, 4 nm apart (Baxter 2004, § 7.5).

/// Number of samples.
pub const SAMPLES: usize = 101;
/// First wavelength, nm.
pub const FIRST_NM: f64 = 380.0;
/// Distance between samples, nm.
pub const STEP_NM: f64 = 4.0;

/// Wavelength of sample `i`, nm.
#[must_use]
pub fn wavelength(i: usize) -> f64 {
    FIRST_NM + STEP_NM * i as f64
}

/// A quantity at each wavelength of the grid.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum(pub [f64; SAMPLES]);

impl Spectrum {
    /// The same value everywhere.
    #[must_use]
    pub fn flat(value: f64) -> Self {
        Self([value; SAMPLES])
    }

    /// The value of `f` at each wavelength in nm.
    #[must_use]
    pub fn from_fn(f: impl Fn(f64) -> f64) -> Self {
        Self(std::array::from_fn(|i| f(wavelength(i))))
    }

    /// Linear interpolation at `nm`; beyond the ends the end's value holds.
    #[must_use]
    pub fn at(&self, nm: f64) -> f64 {
        interpolate(&self.0, (nm - FIRST_NM) / STEP_NM)
    }
}

/// Linear interpolation in a table at the fractional place `x`, held beyond the ends.
pub(crate) fn interpolate(table: &[f64], x: f64) -> f64 {
    let last = table.len() - 1;
    let x = x.clamp(0.0, last as f64);
    let i = (x as usize).min(last.saturating_sub(1));
    let t = x - i as f64;
    table[i] * (1.0 - t) + table[(i + 1).min(last)] * t
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolates_and_holds_the_ends() {
        let ramp = Spectrum::from_fn(|nm| nm);
        assert!((ramp.at(501.0) - 501.0).abs() < 1e-12);
        assert_eq!((ramp.at(300.0), ramp.at(900.0)), (380.0, 780.0));
        assert_eq!(wavelength(SAMPLES - 1), 780.0);
    }
}
