//! Varnish on tiles: a dry layer of clear paint, laid on cells without wet paint and taken off where it is uppermost.

use std::collections::BTreeSet;
use std::sync::Arc;

use maulstick_appearance::colouring::Colouring;
use maulstick_canvas::dry::{DRY_LAYERS_MOST, DryLayer, DryStack};
use maulstick_canvas::page::{Page, Pager};
use maulstick_canvas::planes::{Planes, painted, plane_counts};
use maulstick_canvas::quantum::{Counts, SLOTS, add};
use maulstick_canvas::tile::{Tile, TileId};

use super::part::Part;
use super::{Changed, SurfaceState};

impl SurfaceState {
    /// True if its paint is shown as stacked films.
    pub(crate) fn is_of_films(&self) -> bool {
        self.bare.shown.colouring() == Colouring::Films
    }

    /// For each cell of a tile, true where varnish goes or comes off: on the surface, of a part, and without wet paint.
    fn free(&self, part: &Part, id: TileId, tile: Option<&Tile>) -> Option<Vec<bool>> {
        let mut free = self.within(part, id)?;
        let room = self.room(id).0;
        free.iter_mut()
            .zip(&room)
            .for_each(|(free, room)| *free &= *room > 0.0);
        cover(&mut free, &tile.map(Tile::wet).unwrap_or_default());
        free.contains(&true).then_some(free)
    }

    /// True if any cell of a part is free.
    pub(crate) fn takes_varnish(&self, part: &Part) -> bool {
        self.ids().any(|id| {
            let tile = self.store.version(id).tile.as_deref();
            self.free(part, id, tile).is_some()
        })
    }

    fn ids(&self) -> impl Iterator<Item = TileId> + use<> {
        let [across, up] = self.store.grid();
        (0..across * up).map(move |at| TileId {
            x: at % across,
            y: at / across,
        })
    }

    /// The tiles of a part with a coat of so many quanta by slot as the layer `number`, and what that takes.
    pub(crate) fn varnished(
        &self,
        part: &Part,
        number: u32,
        coat: &[(usize, f32)],
        pager: &Arc<Pager>,
    ) -> (Changed, Counts) {
        let mut given = [0; SLOTS];
        let mut tiles = Changed::new();
        // Tiles that are coated whole share one page.
        let mut whole: Option<Page<Planes>> = None;
        for id in self.ids() {
            let tile = self.store.version(id).tile.as_deref();
            let below = tile.and_then(Tile::dry).cloned();
            if below
                .as_ref()
                .is_some_and(|stack| stack.depth() >= DRY_LAYERS_MOST)
            {
                continue;
            }
            let Some(free) = self.free(part, id, tile) else {
                continue;
            };
            let page = || {
                let planes = coat.iter().map(|(slot, quanta)| {
                    let cells = free.iter().map(|free| if *free { *quanta } else { 0.0 });
                    (*slot, cells.collect())
                });
                Page::new(pager, Arc::new(painted(planes)), None)
            };
            let planes = if free.contains(&false) {
                page()
            } else {
                whole.get_or_insert_with(page).clone()
            };
            add(&mut given, &plane_counts(&planes.get()));
            let wet = tile.and_then(Tile::wet_page).cloned();
            let dry = DryStack::over(below, DryLayer { number, planes });
            tiles.push((id, Arc::new(Tile::of_pages(wet, Some(dry)))));
        }
        (tiles, given)
    }

    /// The tiles of a part without the varnish, the paints of `slots`, that lies uppermost there, cell by cell, and the
    /// numbers of its layers.
    pub(crate) fn unvarnished(&self, part: &Part, slots: &[usize]) -> (Changed, BTreeSet<u32>) {
        let mut tiles = Changed::new();
        let mut numbers = BTreeSet::new();
        for (id, version) in self.store.iter() {
            let Some(tile) = version.tile.as_deref() else {
                continue;
            };
            let Some(free) = self.free(part, id, Some(tile)) else {
                continue;
            };
            if let Some(dry) = without_varnish(tile.dry(), free, slots, &mut numbers) {
                let tile = Tile::of_pages(tile.wet_page().cloned(), dry);
                tiles.push((id, Arc::new(tile)));
            }
        }
        (tiles, numbers)
    }
}

/// Layers without the varnish over which no paint lies on a free cell; `None` where there is none.
fn without_varnish(
    stack: Option<&Arc<DryStack>>,
    mut free: Vec<bool>,
    slots: &[usize],
    numbers: &mut BTreeSet<u32>,
) -> Option<Option<Arc<DryStack>>> {
    let mut below = stack;
    // The layers from the newest down, with what is left of those that lose varnish.
    let mut layers: Vec<(&DryLayer, Option<Planes>)> = Vec::new();
    let mut lowest = None;
    while let Some(stack) = below.filter(|_| free.contains(&true)) {
        let layer = stack.layer();
        let planes = layer.planes.get();
        let left = if planes.iter().all(|(slot, _)| slots.contains(slot)) && planes.own().is_empty()
        {
            remaining(&planes, &free)
        } else {
            cover(&mut free, &planes);
            None
        };
        below = stack.below();
        if left.is_some() {
            numbers.insert(layer.number);
            lowest = Some((layers.len(), below));
        }
        layers.push((layer, left));
    }
    let (last, under) = lowest?;
    let laid = layers.into_iter().take(last + 1).rev();
    Some(laid.fold(under.cloned(), |below, (layer, left)| {
        let planes = match left {
            None => layer.planes.clone(),
            Some(left) if left.is_empty() => return below,
            Some(left) => Page::new(layer.planes.pager(), Arc::new(left), Some(&layer.planes)),
        };
        let number = layer.number;
        Some(DryStack::over(below, DryLayer { number, planes }))
    }))
}

/// Takes the cells on which planes have paint from those that are free.
fn cover(free: &mut [bool], planes: &Planes) {
    for (_, plane) in planes {
        let cells = free.iter_mut().zip(plane.iter());
        cells.for_each(|(free, count)| *free &= *count == 0.0);
    }
}

/// Planes without the cells that are `free`; `None` if these have nothing.
fn remaining(planes: &Planes, free: &[bool]) -> Option<Planes> {
    let mut bare = free.to_vec();
    cover(&mut bare, planes);
    let kept = planes.iter().map(|(slot, plane)| {
        let cells = plane.iter().zip(free);
        let left = cells.map(|(count, free)| if *free { 0.0 } else { *count });
        (*slot, left.collect())
    });
    (bare != free).then(|| painted(kept))
}
