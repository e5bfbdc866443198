//! Rewetting of dry layers.

use std::sync::Arc;

use crate::dry::{DryLayer, DryStack};
use crate::own_plane::OwnPlane;
use crate::page::Page;
use crate::planes::{Planes, TILE_CELLS, painted};
use crate::quantum::{CELL_MAX, SLOTS};
use crate::sheet;
use crate::tile::Tile;

/// A tile whose newest layers are wet again.
#[derive(Clone, Debug, PartialEq)]
pub struct Rewet {
    /// Resulting tile.
    pub tile: Tile,
    /// Number of cells without room for all of it, where the rest is still dry.
    pub full_cells: usize,
}

/// Wet paint of a tile during rewetting.
struct Wet {
    planes: Vec<Option<Vec<f32>>>,
    room: Vec<u64>,
    /// True for cells in which the next layer is uppermost.
    open: Vec<bool>,
    full_cells: usize,
}

impl Wet {
    fn of(tile: &Tile, within: &[bool]) -> Self {
        let mut wet = Self {
            planes: vec![None; SLOTS],
            room: vec![u64::from(CELL_MAX); TILE_CELLS],
            open: within.to_vec(),
            full_cells: 0,
        };
        for (slot, plane) in &*tile.wet() {
            let cells = wet.room.iter_mut().zip(plane.iter());
            cells.for_each(|(room, count)| *room = room.saturating_sub(*count as u64));
            wet.planes[*slot] = Some(plane.to_vec());
        }
        wet
    }

    /// Rewets a layer, from the newest down, and returns the rest of it; `None` if it is unchanged. A cell without room
    /// for all of it takes an even share of its paints, and nothing of the layers under it.
    fn take(&mut self, layer: &Planes) -> Option<Planes> {
        let mut rest: Vec<(usize, Vec<f32>)> = layer
            .iter()
            .map(|(slot, plane)| (*slot, plane.to_vec()))
            .collect();
        let mut any = false;
        for cell in 0..TILE_CELLS {
            let total: u64 = rest.iter().map(|(_, plane)| plane[cell] as u64).sum();
            if !self.open[cell] || total == 0 {
                continue;
            }
            let room = self.room[cell].min(total);
            if room < total {
                self.open[cell] = false;
                self.full_cells += 1;
            }
            for (slot, plane) in &mut rest {
                let taken = (plane[cell] as u64 * room / total) as f32;
                if taken > 0.0 {
                    let wet = self.planes[*slot].get_or_insert_with(|| vec![0.0; TILE_CELLS]);
                    wet[cell] += taken;
                    plane[cell] -= taken;
                    self.room[cell] -= taken as u64;
                    any = true;
                }
            }
        }
        let rest = painted(rest.into_iter().map(|(slot, plane)| (slot, plane.into())));
        let bare = rest.is_empty();
        let own = layer
            .own()
            .iter()
            .filter(|plane| !(bare && plane.shape.is_note()));
        any.then(|| rest.with_own(own.cloned()))
    }
}

/// Notes on what lies on top, in the cells that are `within`.
fn notes_within(planes: &Planes, within: &[bool]) -> Vec<OwnPlane> {
    let notes = planes.own().iter().filter_map(|own| {
        let quanta = sheet::quanta(&own.bytes).zip(within);
        let quanta = quanta.map(|(quanta, within)| if *within { quanta } else { 0.0 });
        Some(sheet::note(sheet::slot_of(own.shape)?, quanta))
    });
    notes.collect()
}

