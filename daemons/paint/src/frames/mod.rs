//! Frames of changed tiles for each view: a thread of its own between the paint and its views.
//!
//! The stepper hands over versions of tiles, which are shared and never copied; colour is computed here, only for tiles
//! that a view shows.

mod brush_looks;
mod films;
mod pyramid;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use maulstick_appearance::Appearance;
use maulstick_appearance::shown_surface::ShownSurface;
use maulstick_bus::typed::Reader;
use maulstick_bus::{Bus, BusError, Request, Server, Wake};
use maulstick_canvas::dry::DryStack;
use maulstick_canvas::tile::{Tile, TileId};
use maulstick_document::TileCache;
use maulstick_optics::backend::FilmBackend;
use maulstick_painting::brush_colour::Carried;
use maulstick_types::paint::{FrameHolds, FrameReply, FrameRequest, FrameTile};
use maulstick_types::wire::topics::Topics;
use maulstick_types::{DecodeError, Flags, Origin, encode, encode_into, encoded_bytes};

use brush_looks::BrushLooks;
use films::SteadyFilms;
use pyramid::{BARE_VERSIONS, Pyramid, coarsest, grid};

/// A reply holds at most this much; the rest comes with the next one, bytes.
const REPLY_BYTES: usize = 12 << 20;
/// Longest wait for a change, ms.
const LONGEST_WAIT_MS: u32 = 2000;
/// Tiles of a reply that are computed together, and tiles of full detail of those at most.
const BATCH: usize = 16;
const MOST_TILES: usize = 64;
/// A view waits this long for tiles that take their time; the rest comes with the next reply.
const REPLY_WORK: Duration = Duration::from_millis(100);
/// Longest time between two looks at the requests.
const LOOK: Duration = Duration::from_millis(100);
/// Time for baking dry layers ahead between two looks at the requests.
const AHEAD: Duration = Duration::from_millis(10);

/// A surface as its views see it.
#[derive(Clone, Debug)]
pub struct FedSurface {
    /// Cells across and up.
    pub cells: [u32; 2],
    /// Tiles across and up.
    pub grid: [u32; 2],
    /// Its appearance where nothing was painted.
    pub bare: Arc<ShownSurface>,
    /// Tiles on which something was painted, with the number of their version.
    pub tiles: BTreeMap<TileId, (u64, Option<Arc<Tile>>)>,
}

impl FedSurface {
    /// Dry layers of a tile that the optics bake.
    #[must_use]
    pub fn dry_on(&self, id: TileId) -> Option<&Arc<DryStack>> {
        self.bare.baked(self.tiles.get(&id)?.1.as_deref())
    }

    /// The tiles on which something has dried that the optics bake.
    pub fn dry_tiles(&self) -> impl Iterator<Item = (TileId, &Arc<DryStack>)> {
        self.tiles
            .iter()
            .filter_map(move |(id, (_, tile))| Some((*id, self.bare.baked(tile.as_deref())?)))
    }
}

/// State handed over by the stepper.
#[derive(Clone, Debug, Default)]
pub struct FrameState {
    /// Surfaces by number.
    pub surfaces: BTreeMap<u32, FedSurface>,
    /// Appearance of the paint.
    pub look: Option<Arc<Appearance>>,
    /// The newest version.
    pub version: u64,
    /// Journal entries below this index are in it.
    pub journal: u64,
    /// Brush states that are in it.
    pub holds: Vec<FrameHolds>,
    /// True while a view waits for changes.
    pub wanted: bool,
    /// Tiles with dry layers that are to be baked for this look, and those that are.
    pub baking: Progress,
    /// Loads of the brushes, by their names.
    pub carried: BTreeMap<String, Carried>,
    /// When a view last asked, rig clock, ns.
    pub watched_ns: u64,
}

/// Progress of long work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// Tiles in all.
    pub all: u32,
    /// Of them done.
    pub done: u32,
}

/// State shared by stepper and frame thread.
#[derive(Clone, Debug, Default)]
pub struct Feed {
    fed: Arc<Mutex<FrameState>>,
    wake: Wake,
}

impl Feed {
    /// An empty feed.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The shared state, for as long as the guard lives.
    pub fn lock(&self) -> MutexGuard<'_, FrameState> {
        self.fed.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Rings the frame thread.
    pub fn ring(&self) {
        self.wake.ring();
    }
}

/// A view that waits.
struct Waiting {
    request: Request,
    asked: FrameRequest,
    deadline_ns: u64,
}

