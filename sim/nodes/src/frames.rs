//! Pictures of what changed, for whoever asks: a thread of its own between the paint and its views.
//!
//! The stepper hands over versions of tiles, which are shared and never copied; colour is computed
//! here, only for tiles that someone looks at.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use maulstick_bus::typed::Reader;
use maulstick_bus::{Bus, BusError, Request, Server, Wake};
use maulstick_optics::Studio;
use maulstick_paint::display::DisplayTile;
use maulstick_paint::tile::{Tile, TileId};
use maulstick_types::paint::{FrameHolds, FrameReply, FrameRequest, FrameTile};
use maulstick_types::{Flags, Origin, encode};

/// A reply holds at most this much; the rest comes with the next one, bytes.
const REPLY_BYTES: usize = 16 << 20;
/// Display tiles that are kept for the next request.
const KEPT_TILES: usize = 1024;
/// Longest wait for a change, ms.
const LONGEST_WAIT_MS: u32 = 400;

/// A surface as its views see it.
#[derive(Clone, Debug, Default)]
pub struct FedSurface {
    /// Cells across and up.
    pub cells: [u32; 2],
    /// Tiles across and up.
    pub grid: [u32; 2],
    /// Reflectance of the ground at the studio's wavelengths.
    pub ground: Vec<f32>,
    /// Tiles on which something was painted, with the number of their version.
    pub tiles: BTreeMap<TileId, (u64, Option<Arc<Tile>>)>,
}

/// What the stepper has handed over.
#[derive(Clone, Debug, Default)]
pub struct Fed {
    /// Surfaces by number.
    pub surfaces: BTreeMap<u32, FedSurface>,
    /// Optics of the paints in use.
    pub studio: Option<Arc<Studio>>,
    /// The newest version.
    pub version: u64,
    /// Journal entries below this index are in it.
    pub journal: u64,
    /// Brush states that are in it.
    pub holds: Vec<FrameHolds>,
    /// Whether a view waits for news.
    pub wanted: bool,
}

/// Where stepper and frame thread meet.
#[derive(Clone, Debug, Default)]
pub struct Feed {
    fed: Arc<Mutex<Fed>>,
    wake: Wake,
}

impl Feed {
    /// An empty feed.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// What was handed over, for as long as the guard lives.
    pub fn lock(&self) -> MutexGuard<'_, Fed> {
        self.fed.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Rings the frame thread.
    pub fn ring(&self) {
        self.wake.ring();
    }
}

/// Display tiles by level and place, with the version that they show.
#[derive(Debug, Default)]
struct Pyramid {
    kept: BTreeMap<(u32, u32, TileId), (u64, Arc<DisplayTile>)>,
    bare: BTreeMap<u32, Arc<DisplayTile>>,
}

impl Pyramid {
    /// Version of a tile of a level: the newest of what lies in it.
    fn version(surface: &FedSurface, level: u32, id: TileId) -> u64 {
        if level == 0 {
            return surface.tiles.get(&id).map_or(0, |(version, _)| *version);
        }
        (0..4)
            .map(|quarter| Self::version(surface, level - 1, child(id, quarter)))
            .max()
            .unwrap_or(0)
    }

    fn tile(
        &mut self,
        studio: &Studio,
        number: u32,
        surface: &FedSurface,
        level: u32,
        id: TileId,
    ) -> Arc<DisplayTile> {
        let version = Self::version(surface, level, id);
        let bare = Arc::clone(
            self.bare
                .entry(number)
                .or_insert_with(|| Arc::new(DisplayTile::of(None, studio, &surface.ground))),
        );
        if version == 0 {
            return bare;
        }
        if let Some((kept, tile)) = self.kept.get(&(number, level, id))
            && *kept == version
        {
            return Arc::clone(tile);
        }
        let tile = Arc::new(if level == 0 {
            let tile = surface.tiles.get(&id).and_then(|(_, tile)| tile.as_deref());
            DisplayTile::of(tile, studio, &surface.ground)
        } else {
            let children: [Arc<DisplayTile>; 4] = std::array::from_fn(|quarter| {
                self.tile(
                    studio,
                    number,
                    surface,
                    level - 1,
                    child(id, quarter as u32),
                )
            });
            DisplayTile::coarser(std::array::from_fn(|i| Some(&*children[i])), &bare)
        });
        if self.kept.len() >= KEPT_TILES {
            self.kept.clear();
        }
        self.kept
            .insert((number, level, id), (version, Arc::clone(&tile)));
        tile
    }
}

