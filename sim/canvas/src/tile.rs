//! Tiles: 64×64 cells, immutable once stored.

use std::sync::Arc;

use crate::dry::{DRY_LAYERS_MOST, DryLayer, DryStack};
use crate::own_plane::OwnPlane;
use crate::page::{Page, Pager};
use crate::planes::{Planes, painted, plane_counts};
use crate::quantum::{CELL_MAX, Counts};
use crate::sheet::{lower_share, slot_of, sum_of_notes};

/// Column and row of a tile, row 0 at the bottom.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TileId {
    /// Row, 0 at the bottom.
    pub y: u32,
    /// Column, 0 at the left.
    pub x: u32,
}

/// Paint of a tile: wet over dried.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tile {
    wet: Option<Page<Planes>>,
    dry: Option<Arc<DryStack>>,
}

impl Tile {
    /// A tile, without a painting, of wet planes over dried paint; planes without paint are left out.
    #[must_use]
    pub fn new(
        planes: impl Iterator<Item = (usize, Arc<[f32]>)>,
        dry: Option<Arc<DryStack>>,
    ) -> Self {
        let planes = painted(planes);
        let wet = (!planes.is_empty()).then(|| Page::loose(planes));
        Self { wet, dry }
    }

    /// A tile of a painting's pages, with non-empty planes; `before` is its earlier state, if known.
    #[must_use]
    pub fn paged(
        pager: &Arc<Pager>,
        planes: Planes,
        dry: Option<Arc<DryStack>>,
        before: Option<&Self>,
    ) -> Self {
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

    /// The page of the wet planes; `None` if nothing is wet.
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

    /// Dried paint; `None` if nothing is dry.
    #[must_use]
    pub fn dry(&self) -> Option<&Arc<DryStack>> {
        self.dry.as_ref()
    }

    /// True if it has no paint.
    #[must_use]
    pub fn is_bare(&self) -> bool {
        self.wet.is_none() && self.dry.is_none()
    }

    /// True if both consist of the same pages.
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

    /// The tile with the lower `share` of its wet film dried as layer `number`, except in the cells of `stays`; `None`
    /// if nothing dries. A whole film dries by reference, unread.
    ///
    /// If the newest dry link is of this layer, and nothing was painted since it dried, it grows: film under film of
    /// the same mixture has the colour of one film. Otherwise there is a new link, because stacked mixtures do not look
    /// like their mixture.
    ///
    /// The model's own planes dry with the whole film, by reference, and stay wet while a part of it does.
    #[must_use]
    pub fn dried(&self, number: u32, share: f32, stays: &[usize]) -> Option<Self> {
        let page = self.wet.as_ref()?;
        let newest = self.dry.as_ref();
        // Numbers of pages and links rise: a wet page older than the link is the remainder of its drying.
        let grows = newest.filter(|link| link.layer().number == number && page.id() < link.id());
        if grows.is_none() && newest.is_some_and(|link| link.depth() >= DRY_LAYERS_MOST) {
            return None;
        }
        let over = |planes: Page<Planes>| {
            let layer = DryLayer { number, planes };
            Some(DryStack::over(self.dry.clone(), layer))
        };
        let is_whole = share >= 1.0 && stays.is_empty();
        let by_reference = || {
            Some(Self {
                wet: None,
                dry: over(page.clone()),
            })
        };
        if is_whole && grows.is_none() {
            return by_reference();
        }
        let wet = page.get();
        if is_whole && wet.own().iter().any(|own| slot_of(own.shape).is_none()) {
            return by_reference();
        }
        let lower = lower_share(&wet, share, stays);
        if lower.is_empty() {
            return None;
        }
        let upper = without(&wet, &lower);
        let pager = page.pager();
        let wet = (!upper.is_empty()).then(|| Page::new(pager, Arc::new(upper), Some(page)));
        let grown = grows.and_then(|link| Some((link, sum(&link.layer().planes.get(), &lower)?)));
        let dry = match grown {
            Some((link, planes)) => {
                let planes = Page::new(pager, Arc::new(planes), Some(&link.layer().planes));
                let layer = DryLayer { number, planes };
                Some(DryStack::over(link.below().cloned(), layer))
            }
            None => over(Page::new(pager, Arc::new(lower), None)),
        };
        Some(Self { wet, dry })
    }

    /// The tile without its wet paint, except in the cells of `stays`; `None` if nothing is removed.
    #[must_use]
    pub fn scraped(&self, stays: &[usize]) -> Option<Self> {
        let page = self.wet.as_ref()?;
        let wet = page.get();
        let kept = |plane: &Arc<[f32]>| -> Arc<[f32]> {
            let mut left = vec![0.0; plane.len()];
            stays.iter().for_each(|cell| left[*cell] = plane[*cell]);
            left.into()
        };
        let own = wet.own().iter().map(|plane| {
            let width = plane.shape.cell_bytes();
            let mut bytes = vec![0; plane.bytes.len()];
            for cell in stays {
                let at = cell * width..(cell + 1) * width;
                bytes[at.clone()].copy_from_slice(&plane.bytes[at]);
            }
            OwnPlane {
                shape: plane.shape,
                bytes: bytes.into(),
            }
        });
        let left = painted(wet.iter().map(|(slot, plane)| (*slot, kept(plane)))).with_own(own);
        if left == *wet {
            return None;
        }
        let wet = (!left.is_empty()).then(|| Page::new(page.pager(), Arc::new(left), Some(page)));
        let dry = self.dry.clone();
        Some(Self { wet, dry })
    }
}

/// What is left of planes without a part of them.
fn without(planes: &Planes, part: &Planes) -> Planes {
    let left = planes.iter().map(|(slot, plane)| {
        let gone = part.iter().find(|(other, _)| other == slot);
        let left = match gone {
            Some((_, gone)) => {
                let cells = plane.iter().zip(gone.iter());
                cells.map(|(all, gone)| all - gone).collect()
            }
            None => Arc::clone(plane),
        };
        (*slot, left)
    });
    let left = painted(left);
    let own = planes.own().iter();
    let own: Vec<OwnPlane> = own
        .filter(|own| !(left.is_empty() && own.shape.is_note()))
        .cloned()
        .collect();
    left.with_own(own)
}

/// Sum of counts, each sheet with its own; `None` if a cell would have more of a paint than is exact.
fn sum(one: &Planes, other: &Planes) -> Option<Planes> {
    let mut planes = one.clone();
    for (slot, more) in other {
        match planes.binary_search_by_key(slot, |(slot, _)| *slot) {
            Err(place) => planes.insert(place, (*slot, Arc::clone(more))),
            Ok(place) => {
                let plane = &mut planes[place].1;
                let cells = plane.iter().zip(more.iter());
                let both: Vec<f32> = cells.map(|(one, other)| one + other).collect();
                if both.iter().any(|count| *count > CELL_MAX as f32) {
                    return None;
                }
                *plane = both.into();
            }
        }
    }
    Some(planes.with_own(sum_of_notes(one, other)))
}

/// A stored tile and the number of its version; no tile where nothing was ever painted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Version {
    /// Incremented with every change of any tile of the painting.
    pub number: u64,
    /// The tile.
    pub tile: Option<Arc<Tile>>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::own_plane::{OwnShape, ValueType};
    use crate::planes::TILE_CELLS;

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

    #[test]
    fn planes_of_the_models_own_dry_with_the_whole_film_and_stay_wet_with_a_part() {
        let shape = OwnShape {
            kind: 1,
            values: ValueType::U8,
            per_cell: 2,
        };
        let own = OwnPlane {
            shape,
            bytes: vec![7; shape.tile_bytes()].into(),
        };
        let film = Planes::from_iter([(2, vec![1000.0; TILE_CELLS].into())]);
        let wet = Page::loose(film.with_own([own]));
        let wet = Tile::of_pages(Some(wet), None);
        let part = wet.dried(1, 0.5, &[]).expect("wet");
        assert_eq!((part.wet().own().len(), part.counts()[2]), (1, 500 << 12));
        let whole = part.dried(1, 1.0, &[]).expect("wet");
        assert!(whole.wet_page().is_none());
        let stack = whole.dry().expect("dried");
        assert_eq!(stack.layer().planes.get().own().len(), 1);
        assert_eq!(stack.counts()[2], 1000 << 12);
        let back = whole
            .rewet(0, &[true; TILE_CELLS], false)
            .expect("dried")
            .tile;
        assert_eq!(back.counts()[2], 1000 << 12);
    }
}
