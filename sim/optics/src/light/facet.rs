//! Facets: normal of the surface at a cell, and its view: all inputs of light from the relief.

use super::shadow::Shadows;
use super::sky::Sky;
use super::{HeightField, Lamp, normal};

/// A piece of a relief as light meets it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    /// Slope s = ρ·∇h.
    pub slope: [f32; 2],
    /// Σ (xx, xy, yy), the covariance of slopes within the cell.
    pub spread: [f32; 3],
    /// V, the share of the lamp that it sees, 0 to 1.
    pub seen: f32,
    /// v, the share of the light from all around that it receives, 0 to 1.
    pub open: f32,
}

impl Facet {
    /// Facet of a flat surface.
    pub const LEVEL: Self = Self {
        slope: [0.0; 2],
        spread: [0.0; 3],
        seen: 1.0,
        open: 1.0,
    };
}

/// Occlusion of lamp and sky over cells of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surroundings {
    /// Path to the lamp.
    pub shadows: Shadows,
    /// The sky and its horizon.
    pub sky: Sky,
    relief: f32,
}

impl Surroundings {
    /// Under a lamp, over cells of side `cell_m`.
    #[must_use]
    pub fn new(lamp: &Lamp, cell_m: f32) -> Self {
        Self {
            shadows: Shadows::new(lamp, cell_m),
            sky: Sky::new(lamp.relief, cell_m),
            relief: lamp.relief,
        }
    }

    /// Reach of a changed cell's light, cells: columns and rows to the lower and to
    /// the higher side.
    #[must_use]
    pub fn reach(&self) -> [[u32; 2]; 2] {
        let sky = self.sky.reach();
        self.shadows
            .reach()
            .map(|side| side.map(|cells| cells.max(sky)))
    }

    /// The cells of row `y` from column `x` on, as many as `facets` takes.
    pub fn row(&self, field: &HeightField<'_>, [x, y]: [usize; 2], facets: &mut [Facet]) {
        let square = self.relief * self.relief;
        for (i, facet) in facets.iter_mut().enumerate() {
            facet.slope = field.slope(x + i, y).map(|rise| rise * self.relief);
            facet.spread = field.spread(x + i, y).map(|spread| spread * square);
        }
        let normals: Vec<[f32; 3]> = facets.iter().map(|facet| normal(facet.slope)).collect();
        let mut share = vec![0.0; facets.len()];
        self.shadows.row(field, [x, y], &mut share);
        for (facet, seen) in facets.iter_mut().zip(&share) {
            facet.seen = *seen;
        }
        self.sky.row(field, [x, y], &normals, &mut share);
        for (facet, open) in facets.iter_mut().zip(&share) {
            facet.open = *open;
        }
    }
}
