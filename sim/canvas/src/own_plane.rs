//! Planes that a paint model keeps of its own beside the counts: volumes, voxels, whatever it needs.
//!
//! Store, history and document keep them with the page that they are on, and know their shape, not their meaning.

use std::sync::Arc;

use maulstick_types::paint::TILE;

/// Planes that a model keeps for each paint, at most: a layer of it each.
pub const LAYERS_MOST: usize = 512;
/// Kinds from here on are notes about the paint of their page.
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
    /// Bytes of a value.
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
    /// Number that its model gives it.
    pub kind: u16,
    /// Type of its values.
    pub values: ValueType,
    /// Values of a cell: its layers, its channels or the voxels of its column.
    pub per_cell: u16,
}

impl OwnShape {
    /// True of a note about the paint of its page, which goes with the last of that paint.
    #[must_use]
    pub fn is_note(&self) -> bool {
        self.kind >= NOTES
    }

    /// Bytes of a cell.
    #[must_use]
    pub fn cell_bytes(&self) -> usize {
        self.values.bytes() * usize::from(self.per_cell)
    }

    /// Bytes of a tile.
    #[must_use]
    pub fn tile_bytes(&self) -> usize {
        TILE * TILE * self.cell_bytes()
    }
}

/// A plane of a tile: the values of cell after cell, row after row from the bottom. Zeros stand for nothing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OwnPlane {
    /// Its shape.
    pub shape: OwnShape,
    /// Its bytes.
    pub bytes: Arc<[u8]>,
}
