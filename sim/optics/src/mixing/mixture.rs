//! Reflectance of mixed paints: an opaque layer, or a film over a ground.
//!
//! Mixing is linear in absorption and scattering (Duncan 1940; Baxter 2004, eq. 7.6), not in
//! reflectance: that is why yellow and blue paint make green.

use maulstick_types::Mixture;
use maulstick_types::mixture::Part;

use crate::km;
use crate::paints::{Paint, PaintError, PaintLibrary};
use crate::spectrum::{Spectrum, wavelength};
use crate::surface::SurfaceCorrection;

/// K and S of a mixture, per metre.
#[derive(Clone, Debug, PartialEq)]
pub struct Blend {
    /// Absorption.
    pub k: Spectrum,
    /// Scattering.
    pub s: Spectrum,
}

/// Form of the paint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Layer {
    /// So thick that nothing below it shows.
    Opaque,
    /// A film over a ground.
    Film {
        /// Its thickness, thinner included, m.
        thickness_m: f64,
        /// Share of its volume that is transparent medium (K = S = 0), 0 to 1.
        thinner: f64,
        /// Internal reflectance of the ground, the same at every wavelength: 0 black, 1 white.
        ground: f64,
    },
}

/// A layer and its surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coat {
    /// The layer.
    pub layer: Layer,
    /// Its surface; without one the reflectance is that inside the film.
    pub surface: Option<SurfaceCorrection>,
}

impl Coat {
    /// An opaque layer as the eye sees it, gloss included.
    #[must_use]
    pub fn masstone() -> Self {
        Self {
            layer: Layer::Opaque,
            surface: Some(SurfaceCorrection::default()),
        }
    }

    /// Reflectance of paint of absorption `k` and scattering `s`, per metre. With a surface it is that of a
    /// spectrometer with the gloss included.
    #[must_use]
    pub fn reflectance(&self, k: f64, s: f64) -> f64 {
        let inside = match self.layer {
            Layer::Opaque => km::opaque(k, s),
            Layer::Film {
                thickness_m,
                thinner,
                ground,
            } => {
                let d = thickness_m * (1.0 - thinner);
                km::over(km::film(k * d, s * d), ground)
            }
        };
        match &self.surface {
            Some(surface) => surface.measured(inside),
            None => inside,
        }
    }
}

impl Blend {
    /// Paints with their shares by volume, which are divided by their sum.
    #[must_use]
    pub fn new(parts: &[(&Paint, f64)]) -> Self {
        let whole: f64 = parts.iter().map(|(_, share)| share).sum();
        let (mut k, mut s) = (Spectrum::flat(0.0), Spectrum::flat(0.0));
        for (paint, share) in parts {
            let add = |to: &mut Spectrum, from: &Spectrum| {
                for (sum, value) in to.0.iter_mut().zip(from.0) {
                    *sum += share / whole * value;
                }
            };
            add(&mut k, &paint.k);
            add(&mut s, &paint.s);
        }
        Self { k, s }
    }

    /// This with a share of `other`, 0 to 1, in it.
    #[must_use]
    pub fn toward(&self, other: &Self, share: f64) -> Self {
        let mix = |a: &Spectrum, b: &Spectrum| {
            Spectrum(std::array::from_fn(|i| {
                (1.0 - share) * a.0[i] + share * b.0[i]
            }))
        };
        Self {
            k: mix(&self.k, &other.k),
            s: mix(&self.s, &other.s),
        }
    }

    /// A mixture of a library's paints.
    ///
    /// # Errors
    /// As [`PaintLibrary::check`].
    pub fn of(library: &PaintLibrary, mixture: &Mixture) -> Result<Self, PaintError> {
        mixture.check()?;
        let find = |part: &Part| library.find(&part.paint).map(|paint| (paint, part.share));
        let parts = mixture.parts.iter().map(find);
        let parts: Vec<_> = parts.collect::<Result<_, _>>()?;
        Ok(Self::new(&parts))
    }

    /// Reflectance at `nm`.
    #[must_use]
    pub fn reflectance_at(&self, nm: f64, coat: &Coat) -> f64 {
        coat.reflectance(self.k.at(nm), self.s.at(nm))
    }

