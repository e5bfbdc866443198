//! Paints available to a fit, as numbers.

use maulstick_appearance::Appearance;
use maulstick_optics::colour::{Matrix, apply, inverse, lab};

/// Paints of a painting that have a colour, under its light.
#[derive(Debug)]
pub(crate) struct Palette<'a> {
    pub(crate) look: &'a Appearance,
    /// Their slots, ascending, without thinner and varnish.
    pub(crate) slots: Vec<usize>,
    /// K and S per metre, a row of paints for each wavelength.
    pub(crate) ks: Vec<Vec<[f64; 2]>>,
    /// Weights of the wavelengths in X, Y and Z.
    pub(crate) weights: Vec<[f64; 3]>,
    /// White point: XYZ of the perfect diffuser.
    pub(crate) white: [f64; 3],
    to_xyz: Matrix,
    /// XYZ of the surface's own reflection, which is added to every colour.
    pub(crate) gloss: [f64; 3],
}

impl<'a> Palette<'a> {
    /// Paints of a painting.
    pub(crate) fn new(look: &'a Appearance) -> Self {
        let studio = &look.studio;
        let slots: Vec<usize> = (0..studio.slots())
            .filter(|slot| !look.is_clear(*slot))
            .collect();
        let row = |sample: usize| {
            let paint = |slot: &usize| studio.paint(*slot)[sample].map(f64::from);
            slots.iter().map(paint).collect()
        };
        let white = studio.white();
        Self {
            look,
            ks: (0..studio.wavelengths()).map(row).collect(),
            weights: studio.rule().weights.clone(),
            white,
            to_xyz: inverse(studio.to_rgb()),
            gloss: white.map(|value| studio.surface().k1 * value),
            slots,
        }
    }

    /// XYZ, with the gloss, of linear red, green and blue without it.
    pub(crate) fn xyz(&self, rgb: [f64; 3]) -> [f64; 3] {
        let xyz = apply(&self.to_xyz, rgb);
        [0, 1, 2].map(|i| xyz[i] + self.gloss[i])
    }

    /// XYZ, with the gloss, of internal reflectances by wavelength.
    pub(crate) fn xyz_of(&self, reflectances: impl Iterator<Item = f64>) -> [f64; 3] {
        let surface = self.look.studio.surface();
        let mut xyz = self.gloss;
        for (weight, r) in self.weights.iter().zip(reflectances) {
            let leaving = surface.leaving(r);
            for (sum, weight) in xyz.iter_mut().zip(weight) {
                *sum += weight * leaving;
            }
        }
        xyz
    }

    /// CIELAB of a colour.
    pub(crate) fn lab(&self, xyz: [f64; 3]) -> [f64; 3] {
        lab(xyz, self.white)
    }

    /// Matrix from linear channels to XYZ.
    pub(crate) fn to_xyz(&self) -> &Matrix {
        &self.to_xyz
    }
}
