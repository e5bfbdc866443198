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

/// The spectrum through points (nm, value) of ascending nm: monotone cubic between them (Fritsch and Butland 1984),
/// which adds no peaks; constant beyond the ends. Without points it is 0.
#[must_use]
pub fn resample(points: &[[f64; 2]]) -> Spectrum {
    let slopes = monotone_slopes(points);
    Spectrum::from_fn(|nm| {
        let above = points.partition_point(|[x, _]| *x <= nm);
        if above == 0 || above == points.len() {
            let end = points.get(above.saturating_sub(1));
            return end.map_or(0.0, |[_, y]| *y);
        }
        let ([x0, y0], [x1, y1]) = (points[above - 1], points[above]);
        let (width, t) = (x1 - x0, (nm - x0) / (x1 - x0));
        let (s, u) = (1.0 - t, t * t);
        y0 * (1.0 + 2.0 * t) * s * s
            + width * slopes[above - 1] * t * s * s
            + y1 * u * (3.0 - 2.0 * t)
            - width * slopes[above] * u * s
    })
}

/// The mean of the power through points (nm, power) of rising nm, straight between them, over the 4 nm
/// around each sample: a narrow line between two samples is not lost. Beyond the ends the end's value
/// holds.
#[must_use]
pub fn bin(points: &[[f64; 2]]) -> Spectrum {
    // The integral from the first point to nm.
    let integral = |nm: f64| -> f64 {
        let (Some(first), Some(last)) = (points.first(), points.last()) else {
            return 0.0;
        };
        let mut sum =
            (nm.min(first[0]) - first[0]) * first[1] + (nm.max(last[0]) - last[0]) * last[1];
        for pair in points.windows(2) {
            let ([x0, y0], [x1, y1]) = (pair[0], pair[1]);
            let x = nm.clamp(x0, x1);
            let y = y0 + (y1 - y0) * (x - x0) / (x1 - x0);
            sum += 0.5 * (y0 + y) * (x - x0);
        }
        sum
    };
    let half = 0.5 * STEP_NM;
    Spectrum::from_fn(|nm| ((integral(nm + half) - integral(nm - half)) / STEP_NM).max(0.0))
}

/// Slopes at points by the weighted harmonic mean of the chords on either side, 0 at extrema.
fn monotone_slopes(points: &[[f64; 2]]) -> Vec<f64> {
    let chord = |i: usize| (points[i + 1][1] - points[i][1]) / (points[i + 1][0] - points[i][0]);
    let last = points.len().saturating_sub(1);
    (0..points.len())
        .map(|i| match i {
            _ if last == 0 => 0.0,
            0 => chord(0),
            _ if i == last => chord(last - 1),
            _ => {
                let (before, after) = (chord(i - 1), chord(i));
                if before * after <= 0.0 {
                    return 0.0;
                }
                let (h0, h1) = (
                    points[i][0] - points[i - 1][0],
                    points[i + 1][0] - points[i][0],
                );
                let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
                (w0 + w1) / (w0 / before + w1 / after)
            }
        })
        .collect()
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

    #[test]
    fn a_line_between_samples_keeps_its_power() {
        let line = |at: f64| {
            [
                [380.0, 0.0],
                [at - 1.0, 0.0],
                [at, 8.0],
                [at + 1.0, 0.0],
                [780.0, 0.0],
            ]
        };
        for at in [588.0, 589.3, 590.0, 591.5] {
            let power: f64 = bin(&line(at)).0.iter().sum::<f64>() * STEP_NM;
            assert!((power - 8.0).abs() < 1e-9, "{at}: {power}");
        }
        let lost: f64 = resample(&line(590.0)).0.iter().sum();
        assert_eq!(lost, 0.0, "points alone would miss it");
        let slope = bin(&[[300.0, 300.0], [900.0, 900.0]]);
        assert!((slope.0[7] - wavelength(7)).abs() < 1e-9);
    }

    #[test]
    fn resampling_keeps_the_points_and_makes_no_new_peaks() {
        let points: Vec<[f64; 2]> = (0..36)
            .map(|i| 400.0 + 10.0 * f64::from(i))
            .map(|nm| [nm, if nm < 560.0 { 0.04 } else { 0.8 }])
            .collect();
        let dense = resample(&points);
        assert!(
            dense
                .0
                .iter()
                .all(|v| (0.04 - 1e-12..=0.8 + 1e-12).contains(v))
        );
        for (nm, value) in [(400.0, 0.04), (560.0, 0.8), (380.0, 0.04)] {
            assert!((dense.at(nm) - value).abs() < 1e-12);
        }
        let line: Vec<[f64; 2]> = [380.0, 431.0, 600.0, 780.0].map(|nm| [nm, 2.0 * nm]).into();
        for (i, v) in resample(&line).0.iter().enumerate() {
            assert!((v - 2.0 * wavelength(i)).abs() < 1e-9);
        }
    }
}
