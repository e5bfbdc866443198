//! Display tiles at every level of detail, made from those below and kept for the next request.

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;
use std::time::{Duration, Instant};

use maulstick_appearance::display::{DisplayTile, WetFilms};
use maulstick_appearance::{Appearance, Bakery};
use maulstick_canvas::dry::DryStack;
use maulstick_canvas::tile::TileId;
use maulstick_document::rows::shown_number;
use maulstick_document::{ShownTile, TileCache};
use maulstick_optics::backend::{BackendError, FilmBackend};
use maulstick_optics::{FilmPlanes, Under};

use super::films::SteadyFilms;
use super::{FedSurface, FrameState, Progress};

/// Number of cached display tiles.
const KEPT_TILES: usize = 1024;

/// From this level on, eight cells to a point and coarser, a bare ground looks even.
const PLAIN_LEVEL: u32 = 3;
/// Surfaces of more tiles than this are not drawn tile by tile where they are bare.
const PLAIN_TILES: u32 = 1024;

/// True if a surface is so vast that its bare parts are drawn as if they were even.
fn is_plain(surface: &FedSurface) -> bool {
    surface.grid[0] * surface.grid[1] > PLAIN_TILES && surface.bare.wells.is_empty()
}

/// Planes of paints by slot.
type Paints<'a> = Vec<(usize, &'a [f32])>;

/// A film over what lies under it.
fn film<'a>(paints: &'a [(usize, &'a [f32])], under: Under<'a>) -> FilmPlanes<'a> {
    FilmPlanes {
        paints,
        opacity: 1.0,
        under,
    }
}

/// The coarsest level: a single tile shows the whole surface.
pub(super) fn coarsest(surface: &FedSurface) -> u32 {
    let [across, up] = surface.grid;
    across.max(up).max(1).next_power_of_two().trailing_zeros()
}

/// Tiles across and up at a level.
pub(super) fn grid(surface: &FedSurface, level: u32) -> [u32; 2] {
    surface.grid.map(|tiles| tiles.div_ceil(1 << level))
}

/// Versions of bare tiles are below this, those of painted ones above: a surface has no more tiles.
pub(super) const BARE_VERSIONS: u64 = 1 << 32;

/// Display tiles by level and place, with the version that they show.
#[derive(Debug, Default)]
pub(super) struct Pyramid {
    kept: BTreeMap<(u32, u32, TileId), (u64, Arc<DisplayTile>)>,
    /// Tiles beyond the edge of a surface.
    outside: BTreeMap<u32, Arc<DisplayTile>>,
    /// A bare tile of a vast surface, from afar.
    plain: BTreeMap<u32, Arc<DisplayTile>>,
    bakery: Bakery,
    pub(super) films: SteadyFilms,
    /// Tiles as they were shown before, in the document.
    pub(super) tile_cache: Option<TileCache>,
    /// Generation of the look that all this shows.
    generation: Option<u64>,
    /// Dry layers still to be baked for it, unless a view needs them first.
    ahead: VecDeque<(u32, TileId, Arc<DryStack>)>,
    /// For which generation that is, and how many they were.
    ahead_of: (Option<u64>, u32),
}

impl Pyramid {
    /// Version of a tile of a level: the newest of its tiles of full detail; 0 where nothing was painted.
    fn painted(surface: &FedSurface, level: u32, id: TileId) -> u64 {
        let [across, up] = grid(surface, level);
        if id.x >= across || id.y >= up {
            return 0;
        }
        if level == 0 {
            return surface.tiles.get(&id).map_or(0, |(version, _)| *version);
        }
        (0..4)
            .map(|quarter| Self::painted(surface, level - 1, child(id, quarter)))
            .max()
            .unwrap_or(0)
    }

    /// Version of a tile as views count them: no two tiles of a level share one, and bare tiles
    /// come first, one after the other, so that any number of tiles is sent in parts.
    pub(super) fn version(surface: &FedSurface, level: u32, id: TileId) -> u64 {
        match Self::painted(surface, level, id) {
            0 => u64::from(id.y) * u64::from(grid(surface, level)[0]) + u64::from(id.x) + 1,
            painted => BARE_VERSIONS + painted,
        }
    }