impl Tile {
    /// The tile with its layers from number `least` on rewetted in the cells that are `within`; `None` where that
    /// changes nothing. The model's own planes stay where they are, but where the model keeps `sheets` the newest layer's
    /// come back with it.
    #[must_use]
    pub fn rewet(&self, least: u32, within: &[bool], sheets: bool) -> Option<Rewet> {
        let mut links = Vec::new();
        let mut next = self.dry();
        while let Some(link) = next
            && link.layer().number >= least
        {
            links.push(link);
            next = link.below();
        }
        let mut dry = next.cloned();
        let mut wet = Wet::of(self, within);
        let taken = links
            .iter()
            .map(|link| wet.take(&link.layer().planes.get()));
        let rests: Vec<Option<Planes>> = taken.collect();
        let pager = links.first()?.layer().planes.pager();
        let mut is_new = false;
        for (link, rest) in links.iter().zip(rests).rev() {
            let (number, planes) = (link.layer().number, &link.layer().planes);
            let layer = match rest {
                None if !is_new => {
                    dry = Some(Arc::clone(link));
                    continue;
                }
                None => link.layer().clone(),
                Some(rest) if rest.is_empty() => {
                    is_new = true;
                    continue;
                }
                Some(rest) => DryLayer {
                    number,
                    planes: Page::new(pager, Arc::new(rest), Some(planes)),
                },
            };
            is_new = true;
            dry = Some(DryStack::over(dry, layer));
        }
        if !is_new {
            return None;
        }
        let planes = wet.planes.into_iter().enumerate();
        let planes = planes.filter_map(|(slot, plane)| Some((slot, plane?.into())));
        // What lay on top of the newest layer lies on top again, unless the tile has other wet paint.
        let newest = links.first()?.layer().planes.get();
        let on_top = (sheets && self.wet_page().is_none()).then(|| notes_within(&newest, within));
        let before = self.wet();
        let own = before.own().iter().cloned();
        let own = own.chain(on_top.into_iter().flatten());
        let planes = painted(planes).with_own(own);
        Some(Rewet {
            tile: Self::paged(pager, planes, dry, Some(self)),
            full_cells: wet.full_cells,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantum::{Counts, add};

    fn plane(of: impl Fn(usize) -> u32) -> Arc<[f32]> {
        (0..TILE_CELLS).map(|cell| of(cell) as f32).collect()
    }

    fn all(tile: &Tile) -> Counts {
        let mut sum = tile.counts();
        if let Some(stack) = tile.dry() {
            add(&mut sum, &stack.counts());
        }
        sum
    }

    /// Two layers of two paints each, and wet paint.
    fn tile() -> Tile {
        let under = Tile::new(
            [(0, plane(|i| 1 + i as u32 % 7)), (3, plane(|_| 11))].into_iter(),
            None,
        );
        let under = under.dried(1, 1.0, &[]).expect("wet");
        let over = [(0, plane(|i| (i as u32 % 5) * 3)), (2, plane(|_| 1 << 23))];
        let over = Tile::new(over.into_iter(), under.dry().cloned());
        let over = over.dried(2, 1.0, &[]).expect("wet");
        let wet = plane(|i| if i == 9 { (1 << 23) + 5 } else { 2 });
        Tile::new([(2, wet)].into_iter(), over.dry().cloned())
    }

    #[test]
    fn layers_become_wet_from_the_newest_down_and_no_quantum_is_lost() {
        let tile = tile();
        let everywhere = vec![true; TILE_CELLS];
        let one = tile.rewet(2, &everywhere, true).expect("a layer");
        assert_eq!(all(&one.tile), all(&tile));
        assert_eq!(one.full_cells, 1, "cell 9 is full");
        let stack = one.tile.dry().expect("the lower one");
        assert_eq!((stack.depth(), stack.layer().number), (2, 2), "of cell 9");
        let left: u64 = stack
            .layer()
            .planes
            .get()
            .iter()
            .map(|(_, p)| p[9] as u64)
            .sum();
        let wet: u64 = one.tile.wet().iter().map(|(_, p)| p[9] as u64).sum();
        // Each of two paints is truncated to whole quanta.
        assert!(wet <= 1 << 24 && wet + 2 > 1 << 24, "{wet}");
        assert_eq!(left + wet, (1 << 24) + 5 + 12);
        let both = tile.rewet(0, &everywhere, true).expect("layers");
        assert_eq!(all(&both.tile), all(&tile));
        let stack = both.tile.dry().expect("cell 9 of both");
        assert_eq!(stack.depth(), 2);
        let lowest = stack.layers().last().expect("two").planes.get();
        let cells = (0..TILE_CELLS).filter(|cell| lowest.iter().any(|(_, p)| p[*cell] > 0.0));
        assert_eq!(
            cells.collect::<Vec<_>>(),
            [9],
            "what lies under a layer stays there"
        );
    }

    #[test]
    fn beside_the_region_all_stays_and_shares_its_pages() {
        let tile = tile();
        assert_eq!(
            tile.rewet(3, &vec![true; TILE_CELLS], true),
            None,
            "no such layer"
        );
        assert_eq!(tile.rewet(0, &vec![false; TILE_CELLS], true), None);
        let mut within = vec![false; TILE_CELLS];
        within[100] = true;
        let part = tile.rewet(2, &within, true).expect("a cell");
        assert_eq!(all(&part.tile), all(&tile));
        let (now, before) = (part.tile.dry().expect("dry"), tile.dry().expect("dry"));
        assert!(Arc::ptr_eq(
            now.below().expect("two"),
            before.below().expect("two")
        ));
        let differ = now
            .height()
            .iter()
            .zip(before.height().iter())
            .filter(|(a, b)| a != b)
            .count();
        assert_eq!(differ, 1);
        let nothing_left =
            Tile::of_pages(None, part.tile.dry().cloned()).rewet(0, &vec![true; TILE_CELLS], true);
        assert_eq!(nothing_left.expect("all").tile.dry(), None);
    }
}
