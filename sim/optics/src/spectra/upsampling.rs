//! Reflectances that have a given colour (Jakob and Hanika 2019, "A Low-Dimensional Function Space for
//! Efficient Spectral Upsampling").
//!
//! Light that leaves a printed surface is modelled as (1 − k₁)·S(c₀·u² + c₁·u + c₂), S the sigmoid ½ + x/(2√(1 + x²)),
//! u the wavelength from −1 at 380 nm to 1 at 780 nm. With the surface's own reflection k₁ that is the visible colour,
//! and XYZ is linear in S; the internal reflectance under the surface is S/((1 − k₂) + k₂·S). The three coefficients
//! are found by damped Gauss-Newton steps in CIELAB.

use crate::colour::{Matrix, apply, inverse, solve3};
use crate::studio::Studio;
use crate::surface::SurfaceCorrection;

/// Greatest number of steps; a colour inside of the gamut takes about eight.
const STEPS: usize = 60;
/// A colour as near as this is reached, ΔE*ab.
const NEAR_DELTA_E: f64 = 0.01;
/// Bound of a coefficient, where the sigmoid is within a millionth of 1.
const LARGEST_COEFFICIENT: f64 = 500.0;
/// Damping with which the steps begin, and with which they are given up.
const DAMPING: [f64; 2] = [1e-3, 1e9];
/// Lightness of the grey from which the search begins, as a share of white.
const START: [f64; 2] = [0.002, 0.998];

/// Coefficients c₀, c₁, c₂ of a smooth reflectance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Smooth(pub [f32; 3]);

/// Finds smooth reflectances at the wavelengths of one studio.
#[derive(Clone, Debug, PartialEq)]
pub struct Upsampler {
    /// u at each wavelength.
    places: Vec<f64>,
    weights: Vec<[f64; 3]>,
    white: [f64; 3],
    /// From linear sRGB to XYZ.
    from_rgb: Matrix,
    /// Linear sRGB of the perfect diffuser: 1 to an adapted eye.
    white_rgb: [f64; 3],
    surface: SurfaceCorrection,
}

/// S and its slope.
fn sigmoid(x: f64) -> [f64; 2] {
    let root = 1.0 / (1.0 + x * x).sqrt();
    [0.5 + 0.5 * x * root, 0.5 * root * root * root]
}

impl Upsampler {
    /// For the wavelengths, the light and the eye of a studio.
    #[must_use]
    pub fn new(studio: &Studio) -> Self {
        let rule = studio.rule();
        let white = studio.white();
        let place = |nm: &f64| (nm - 580.0) / 200.0;
        Self {
            places: rule.wavelengths_nm.iter().map(place).collect(),
            weights: rule.weights.clone(),
            white,
            from_rgb: inverse(studio.to_rgb()),
            white_rgb: apply(studio.to_rgb(), white),
            surface: studio.surface(),
        }
    }

    /// Number of wavelengths.
    #[must_use]
    pub fn wavelengths(&self) -> usize {
        self.places.len()
    }

