//! Reflections of the surroundings: a prefiltered environment map of what lies before a picture.
//!
//! Facets of slope h̃ show a viewer straight above the direction whose paraboloid coordinates are −h̃ (Heidrich and Seidel
//! 1998, *View-independent environment maps*): level facets the place of the viewer himself, those of slope 1 the
//! horizon. Hence the map needs no frame of its own for every facet, and rough paint is a convolution with GGX's density
//! of slopes ([`super::gloss`]), the same everywhere on the map:
//!
//! ```text
//! L(s, α) = ∫ P(h̃ − s)·L(h̃) d²h̃,   α² = α_paint² + Σ_xx + Σ_yy
//! ```
//!
//! Below the horizon the surroundings are as at it. Radiances are relative: their mean luminance by the light that falls
//! on a level surface is 1, whatever the surroundings, so another one does not change the exposure.
//!
//! | module | holds |
//! | --- | --- |
//! | `prefilter` | the convolution |
//! | `room` | rooms with windows |
//! | [`panorama`] | pictures of surroundings, by latitude and longitude |
//! | `rgbe` | texels as bytes |

pub mod panorama;
mod prefilter;
mod rgbe;
mod room;

use std::sync::{Arc, LazyLock};

pub use panorama::Panorama;

/// Levels of roughness .1, .2, .4 and .8.
pub const LEVELS: usize = 4;
/// Steps from texel to texel of the sharpest level either way; each rougher one has half as many.
pub const STEPS: usize = 32;
/// Texels of all levels.
pub const TEXELS: usize = 33 * 33 + 17 * 17 + 9 * 9 + 5 * 5;
/// Bytes of a texel of a map as bytes.
pub const TEXEL_BYTES: usize = 4;
const _: () = assert!(TEXELS * TEXEL_BYTES == maulstick_types::scene::ENVIRONMENT_BYTES);
/// Roughness of the sharpest level.
pub const SHARPEST: f32 = 0.1;

/// Texels of a level either way.
#[must_use]
pub const fn side(level: usize) -> usize {
    (STEPS >> level) + 1
}

/// Relative radiance, linear red, green, blue, that each slope mirrors at each roughness.
#[derive(Clone, Debug, PartialEq)]
pub struct EnvironmentMap {
    /// Level by level from the sharpest, row by row from the lowest. Texel (i, j) of a level of n + 1 texels a side is at
    /// the paraboloid coordinates 2i/n − 1, 2j/n − 1: right and up the picture.
    texels: Vec<[f32; 3]>,
}

impl EnvironmentMap {
    /// The map of surroundings of this radiance, by unit vectors in the frame of the picture: x right, y up, z out of
    /// it; those with z ≥ 0 are asked for. `None` where all is black, or a radiance is negative or not finite.
    #[must_use]
    pub fn of(radiance: impl Fn([f64; 3]) -> [f64; 3]) -> Option<Self> {
        prefilter::texels(radiance).map(|texels| Self { texels })
    }

    /// A studio: windows in the wall at the left, the viewer before a dim wall, a warm floor.
    #[must_use]
    pub fn room() -> Arc<Self> {
        static MAP: LazyLock<Arc<EnvironmentMap>> = LazyLock::new(|| built(&room::STUDIO));
        Arc::clone(&MAP)
    }

    /// A dark room with a tall window of eight panes at the left.
    #[must_use]
    pub fn window() -> Arc<Self> {
        static MAP: LazyLock<Arc<EnvironmentMap>> = LazyLock::new(|| built(&room::CHAMBER));
        Arc::clone(&MAP)
    }

    /// The map of bytes, [`TEXEL_BYTES`] a texel: mantissas of red, green and blue and their common exponent
    /// (Ward 1991, *Real pixels*). `None` where they are not as many as the texels need.
    #[must_use]
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let (texels, rest) = bytes.as_chunks::<TEXEL_BYTES>();
        let is_whole = texels.len() == TEXELS && rest.is_empty();
        is_whole.then(|| Self {
            texels: texels.iter().map(rgbe::decode).collect(),
        })
    }

    /// These bytes.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        self.texels.iter().flat_map(rgbe::encode).collect()
    }

    /// Texels of a level.
    #[must_use]
    pub fn level(&self, level: usize) -> &[[f32; 3]] {
        let from: usize = (0..level).map(|finer| side(finer) * side(finer)).sum();
        &self.texels[from..from + side(level) * side(level)]
    }

    /// Radiance that facets about the slope `slope` of roughness `rough` mirror to a viewer straight above.
    #[must_use]
    pub fn mirrored(&self, slope: [f32; 2], rough: f32) -> [f32; 3] {
        let far = (slope[0] * slope[0] + slope[1] * slope[1]).sqrt().max(1.0);
        let toward = [-slope[0] / far, -slope[1] / far];
        let at = place(rough);
        let level = (at as usize).min(LEVELS - 2);
        let share = at - level as f32;
        let [sharp, dull] = [level, level + 1].map(|level| self.between(level, toward));
        [0, 1, 2].map(|i| sharp[i] + (dull[i] - sharp[i]) * share)
    }

    /// Bilinear interpolation of a level.
    fn between(&self, level: usize, toward: [f32; 2]) -> [f32; 3] {
        let (texels, side) = (self.level(level), side(level));
        let steps = (side - 1) as f32;
        let at = toward.map(|v| ((0.5 * v + 0.5) * steps).clamp(0.0, steps));
        let low = at.map(|v| (v as usize).min(side - 2));
        let [x, y] = [0, 1].map(|i| at[i] - low[i] as f32);
        let texel = |right: usize, up: usize| texels[(low[1] + up) * side + low[0] + right];
        let [a, b, c, d] = [texel(0, 0), texel(1, 0), texel(0, 1), texel(1, 1)];
        [0, 1, 2].map(|i| {
            let lower = a[i] + (b[i] - a[i]) * x;
            let upper = c[i] + (d[i] - c[i]) * x;
            lower + (upper - lower) * y
        })
    }
}

/// Level of a roughness, 0 to [`LEVELS`] − 1: linear between the levels' own.
fn place(rough: f32) -> f32 {
    let times = rough / SHARPEST;
    let place = if times < 2.0 {
        times - 1.0
    } else if times < 4.0 {
        0.5 * times
    } else {
        1.0 + 0.25 * times
    };
    place.clamp(0.0, (LEVELS - 1) as f32)
}

/// Roughness of a level.
fn roughness(level: usize) -> f64 {
    f64::from(SHARPEST) * (1u32 << level) as f64
}

fn built(room: &room::Room) -> Arc<EnvironmentMap> {
    let map = EnvironmentMap::of(|toward| room.radiance(toward));
    Arc::new(map.unwrap_or(EnvironmentMap {
        texels: vec![[1.0; 3]; TEXELS],
    }))
}

#[cfg(test)]
mod tests;