/// Answers views.
pub struct FrameServer {
    bus: Arc<dyn Bus>,
    server: Server,
    reader: Reader,
    feed: Feed,
    stepper: Wake,
    me: Origin,
    pyramid: Pyramid,
    looks: Option<BrushLooks>,
    waiting: Vec<Waiting>,
}

impl FrameServer {
    /// Serves `topic`; rings `stepper` when a view waits for news.
    ///
    /// # Errors
    /// [`BusError::Topic`].
    pub fn new(
        bus: Arc<dyn Bus>,
        topic: &str,
        feed: Feed,
        stepper: &Wake,
        me: Origin,
    ) -> Result<Self, BusError> {
        let server = bus.serve(topic, 16, &feed.wake)?;
        Ok(Self {
            bus,
            server,
            reader: Reader::default(),
            feed,
            stepper: stepper.clone(),
            me,
            pyramid: Pyramid::default(),
            looks: None,
            waiting: Vec::new(),
        })
    }

    /// Computes colours with `films` from now on.
    #[must_use]
    pub fn with_films(mut self, films: Box<dyn FilmBackend>) -> Self {
        self.pyramid.films = SteadyFilms::new(films);
        self
    }

    /// Looks for tiles among those that were shown before, and puts new ones there.
    #[must_use]
    pub fn with_tile_cache(mut self, tile_cache: TileCache) -> Self {
        self.pyramid.tile_cache = Some(tile_cache);
        self
    }

    /// Tells on the topics of a rig how the paint on its brushes looks, as far as it is handed over.
    #[must_use]
    pub fn telling_brushes(mut self, topics: &Topics) -> Self {
        self.looks = Some(BrushLooks::new(topics));
        self
    }

    /// Answers who can be answered, and returns how long to wait at most.
    pub fn poll(&mut self) -> Duration {
        let now_ns = self.bus.now_ns();
        while let Some(request) = self.server.try_recv() {
            let read = self
                .reader
                .read::<FrameRequest>(&request.key, &request.bytes);
            if let Some((_, asked)) = read {
                self.feed.lock().watched_ns = now_ns;
                let wait_ms = asked.wait_ms.min(LONGEST_WAIT_MS);
                let deadline_ns = now_ns + u64::from(wait_ms) * 1_000_000;
                self.waiting.push(Waiting {
                    request,
                    asked,
                    deadline_ns,
                });
            }
        }
        let fed = self.feed.lock().clone();
        if let Some(looks) = &mut self.looks
            && let Err(error) = looks.publish(&*self.bus, self.me, &fed)
        {
            tracing::error!("the look of a brush cannot be sent: {error}");
        }
        // A tile that takes long is gone on with at once.
        let mut begun = false;
        for waiting in std::mem::take(&mut self.waiting) {
            let reply = self.reply(&fed, &waiting.asked);
            let asked = (waiting.asked.epoch, waiting.asked.look);
            let news = !reply.tiles.is_empty() || asked != (reply.epoch, reply.look);
            begun |= reply.more;
            if !news && now_ns < waiting.deadline_ns {
                self.waiting.push(waiting);
                continue;
            }
            if let Err(error) = self.answer(waiting, now_ns, &reply) {
                tracing::error!("a frame cannot be sent: {error}");
            }
        }
        let deadlines = self.waiting.iter().map(|waiting| waiting.deadline_ns);
        let soonest_ns = deadlines.min().map_or(u64::MAX, |deadline_ns| {
            self.want(now_ns);
            deadline_ns - now_ns
        });
        if self.bake_ahead(&fed) || begun && !self.waiting.is_empty() {
            return Duration::ZERO;
        }
        LOOK.min(Duration::from_nanos(soonest_ns))
    }

    /// Has the stepper hand over what changes: a view watches.
    fn want(&self, now_ns: u64) {
        let mut fed = self.feed.lock();
        fed.watched_ns = now_ns;
        if !std::mem::replace(&mut fed.wanted, true) {
            self.stepper.ring();
        }
    }

    /// Sends a reply, in shared memory where the view asks for it.
    fn answer(&self, waiting: Waiting, now_ns: u64, reply: &FrameReply) -> Result<(), DecodeError> {
        let (me, sent_ns) = (&self.me, self.bus.now_ns());
        let sent = if waiting.asked.shared {
            let mut encoded = Ok(());
            let length = encoded_bytes(reply)?;
            let sent = waiting.request.answer_shared(length, &mut |into| {
                encoded = encode_into(me, Flags::NONE, 0, now_ns, sent_ns, reply, into);
            });
            encoded?;
            sent
        } else {
            let bytes = encode(me, Flags::NONE, 0, now_ns, sent_ns, reply)?;
            waiting.request.answer(bytes)
        };
        if let Err(error) = sent {
            tracing::debug!("a view is gone: {error}");
        }
        Ok(())
    }

