//! The optics of one painting: its paints and the light that it stands in.

use crate::cie::{Illuminant, Observer};
use crate::colour::{Matrix, apply, lab, linear_srgb_as_it_is, xyz_to_linear_srgb};
use crate::km::{self, film_over_f32};
use crate::paints::Paint;
use crate::rule::SamplingRule;
use crate::spectrum::Spectrum;
use crate::surface::SurfaceCorrection;

/// Cells that are computed together: their sums stay in the first cache.
const RUN: usize = 64;

/// Choice of the wavelengths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RuleKind {
    /// [`SamplingRule::gauss`].
    Gauss,
    /// [`SamplingRule::fitted`].
    #[default]
    Fitted,
    /// [`SamplingRule::reference`].
    Reference,
}

impl RuleKind {
    /// The rule called `name`: `gauss`, `fitted` or `reference`.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "gauss" => Some(Self::Gauss),
            "fitted" => Some(Self::Fitted),
            "reference" => Some(Self::Reference),
            _ => None,
        }
    }
}

/// The light, and how it becomes colour.
#[derive(Clone, Debug, PartialEq)]
pub struct StudioSettings {
    /// The light's spectrum.
    pub light: Illuminant,
    /// Observer of the colours.
    pub observer: Observer,
    /// Choice of the wavelengths.
    pub rule: RuleKind,
    /// Their number; [`RuleKind::Reference`] takes all 101.
    pub samples: usize,
    /// True if the eye is adapted to the light's white, so that the perfect diffuser is (1, 1, 1); otherwise the
    /// light's cast stays.
    pub adapted: bool,
}

impl Default for StudioSettings {
    /// Average daylight, sixteen fitted samples, adapted.
    fn default() -> Self {
        Self {
            light: Illuminant::d65(),
            observer: Observer::default(),
            rule: RuleKind::default(),
            samples: 16,
            adapted: true,
        }
    }
}

impl StudioSettings {
    /// XYZ of the perfect diffuser, Y = 1.
    #[must_use]
    pub fn white(&self) -> [f64; 3] {
        self.light.xyz(self.observer, &Spectrum::flat(1.0))
    }

    /// From XYZ under this light to linear sRGB.
    #[must_use]
    pub fn to_rgb(&self) -> Matrix {
        if self.adapted {
            xyz_to_linear_srgb(self.white())
        } else {
            linear_srgb_as_it_is()
        }
    }

    /// The rule for a palette of `paints`.
    #[must_use]
    pub fn rule(&self, paints: &[Paint]) -> SamplingRule {
        match self.rule {
            RuleKind::Gauss => SamplingRule::gauss(self.samples, self.observer, &self.light),
            RuleKind::Fitted => {
                SamplingRule::fitted(self.samples, self.observer, &self.light, paints)
            }
            RuleKind::Reference => SamplingRule::reference(self.observer, &self.light),
        }
    }
}

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

/// Ground of a film: internal reflectances at the wavelengths of the rule.
#[derive(Clone, Copy, Debug)]
pub enum Under<'a> {
    /// The same in all cells: a value a wavelength.
    Even(&'a [f32]),
    /// A plane of cells a wavelength, one after the other.
    Planes(&'a [f32]),
}

impl Under<'_> {
    /// The reflectances of cells `start`.. at a wavelength, of `cells` in all.
    #[inline]
    fn run(&self, sample: usize, cells: usize, start: usize) -> [f32; RUN] {
        match self {
            Self::Even(values) => [values[sample]; RUN],
            Self::Planes(values) => {
                let mut run = [0.0; RUN];
                let end = (start + RUN).min(cells);
                run[..end - start].copy_from_slice(&values[sample * cells..][start..end]);
                run
            }
        }
    }
}

/// A film over its ground, for a run of cells.
#[derive(Clone, Copy, Debug)]
pub struct FilmPlanes<'a> {
    /// Slot of the paint and its thickness in each cell, m; all of one length.
    pub paints: &'a [(usize, &'a [f32])],
    /// Factor on the film's optical thickness; its height stays.
    pub opacity: f32,
    /// Its ground.
    pub under: Under<'a>,
}

impl FilmPlanes<'_> {
    /// Writes K·d and S·d of cells `start`.. at a wavelength to `sums`.
    #[inline]
    fn thickness(
        &self,
        paints: &[Vec<[f32; 2]>],
        sample: usize,
        start: usize,
        sums: &mut [[f32; RUN]; 2],
    ) {
        *sums = [[0.0; RUN]; 2];
        let mut rest = self.paints;
        while let Some((four, others)) = rest.split_first_chunk::<4>() {
            self.add(four, paints, sample, start, sums);
            rest = others;
        }
        if let Some((two, others)) = rest.split_first_chunk::<2>() {
            self.add(two, paints, sample, start, sums);
            rest = others;
        }
        if let Some(one) = rest.first_chunk::<1>() {
            self.add(one, paints, sample, start, sums);
        }
    }

    /// Adds K·d and S·d of several paints; several at once reduce the memory traffic of the sums.
    #[inline]
    fn add<const N: usize>(
        &self,
        some: &[(usize, &[f32]); N],
        paints: &[Vec<[f32; 2]>],
        sample: usize,
        start: usize,
        [kd, sd]: &mut [[f32; RUN]; 2],
    ) {
        let length = RUN.min(some[0].1.len() - start);
        let runs = some.map(|(_, plane)| &plane[start..start + length]);
        let per_m = some.map(|(slot, _)| paints[slot][sample].map(|per_m| per_m * self.opacity));
        for i in 0..length {
            let (mut k_sum, mut s_sum) = (kd[i], sd[i]);
            for (run, [k, s]) in runs.iter().zip(per_m) {
                k_sum += k * run[i];
                s_sum += s * run[i];
            }
            (kd[i], sd[i]) = (k_sum, s_sum);
        }
    }
}

