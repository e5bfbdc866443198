//! Planes of a page: counts, one value a cell for each paint of a tile, and its model's own planes.

use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use maulstick_types::paint::TILE;

use crate::own_plane::OwnPlane;
use crate::quantum::{Counts, SLOTS};

/// Cells of a tile.
pub const TILE_CELLS: usize = TILE * TILE;

/// Planes of a page: one of counts for each paint that is present, in order of slot, and the paint model's own.
/// Dereferences to the planes of counts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Planes {
    counts: Vec<(usize, Arc<[f32]>)>,
    own: Vec<OwnPlane>,
}

impl Planes {
    /// No planes.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The same counts with these own planes, without those that are all zeros.
    #[must_use]
    pub fn with_own(mut self, own: impl IntoIterator<Item = OwnPlane>) -> Self {
        let holds = |plane: &OwnPlane| plane.bytes.iter().any(|byte| *byte != 0);
        self.own = own.into_iter().filter(holds).collect();
        self.own.sort_by_key(|plane| plane.shape);
        self
    }

    /// The model's own planes, in order of their shapes.
    #[must_use]
    pub fn own(&self) -> &[OwnPlane] {
        &self.own
    }

    /// True if there is neither paint nor an own plane.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.counts.is_empty() && self.own.is_empty()
    }

    /// Size in memory, bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let own = self.own.iter().map(|plane| plane.bytes.len());
        self.counts.len() * TILE_CELLS * size_of::<f32>() + own.sum::<usize>()
    }
}

impl Deref for Planes {
    type Target = Vec<(usize, Arc<[f32]>)>;

    fn deref(&self) -> &Self::Target {
        &self.counts
    }
}

impl DerefMut for Planes {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.counts
    }
}

impl FromIterator<(usize, Arc<[f32]>)> for Planes {
    fn from_iter<I: IntoIterator<Item = (usize, Arc<[f32]>)>>(counts: I) -> Self {
        Self {
            counts: counts.into_iter().collect(),
            own: Vec::new(),
        }
    }
}

impl<'a> IntoIterator for &'a Planes {
    type Item = &'a (usize, Arc<[f32]>);
    type IntoIter = std::slice::Iter<'a, (usize, Arc<[f32]>)>;

    fn into_iter(self) -> Self::IntoIter {
        self.counts.iter()
    }
}

/// All counts of planes, by slot.
#[must_use]
pub fn plane_counts(planes: &Planes) -> Counts {
    let mut counts = [0; SLOTS];
    for (slot, plane) in planes {
        counts[*slot] = plane.iter().map(|count| *count as u64).sum();
    }
    counts
}

/// The planes with any paint.
#[must_use]
pub fn painted(planes: impl Iterator<Item = (usize, Arc<[f32]>)>) -> Planes {
    planes
        .filter(|(_, plane)| plane.iter().any(|count| *count != 0.0))
        .collect()
}
