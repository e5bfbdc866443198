//! The optics of one painting: its paints, its ground and the light that it stands in.

use crate::cie::{Illuminant, Observer};
use crate::colour::{apply, lab, xyz_to_linear_srgb};
use crate::km;
use crate::paints::Paint;
use crate::rule::SamplingRule;
use crate::spectrum::Spectrum;
use crate::surface::SurfaceCorrection;

/// Everything that turns films of paint into colour, at the wavelengths of one rule.
#[derive(Clone, Debug)]
pub struct Studio {
    rule: SamplingRule,
    surface: SurfaceCorrection,
    white: [f64; 3],
    to_rgb: [[f64; 3]; 3],
    /// K and S of each paint at each wavelength, per metre.
    paints: Vec<Vec<[f32; 2]>>,
    /// Linear sRGB of a reflectance of 1 at each wavelength alone.
    rgb: Vec<[f32; 3]>,
}

/// The films of a run of cells: one plane of thickness, m, for each paint slot in use.
#[derive(Clone, Copy, Debug)]
pub struct FilmPlanes<'a> {
    /// Slot of the paint and thickness in each cell; all of one length.
    pub paints: &'a [(usize, &'a [f32])],
    /// Internal reflectance of what lies below, a value for each wavelength of the rule.
    pub ground: &'a [f32],
}

impl Studio {
    /// A studio for `light` with `rule`.
    #[must_use]
    pub fn new(rule: SamplingRule, observer: Observer, light: &Illuminant) -> Self {
        let white = light.xyz(observer, &Spectrum::flat(1.0));
        let to_rgb = xyz_to_linear_srgb(white);
        let rgb = rule
            .weights
            .iter()
            .map(|weight| apply(&to_rgb, *weight).map(|v| v as f32))
            .collect();
        let surface = SurfaceCorrection::default();
        Self {
            rule,
            surface,
            white,
            to_rgb,
            paints: Vec::new(),
            rgb,
        }
    }

    /// Baxter 2004, § 7.7: eight Gauss samples, under average daylight.
    #[must_use]
    pub fn daylight() -> Self {
        let (observer, light) = (Observer::default(), Illuminant::d65());
        Self::new(SamplingRule::gauss(8, observer, &light), observer, &light)
    }

    /// Adds a paint and returns its slot.
    pub fn add(&mut self, paint: &Paint) -> usize {
        let at = |nm: &f64| [paint.k.at(*nm) as f32, paint.s.at(*nm) as f32];
        self.paints
            .push(self.rule.wavelengths_nm.iter().map(at).collect());
        self.paints.len() - 1
    }

    /// Number of wavelengths.
    #[must_use]
    pub fn wavelengths(&self) -> usize {
        self.rule.len()
    }

    /// A spectrum at the rule's wavelengths.
    #[must_use]
    pub fn sample(&self, spectrum: &Spectrum) -> Vec<f32> {
        self.rule
            .wavelengths_nm
            .iter()
            .map(|nm| spectrum.at(*nm) as f32)
            .collect()
    }

    /// XYZ of the perfect diffuser.
    #[must_use]
    pub fn white(&self) -> [f64; 3] {
        self.white
    }

    /// Linear sRGB, without gloss, of one wet film over a ground, for a run of cells. `rgb` are the
    /// planes of red, green and blue, as long as those of the paints.
    ///
    /// One exponential and three divisions a sample: two of the film, one of film over ground and
    /// surface together.
    pub fn shade(&self, films: &FilmPlanes<'_>, rgb: [&mut [f32]; 3]) {
        const RUN: usize = 64;
        let [red, green, blue] = rgb;
        let cells = red.len();
        let (k1, k2) = (self.surface.k1 as f32, self.surface.k2 as f32);
        let open = (1.0 - k1) * (1.0 - k2);
        for start in (0..cells).step_by(RUN) {
            let run = start..(start + RUN).min(cells);
            let mut sum = [[0.0f32; RUN]; 3];
            for (sample, weight) in self.rgb.iter().enumerate() {
                let (mut kd, mut sd) = ([0.0f32; RUN], [0.0f32; RUN]);
                for (slot, thickness) in films.paints {
                    let [k, s] = self.paints[*slot][sample];
                    let run = &thickness[run.clone()];
                    for ((kd, sd), d) in kd.iter_mut().zip(&mut sd).zip(run) {
                        *kd += k * d;
                        *sd += s * d;
                    }
                }
                let ground = films.ground[sample];
                let [r, g, b] = &mut sum;
                for i in 0..RUN {
                    let film = km::film_f32(kd[i], sd[i]);
                    // Film over ground is n/m; the surface makes open·n/(m − k₂·n) of it.
                    let m = 1.0 - film.r * ground;
                    let n = film.r * m + film.t * film.t * ground;
                    let leaving = open * n / (m - k2 * n);
                    r[i] += weight[0] * leaving;
                    g[i] += weight[1] * leaving;
                    b[i] += weight[2] * leaving;
                }
            }
            let length = run.len();
            red[run.clone()].copy_from_slice(&sum[0][..length]);
            green[run.clone()].copy_from_slice(&sum[1][..length]);
            blue[run].copy_from_slice(&sum[2][..length]);
        }
    }

