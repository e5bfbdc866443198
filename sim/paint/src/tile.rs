//! Tiles: 64×64 cells, immutable once stored.

use std::sync::Arc;

use maulstick_types::paint::TILE;

use crate::dry::{DryLayer, DryStack};
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

/// What lies on a tile: wet paint over what has dried.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tile {
    wet: Planes,
    dry: Option<Arc<DryStack>>,
}

impl Tile {
    /// A tile of wet planes over what has dried; planes without paint are left out.
    #[must_use]
    pub fn new(
        planes: impl Iterator<Item = (usize, Arc<[f32]>)>,
        dry: Option<Arc<DryStack>>,
    ) -> Self {
        Self {
            wet: planes
                .filter(|(_, plane)| plane.iter().any(|count| *count != 0.0))
                .collect(),
            dry,
        }
    }

    /// The wet planes, in order of slot.
    #[must_use]
    pub fn wet(&self) -> &Planes {
        &self.wet
    }

    /// What has dried.
    #[must_use]
    pub fn dry(&self) -> Option<&Arc<DryStack>> {
        self.dry.as_ref()
    }

    /// Counts of the wet paint by slot.
    #[must_use]
    pub fn counts(&self) -> Counts {
        plane_counts(&self.wet)
    }

    /// The tile with the lower `share` of its wet film dried as layer `number`, but for the cells of
    /// `wells`; none where nothing dries. All of it dries by reference.
    #[must_use]
    pub fn dried(&self, number: u32, share: f32, wells: &[usize]) -> Option<Self> {
        if self.wet.is_empty() {
            return None;
        }
        let under = self.dry.clone();
        if share >= 1.0 && wells.is_empty() {
            let layer = DryLayer {
                number,
                planes: self.wet.clone(),
            };
            return Some(Self {
                wet: Vec::new(),
                dry: Some(DryStack::over(under, layer)),
            });
        }
        let part = |plane: &Arc<[f32]>| -> Arc<[f32]> {
            let mut lower: Vec<f32> = plane.iter().map(|count| (count * share).floor()).collect();
            wells.iter().for_each(|cell| lower[*cell] = 0.0);
            lower.into()
        };
        let lower: Planes = self
            .wet
            .iter()
            .map(|(slot, plane)| (*slot, part(plane)))
            .filter(|(_, plane)| plane.iter().any(|count| *count != 0.0))
            .collect();
        if lower.is_empty() {
            return None;
        }
        let upper = self.wet.iter().map(|(slot, plane)| {
            let dried = lower.iter().find(|(other, _)| other == slot);
            let left = match dried {
                Some((_, dried)) => plane
                    .iter()
                    .zip(dried.iter())
                    .map(|(all, dry)| all - dry)
                    .collect(),
                None => Arc::clone(plane),
            };
            (*slot, left)
        });
        let stack = DryStack::over(
            under,
            DryLayer {
                number,
                planes: lower.clone(),
            },
        );
        Some(Self::new(upper, Some(stack)))
    }

    /// Bytes that it takes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let dry = self.dry.as_ref().map_or(0, |stack| stack.bytes());
        self.wet.len() * TILE_CELLS * size_of::<f32>() + dry
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drying_loses_no_quantum_whatever_the_share() {
        let plane = |step: usize| -> Arc<[f32]> {
            (0..TILE_CELLS)
                .map(|i| (i * step % 999 * 1000) as f32)
                .collect()
        };
        let wet = Tile::new([(2, plane(7)), (5, plane(13))].into_iter(), None);
        let all = wet.counts();
        for share in [1e-3f32, 0.3, 0.5, 0.999, 1.0] {
            let dried = wet.dried(1, share, &[]).expect("wet");
            let stack = dried.dry().expect("dried");
            let mut sum = dried.counts();
            crate::quantum::add(&mut sum, &stack.counts());
            assert_eq!(sum, all, "{share}");
            let lower = stack.counts()[2] as f64 / all[2] as f64;
            assert!((lower - f64::from(share)).abs() < 2e-3, "{share} {lower}");
            let twice = dried.dried(2, 1.0, &[]);
            assert_eq!(twice.is_some(), share < 1.0);
            let depth = twice.and_then(|tile| Some(tile.dry()?.depth()));
            assert_eq!(depth, (share < 1.0).then_some(2));
        }
        let whole = wet.dried(1, 1.0, &[]).expect("wet");
        let layer = whole.dry().expect("dried").layer();
        assert!(
            Arc::ptr_eq(&layer.planes[0].1, &wet.wet()[0].1),
            "by reference"
        );
        assert_eq!(wet.dried(1, 1e-9, &[]), None);
        let around = wet.dried(1, 1.0, &[5, 6]).expect("wet");
        let stays: Vec<f32> = (4..8).map(|cell| around.wet()[0].1[cell]).collect();
        assert_eq!(stays, [0.0, 35_000.0, 42_000.0, 0.0], "a well stays wet");
    }
}
