//! A paint model's own planes beside the counts, for example volumes or voxels.
//!
//! Store, history and document keep them with their page, by their shape, without interpreting them.

use std::sync::Arc;

use maulstick_types::paint::TILE;

/// Greatest number of own planes for each paint, one a layer.
pub const LAYERS_MOST: usize = 512;
/// First kind of the notes about the paint of their page.
const NOTES: u16 = 0xFF00;

/// Type of the values of a plane, little-endian.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ValueType {
    /// 8 bits, unsigned.
    U8,
    /// 16 bits, unsigned.
    U16,
    /// 32 bits, floating point.
    F32,
}

impl ValueType {
    /// Size of a value, bytes.
    #[must_use]
    pub fn bytes(self) -> usize {
        match self {
            Self::U8 => 1,
            Self::U16 => 2,
            Self::F32 => 4,
        }
    }
}

/// Key of a plane among those of its page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct OwnShape {
    /// Number chosen by its model.
    pub kind: u16,
    /// Type of its values.
    pub values: ValueType,
    /// Number of values of a cell: its layers, its channels or the voxels of its column.
    pub per_cell: u16,
}

impl OwnShape {
    /// True for a note about the paint of its page, which is dropped with the last of that paint.
    #[must_use]
    pub fn is_note(&self) -> bool {
        self.kind >= NOTES
    }

    /// Size of a cell, bytes.
    #[must_use]
    pub fn cell_bytes(&self) -> usize {
        self.values.bytes() * usize::from(self.per_cell)
    }

    /// Size of a tile, bytes.
    #[must_use]
    pub fn tile_bytes(&self) -> usize {
        TILE * TILE * self.cell_bytes()
    }
}

/// A plane of a tile: values cell by cell, row by row from the bottom; zeros are empty.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OwnPlane {
    /// Its shape.
    pub shape: OwnShape,
    /// Its bytes.
    pub bytes: Arc<[u8]>,
}