    /// Begins anew under another look.
    fn turn_to(&mut self, look: &Appearance) {
        if self.generation != Some(look.generation()) {
            self.generation = Some(look.generation());
            self.kept.clear();
            self.outside.clear();
            self.plain.clear();
        }
    }

    /// Bakes dry layers for the present look, a tile after the other, for as long as `limit`. Layers that dry later are
    /// baked on demand.
    pub(super) fn bake_ahead(&mut self, fed: &FrameState, limit: Duration) -> Progress {
        let Some(look) = &fed.look else {
            return Progress::default();
        };
        self.turn_to(look);
        if self.ahead_of.0 != Some(look.generation()) {
            let dry = fed.surfaces.iter().flat_map(|(number, surface)| {
                let tiles = surface.dry_tiles();
                tiles.map(|(id, stack)| (*number, id, Arc::clone(stack)))
            });
            self.ahead = dry.collect();
            self.ahead_of = (Some(look.generation()), self.ahead.len() as u32);
        }
        let begun = Instant::now();
        while begun.elapsed() < limit
            && let Some((number, id, stack)) = self.ahead.pop_front()
        {
            // Paint that has dried since was, or will be, baked when a view needs it.
            if let Some(surface) = fed.surfaces.get(&number)
                && surface
                    .dry_on(id)
                    .is_some_and(|now| Arc::ptr_eq(now, &stack))
            {
                let ground = surface.bare.ground.tile(id);
                let over = (&stack, ground.under());
                let sight = (&**look, &mut self.films as &mut dyn FilmBackend);
                self.bakery
                    .planes(sight, surface.bare.shown, number, id, over);
            }
        }
        Progress {
            all: self.ahead_of.1,
            done: self.ahead_of.1 - self.ahead.len() as u32,
        }
    }

    /// Tiles of full detail that a tile of a level is still to be made of: those that are not cached, nor a tile that is
    /// made of them. `most` are found at most.
    pub(super) fn stale(
        &self,
        number: u32,
        surface: &FedSurface,
        (level, id): (u32, TileId),
        most: usize,
    ) -> Vec<TileId> {
        let (mut found, mut left) = (Vec::new(), vec![(level, id)]);
        while let Some((level, id)) = left.pop() {
            let [across, up] = grid(surface, level);
            let version = Self::painted(surface, level, id);
            let kept = self.kept.get(&(number, level, id));
            let is_kept = kept.is_some_and(|(kept, _)| *kept == version);
            if is_kept || id.x >= across || id.y >= up {
                continue;
            }
            match level {
                0 => found.push(id),
                _ => left.extend((0..4).rev().map(|quarter| (level - 1, child(id, quarter)))),
            }
            if found.len() >= most {
                break;
            }
        }
        found
    }

