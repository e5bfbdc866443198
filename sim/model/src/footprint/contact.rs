//! Contact of a brush texel with a cell.

use crate::brush::traits::BrushTraits;

/// A cell in contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contact {
    /// Its place in the window's planes.
    pub cell: u32,
    /// Its place in the planes of the cells [around](super::footprint::Footprint::around).
    pub local: u32,
    /// The brush texel that touches it: `strip · TEXELS_PER_STRIP + along`.
    pub texel: u32,
    /// Share of the cell that is covered, 0 to 1.
    pub cover: f32,
    /// Travel of the strip since the previous step, cells.
    pub moved: [f32; 2],
    /// Depth below the top of the wet paint, cells; at most its thickness.
    pub depth: f32,
    /// `depth` by the thickness of the wet paint, 0 to 1.
    pub fraction: f32,
    /// Gap above the top of the wet paint, bridged by its film, cells.
    pub gap: f32,
}

impl Contact {
    /// Travel of the strip of a brush with these traits, reference cells.
    #[must_use]
    #[inline(always)]
    pub fn travel(&self, traits: &BrushTraits) -> f32 {
        let [u, v] = self.moved;
        (u * u + v * v).sqrt() * traits.cell_per_reference
    }
}
