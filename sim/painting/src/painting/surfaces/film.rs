//! Films of paint over tiles, without a brush.

use std::collections::HashMap;
use std::sync::Arc;

use maulstick_canvas::dry::DryStack;
use maulstick_canvas::page::{Page, Pager};
use maulstick_canvas::planes::{Planes, TILE_CELLS};
use maulstick_canvas::quantum::{CELL_MAX, Counts, SLOTS};
use maulstick_canvas::sheet::without_notes;
use maulstick_canvas::tile::{Tile, TileId};

use super::SurfaceState;

/// Wet paint of a tile with more applied to it.
#[derive(Clone)]
struct Laid {
    page: Page<Planes>,
    /// Paint that was applied.
    given: Counts,
    /// Most quanta of a cell.
    top: f32,
}

/// A tile with more wet paint.
pub(crate) struct FilmTile {
    pub(crate) tile: Tile,
    /// Paint that was applied.
    pub(crate) given: Counts,
    /// Most quanta of a cell, with what has dried beneath.
    pub(crate) top: f32,
}

/// Results of an even film on tiles that were alike: they share their pages, so that a vast canvas takes no more room
/// than a tile.
#[derive(Default)]
pub(crate) struct Films {
    /// Results by the page of the wet paint; 0 without any.
    laid: HashMap<u64, Laid>,
    /// Most quanta that has dried on a cell, by the pages of the layers.
    beneath: HashMap<Vec<u64>, f32>,
}

impl Films {
    fn beneath(&mut self, stack: &DryStack) -> f32 {
        let pages = stack.layers().map(|layer| layer.planes.id()).collect();
        let highest = || stack.height().iter().copied().fold(0.0, f32::max);
        *self.beneath.entry(pages).or_insert_with(highest)
    }
}

impl SurfaceState {
    /// A tile with more wet paint, `quanta` by cell and slot: as much as the cells still hold; `None` if that is none.
    /// Cells beyond the surface's edge and in wells get none. With `films` it is as much on every cell.
    pub(crate) fn with_film(
        &self,
        id: TileId,
        quanta: impl Fn(usize, usize) -> f32,
        films: Option<&mut Films>,
        pager: &Arc<Pager>,
    ) -> Option<FilmTile> {
        let before = self.store.version(id).tile.as_deref();
        let (room, is_whole) = self.room(id);
        let mut alone = Films::default();
        let films = match films {
            Some(films) if is_whole => films,
            _ => &mut alone,
        };
        let wet = before.and_then(Tile::wet_page);
        let key = wet.map_or(0, Page::id);
        let laid = match films.laid.get(&key) {
            Some(laid) => laid.clone(),
            None => {
                let laid = laid(wet, room, quanta, pager)?;
                films.laid.insert(key, laid.clone());
                laid
            }
        };
        let dry = before.and_then(Tile::dry).cloned();
        let beneath = dry.as_ref().map_or(0.0, |stack| films.beneath(stack));
        Some(FilmTile {
            tile: Tile::of_pages(Some(laid.page), dry),
            given: laid.given,
            top: laid.top + beneath,
        })
    }

    /// Most quanta that each cell of a tile takes, and true if all cells take paint, none of them a well's.
    pub(super) fn room(&self, id: TileId) -> (Vec<f32>, bool) {
        let mut room = vec![CELL_MAX as f32; TILE_CELLS];
        let [width, height] = self.store.cells().map(|cells| cells as usize);
        let side = maulstick_types::paint::TILE;
        for (cell, room) in room.iter_mut().enumerate() {
            let x = id.x as usize * side + cell % side;
            let y = id.y as usize * side + cell / side;
            if x >= width || y >= height {
                *room = 0.0;
            }
        }
        for cell in self.bare.cells_in_wells(id) {
            room[cell] = 0.0;
        }
        let is_whole = room.iter().all(|room| *room > 0.0);
        (room, is_whole)
    }
}

/// Wet paint with more applied to it; `None` if there is no room.
fn laid(
    wet: Option<&Page<Planes>>,
    mut room: Vec<f32>,
    quanta: impl Fn(usize, usize) -> f32,
    pager: &Arc<Pager>,
) -> Option<Laid> {
    let before = wet.map(Page::get).unwrap_or_default();
    let mut planes: Vec<Option<Vec<f32>>> = vec![None; SLOTS];
    for (slot, plane) in &*before {
        room.iter_mut()
            .zip(plane.iter())
            .for_each(|(room, held)| *room = (*room - held).max(0.0));
        planes[*slot] = Some(plane.to_vec());
    }
    let mut given = [0u64; SLOTS];
    for (cell, room) in room.iter_mut().enumerate() {
        for (slot, plane) in planes.iter_mut().enumerate() {
            let part = quanta(cell, slot).min(*room).max(0.0).floor();
            if part > 0.0 {
                plane.get_or_insert_with(|| vec![0.0; TILE_CELLS])[cell] += part;
                *room -= part;
                given[slot] += part as u64;
            }
        }
    }
    if given.iter().all(|count| *count == 0) {
        return None;
    }
    let planes = planes.into_iter().enumerate();
    let planes = planes.filter_map(|(slot, plane)| Some((slot, plane?.into())));
    // A laid film and what it lies on are one sheet.
    let planes = Planes::from_iter(planes).with_own(without_notes(&before));
    let sums = (0..TILE_CELLS).map(|cell| planes.iter().map(|(_, plane)| plane[cell]).sum());
    Some(Laid {
        top: sums.fold(0.0, f32::max),
        page: Page::new(pager, Arc::new(planes), wet),
        given,
    })
}
