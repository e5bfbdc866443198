//! Colour of a layer of one cell, and its slopes by the shares of the paints.

use maulstick_num::powf;
use maulstick_optics::colour::{srgb_decode, srgb_encode};
use maulstick_optics::km::over_with_slopes;

use crate::palette::Palette;

/// Colour of a layer over its ground in a cell, as a function of the shares of its paints.
pub(crate) trait CellColour {
    /// CIELAB, gloss included; `slopes` receives its derivatives by each share.
    fn lab(&self, shares: &[f64], slopes: &mut [[f64; 3]]) -> [f64; 3];
}

/// CIELAB of a colour; converts slopes of XYZ into those of CIELAB.
fn lab_with_slopes(palette: &Palette<'_>, xyz: [f64; 3], slopes: &mut [[f64; 3]]) -> [f64; 3] {
    const EDGE: f64 = 216.0 / 24_389.0;
    const LINE: f64 = 24_389.0 / 27.0 / 116.0;
    let curve = |i: usize| {
        let t = xyz[i] / palette.white[i];
        let (value, slope) = if t > EDGE {
            let root = powf(t, 1.0 / 3.0);
            (root, root / (3.0 * t))
        } else {
            (LINE * t + 16.0 / 116.0, LINE)
        };
        (value, slope / palette.white[i])
    };
    let [(x, dx), (y, dy), (z, dz)] = [curve(0), curve(1), curve(2)];
    for slope in slopes {
        let [a, b, c] = [slope[0] * dx, slope[1] * dy, slope[2] * dz];
        *slope = [116.0 * b, 500.0 * (a - b), 200.0 * (b - c)];
    }
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// A film of a given thickness.
pub(crate) struct FilmCell<'a> {
    pub(crate) palette: &'a Palette<'a>,
    /// Internal reflectance of its ground, a value a wavelength.
    pub(crate) under: &'a [f64],
    /// Thickness of its paints without the thinner, times the opacity of its layer, m.
    pub(crate) thickness_m: f64,
}

impl CellColour for FilmCell<'_> {
    fn lab(&self, shares: &[f64], slopes: &mut [[f64; 3]]) -> [f64; 3] {
        let surface = self.palette.look.studio.surface();
        let open = (1.0 - surface.k1) * (1.0 - surface.k2);
        slopes.fill([0.0; 3]);
        let mut xyz = self.palette.gloss;
        let samples = self.palette.ks.iter().zip(&self.palette.weights);
        for ((ks, weight), under) in samples.zip(self.under) {
            let (mut k, mut s) = (0.0, 0.0);
            for (ks, share) in ks.iter().zip(shares) {
                k += ks[0] * share;
                s += ks[1] * share;
            }
            let (kd, sd) = (k * self.thickness_m, s * self.thickness_m);
            let [r, by_k, by_s] = over_with_slopes(kd, sd, *under);
            let through = 1.0 / (1.0 - surface.k2 * r);
            let leaving = open * r * through;
            // Slope of the emerging light by r, of r by the thicknesses.
            let steep = open * through * through * self.thickness_m;
            let (by_k, by_s) = (steep * by_k, steep * by_s);
            for (sum, weight) in xyz.iter_mut().zip(weight) {
                *sum += weight * leaving;
            }
            for (slope, [k, s]) in slopes.iter_mut().zip(ks) {
                let by = by_k * k + by_s * s;
                for (sum, weight) in slope.iter_mut().zip(weight) {
                    *sum += weight * by;
                }
            }
        }
        lab_with_slopes(self.palette, xyz, slopes)
    }
}

/// A layer of volumes.
pub(crate) struct VolumeCell<'a> {
    pub(crate) palette: &'a Palette<'a>,
    /// Encoded colours of its paints.
    pub(crate) encoded: &'a [[f64; 3]],
    /// Encoded colour of its ground.
    pub(crate) under: [f64; 3],
    /// Opacity of the layer.
    pub(crate) hides: f64,
}

impl CellColour for VolumeCell<'_> {
    fn lab(&self, shares: &[f64], slopes: &mut [[f64; 3]]) -> [f64; 3] {
        let mut mixed = [0.0; 3];
        for (encoded, share) in self.encoded.iter().zip(shares) {
            for (sum, value) in mixed.iter_mut().zip(encoded) {
                *sum += share * value;
            }
        }
        let seen = |i: usize| {
            let encoded = self.under[i] + self.hides * (mixed[i] - self.under[i]);
            encoded.clamp(0.0, 1.0)
        };
        let encoded = [seen(0), seen(1), seen(2)];
        let steep = encoded.map(|value| {
            if value <= 0.040_45 {
                1.0 / 12.92
            } else {
                2.4 / 1.055 * powf((value + 0.055) / 1.055, 1.4)
            }
        });
        let to_xyz = self.palette.to_xyz();
        for (slope, own) in slopes.iter_mut().zip(self.encoded) {
            let by = [0, 1, 2].map(|i| self.hides * steep[i] * own[i]);
            *slope = maulstick_optics::colour::apply(to_xyz, by);
        }
        let xyz = self.palette.xyz(encoded.map(srgb_decode));
        lab_with_slopes(self.palette, xyz, slopes)
    }
}

/// Encoded sRGB of linear light.
pub(crate) fn encoded(linear: f32) -> f32 {
    srgb_encode(linear.into()) as f32
}
