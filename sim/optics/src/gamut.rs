//! Colours outside a display's gamut, as mixtures of measured pigments and highlights on them may be.
//!
//! [`GamutMapping::Soft`] works in Oklab (Ottosson 2020, *A perceptual color space for image processing*), where a line
//! of constant hue also looks like one. A colour of lightness L and chroma C moves along the line from a grey of
//! lightness L₀ to it, on which the gamut ends at the share 1/r of the distance:
//!
//! ```text
//! L₀ = ½·(1 + sgn(D)·(e − √(e² − 2|D|))),  D = L − ½,  e = ½ + |D| + α·C,  α = 1
//! (L − L₀, C) ← (L − L₀, C)·ρ/r,  ρ = κ + z − z²/(4·(1 − κ)),  z = clamp(r, κ, 2 − κ) − κ,  κ = .8
//! ```
//!
//! L₀ is Ottosson's (2021, *Two practical gamut clipping algorithms*, "adaptive L₀, ½"): L itself for a grey, so that
//! greys up to white stay; nearer to the middle for more colourful colours, so that a yellow flank slightly too bright
//! for the display gets darker before it bleaches, while the light and dark of a relief in paint that is too colourful
//! remain. A larger α keeps more colour and less lightness. ρ has slope 1 at the knee κ and slope 0 where it reaches
//! the edge, so there is no sudden onset. Colours inside the knee are unchanged, even by rounding.
//!
//! [`GamutMapping::Clamp`] is the clamp of Baxter 2004, § 7.8.1, the reference of this module's tests.
//!
//! The same terms are in `ui/src/render/shaders/light_surface.wgsl`.

use crate::colour::{Matrix, inverse, product};

/// Share κ of the distance to the edge of the gamut within which colours are unchanged.
pub const KNEE: f32 = 0.8;
/// α: how much of the lightness goes for colour.
pub const FOR_COLOUR: f32 = 1.0;
/// Halvings of the interval in which the edge of the gamut is looked for.
pub const HALVINGS: u32 = 10;

/// Oklab's cone responses of linear sRGB, and Lab of their cube roots.
const CONES: Matrix = [
    [0.412_221_470_8, 0.536_332_536_3, 0.051_445_992_9],
    [0.211_903_498_2, 0.680_699_545_1, 0.107_396_956_6],
    [0.088_302_461_9, 0.281_718_837_6, 0.629_978_700_5],
];
const LAB: Matrix = [
    [0.210_454_255_3, 0.793_617_785_0, -0.004_072_046_8],
    [1.977_998_495_1, -2.428_592_205_0, 0.450_593_709_9],
    [0.025_904_037_1, 0.782_771_766_2, -0.808_675_766_0],
];

/// Mapping of colours into the gamut.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GamutMapping {
    /// At constant hue, with a smooth onset.
    #[default]
    Soft,
    /// Along the line to white in linear light, with a sudden onset; too bright channels are cut off.
    Clamp,
}

/// Mapping from the working space into the gamut of a display.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gamut {
    /// The mapping.
    pub mapping: GamutMapping,
    /// Rows: from linear sRGB, the working space, to linear light of the display.
    pub from_working: [[f32; 3]; 3],
    /// Rows: from linear light of the display to cone responses.
    pub to_cones: [[f32; 3]; 3],
    /// Rows of the inverse matrix.
    pub from_cones: [[f32; 3]; 3],
    /// Rows: Oklab of the cube roots of cone responses.
    pub to_lab: [[f32; 3]; 3],
    /// Rows of the inverse matrix.
    pub from_lab: [[f32; 3]; 3],
}

impl Gamut {
    /// The gamut of a display whose linear light is `from_working` times that of the working space.
    #[must_use]
    pub fn new(mapping: GamutMapping, from_working: &Matrix) -> Self {
        let to_cones = product(&CONES, &inverse(from_working));
        let single = |m: &Matrix| m.map(|row| row.map(|v| v as f32));
        Self {
            mapping,
            from_working: single(from_working),
            to_cones: single(&to_cones),
            from_cones: single(&inverse(&to_cones)),
            to_lab: single(&LAB),
            from_lab: single(&inverse(&LAB)),
        }
    }

    /// Linear light of the display, each channel in 0 to 1, for a colour of the working space.
    #[must_use]
    pub fn map(&self, working: [f32; 3]) -> [f32; 3] {
        let rgb = times(&self.from_working, working);
        match self.mapping {
            GamutMapping::Soft => self.soft(rgb),
            GamutMapping::Clamp => clamp_chromaticity(rgb).map(|channel| channel.clamp(0.0, 1.0)),
        }
    }