    /// Bakes dry layers ahead of any view, for a short while; true if there are more.
    fn bake_ahead(&mut self, fed: &FrameState) -> bool {
        let progress = self.pyramid.bake_ahead(fed, AHEAD);
        let mut shared = self.feed.lock();
        // A look that was handed over meanwhile begins anew.
        let same = shared.look.as_ref().map(|look| look.generation());
        if same == fed.look.as_ref().map(|look| look.generation()) {
            shared.baking = progress;
        }
        progress.done < progress.all
    }

    /// Serves until `stop` says so.
    pub fn run(mut self, stop: &maulstick_rig::Stop) {
        while !stop.requested() {
            let wait = self.poll();
            self.feed.wake.wait(wait);
        }
    }

    fn reply(&mut self, fed: &FrameState, asked: &FrameRequest) -> FrameReply {
        let mut reply = FrameReply {
            surface: asked.surface,
            epoch: self.me.epoch,
            look: fed.look.as_ref().map_or(0, |look| look.generation()),
            version: BARE_VERSIONS + fed.version,
            level: 0,
            cells: [0; 2],
            journal: fed.journal,
            holds: fed.holds.clone(),
            more: false,
            tiles: Vec::new(),
        };
        let (Some(surface), Some(look)) = (fed.surfaces.get(&asked.surface), &fed.look) else {
            return reply;
        };
        let level = asked.level.min(coarsest(surface));
        reply.level = level;
        reply.cells = surface.cells.map(|cells| cells.div_ceil(1 << level));
        let since = if (asked.epoch, asked.look) == (reply.epoch, reply.look) {
            asked.since
        } else {
            0
        };
        let changed = changed_tiles(surface, level, &asked.tiles, since);
        let (mut bytes, late) = (0, Instant::now() + REPLY_WORK);
        let mut sent = since;
        for (place, (version, id)) in changed.iter().enumerate() {
            if place % BATCH == 0 {
                let part = &changed[place..(place + BATCH).min(changed.len())];
                let ids = part.iter().map(|(_, id)| *id);
                self.shade(look, (asked.surface, surface), level, ids);
            }
            let tile = (level, *id);
            let made = self.pyramid.tile(look, asked.surface, surface, tile, late);
            let Some(shown) = made else {
                (reply.more, reply.version) = (true, sent);
                break;
            };
            sent = *version;
            let planes = shown.to_bytes();
            bytes += planes.len();
            reply.tiles.push(FrameTile {
                x: id.x,
                y: id.y,
                planes: planes.into(),
            });
            // No two tiles share a version, so the rest can be asked for from any of them on.
            let enough = bytes >= REPLY_BYTES || Instant::now() >= late;
            if enough && place + 1 < changed.len() {
                (reply.more, reply.version) = (true, *version);
                break;
            }
        }
        reply
    }

    /// Shades a batch of tiles together, as far as they are not known from before.
    fn shade(
        &mut self,
        look: &Appearance,
        (number, surface): (u32, &FedSurface),
        level: u32,
        batch: impl Iterator<Item = TileId>,
    ) {
        let pyramid = &mut self.pyramid;
        let new = batch.filter(|id| !pyramid.recall(look, number, surface, level, *id));
        let new: Vec<TileId> = new.collect();
        let mut ids = Vec::new();
        for id in new {
            let most = MOST_TILES - ids.len();
            if most > 0 {
                ids.extend(self.pyramid.stale(number, surface, (level, id), most));
            }
        }
        self.pyramid.shade(look, number, surface, &ids);
    }
}

/// Tiles of a level within `[left, bottom, right, top]` above the version `since`, the oldest first.
fn changed_tiles(
    surface: &FedSurface,
    level: u32,
    tiles: &[u32; 4],
    since: u64,
) -> Vec<(u64, TileId)> {
    let grid = grid(surface, level);
    let mut changed = Vec::new();
    for y in tiles[1]..tiles[3].min(grid[1]) {
        for x in tiles[0]..tiles[2].min(grid[0]) {
            let id = TileId { x, y };
            let version = Pyramid::version(surface, level, id);
            if version > since {
                changed.push((version, id));
            }
        }
    }
    changed.sort();
    changed
}

#[cfg(test)]
mod tests;