fn child(id: TileId, quarter: u32) -> TileId {
    TileId {
        x: 2 * id.x + quarter % 2,
        y: 2 * id.y + quarter / 2,
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
            waiting: Vec::new(),
        })
    }

    /// Answers who can be answered and returns how long to wait at most.
    pub fn turn(&mut self) -> Duration {
        let now_ns = self.bus.now_ns();
        while let Some(request) = self.server.try_recv() {
            let read = self
                .reader
                .read::<FrameRequest>(&request.key, &request.bytes);
            if let Some((_, asked)) = read {
                let wait_ms = asked.wait_ms.min(LONGEST_WAIT_MS);
                let deadline_ns = now_ns + u64::from(wait_ms) * 1_000_000;
                self.waiting.push(Waiting {
                    request,
                    asked,
                    deadline_ns,
                });
            }
        }
        let fed = self.feed.lock().clone_for(&self.waiting);
        for waiting in std::mem::take(&mut self.waiting) {
            let reply = self.reply(&fed, &waiting.asked);
            let news = !reply.tiles.is_empty() || waiting.asked.epoch != self.me.epoch;
            if !news && now_ns < waiting.deadline_ns {
                self.waiting.push(waiting);
                continue;
            }
            match encode(&self.me, Flags::NONE, 0, now_ns, self.bus.now_ns(), &reply) {
                Ok(bytes) => {
                    if let Err(error) = waiting.request.answer(bytes) {
                        tracing::debug!("a view is gone: {error}");
                    }
                }
                Err(error) => tracing::error!("a frame cannot be sent: {error}"),
            }
        }
        if !self.waiting.is_empty() {
            self.feed.lock().wanted = true;
            self.stepper.ring();
        }
        Duration::from_millis(if self.waiting.is_empty() { 100 } else { 20 })
    }

    /// Serves until `stop` says so.
    pub fn run(mut self, stop: &maulstick_rig::Stop) {
        while !stop.requested() {
            let wait = self.turn();
            self.feed.wake.wait(wait);
        }
    }

    fn reply(&mut self, fed: &Fed, asked: &FrameRequest) -> FrameReply {
        let mut reply = FrameReply {
            surface: asked.surface,
            epoch: self.me.epoch,
            // 0 is what a new view asks with, so an unpainted canvas is of version 1.
            version: fed.version.max(1),
            level: asked.level.min(16),
            cells: [0; 2],
            journal: fed.journal,
            holds: fed.holds.clone(),
            more: false,
            tiles: Vec::new(),
        };
        let (Some(surface), Some(studio)) = (fed.surfaces.get(&asked.surface), &fed.studio) else {
            return reply;
        };
        let level = reply.level;
        reply.cells = surface.cells.map(|cells| cells.div_ceil(1 << level));
        let since = if asked.epoch == self.me.epoch {
            asked.since
        } else {
            0
        };
        let grid = surface.grid.map(|tiles| tiles.div_ceil(1 << level));
        let mut changed = Vec::new();
        for y in asked.tiles[1]..asked.tiles[3].min(grid[1]) {
            for x in asked.tiles[0]..asked.tiles[2].min(grid[0]) {
                let id = TileId { x, y };
                let version = Pyramid::version(surface, level, id);
                if version > since || since == 0 {
                    changed.push((version, id));
                }
            }
        }
        changed.sort();
        let mut bytes = 0;
        for (place, (version, id)) in changed.iter().enumerate() {
            let shown = self
                .pyramid
                .tile(studio, asked.surface, surface, level, *id);
            let planes = shown.to_bytes();
            bytes += planes.len();
            reply.tiles.push(FrameTile {
                x: id.x,
                y: id.y,
                planes: planes.into(),
            });
            // Tiles of one version go together, or the rest would never be asked for.
            let next_differs = changed
                .get(place + 1)
                .is_some_and(|(next, _)| next != version);
            if bytes >= REPLY_BYTES && next_differs && *version > 0 {
                (reply.more, reply.version) = (true, *version);
                break;
            }
        }
        reply
    }
}