    /// Computes tiles of full detail together.
    pub(super) fn shade(
        &mut self,
        look: &Appearance,
        number: u32,
        surface: &FedSurface,
        ids: &[TileId],
    ) {
        self.turn_to(look);
        let painted = |id: &TileId| surface.tiles.get(id).and_then(|(_, tile)| tile.as_deref());
        let grounds: Vec<_> = ids.iter().map(|id| surface.bare.ground.tile(*id)).collect();
        let stacks: Vec<Option<&Arc<DryStack>>> = ids
            .iter()
            .map(|id| surface.bare.baked(painted(id)))
            .collect();
        let dry: Vec<(TileId, &Arc<DryStack>, Under<'_>)> = ids
            .iter()
            .zip(stacks.iter().zip(&grounds))
            .filter_map(|(id, (stack, ground))| Some((*id, (*stack)?, ground.under())))
            .collect();
        let sight = (look, &mut self.films as &mut dyn FilmBackend);
        let mut planes = self
            .bakery
            .planes_of(sight, surface.bare.shown, number, &dry)
            .into_iter();
        let baked: Vec<Option<Arc<[f32]>>> = stacks
            .iter()
            .map(|stack| stack.and_then(|_| planes.next()))
            .collect();
        let bare = &surface.bare;
        let films: Vec<WetFilms> = ids.iter().map(|id| bare.films(painted(id))).collect();
        let under: Vec<Under<'_>> = baked
            .iter()
            .zip(&grounds)
            .map(|(baked, ground)| match baked {
                Some(baked) => Under::Planes(baked),
                None => ground.under(),
            })
            .collect();
        let colours = match self.colours(look, &films, &under) {
            Ok(colours) => colours,
            Err(error) => {
                tracing::error!("tiles cannot be shown: {error}");
                return;
            }
        };
        for ((id, films), rgb) in ids.iter().zip(&films).zip(colours) {
            let shown = surface.bare.display(*id, painted(id), (films, rgb), look);
            let version = Self::painted(surface, 0, *id);
            self.put_aside(look, (number, 0, *id), version, &shown);
            self.keep((number, 0, *id), version, Arc::new(shown));
        }
    }

    /// Colours of wet films over what lies under them.
    fn colours(
        &mut self,
        look: &Appearance,
        films: &[WetFilms],
        under: &[Under<'_>],
    ) -> Result<Vec<[Vec<f32>; 3]>, BackendError> {
        let bodies: Vec<(usize, Paints<'_>)> = (films.iter().enumerate())
            .filter_map(|(tile, films)| Some((tile, films.body()?)))
            .collect();
        let batch: Vec<FilmPlanes<'_>> = bodies
            .iter()
            .map(|(tile, paints)| film(paints, under[*tile]))
            .collect();
        let baked = match batch[..] {
            [] => Vec::new(),
            _ => self.films.bake(&look.studio, &batch)?,
        };
        let mut under = under.to_vec();
        for ((tile, _), planes) in bodies.iter().zip(&baked) {
            under[*tile] = Under::Planes(planes);
        }
        let planes: Vec<Paints<'_>> = films.iter().map(WetFilms::planes).collect();
        let batch: Vec<FilmPlanes<'_>> = (planes.iter().zip(under))
            .map(|(paints, under)| film(paints, under))
            .collect();
        self.films.shade(&look.studio, &batch)
    }

    /// Tile beyond the edge of a surface, as if it continued.
    fn outside(
        &mut self,
        look: &Appearance,
        number: u32,
        surface: &FedSurface,
    ) -> Arc<DisplayTile> {
        let bare = || {
            let films = WetFilms::default();
            let rgb = films.shade(&look.studio, Under::Even(surface.bare.ground.mean()));
            Arc::new(DisplayTile::of(None, (&films, rgb), look))
        };
        Arc::clone(self.outside.entry(number).or_insert_with(bare))
    }

    /// A tile as it was shown before.
    fn shown(
        &self,
        look: &Appearance,
        place: (u32, u32, TileId),
        version: u64,
    ) -> Option<Arc<DisplayTile>> {
        let (number, level, id) = place;
        let tile_cache = self.tile_cache.as_ref().filter(|_| version > 0)?;
        let bytes = tile_cache.get(shown_number(number, level, id), version, look.print())?;
        DisplayTile::from_bytes(&bytes).map(Arc::new)
    }

    /// True if a tile is available, in memory or, as it was shown before, in the document.
    pub(super) fn recall(
        &mut self,
        look: &Appearance,
        number: u32,
        surface: &FedSurface,
        level: u32,
        id: TileId,
    ) -> bool {
        self.turn_to(look);
        let place = (number, level, id);
        let version = Self::painted(surface, level, id);
        if self
            .kept
            .get(&place)
            .is_some_and(|(kept, _)| *kept == version)
        {
            return true;
        }
        let shown = self.shown(look, place, version);
        let recalled = shown.is_some();
        if let Some(shown) = shown {
            self.keep(place, version, shown);
        }
        recalled
    }

    /// Has the document keep a tile as it is shown.
    fn put_aside(
        &self,
        look: &Appearance,
        place: (u32, u32, TileId),
        version: u64,
        tile: &DisplayTile,
    ) {
        if let Some(tile_cache) = self.tile_cache.as_ref().filter(|_| version > 0) {
            let (number, level, id) = place;
            tile_cache.put(ShownTile {
                place: shown_number(number, level, id),
                version,
                look: look.print(),
                bytes: tile.to_bytes(),
            });
        }
    }

    /// A bare tile seen from afar, where threads and grain are too small to be seen.
    fn plain(&mut self, look: &Appearance, number: u32, surface: &FedSurface) -> Arc<DisplayTile> {
        if let Some(plain) = self.plain.get(&number) {
            return Arc::clone(plain);
        }
        let near = self.finest(look, number, surface, TileId { x: 0, y: 0 });
        let plain = Arc::new(near.even());
        self.plain.insert(number, Arc::clone(&plain));
        plain
    }

    fn keep(&mut self, place: (u32, u32, TileId), version: u64, tile: Arc<DisplayTile>) {
        if self.kept.len() >= KEPT_TILES {
            // A coarse tile is made of many: it is kept as long as there is room.
            let finest = self.kept.keys().map(|(_, level, _)| *level).min();
            self.kept.retain(|(_, level, _), _| Some(*level) > finest);
        }
        self.kept.insert(place, (version, tile));
    }

    /// A tile of a level; `None` where it is made of so many others that this takes longer than until `late`. What was
    /// made of it is kept for the next call.
    pub(super) fn tile(
        &mut self,
        look: &Appearance,
        number: u32,
        surface: &FedSurface,
        (level, id): (u32, TileId),
        late: Instant,
    ) -> Option<Arc<DisplayTile>> {
        self.turn_to(look);
        let version = Self::painted(surface, level, id);
        if let Some((kept, tile)) = self.kept.get(&(number, level, id))
            && *kept == version
        {
            return Some(Arc::clone(tile));
        }
        if version == 0 && level >= PLAIN_LEVEL && is_plain(surface) {
            return Some(self.plain(look, number, surface));
        }
        if let Some(shown) = self.shown(look, (number, level, id), version) {
            self.keep((number, level, id), version, Arc::clone(&shown));
            return Some(shown);
        }
        if level == 0 {
            // What is shaded already is put together, however late it is: so each call gets farther.
            return (Instant::now() < late).then(|| self.finest(look, number, surface, id));
        }
        let tile = Arc::new({
            let outside = self.outside(look, number, surface);
            let [across, up] = grid(surface, level - 1);
            let mut children: [Option<Arc<DisplayTile>>; 4] = Default::default();
            for (quarter, tile) in children.iter_mut().enumerate() {
                let child = child(id, quarter as u32);
                if child.x < across && child.y < up {
                    let place = (level - 1, child);
                    *tile = Some(self.tile(look, number, surface, place, late)?);
                }
            }
            let children = children.each_ref().map(|child| child.as_deref());
            let finer = (1u64 << (level - 1).min(31)) as f32;
            let cell_m = finer / surface.bare.relief.cells_per_m();
            DisplayTile::coarser(children, &outside, cell_m)
        });
        self.put_aside(look, (number, level, id), version, &tile);
        self.keep((number, level, id), version, Arc::clone(&tile));
        Some(tile)
    }

    /// A tile of full detail.
    fn finest(
        &mut self,
        look: &Appearance,
        number: u32,
        surface: &FedSurface,
        id: TileId,
    ) -> Arc<DisplayTile> {
        self.shade(look, number, surface, &[id]);
        let kept = self.kept.get(&(number, 0, id));
        let kept = kept.map(|(_, tile)| Arc::clone(tile));
        kept.unwrap_or_else(|| self.outside(look, number, surface))
    }
}

fn child(id: TileId, quarter: u32) -> TileId {
    TileId {
        x: 2 * id.x + quarter % 2,
        y: 2 * id.y + quarter / 2,
    }
}
