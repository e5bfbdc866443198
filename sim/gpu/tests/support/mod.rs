//! Random films, and their reflectance in plain f64: film over film, wavelength by wavelength.

use maulstick_optics::backend::{FilmBackend, TILE_CELLS};
use maulstick_optics::colour::{linear_srgb_as_it_is, xyz_to_linear_srgb};
use maulstick_optics::studio::{RuleKind, StudioSettings};
use maulstick_optics::{FilmPlanes, PaintLibrary, Studio, Under, km};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng as _;

/// Interval between the cells that the slow oracle tests.
pub(crate) const STRIDE: usize = 61;

/// Uniform in 0..1.
pub(crate) fn unit(random: &mut Pcg64) -> f64 {
    (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

/// The films of a tile, which own their planes.
#[derive(Clone)]
pub(crate) struct Film {
    pub(crate) paints: Vec<(usize, Vec<f32>)>,
    pub(crate) opacity: f32,
    /// A value a wavelength, or a plane a wavelength.
    pub(crate) under: Vec<f32>,
}

impl Film {
    /// A film of `paints` paints up to `most_m` thick, over planes or an even ground.
    pub(crate) fn random(
        random: &mut Pcg64,
        studio: &Studio,
        paints: usize,
        most_m: f64,
        planes: bool,
    ) -> Self {
        let samples = studio.wavelengths();
        let mut slots: Vec<usize> = (0..studio.slots()).collect();
        let mut drawn = Vec::new();
        for _ in 0..paints {
            let slot = slots.swap_remove((unit(random) * slots.len() as f64) as usize);
            // Bare in part, and of all thicknesses from nanometres up.
            let mut cell = || {
                let (draw, bare) = (unit(random), unit(random) < 0.1);
                if bare {
                    0.0
                } else {
                    (most_m * draw * draw * draw) as f32
                }
            };
            drawn.push((slot, (0..TILE_CELLS).map(|_| cell()).collect()));
        }
        let values = if planes {
            samples * TILE_CELLS
        } else {
            samples
        };
        Self {
            paints: drawn,
            opacity: [1.0, 0.5, 0.125][(3.0 * unit(random)) as usize],
            under: (0..values).map(|_| unit(random) as f32).collect(),
        }
    }

    fn under(&self) -> Under<'_> {
        if self.under.len().is_multiple_of(TILE_CELLS) {
            Under::Planes(&self.under)
        } else {
            Under::Even(&self.under)
        }
    }

    /// Internal reflectance of a cell at a wavelength.
    pub(crate) fn reflectance(&self, studio: &Studio, sample: usize, cell: usize) -> f64 {
        let sum = |which: usize| -> f64 {
            let of = |(slot, plane): &(usize, Vec<f32>)| {
                f64::from(studio.paint(*slot)[sample][which]) * f64::from(plane[cell])
            };
            self.paints.iter().map(of).sum::<f64>() * f64::from(self.opacity)
        };
        let under = match self.under() {
            Under::Even(values) => values[sample],
            Under::Planes(values) => values[sample * TILE_CELLS + cell],
        };
        km::over(km::film(sum(0), sum(1)), f64::from(under))
    }

    /// Linear sRGB of a cell without gloss.
    pub(crate) fn rgb(&self, studio: &Studio, settings: &StudioSettings, cell: usize) -> [f64; 3] {
        let leaving = |sample| {
            studio
                .surface()
                .leaving(self.reflectance(studio, sample, cell))
        };
        let all: Vec<f64> = (0..studio.wavelengths()).map(leaving).collect();
        let to_rgb = if settings.adapted {
            xyz_to_linear_srgb(studio.white())
        } else {
            linear_srgb_as_it_is()
        };
        maulstick_optics::colour::apply(&to_rgb, studio.rule().xyz(&all))
    }
}

/// A studio of sixteen paints with `samples` wavelengths.
pub(crate) fn studio(rule: RuleKind, samples: usize) -> (Studio, StudioSettings) {
    let settings = StudioSettings {
        rule,
        samples,
        ..StudioSettings::default()
    };
    let library = PaintLibrary::measured().expect("whole");
    let mut studio = Studio::new(&settings, library.paints());
    for paint in library.paints() {
        studio.add(paint);
    }
    (studio, settings)
}

/// Runs `work` with films in the layout of backends.
pub(crate) fn as_tiles<T>(films: &[Film], work: impl FnOnce(&[FilmPlanes<'_>]) -> T) -> T {
    let paints: Vec<Vec<(usize, &[f32])>> = films
        .iter()
        .map(|film| {
            film.paints
                .iter()
                .map(|(slot, d)| (*slot, &d[..]))
                .collect()
        })
        .collect();
    let tiles: Vec<FilmPlanes<'_>> = films
        .iter()
        .zip(&paints)
        .map(|(film, paints)| FilmPlanes {
            paints,
            opacity: film.opacity,
            under: film.under(),
        })
        .collect();
    work(&tiles)
}

/// Greatest differences of a backend's results `told` from the plain films `films`: of linear sRGB, and of internal
/// reflectance.
pub(crate) fn off(
    backend: &mut dyn FilmBackend,
    (studio, settings): &(Studio, StudioSettings),
    told: &[Film],
    films: &[Film],
) -> [f64; 2] {
    let (shaded, baked) = as_tiles(told, |tiles| {
        let shaded = backend.shade(studio, tiles).expect("shaded");
        (shaded, backend.bake(studio, tiles).expect("baked"))
    });
    assert_eq!((shaded.len(), baked.len()), (films.len(), films.len()));
    let mut worst = [0.0f64; 2];
    for ((film, rgb), planes) in films.iter().zip(&shaded).zip(&baked) {
        assert!(rgb.iter().flatten().chain(planes).all(|v| v.is_finite()));
        for cell in (0..TILE_CELLS).step_by(STRIDE) {
            let exact = film.rgb(studio, settings, cell);
            for (got, exact) in rgb.iter().zip(exact) {
                worst[0] = worst[0].max((f64::from(got[cell]) - exact).abs());
            }
            for sample in 0..studio.wavelengths() {
                let exact = film.reflectance(studio, sample, cell);
                let got = f64::from(planes[sample * TILE_CELLS + cell]);
                worst[1] = worst[1].max((got - exact).abs());
            }
        }
    }
    worst
}
