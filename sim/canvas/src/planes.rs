//! Planes of counts: one value a cell for each paint of a tile.

use std::sync::Arc;

use maulstick_types::paint::TILE;

use crate::quantum::{Counts, SLOTS};

/// Cells of a tile.
pub const TILE_CELLS: usize = TILE * TILE;

/// A plane of counts for each paint that is there, in order of slot.
pub type Planes = Vec<(usize, Arc<[f32]>)>;

/// All counts of planes, by slot.
#[must_use]
pub fn plane_counts(planes: &Planes) -> Counts {
    let mut counts = [0; SLOTS];
    for (slot, plane) in planes {
        counts[*slot] = plane.iter().map(|count| *count as u64).sum();
    }
    counts
}

/// The planes that hold any paint.
pub(crate) fn painted(planes: impl Iterator<Item = (usize, Arc<[f32]>)>) -> Planes {
    planes
        .filter(|(_, plane)| plane.iter().any(|count| *count != 0.0))
        .collect()
}