impl Fed {
    /// A copy of what the waiting views may need.
    fn clone_for(&self, waiting: &[Waiting]) -> Self {
        if waiting.is_empty() {
            Self::default()
        } else {
            self.clone()
        }
    }
}

impl std::fmt::Debug for FrameServer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("FrameServer")
            .field("waiting", &self.waiting.len())
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use maulstick_bus::bus::Answer;
    use maulstick_bus::{Faults, MemoryNet};
    use maulstick_types::decode;

    use super::*;

    const ME: Origin = Origin {
        source: 9,
        epoch: 5,
    };

    struct Rig {
        net: MemoryNet,
        server: FrameServer,
        feed: Feed,
    }

    fn rig() -> Rig {
        let net = MemoryNet::new(1, 0, Faults::default());
        let feed = Feed::new();
        let studio = Studio::daylight();
        {
            let mut fed = feed.lock();
            let ground = vec![0.95; studio.wavelengths()];
            let surface = FedSurface {
                cells: [200, 130],
                grid: [4, 3],
                ground,
                tiles: BTreeMap::new(),
            };
            fed.surfaces.insert(0, surface);
            fed.studio = Some(Arc::new(studio));
        }
        let bus: Arc<dyn Bus> = Arc::new(net.bus());
        let server = FrameServer::new(bus, "frame", feed.clone(), &Wake::new(), ME).expect("one");
        Rig { net, server, feed }
    }

    fn ask(rig: &mut Rig, asked: &FrameRequest) -> Option<FrameReply> {
        let bytes = encode(&ME, Flags::NONE, 0, 0, 0, asked).expect("encoded");
        let limit = Duration::from_secs(1);
        let pending = rig
            .net
            .bus()
            .ask("frame", bytes, limit, &Wake::new())
            .expect("asked");
        rig.net.advance(1);
        rig.server.turn();
        rig.net.advance(1);
        match pending.try_recv() {
            Some(Answer::Bytes(bytes)) => Some(decode(&bytes).expect("a reply").1),
            _ => None,
        }
    }

    fn request(since: u64, epoch: u32, level: u32) -> FrameRequest {
        FrameRequest {
            surface: 0,
            since,
            epoch,
            tiles: [0, 0, 100, 100],
            level,
            wait_ms: 300,
        }
    }

    fn paint(rig: &Rig, id: TileId, version: u64) {
        let mut fed = rig.feed.lock();
        fed.version = version;
        if let Some(surface) = fed.surfaces.get_mut(&0) {
            surface.tiles.insert(id, (version, None));
        }
    }

    #[test]
    fn a_new_view_gets_all_tiles_and_then_only_what_changed() {
        let mut rig = rig();
        paint(&rig, TileId { x: 1, y: 1 }, 7);
        let all = ask(&mut rig, &request(0, 0, 0)).expect("at once");
        assert_eq!((all.tiles.len(), all.version, all.epoch), (12, 7, 5));
        assert_eq!(ask(&mut rig, &request(7, 5, 0)), None, "it waits for news");
        paint(&rig, TileId { x: 3, y: 0 }, 8);
        let news = ask(&mut rig, &request(7, 5, 0)).expect("news");
        assert_eq!(
            news.tiles.iter().map(|t| (t.x, t.y)).collect::<Vec<_>>(),
            vec![(3, 0)]
        );
    }

    #[test]
    fn an_unpainted_canvas_is_sent_once() {
        let mut rig = rig();
        let all = ask(&mut rig, &request(0, 0, 0)).expect("at once");
        assert_eq!(all.tiles.len(), 12);
        assert_eq!(
            ask(&mut rig, &request(all.version, 5, 0)),
            None,
            "it waits for news"
        );
    }

    #[test]
    fn a_coarse_tile_is_news_when_any_of_its_cells_is() {
        let mut rig = rig();
        paint(&rig, TileId { x: 3, y: 2 }, 4);
        let news = ask(&mut rig, &request(3, 5, 2)).expect("news");
        assert_eq!((news.tiles.len(), news.cells), (1, [50, 33]));
    }

    #[test]
    fn a_view_of_an_earlier_epoch_gets_everything_anew() {
        let mut rig = rig();
        assert_eq!(
            ask(&mut rig, &request(99, 4, 0)).map(|reply| reply.tiles.len()),
            Some(12)
        );
    }
}
