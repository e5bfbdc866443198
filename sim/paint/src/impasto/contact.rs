//! Contact of a brush texel with a cell.

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
    /// How far the strip went since the step before, cells.
    pub moved: [f32; 2],
    /// How deep it reaches below the top of the wet paint, cells; at most its thickness.
    pub depth: f32,
    /// `depth` by the thickness of the wet paint, 0 to 1.
    pub fraction: f32,
    /// How far it stays above the top of the wet paint, bridged by its film, cells.
    pub gap: f32,
}
