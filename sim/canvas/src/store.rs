//! The tiles of a surface: immutable, reference-counted versions, and leases on them.

use std::collections::BTreeSet;
use std::sync::Arc;

use maulstick_types::paint::TILE;

use crate::page::Pager;
use crate::quantum::{Counts, SLOTS, add};
use crate::tile::{Tile, TileId, Version};

/// A half-open rectangle of tiles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileRect {
    /// Lowest column and row.
    pub from: [u32; 2],
    /// One past the highest.
    pub to: [u32; 2],
}

impl TileRect {
    /// True if all of `other` lies inside.
    #[must_use]
    pub fn holds(&self, other: &Self) -> bool {
        (0..2).all(|i| self.from[i] <= other.from[i] && other.to[i] <= self.to[i])
    }

    /// True if a tile lies inside.
    #[must_use]
    pub fn contains(&self, id: TileId) -> bool {
        let within = |i: usize, at: u32| (self.from[i]..self.to[i]).contains(&at);
        within(0, id.x) && within(1, id.y)
    }

    /// Tiles, row after row from the bottom.
    pub fn tiles(&self) -> impl Iterator<Item = TileId> + use<> {
        let rect = *self;
        (rect.from[1]..rect.to[1])
            .flat_map(move |y| (rect.from[0]..rect.to[0]).map(move |x| TileId { x, y }))
    }

    /// Cells across and up.
    #[must_use]
    pub fn cells(&self) -> [usize; 2] {
        [0, 1].map(|i| (self.to[i] - self.from[i]) as usize * TILE)
    }
}

/// The tiles of one surface.
#[derive(Clone, Debug)]
pub struct TileStore {
    cells: [u32; 2],
    grid: [u32; 2],
    versions: Vec<Version>,
    leased: BTreeSet<TileId>,
    pager: Arc<Pager>,
}

impl TileStore {
    /// An empty surface of `cells` across and up, without a painting.
    #[must_use]
    pub fn new(cells: [u32; 2]) -> Self {
        Self::paged(cells, &Arc::default())
    }

    /// An empty surface whose tiles are among the pages of a painting.
    #[must_use]
    pub fn paged(cells: [u32; 2], pager: &Arc<Pager>) -> Self {
        let grid = cells.map(|cells| cells.div_ceil(TILE as u32));
        let versions = vec![Version::default(); (grid[0] * grid[1]) as usize];
        Self {
            cells,
            grid,
            versions,
            leased: BTreeSet::new(),
            pager: Arc::clone(pager),
        }
    }

    /// Cells across and up.
    #[must_use]
    pub fn cells(&self) -> [u32; 2] {
        self.cells
    }

    /// Tiles across and up; the last ones may extend over the edge.
    #[must_use]
    pub fn grid(&self) -> [u32; 2] {
        self.grid
    }

    /// Pager of its painting.
    #[must_use]
    pub fn pager(&self) -> &Arc<Pager> {
        &self.pager
    }

    fn place(&self, id: TileId) -> usize {
        (id.y * self.grid[0] + id.x) as usize
    }

    /// The newest version of a tile.
    #[must_use]
    pub fn version(&self, id: TileId) -> &Version {
        &self.versions[self.place(id)]
    }

    /// Replaces a version, and returns the old one.
    pub fn replace(&mut self, id: TileId, version: Version) -> Version {
        let place = self.place(id);
        std::mem::replace(&mut self.versions[place], version)
    }

    /// All tiles with their versions, row after row from the bottom.
    pub fn iter(&self) -> impl Iterator<Item = (TileId, &Version)> {
        let across = self.grid[0];
        self.versions
            .iter()
            .enumerate()
            .map(move |(place, version)| {
                (
                    TileId {
                        x: place as u32 % across,
                        y: place as u32 / across,
                    },
                    version,
                )
            })
    }

    /// The tiles that touch the rectangle of cells `from`..`to`, cut to the surface; `None` if it is outside.
    #[must_use]
    pub fn around(&self, from: [i64; 2], to: [i64; 2]) -> Option<TileRect> {
        let mut rect = TileRect {
            from: [0; 2],
            to: [0; 2],
        };
        for i in 0..2 {
            let low = from[i].clamp(0, i64::from(self.cells[i]));
            let high = to[i].clamp(0, i64::from(self.cells[i]));
            if low >= high {
                return None;
            }
            rect.from[i] = (low as u32) / TILE as u32;
            rect.to[i] = (high as u32).div_ceil(TILE as u32);
        }
        Some(rect)
    }

    /// Leases the tiles of `rect` to a window; false if one of them is leased already.
    pub fn lease(&mut self, rect: &TileRect) -> bool {
        if rect.tiles().any(|id| self.leased.contains(&id)) {
            return false;
        }
        self.leased.extend(rect.tiles());
        true
    }

    /// Returns leased tiles.
    pub fn release(&mut self, rect: &TileRect) {
        rect.tiles().for_each(|id| {
            self.leased.remove(&id);
        });
    }

    /// Counts of all wet paint by slot.
    #[must_use]
    pub fn counts(&self) -> Counts {
        self.sum(|tile| tile.counts())
    }

    /// Counts of all dry paint by slot.
    #[must_use]
    pub fn dry_counts(&self) -> Counts {
        self.sum(|tile| tile.dry().map_or([0; SLOTS], |stack| stack.counts()))
    }

    fn sum(&self, of: impl Fn(&Tile) -> Counts) -> Counts {
        let mut counts = [0; SLOTS];
        for tile in self
            .versions
            .iter()
            .filter_map(|version| version.tile.as_ref())
        {
            add(&mut counts, &of(tile));
        }
        counts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn around_cuts_to_the_surface() {
        let store = TileStore::new([100, 200]);
        assert_eq!(store.grid(), [2, 4]);
        let rect = store.around([-5, 60], [70, 65]).expect("inside");
        assert_eq!(
            rect,
            TileRect {
                from: [0, 0],
                to: [2, 2]
            }
        );
        assert_eq!(store.around([100, 0], [120, 10]), None);
        assert_eq!(store.around([-9, 0], [0, 10]), None);
    }

    #[test]
    fn a_tile_is_leased_once() {
        let mut store = TileStore::new([256, 256]);
        let (left, right) = (
            TileRect {
                from: [0, 0],
                to: [2, 2],
            },
            TileRect {
                from: [1, 1],
                to: [3, 3],
            },
        );
        assert!(store.lease(&left) && !store.lease(&right));
        store.release(&left);
        assert!(store.lease(&right));
    }
}