    fn soft(&self, rgb: [f32; 3]) -> [f32; 3] {
        let most = rgb[0].max(rgb[1]).max(rgb[2]);
        // Black and NaN have no hue.
        if !(most > 0.0 && most < f32::MAX) {
            return [0.0; 3];
        }
        let [lightness, a, b] = self.lab(rgb);
        let from_middle = lightness - 0.5;
        let side = if from_middle < 0.0 { -1.0 } else { 1.0 };
        let e = 0.5 + from_middle.abs() + FOR_COLOUR * (a * a + b * b).sqrt();
        let root = (e * e - 2.0 * from_middle.abs()).max(0.0).sqrt();
        let grey = (0.5 + 0.5 * side * (e - root)).clamp(0.0, 1.0);
        let ray = Ray::new(self, grey, [lightness - grey, a, b]);
        if ray.outside(1.0 / KNEE) <= 0.0 {
            return rgb;
        }
        let r = 1.0 / ray.edge();
        let z = r.clamp(KNEE, 2.0 - KNEE) - KNEE;
        let kept = (KNEE + z - z * z / (4.0 * (1.0 - KNEE))) / r;
        ray.at(kept.min(1.0)).map(|channel| channel.clamp(0.0, 1.0))
    }

    /// Oklab of linear light of the display.
    #[must_use]
    pub fn lab(&self, rgb: [f32; 3]) -> [f32; 3] {
        times(&self.to_lab, times(&self.to_cones, rgb).map(cube_root))
    }
}

/// The colours of one hue between a grey at 0 and a colour at 1, and beyond.
struct Ray<'a> {
    gamut: &'a Gamut,
    /// Cube roots of the cone responses of the grey, and their change toward the colour.
    grey: f32,
    way: [f32; 3],
}

impl<'a> Ray<'a> {
    /// From a grey by a difference in Oklab.
    fn new(gamut: &'a Gamut, grey: f32, [l, a, b]: [f32; 3]) -> Self {
        // The first column of from_lab is 1: grey has equal cone responses.
        let way = gamut.from_lab.map(|row| l + row[1] * a + row[2] * b);
        Self { gamut, grey, way }
    }

    fn at(&self, share: f32) -> [f32; 3] {
        let cones = self.way.map(|way| {
            let root = self.grey + share * way;
            root * root * root
        });
        times(&self.gamut.from_cones, cones)
    }

    /// Distance of the farthest channel from the gamut; negative inside.
    fn outside(&self, share: f32) -> f32 {
        let [r, g, b] = self.at(share).map(|channel| (-channel).max(channel - 1.0));
        r.max(g).max(b)
    }

    /// Its exit from the gamut: by halving from the outer end of the knee, then along the chord.
    fn edge(&self) -> f32 {
        let (mut low, mut high) = (0.0f32, 1.0 / KNEE);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let inside = self.outside(middle) <= 0.0;
            low = if inside { middle } else { low };
            high = if inside { high } else { middle };
        }
        let (inner, outer) = (self.outside(low).min(0.0), self.outside(high).max(1e-9));
        (low + (high - low) * (-inner / (outer - inner))).max(1e-6)
    }
}

fn times(m: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// Cube root, relative error below 1e-6: a third of the exponent, then Newton's method on
/// y³ = |x|.
#[must_use]
pub fn cube_root(x: f32) -> f32 {
    let size = x.abs();
    // Two thirds of the exponent's bias; the first guess is off by at most 4 %, which each iteration squares.
    let mut y = f32::from_bits(size.to_bits() / 3 + 0x2a51_4067);
    for _ in 0..3 {
        y = (2.0 * y + size / (y * y)) * (1.0 / 3.0);
    }
    if size < 1e-30 {
        0.0
    } else if x < 0.0 {
        -y
    } else {
        y
    }
}

/// Brings colours outside the display's gamut onto its edge along the line to white
/// (Baxter 2004, § 7.8.1, with the chromaticity min(RGB)/sum that its pseudocode means).
#[must_use]
pub fn clamp_chromaticity(rgb: [f32; 3]) -> [f32; 3] {
    let least = rgb[0].min(rgb[1]).min(rgb[2]);
    if least >= 0.0 {
        return rgb;
    }
    let sum = rgb[0] + rgb[1] + rgb[2];
    if sum <= 0.0 {
        return [0.0; 3];
    }
    let third = 1.0 / 3.0;
    let t = third / (third - least / sum);
    rgb.map(|channel| ((third + t * (channel / sum - third)) * sum).max(0.0))
}

#[cfg(test)]
mod tests;
