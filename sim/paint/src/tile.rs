//! Tiles: 64×64 cells, immutable once stored.

use std::sync::Arc;

use maulstick_types::paint::TILE;

use crate::quantum::{Counts, SLOTS};

/// Cells of a tile.
pub const TILE_CELLS: usize = TILE * TILE;

/// Column and row of a tile, row 0 at the bottom.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TileId {
    /// Row.
    pub y: u32,
    /// Column.
    pub x: u32,
}

/// What lies on a tile: a plane of counts for each paint that is there, in order of slot.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tile {
    wet: Vec<(usize, Box<[f32]>)>,
}

impl Tile {
    /// A tile of wet planes; planes without paint are left out.
    #[must_use]
    pub fn new(planes: impl Iterator<Item = (usize, Box<[f32]>)>) -> Self {
        Self {
            wet: planes
                .filter(|(_, plane)| plane.iter().any(|count| *count != 0.0))
                .collect(),
        }
    }

    /// The wet planes, in order of slot.
    #[must_use]
    pub fn wet(&self) -> &[(usize, Box<[f32]>)] {
        &self.wet
    }

    /// All counts by slot.
    #[must_use]
    pub fn counts(&self) -> Counts {
        let mut counts = [0; SLOTS];
        for (slot, plane) in &self.wet {
            counts[*slot] = plane.iter().map(|count| *count as u64).sum();
        }
        counts
    }

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.wet.len() * TILE_CELLS * size_of::<f32>()
    }
}

/// A stored tile and the number of its version; none where nothing was ever painted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Version {
    /// Grows with every change of any tile of the painting.
    pub number: u64,
    /// The tile.
    pub tile: Option<Arc<Tile>>,
}
