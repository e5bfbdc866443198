//! Pictures of what changed, for whoever asks: a thread of its own between the paint and its views.
//!
//! The stepper hands over versions of tiles, which are shared and never copied; colour is computed
//! here, only for tiles that someone looks at.

mod pyramid;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use maulstick_bus::typed::Reader;
use maulstick_bus::{Bus, BusError, Request, Server, Wake};
use maulstick_optics::Studio;
use maulstick_paint::bare::Bare;
use maulstick_paint::tile::{Tile, TileId};
use maulstick_types::paint::{FrameHolds, FrameReply, FrameRequest, FrameTile};
use maulstick_types::{Flags, Origin, encode};

use pyramid::{BARE_VERSIONS, Pyramid, coarsest, grid};

/// A reply holds at most this much; the rest comes with the next one, bytes.
const REPLY_BYTES: usize = 16 << 20;
/// Longest wait for a change, ms.
const LONGEST_WAIT_MS: u32 = 400;

/// A surface as its views see it.
#[derive(Clone, Debug)]
pub struct FedSurface {
    /// Cells across and up.
    pub cells: [u32; 2],
    /// Tiles across and up.
    pub grid: [u32; 2],
    /// What it shows where nothing was painted.
    pub bare: Arc<Bare>,
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
            version: BARE_VERSIONS + fed.version,
            level: 0,
            cells: [0; 2],
            journal: fed.journal,
            holds: fed.holds.clone(),
            more: false,
            tiles: Vec::new(),
        };
        let (Some(surface), Some(studio)) = (fed.surfaces.get(&asked.surface), &fed.studio) else {
            return reply;
        };
        let level = asked.level.min(coarsest(surface));
        reply.level = level;
        reply.cells = surface.cells.map(|cells| cells.div_ceil(1 << level));
        let since = if asked.epoch == self.me.epoch {
            asked.since
        } else {
            0
        };
        let grid = grid(surface, level);
        let mut changed = Vec::new();
        for y in asked.tiles[1]..asked.tiles[3].min(grid[1]) {
            for x in asked.tiles[0]..asked.tiles[2].min(grid[0]) {
                let id = TileId { x, y };
                let version = Pyramid::version(surface, level, id);
                if version > since {
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
            // No two tiles share a version, so the rest can be asked for from any of them on.
            if bytes >= REPLY_BYTES && place + 1 < changed.len() {
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
mod tests;