impl Studio {
    /// A studio for a palette of `paints`; none of them has a slot yet.
    #[must_use]
    pub fn new(settings: &StudioSettings, paints: &[Paint]) -> Self {
        let rule = settings.rule(paints);
        let (white, to_rgb) = (settings.white(), settings.to_rgb());
        let rgb = rule
            .weights
            .iter()
            .map(|weight| apply(&to_rgb, *weight).map(|v| v as f32))
            .collect();
        Self {
            rule,
            surface: SurfaceCorrection::default(),
            white,
            to_rgb,
            paints: Vec::new(),
            rgb,
        }
    }

    /// Baxter 2004, § 7.7: eight Gauss samples, under average daylight.
    #[must_use]
    pub fn daylight() -> Self {
        let settings = StudioSettings {
            rule: RuleKind::Gauss,
            samples: 8,
            ..StudioSettings::default()
        };
        Self::new(&settings, &[])
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

    /// Number of paints; all slots are below it.
    #[must_use]
    pub fn slots(&self) -> usize {
        self.paints.len()
    }

    /// The rule.
    #[must_use]
    pub fn rule(&self) -> &SamplingRule {
        &self.rule
    }

    /// Surface correction.
    #[must_use]
    pub fn surface(&self) -> SurfaceCorrection {
        self.surface
    }

    /// K and S of the paint in a slot at each wavelength, per metre.
    #[must_use]
    pub fn paint(&self, slot: usize) -> &[[f32; 2]] {
        &self.paints[slot]
    }

    /// Linear sRGB of a reflectance of 1 at each wavelength alone.
    #[must_use]
    pub fn primaries(&self) -> &[[f32; 3]] {
        &self.rgb
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

    /// From XYZ to linear sRGB.
    #[must_use]
    pub fn to_rgb(&self) -> &Matrix {
        &self.to_rgb
    }

    /// Linear sRGB, without gloss, of one film over its ground. `rgb` are the planes of red, green and blue, as long as
    /// those of the paints.
    ///
    /// One exponential and one division a sample: the film over its ground is n/m (see [`film_over_f32`]), and the
    /// surface turns it into (1−k₁)(1−k₂)·n/(m − k₂·n).
    pub fn shade(&self, films: &FilmPlanes<'_>, rgb: [&mut [f32]; 3]) {
        let [red, green, blue] = rgb;
        let cells = red.len();
        let (k1, k2) = (self.surface.k1 as f32, self.surface.k2 as f32);
        let open = (1.0 - k1) * (1.0 - k2);
        let mut thickness = [[0.0f32; RUN]; 2];
        // A bare even ground is one colour.
        let bare = films.paints.is_empty() && matches!(films.under, Under::Even(_));
        let distinct = if bare { cells.min(1) } else { cells };
        for start in (0..distinct).step_by(RUN) {
            let mut sum = [[0.0f32; RUN]; 3];
            for (sample, weight) in self.rgb.iter().enumerate() {
                films.thickness(&self.paints, sample, start, &mut thickness);
                let ([kd, sd], under) = (&thickness, films.under.run(sample, cells, start));
                let [r, g, b] = &mut sum;
                for i in 0..RUN {
                    let film = film_over_f32(kd[i], sd[i], under[i]);
                    let leaving = open * film.n / (film.m - k2 * film.n);
                    r[i] += weight[0] * leaving;
                    g[i] += weight[1] * leaving;
                    b[i] += weight[2] * leaving;
                }
            }
            let run = start..(start + RUN).min(cells);
            let length = run.len();
            red[run.clone()].copy_from_slice(&sum[0][..length]);
            green[run.clone()].copy_from_slice(&sum[1][..length]);
            blue[run].copy_from_slice(&sum[2][..length]);
        }
        if bare && cells > 0 {
            for plane in [red, green, blue] {
                plane.fill(plane[0]);
            }
        }
    }

    /// Internal reflectance of one film over its ground, a plane of `cells` a wavelength: a dried film becomes the
    /// ground of later paint (Baxter 2004, § 7.8).
    #[must_use]
    pub fn bake(&self, films: &FilmPlanes<'_>, cells: usize) -> Vec<f32> {
        let mut baked = vec![0.0f32; self.rule.len() * cells];
        let mut thickness = [[0.0f32; RUN]; 2];
        for (sample, plane) in baked.chunks_exact_mut(cells.max(1)).enumerate() {
            for start in (0..cells).step_by(RUN) {
                films.thickness(&self.paints, sample, start, &mut thickness);
                let ([kd, sd], under) = (&thickness, films.under.run(sample, cells, start));
                let mut run = [0.0f32; RUN];
                for i in 0..RUN {
                    let film = film_over_f32(kd[i], sd[i], under[i]);
                    run[i] = (film.n / film.m).clamp(0.0, 1.0);
                }
                let end = (start + RUN).min(cells);
                plane[start..end].copy_from_slice(&run[..end - start]);
            }
        }
        baked
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
mod tests;