    /// Reflectance at the 101 samples.
    #[must_use]
    pub fn reflectance(&self, coat: &Coat) -> Spectrum {
        Spectrum(std::array::from_fn(|i| {
            self.reflectance_at(wavelength(i), coat)
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blend(mixture: &str) -> Blend {
        let library = PaintLibrary::measured().expect("whole");
        Blend::of(&library, &mixture.parse().expect("a mixture")).expect("known paints")
    }

    fn film(um: f64, thinner: f64, ground: f64) -> Coat {
        Coat {
            layer: Layer::Film {
                thickness_m: um * 1e-6,
                thinner,
                ground,
            },
            surface: None,
        }
    }

    const OPAQUE: Coat = Coat {
        layer: Layer::Opaque,
        surface: None,
    };

    fn worst(one: &Spectrum, two: &Spectrum) -> f64 {
        let off = one.0.iter().zip(two.0).map(|(a, b)| (a - b).abs());
        off.fold(0.0, f64::max)
    }

    #[test]
    fn absorption_and_scattering_mix_linearly() {
        let green = blend("Cobalt Blue=0.5,Hansa Yellow Opaque=0.5").reflectance(&OPAQUE);
        let library = PaintLibrary::measured().expect("whole");
        let [blue, yellow] = ["Cobalt Blue", "Hansa Yellow Opaque"]
            .map(|name| library.find(name).expect("known").clone());
        // Duncan's (1 − R)²/(2R) = ΣcK/ΣcS.
        let error = |shares: [f64; 2]| {
            let mut worst = 0.0f64;
            for (i, r) in green.0.iter().enumerate() {
                let k = shares[0] * blue.k.0[i] + shares[1] * yellow.k.0[i];
                let s = shares[0] * blue.s.0[i] + shares[1] * yellow.s.0[i];
                worst = worst.max(((1.0 - r) * (1.0 - r) / (2.0 * r) / (k / s) - 1.0).abs());
            }
            worst
        };
        println!("eq. 7.6 to {:e}", error([0.5, 0.5]));
        assert!(error([0.5, 0.5]) < 1e-9);
        assert!(error([0.5 + 1e-8, 0.5]) > 1e-9, "a fault would pass");
    }

    #[test]
    fn titanium_white_hides_black_as_measured() {
        let white = blend("Titanium White");
        for (um, r) in [(25.0, 0.79), (50.0, 0.88), (100.0, 0.94)] {
            let got = white.reflectance_at(620.0, &film(um, 0.0, 0.0));
            let twice = white.reflectance_at(620.0, &film(2.0 * um, 0.5, 0.0));
            println!("{um} µm over black: {got:.4}, expected {r}");
            assert!((got - r).abs() < 0.01 && (got - twice).abs() < 1e-12);
            let thinned = white.reflectance_at(620.0, &film(um, 0.5, 0.0));
            assert!((thinned - r).abs() > 0.01, "a fault would pass");
        }
    }

    #[test]
    fn a_film_goes_from_its_ground_to_its_masstone() {
        let glaze = blend("Quinacridone Red=0.8,Ultramarine Blue=0.2");
        let masstone = glaze.reflectance(&OPAQUE);
        for ground in [0.0, 0.4, 1.0] {
            let nothing = [film(0.0, 0.0, ground), film(50.0, 1.0, ground)];
            for coat in nothing {
                assert!(worst(&glaze.reflectance(&coat), &Spectrum::flat(ground)) < 1e-12);
            }
            let thick = glaze.reflectance(&film(1e6, 0.0, ground));
            assert!(worst(&thick, &masstone) < 1e-9, "{ground}");
            let thin = glaze.reflectance(&film(10.0, 0.0, ground));
            assert!(worst(&thin, &masstone) > 1e-2, "a fault would pass");
            assert!(thin.0.iter().all(|r| (0.0..=1.0).contains(r)));
        }
        // Kubelka 1954: a film over another is the thicker film.
        let (one, two) = (film(10.0, 0.0, 0.3), film(20.0, 0.0, 0.3));
        for nm in [400.0, 550.0, 700.0] {
            let lower = glaze.reflectance_at(nm, &one);
            let layered = glaze.reflectance_at(nm, &film(10.0, 0.0, lower));
            assert!((layered - glaze.reflectance_at(nm, &two)).abs() < 1e-12);
        }
    }

    #[test]
    fn the_surface_comes_last() {
        let paint = blend("Yellow Ochre");
        let (inside, seen) = (
            paint.reflectance(&OPAQUE),
            paint.reflectance(&Coat::masstone()),
        );
        let surface = SurfaceCorrection::default();
        for (inside, seen) in inside.0.iter().zip(seen.0) {
            assert!((surface.internal(seen) - inside).abs() < 1e-12);
        }
        assert!(worst(&inside, &seen) > 1e-2, "a fault would pass");
    }

    #[test]
    fn what_is_no_mixture_of_the_paints_is_refused() {
        let library = PaintLibrary::measured().expect("whole");
        let misspelt = Mixture::pure("Colbat Blue");
        let error = Blend::of(&library, &misspelt).expect_err("misspelt");
        assert!(
            matches!(error, PaintError::Unknown { nearest: Some(near), .. } if near == "Cobalt Blue")
        );
    }
}
