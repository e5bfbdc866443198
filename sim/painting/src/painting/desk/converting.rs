//! Conversion of a surface to another paint model.

use std::collections::HashMap;
use std::sync::Arc;

use maulstick_appearance::colouring::Colouring;
use maulstick_appearance::ground::Ground;
use maulstick_canvas::dry::{DryLayer, DryStack};
use maulstick_canvas::own_plane::OwnPlane;
use maulstick_canvas::page::{Page, Pager};
use maulstick_canvas::planes::Planes;
use maulstick_canvas::sheet::without_notes;
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_convert::{Converted, Converter, Distance, TileGround};
use maulstick_num::fork_join;
use maulstick_types::paint::TILE;

use super::Desk;
use crate::painting::surfaces::{Changed, SurfaceState};

/// Tiles that are converted at a time, shared by the cores.
const AT_A_TIME: usize = 64;

/// Tiles with the same pages, which become one and the same.
type Pages = Vec<u64>;

/// What a tile is made of.
fn pages_of(tile: &Tile) -> Pages {
    let wet = tile.wet_page().map_or(0, Page::id);
    let layers = tile.dry().into_iter().flat_map(|stack| stack.layers());
    std::iter::once(wet)
        .chain(layers.flat_map(|layer| [u64::from(layer.number), layer.planes.id()]))
        .collect()
}

/// A tile that is to be converted.
struct Job {
    id: TileId,
    tile: Arc<Tile>,
    stays: Vec<usize>,
    converted: Converted,
}

impl Desk {
    /// The tiles of a surface in another colouring, as far as they change, and how near they come to what was seen.
    pub(crate) fn converted(&self, on: usize, to: Colouring) -> (Changed, Distance) {
        let surface = &self.surfaces[on];
        let from = surface.model.shown.colouring();
        let mut conversion = Conversion {
            surface,
            pager: &self.surfaces.pager,
            converter: Converter::new(&self.optics.look, from, to),
            is_even: matches!(surface.bare.ground, Ground::Even(_)),
            jobs: Vec::new(),
            known: HashMap::new(),
            tiles: Changed::new(),
            distance: Distance::default(),
        };
        conversion.run();
        let Conversion {
            mut tiles,
            distance,
            ..
        } = conversion;
        let is_other = |(id, tile): &(TileId, Arc<Tile>)| {
            let before = surface.store.version(*id).tile.as_deref();
            !before.is_some_and(|before| before.is(tile))
        };
        tiles.retain(is_other);
        (tiles, distance)
    }
}

/// Conversion of a surface's tiles to another colouring.
struct Conversion<'a> {
    surface: &'a SurfaceState,
    pager: &'a Arc<Pager>,
    converter: Converter<'a>,
    /// True on a ground of one colour: tiles with the same pages become one and the same.
    is_even: bool,
    /// Tiles that wait to be converted together.
    jobs: Vec<Job>,
    /// Converted tiles by the pages of before.
    known: HashMap<Pages, (Arc<Tile>, Distance)>,
    tiles: Changed,
    distance: Distance,
}

impl Conversion<'_> {
    fn run(&mut self) {
        let mut repeated = Vec::new();
        for (id, version) in self.surface.store.iter() {
            let Some(tile) = version.tile.as_ref().filter(|tile| !tile.is_bare()) else {
                continue;
            };
            let stays: Vec<usize> = self.surface.bare.cells_in_wells(id).collect();
            let pages = pages_of(tile);
            let is_queued = |job: &Job| job.stays.is_empty() && pages_of(&job.tile) == pages;
            let is_known = self.known.contains_key(&pages) || self.jobs.iter().any(is_queued);
            if self.is_even && stays.is_empty() && is_known {
                repeated.push((id, pages));
                continue;
            }
            self.jobs.push(Job {
                id,
                tile: Arc::clone(tile),
                stays,
                converted: Converted::default(),
            });
            if self.jobs.len() == AT_A_TIME {
                self.flush();
            }
        }
        self.flush();
        for (id, pages) in repeated {
            if let Some((tile, seen)) = self.known.get(&pages) {
                self.distance.add(seen);
                self.tiles.push((id, Arc::clone(tile)));
            }
        }
    }

    /// Converts the tiles that wait.
    fn flush(&mut self) {
        let (surface, converter) = (self.surface, &self.converter);
        let work = |job: &mut Job| {
            let ground = surface.bare.ground.tile(job.id);
            let ground = TileGround {
                under: ground.under(),
                stays: &job.stays,
            };
            job.converted = converter.tile(&job.tile, ground);
        };
        let each = self.jobs.len().div_ceil(fork_join::threads()).max(1);
        let mut shares: Vec<&mut [Job]> = self.jobs.chunks_mut(each).collect();
        fork_join::each(&mut shares, |share| share.iter_mut().for_each(work));
        for job in self.jobs.drain(..) {
            let first = [job.id.x, job.id.y].map(|tile| tile as usize * TILE);
            let seen = job.converted.distance.moved(first);
            let tile = Arc::new(assembled(&job.tile, job.converted, self.pager));
            if self.is_even && job.stays.is_empty() {
                let converted = (Arc::clone(&tile), seen);
                self.known.insert(pages_of(&job.tile), converted);
            }
            self.distance.add(&seen);
            self.tiles.push((job.id, tile));
        }
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
        let layers = changed.into_iter().rev();
        layers.fold(None, |below, layer| Some(DryStack::over(below, layer)))
    };
    // The wet page comes after the links: what dries of it from now on is a layer of its own.
    let wet = tile.wet_page();
    // Other models do not keep what lies on top.
    let own: Vec<OwnPlane> = without_notes(&converted.wet).collect();
    let wet = wet.map(|wet| page(wet, converted.wet.with_own(own)));
    Tile::of_pages(wet.filter(|page| !page.get().is_empty()), dry)
}
