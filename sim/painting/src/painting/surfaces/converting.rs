//! Conversion of a surface to another paint model.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use maulstick_appearance::colouring::Colouring;
use maulstick_canvas::EditError;
use maulstick_canvas::dry::{DryLayer, DryStack};
use maulstick_canvas::page::{Page, Pager};
use maulstick_canvas::planes::Planes;
use maulstick_canvas::quantum::{Counts, SLOTS, add};
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_convert::{Converted, Converter, Distance, TileGround};
use maulstick_num::fork_join;
use maulstick_types::paint::TILE;
use maulstick_types::scene::WellKind;

use super::part::Changed;
use crate::painting::Painting;

/// Tiles that are converted at a time, shared by the cores.
const AT_A_TIME: usize = 64;

/// Tiles with the same pages, which become one and the same.
type Pages = Vec<u64>;

/// Pages of a tile.
fn pages_of(tile: &Tile) -> Pages {
    let wet = tile.wet_page().map_or(0, Page::id);
    let layers = tile.dry().into_iter().flat_map(|stack| stack.layers());
    std::iter::once(wet)
        .chain(layers.flat_map(|layer| [u64::from(layer.number), layer.planes.id()]))
        .collect()
}

/// A tile to convert.
struct Job {
    id: TileId,
    tile: Arc<Tile>,
    stays: Vec<usize>,
    converted: Converted,
}

impl Painting {
    /// Assigns slots to the paints of the palette's wells, while there are free ones, so that conversions may use them.
    pub(crate) fn take_up_wells(&mut self) -> Result<(), EditError> {
        let wells = self.scene.surfaces.iter().flat_map(|own| own.wells.clone());
        for well in wells.collect::<Vec<_>>() {
            if let WellKind::Paint { mixture } = well.kind {
                match self.optics.slots(&mut self.scene, &mixture) {
                    Ok(_) | Err(EditError::TooManyPaints(_)) => {}
                    Err(error) => return Err(error),
                }
            }
        }
        Ok(())
    }

    /// Models of the surfaces, by their numbers.
    pub(crate) fn model_names(&self) -> BTreeMap<u32, &'static str> {
        let surfaces = self.surfaces.iter();
        surfaces.map(|own| (own.id, own.model.name)).collect()
    }

    /// The changed tiles of a surface in another colouring, and their distance from the old appearance.
    pub(crate) fn converted(&self, on: usize, to: Colouring) -> (Changed, Distance) {
        let surface = &self.surfaces[on];
        let converter = Converter::new(&self.optics.look, surface.model.shown.colouring(), to);
        let is_even = matches!(
            surface.bare.ground,
            maulstick_appearance::ground::Ground::Even(_)
        );
        let mut known: HashMap<Pages, (Arc<Tile>, Distance)> = HashMap::new();
        let (mut tiles, mut distance) = (Changed::new(), Distance::default());
        let mut jobs: Vec<Job> = Vec::new();
        let mut flush = |jobs: &mut Vec<Job>, known: &mut HashMap<Pages, (Arc<Tile>, Distance)>| {
            let work = |job: &mut Job| {
                let ground = surface.bare.ground.tile(job.id);
                let ground = TileGround {
                    under: ground.under(),
                    stays: &job.stays,
                };
                job.converted = converter.tile(&job.tile, ground);
            };
            let each = jobs.len().div_ceil(fork_join::threads()).max(1);
            let mut shares: Vec<&mut [Job]> = jobs.chunks_mut(each).collect();
            fork_join::each(&mut shares, |share| share.iter_mut().for_each(work));
            for job in jobs.drain(..) {
                let first = [job.id.x, job.id.y].map(|tile| tile as usize * TILE);
                let seen = job.converted.distance.moved(first);
                let tile = assembled(&job.tile, job.converted, &self.surfaces.pager);
                let tile = Arc::new(tile);
                if is_even && job.stays.is_empty() {
                    known.insert(pages_of(&job.tile), (Arc::clone(&tile), seen));
                }
                distance.add(&seen);
                tiles.push((job.id, tile));
            }
        };
        let mut repeated = Vec::new();
        for (id, version) in surface.store.iter() {
            let Some(tile) = version.tile.as_ref().filter(|tile| !tile.is_bare()) else {
                continue;
            };
            let stays: Vec<usize> = surface.bare.cells_in_wells(id).collect();
            let pages = pages_of(tile);
            let is_queued = |job: &Job| job.stays.is_empty() && pages_of(&job.tile) == pages;
            let is_known = known.contains_key(&pages) || jobs.iter().any(is_queued);
            if is_even && stays.is_empty() && is_known {
                repeated.push((id, pages));
                continue;
            }
            jobs.push(Job {
                id,
                tile: Arc::clone(tile),
                stays,
                converted: Converted::default(),
            });
            if jobs.len() == AT_A_TIME {
                flush(&mut jobs, &mut known);
            }
        }
        flush(&mut jobs, &mut known);
        for (id, pages) in repeated {
            if let Some((tile, seen)) = known.get(&pages) {
                distance.add(seen);
                tiles.push((id, Arc::clone(tile)));
            }
        }
        let is_other = |(id, tile): &(TileId, Arc<Tile>)| {
            let before = surface.store.version(*id).tile.as_deref();
            !before.is_some_and(|before| before.is(tile))
        };
        tiles.retain(is_other);
        (tiles, distance)
    }

    /// Replaces tiles by converted ones with the same amounts of paint by cell, within a step: changes from one paint
    /// to another are booked as given and taken by a mode.
    pub(crate) fn put_converted(&mut self, on: usize, tiles: Changed) {
        let count = |tile: &Tile| {
            let mut counts = tile.counts();
            if let Some(stack) = tile.dry() {
                add(&mut counts, &stack.counts());
            }
            counts
        };
        let (mut before, mut after): (Counts, Counts) = ([0; SLOTS], [0; SLOTS]);
        for (id, tile) in &tiles {
            if let Some(tile) = &self.surfaces[on].store.version(*id).tile {
                add(&mut before, &count(tile));
            }
            add(&mut after, &count(tile));
        }
        self.put_changed(on, tiles);
        let exchanged: [i64; SLOTS] =
            std::array::from_fn(|slot| after[slot] as i64 - before[slot] as i64);
        self.accounts.ledger.from_mode(&exchanged);
        self.book(None);
    }
}

/// A tile of converted paint: pages that did not change are those of before.
fn assembled(tile: &Tile, converted: Converted, pager: &Arc<Pager>) -> Tile {
    let page = |page: &Page<Planes>, planes: Planes| {
        if *page.get() == planes {
            page.clone()
        } else {
            Page::new(pager, Arc::new(planes), Some(page))
        }
    };
    let stack = tile.dry();
    let layers: Vec<&DryLayer> = stack.into_iter().flat_map(|stack| stack.layers()).collect();
    let mut changed = Vec::new();
    for (layer, planes) in layers.iter().zip(converted.dry) {
        changed.push(DryLayer {
            number: layer.number,
            planes: page(&layer.planes, planes),
        });
    }
    let same = layers
        .iter()
        .zip(&changed)
        .all(|(one, other)| one.planes.is(&other.planes));
    let dry = if same {
        stack.cloned()
    } else {
        changed
            .into_iter()
            .rev()
            .fold(None, |below, layer| Some(DryStack::over(below, layer)))
    };
    // The wet page comes after the links: paint drying from it is a separate layer.
    let wet = tile.wet_page();
    let wet = wet.map(|wet| page(wet, converted.wet));
    Tile::of_pages(wet.filter(|page| !page.get().is_empty()), dry)
}