    /// The linear sRGB colour nearest to `rgb` that a surface can have: none is darker than its own
    /// reflection in any channel.
    #[must_use]
    pub fn reachable(&self, rgb: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| rgb[i].max(self.surface.k1 * self.white_rgb[i]))
    }

    /// The smooth reflectance with the linear sRGB colour `rgb`, gloss included, or the nearest to it.
    #[must_use]
    pub fn fit(&self, rgb: [f64; 3]) -> Smooth {
        let gloss = self.white.map(|v| self.surface.k1 * v);
        let seen = apply(&self.from_rgb, self.reachable(rgb));
        let xyz = [0, 1, 2].map(|i| (seen[i] - gloss[i]) / (1.0 - self.surface.k1));
        let target = lab_with_slopes(xyz, self.white).0;
        let grey = 2.0 * (xyz[1] / self.white[1]).clamp(START[0], START[1]) - 1.0;
        let mut at = [0.0, 0.0, grey / (1.0 - grey * grey).sqrt()];
        let (mut off, mut jacobian) = self.off(at, target);
        let mut damping = DAMPING[0];
        for _ in 0..STEPS {
            let error = square(off);
            if error < NEAR_DELTA_E * NEAR_DELTA_E || damping > DAMPING[1] {
                break;
            }
            let column = |i: usize| jacobian.map(|row| row[i]);
            let mut normal: Matrix =
                std::array::from_fn(|i| std::array::from_fn(|j| dot(column(i), column(j))));
            for i in 0..3 {
                normal[i][i] = normal[i][i] * (1.0 + damping) + 1e-12;
            }
            let step = solve3(&normal, [0, 1, 2].map(|i| dot(column(i), off)));
            let next = [0, 1, 2]
                .map(|i| (at[i] - step[i]).clamp(-LARGEST_COEFFICIENT, LARGEST_COEFFICIENT));
            let (next_off, next_jacobian) = self.off(next, target);
            // A step that is no number is not smaller.
            if square(next_off) < error {
                (at, off, jacobian) = (next, next_off, next_jacobian);
                damping *= 0.2;
            } else {
                damping = (10.0 * damping).max(DAMPING[0]);
            }
        }
        Smooth(at.map(|c| c as f32))
    }

    /// Difference of the coefficients' colour from the target in CIELAB, and its slopes.
    fn off(&self, c: [f64; 3], target: [f64; 3]) -> ([f64; 3], Matrix) {
        let mut xyz = [0.0; 3];
        let mut slopes = [[0.0; 3]; 3];
        for (u, weight) in self.places.iter().zip(&self.weights) {
            let [value, slope] = sigmoid((c[0] * u + c[1]) * u + c[2]);
            let powers = [u * u * slope, u * slope, slope];
            for i in 0..3 {
                xyz[i] += weight[i] * value;
                (0..3).for_each(|j| slopes[i][j] += weight[i] * powers[j]);
            }
        }
        let (lab, by_xyz) = lab_with_slopes(xyz, self.white);
        let off = [0, 1, 2].map(|i| lab[i] - target[i]);
        (off, crate::colour::product(&by_xyz, &slopes))
    }

    /// Internal reflectance of each colour at a wavelength, by its number.
    pub fn internal(&self, sample: usize, colours: &[Smooth], plane: &mut [f32]) {
        let u = self.places[sample] as f32;
        let k2 = self.surface.k2 as f32;
        for (value, Smooth([a, b, c])) in plane.iter_mut().zip(colours) {
            let x = (a * u + b) * u + c;
            let s = (0.5 + 0.5 * x / (1.0 + x * x).sqrt()).clamp(0.0, 1.0);
            *value = s / ((1.0 - k2) + k2 * s);
        }
    }

    /// Internal reflectances of one colour, a value a wavelength.
    #[must_use]
    pub fn even(&self, colour: Smooth) -> Vec<f32> {
        let mut value = [0.0];
        let samples = 0..self.places.len();
        samples
            .map(|sample| {
                self.internal(sample, &[colour], &mut value);
                value[0]
            })
            .collect()
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn square(v: [f64; 3]) -> f64 {
    dot(v, v)
}

/// CIELAB of a colour and its slopes by X, Y and Z: rows are L*, a* and b*.
#[must_use]
pub fn lab_with_slopes(xyz: [f64; 3], white: [f64; 3]) -> ([f64; 3], Matrix) {
    let lab = crate::colour::lab(xyz, white);
    let y = (lab[0] + 16.0) / 116.0;
    let roots = [y + lab[1] / 500.0, y, y - lab[2] / 200.0];
    // f(t) = ∛t above its edge has the slope f/(3t).
    let slope = |i: usize| {
        let t = xyz[i] / white[i];
        let by_t = if t > 216.0 / 24389.0 {
            roots[i] / (3.0 * t)
        } else {
            24389.0 / (27.0 * 116.0)
        };
        by_t / white[i]
    };
    let [x, y, z] = [slope(0), slope(1), slope(2)];
    let rows = [
        [0.0, 116.0 * y, 0.0],
        [500.0 * x, -500.0 * y, 0.0],
        [0.0, 200.0 * y, -200.0 * z],
    ];
    (lab, rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cie::Illuminant;
    use crate::colour::{delta_e_2000, lab, srgb_decode};
    use crate::paints::PaintLibrary;
    use crate::studio::StudioSettings;

    fn studio(light: &str) -> Studio {
        let library = PaintLibrary::measured().expect("whole");
        let settings = StudioSettings {
            light: Illuminant::named(light).expect("known"),
            ..StudioSettings::default()
        };
        Studio::new(&settings, library.paints())
    }

    /// ΔE₀₀ between sRGB bytes and the displayed ground made for them.
    fn reached(studio: &Studio, made: &Upsampler, bytes: [u8; 3], fault: f32) -> f64 {
        let rgb = bytes.map(|byte| srgb_decode(f64::from(byte) / 255.0));
        let mut ground = made.even(made.fit(rgb));
        ground.iter_mut().for_each(|r| *r *= 1.0 + fault);
        let white = studio.white();
        let want = apply(&inverse(studio.to_rgb()), made.reachable(rgb));
        delta_e_2000(studio.lab(&[], &ground), lab(want, white))
    }

    #[test]
    fn colours_of_pictures_are_reached() {
        for light in ["D65", "A", "FL11"] {
            let studio = studio(light);
            let made = Upsampler::new(&studio);
            let (mut worst, mut least_fault) = (0.0f64, f64::MAX);
            for i in 0..16 * 16 * 16 {
                let bytes = [i % 16, i / 16 % 16, i / 256].map(|step| 17 * step as u8);
                worst = worst.max(reached(&studio, &made, bytes, 0.0));
                if bytes.iter().all(|byte| *byte >= 60) {
                    least_fault = least_fault.min(reached(&studio, &made, bytes, -0.1));
                }
            }
            println!("{light}: worst {worst:.3}, of a fault {least_fault:.3}");
            assert!(worst < 0.5);
            assert!(least_fault > 0.5, "a fault would pass");
        }
    }

    #[test]
    fn none_but_what_is_darker_than_the_gloss_is_another_colour() {
        let made = Upsampler::new(&studio("D65"));
        let at = |byte: f64| srgb_decode(byte / 255.0);
        let rgb = [at(50.0), at(255.0), at(120.0)];
        let off = made
            .reachable(rgb)
            .into_iter()
            .zip(rgb)
            .map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-9);
        assert!(made.reachable([at(40.0), 0.5, 0.5])[0] > at(47.0));
    }

    #[test]
    fn a_grey_is_flat_and_black_and_white_are_reached() {
        let studio = studio("D65");
        let made = Upsampler::new(&studio);
        for value in [0.0, 0.05, 0.2, 0.6, 1.0] {
            let ground = made.even(made.fit([value; 3]));
            let internal = studio.surface().internal(value.max(0.03)) as f32;
            let off = ground.iter().map(|r| (r - internal).abs());
            let off = off.fold(0.0, f32::max);
            println!("{value}: {off}");
            assert!(off < 2e-3, "{value}: {ground:?}");
        }
    }

    #[test]
    fn slopes_of_lab_are_those_of_differences() {
        let white = [0.95, 1.0, 1.089];
        for xyz in [[0.2, 0.3, 0.1], [0.004, 0.003, 0.006]] {
            let (_, rows) = lab_with_slopes(xyz, white);
            for j in 0..3 {
                let moved = |by: f64| {
                    let mut xyz = xyz;
                    xyz[j] += by;
                    lab(xyz, white)
                };
                let (up, down) = (moved(1e-6), moved(-1e-6));
                for i in 0..3 {
                    let difference = (up[i] - down[i]) / 2e-6;
                    let off = (rows[i][j] - difference).abs();
                    assert!(off < 1e-4 * (1.0 + difference.abs()), "{i} {j}");
                    assert!(difference == 0.0 || (1.01 * rows[i][j] - difference).abs() > off);
                }
            }
        }
    }
}
