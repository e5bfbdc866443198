//! Pictures of surroundings by latitude and longitude, twice as wide as high.
//!
//! Their middle is what faces the picture, seen from it; up is up the picture.

use super::EnvironmentMap;

/// Most texels of a panorama across: a larger picture is averaged as it is read.
const ACROSS: usize = 512;

/// A panorama, of linear light.
#[derive(Clone, Debug)]
pub struct Panorama {
    size: [usize; 2],
    /// Pixels of the picture across and down.
    of: [usize; 2],
    /// Sums of radiance, and their pixels; row 0 is the top.
    texels: Vec<([f64; 3], f64)>,
}

impl Panorama {
    /// One without rows yet, of a picture of so many pixels across and down; `None` where it is not twice as wide as
    /// high.
    #[must_use]
    pub fn new(pixels: [usize; 2]) -> Option<Self> {
        let size = [pixels[0].min(ACROSS), pixels[1].min(ACROSS / 2)];
        let is_whole = pixels[1] > 0 && pixels[0] == 2 * pixels[1];
        is_whole.then(|| Self {
            size,
            of: pixels,
            texels: vec![([0.0; 3], 0.0); size[0] * size[1]],
        })
    }

    /// Takes a row of the picture, linear radiance; row 0 is the top.
    pub fn add(&mut self, row: usize, pixels: &[[f32; 3]]) {
        let line = row * self.size[1] / self.of[1] * self.size[0];
        for (column, pixel) in pixels.iter().enumerate() {
            let texel = line + column * self.size[0] / self.of[0];
            let Some((sum, count)) = self.texels.get_mut(texel) else {
                return;
            };
            for (sum, channel) in sum.iter_mut().zip(pixel) {
                *sum += f64::from(*channel);
            }
            *count += 1.0;
        }
    }

    /// The map of it; `None` where the half before the picture is black.
    #[must_use]
    pub fn map(&self) -> Option<EnvironmentMap> {
        EnvironmentMap::of(|toward| self.radiance(toward))
    }

    /// Radiance from a direction in the frame of the picture.
    fn radiance(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        use std::f64::consts::{FRAC_PI_2, PI, TAU};
        // Facing the surroundings, right is the picture's left.
        let longitude = maulstick_num::atan2(-x, z);
        let latitude = FRAC_PI_2 - maulstick_num::acos(y);
        let shares = [0.5 + longitude / TAU, 0.5 - latitude / PI];
        let [column, row] = [0, 1].map(|i| {
            let most = self.size[i] - 1;
            ((shares[i] * self.size[i] as f64) as usize).min(most)
        });
        let (sum, count) = self.texels[row * self.size[0] + column];
        sum.map(|channel| channel / count.max(1.0))
    }
}