    /// Linear sRGB, gloss included, of a uniform film: thickness in metres by slot, over a ground.
    #[must_use]
    pub fn colour(&self, films: &[(usize, f64)], ground: &[f32]) -> [f64; 3] {
        apply(&self.to_rgb, self.film_xyz(films, ground))
    }

    /// CIELAB, gloss included, of a uniform film over a ground.
    #[must_use]
    pub fn lab(&self, films: &[(usize, f64)], ground: &[f32]) -> [f64; 3] {
        lab(self.film_xyz(films, ground), self.white)
    }

    fn film_xyz(&self, films: &[(usize, f64)], ground: &[f32]) -> [f64; 3] {
        let reflectance = |sample: usize| {
            let sum = |which: usize| {
                films
                    .iter()
                    .map(|(slot, d)| f64::from(self.paints[*slot][sample][which]) * d)
                    .sum()
            };
            self.surface.measured(km::over(
                km::film(sum(0), sum(1)),
                f64::from(ground[sample]),
            ))
        };
        self.rule
            .xyz(&(0..self.rule.len()).map(reflectance).collect::<Vec<_>>())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paints::PaintLibrary;

    fn studio(names: &[&str]) -> Studio {
        let library = PaintLibrary::measured().expect("whole");
        let mut studio = Studio::daylight();
        for name in names {
            studio.add(library.find(name).expect("known"));
        }
        studio
    }

    fn shade(studio: &Studio, thickness: [f32; 2], ground: f32) -> [f32; 3] {
        let planes = thickness.map(|d| vec![d; 130]);
        let paints = [(0, planes[0].as_slice()), (1, planes[1].as_slice())];
        let ground = vec![ground; studio.wavelengths()];
        let mut rgb = [const { [0.0f32; 130] }; 3];
        let [r, g, b] = &mut rgb;
        studio.shade(
            &FilmPlanes {
                paints: &paints,
                ground: &ground,
            },
            [r, g, b],
        );
        assert!(rgb.iter().all(|plane| plane.iter().all(|v| *v == plane[0])));
        rgb.map(|plane| plane[129])
    }

    #[test]
    fn planes_agree_with_the_plain_formula() {
        let studio = studio(&["Ultramarine Blue", "Yellow Ochre"]);
        let ground = vec![0.9f32; studio.wavelengths()];
        for (a, b) in [
            (0.0, 0.0),
            (1e-6, 0.0),
            (2e-5, 1e-5),
            (1e-4, 3e-4),
            (0.0, 5e-3),
        ] {
            let exact = studio.colour(&[(0, a), (1, b)], &ground);
            let got = shade(&studio, [a as f32, b as f32], 0.9);
            for (got, exact) in got.iter().zip(exact) {
                let error = (f64::from(*got) + studio.surface.k1 - exact).abs();
                assert!(error < 3e-6, "{a} {b}: {got} {exact}");
                assert!((error - 3e-5).abs() > 3e-6, "a fault would pass");
            }
        }
    }

    #[test]
    fn paints_look_like_their_names() {
        let studio = studio(&[
            "Ultramarine Blue",
            "Hansa Yellow Opaque",
            "Yellow Ochre",
            "Titanium White",
        ]);
        let black = vec![0.0f32; studio.wavelengths()];
        let opaque = |slot: usize| studio.colour(&[(slot, 0.01)], &black);
        let [r, g, b] = opaque(0);
        assert!(
            b > 2.0 * r && b > 2.0 * g,
            "ultramarine is blue: {r} {g} {b}"
        );
        let [r, g, b] = opaque(1);
        assert!(
            r > 4.0 * b && g > 4.0 * b,
            "hansa yellow is yellow: {r} {g} {b}"
        );
        let lightness = studio.lab(&[(2, 0.01)], &black)[0];
        assert!(
            (lightness - 55.0).abs() < 2.5,
            "yellow ochre's L* is 55, not {lightness}"
        );
        let [r, g, b] = opaque(3);
        assert!(
            r > 0.85 && (r - b).abs() < 0.12 && (r - g).abs() < 0.05,
            "white: {r} {g} {b}"
        );
        let [r, g, b] = studio.colour(&[(0, 0.005), (1, 0.005)], &black);
        assert!(
            g > 1.2 * r && g > 1.2 * b,
            "blue and yellow make green: {r} {g} {b}"
        );
    }
}
