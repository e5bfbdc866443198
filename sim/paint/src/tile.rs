//! Tiles: 64×64 cells, immutable once stored.

use std::sync::Arc;

use maulstick_types::paint::TILE;

use crate::dry::{DryLayer, DryStack};
use crate::page::{Backing, Content, Page, Pager};
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

impl Content for Planes {
    fn bytes(&self) -> usize {
        self.len() * TILE_CELLS * size_of::<f32>()
    }

    fn fetch(backing: &dyn Backing, id: u64) -> Result<Self, String> {
        backing.planes(id)
    }

    fn nothing() -> Self {
        Self::new()
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

/// What lies on a tile: wet paint over what has dried.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tile {
    wet: Option<Page<Planes>>,
    dry: Option<Arc<DryStack>>,
}

fn painted(planes: impl Iterator<Item = (usize, Arc<[f32]>)>) -> Planes {
    planes
        .filter(|(_, plane)| plane.iter().any(|count| *count != 0.0))
        .collect()
}

impl Tile {
    /// A tile, of no painting, of wet planes over what has dried; planes without paint are left out.
    #[must_use]
    pub fn new(
        planes: impl Iterator<Item = (usize, Arc<[f32]>)>,
        dry: Option<Arc<DryStack>>,
    ) -> Self {
        let planes = painted(planes);
        let wet = (!planes.is_empty()).then(|| Page::loose(planes));
        Self { wet, dry }
    }

    /// A tile of a painting's pages: a later state of `before`, if that is known.
    #[must_use]
    pub fn paged(
        pager: &Arc<Pager>,
        planes: impl Iterator<Item = (usize, Arc<[f32]>)>,
        dry: Option<Arc<DryStack>>,
        before: Option<&Self>,
    ) -> Self {
        let planes = painted(planes);
        let before = before.and_then(|tile| tile.wet.as_ref());
        let wet = (!planes.is_empty()).then(|| Page::new(pager, Arc::new(planes), before));
        Self { wet, dry }
    }

    /// A tile of pages.
    #[must_use]
    pub fn of_pages(wet: Option<Page<Planes>>, dry: Option<Arc<DryStack>>) -> Self {
        Self { wet, dry }
    }

    /// The wet planes, in order of slot.
    #[must_use]
    pub fn wet(&self) -> Arc<Planes> {
        self.wet.as_ref().map(Page::get).unwrap_or_default()
    }

    /// The page of the wet planes, if anything is wet.
    #[must_use]
    pub fn wet_page(&self) -> Option<&Page<Planes>> {
        self.wet.as_ref()
    }

    /// Its wet page and those of its dry layers.
    pub fn pages(&self) -> impl Iterator<Item = &Page<Planes>> {
        let layers = self.dry.iter().flat_map(|stack| stack.layers());
        let dry = layers.map(|layer| &layer.planes);
        self.wet.iter().chain(dry)
    }

    /// What has dried.
    #[must_use]
    pub fn dry(&self) -> Option<&Arc<DryStack>> {
        self.dry.as_ref()
    }

    /// Whether nothing lies on it.
    #[must_use]
    pub fn is_bare(&self) -> bool {
        self.wet.is_none() && self.dry.is_none()
    }

    /// Whether both are made of the same pages.
    #[must_use]
    pub fn is(&self, other: &Self) -> bool {
        let wet = match (&self.wet, &other.wet) {
            (Some(one), Some(other)) => one.is(other),
            (one, other) => one.is_none() && other.is_none(),
        };
        let dry = match (&self.dry, &other.dry) {
            (Some(one), Some(other)) => Arc::ptr_eq(one, other),
            (one, other) => one.is_none() && other.is_none(),
        };
        wet && dry
    }

    /// Counts of the wet paint by slot.
    #[must_use]
    pub fn counts(&self) -> Counts {
        plane_counts(&self.wet())
    }

    /// The tile with the lower `share` of its wet film dried as layer `number`, but for the cells of
    /// `wells`; none where nothing dries. All of it dries by reference, unread.
    #[must_use]
    pub fn dried(&self, number: u32, share: f32, wells: &[usize]) -> Option<Self> {
        let page = self.wet.as_ref()?;
        let over = |planes: Page<Planes>| {
            let layer = DryLayer { number, planes };
            Some(DryStack::over(self.dry.clone(), layer))
        };
        if share >= 1.0 && wells.is_empty() {
            return Some(Self {
                wet: None,
                dry: over(page.clone()),
            });
        }
        let part = |plane: &Arc<[f32]>| -> Arc<[f32]> {
            let mut lower: Vec<f32> = plane.iter().map(|count| (count * share).floor()).collect();
            wells.iter().for_each(|cell| lower[*cell] = 0.0);
            lower.into()
        };
        let wet = page.get();
        let lower = painted(wet.iter().map(|(slot, plane)| (*slot, part(plane))));
        if lower.is_empty() {
            return None;
        }
        let upper = wet.iter().map(|(slot, plane)| {
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
        let upper: Vec<_> = upper.collect();
        let dry = over(Page::new(page.pager(), Arc::new(lower), None));
        Some(Self::paged(
            page.pager(),
            upper.into_iter(),
            dry,
            Some(self),
        ))
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
            wet.wet_page().is_some_and(|page| page.is(&layer.planes)),
            "by reference"
        );
        assert_eq!(wet.dried(1, 1e-9, &[]), None);
        let around = wet.dried(1, 1.0, &[5, 6]).expect("wet");
        let stays: Vec<f32> = (4..8).map(|cell| around.wet()[0].1[cell]).collect();
        assert_eq!(stays, [0.0, 35_000.0, 42_000.0, 0.0], "a well stays wet");
    }
}
