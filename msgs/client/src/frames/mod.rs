//! Threads that pull frames: one query in flight for each surface, repeated as soon as it is answered.
//!
//! | module | content |
//! | --- | --- |
//! | [`tiles`] | tiles that a view wants |
//! | [`tile_planner`] | the next query, so that the view's sheets hold them |

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use half::f16;
use maulstick_bus::bus::Answer;
use maulstick_bus::{Bus, BusError, Payload, Qos, Wake};
use maulstick_rig::Stop;
use maulstick_types::paint::{FrameHolds, FrameRequest, TILE};
use maulstick_types::{DecodeError, Flags, FrameView, Origin, encode};

use tile_planner::{Asked, AtlasState, Part, TilePlanner};
use tiles::Wanted;

pub mod tile_planner;
pub mod tiles;

/// A frame that does not arrive within this time, and what the paint node may wait, is requested again.
const LIMIT: Duration = Duration::from_millis(500);
/// Pause between two queries that nobody answers.
const PAUSE: Duration = Duration::from_millis(50);
/// Longest time the paint node may wait for a change after the last one, ms; it doubles with each wait in vain.
const WAIT_MS: u32 = 200;
/// The same at rest, ms.
const REST_MS: u32 = 1600;
/// So many frames in a row that came only through the socket: shared memory does not work.
const STRIKES: u32 = 3;
/// Cells of a tile.
const TILE_CELLS: usize = TILE * TILE;
/// Bytes of a plane of half floats.
const HALVES: usize = 2 * TILE_CELLS;
/// Start of the wetness in a tile's planes: after red, green, blue and gloss.
const WETNESS: usize = 4 * HALVES;
/// Colour of the tint of wet paint, linear, and how strong it is.
const WET: [f32; 3] = [0.0, 0.35, 1.0];
const WET_SHARE: f32 = 0.6;
/// Start of the heights in a tile's planes: after red, green, blue, gloss and wetness.
const HEIGHTS: usize = 5 * HALVES;

/// A tile as the textures take it: rows upward from the lowest, 64×64 texels.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownTile {
    /// Column.
    pub x: u32,
    /// Row, 0 at the bottom.
    pub y: u32,
    /// Linear red, green, blue, and gloss: four half floats a texel.
    pub colour: Vec<u8>,
    /// m, a float a texel.
    pub height: Vec<u8>,
}

/// Content of a reply.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shown {
    /// The atlas that the tiles belong to.
    pub part: Part,
    /// That atlas with these tiles.
    pub atlas: AtlasState,
    /// Cells of the surface at the atlas's level.
    pub cells: [u32; 2],
    /// Changed tiles.
    pub tiles: Vec<ShownTile>,
    /// The journal entries below this index are in the detail; 0 if this reply does not say.
    pub journal: u64,
    /// The brush states that are in the detail; empty if this reply does not say.
    pub holds: Vec<FrameHolds>,
}

/// Replies that the window has not yet taken, and what it wants.
#[derive(Clone, Debug, Default)]
pub struct FrameInbox {
    replies: Arc<Mutex<Vec<Shown>>>,
    wanted: Arc<Mutex<Option<Wanted>>>,
    fault: Arc<Mutex<Option<DecodeError>>>,
    progress: Arc<Mutex<[u32; 2]>>,
    asking: Wake,
}

fn locked<T>(of: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    of.lock().unwrap_or_else(PoisonError::into_inner)
}

impl FrameInbox {
    /// Takes what has come.
    #[must_use]
    pub fn take(&self) -> Vec<Shown> {
        std::mem::take(&mut *locked(&self.replies))
    }

    /// Requests this from the next frame on; nothing is requested before.
    pub fn want(&self, wanted: Wanted) {
        if locked(&self.wanted).replace(wanted) != Some(wanted) {
            self.wake();
        }
    }

    /// Wakes the thread that pulls, so that it sees whether it is to stop.
    pub fn wake(&self) {
        self.asking.ring();
    }

    /// The error, while the replies of the paint node cannot be read.
    #[must_use]
    pub fn fault(&self) -> Option<DecodeError> {
        locked(&self.fault).clone()
    }

    /// Tiles that have arrived of those that are missing in the view, and those in all.
    #[must_use]
    pub fn progress(&self) -> [u32; 2] {
        *locked(&self.progress)
    }

    fn wanted(&self) -> Option<Wanted> {
        *locked(&self.wanted)
    }
}

/// Source of frames.
#[derive(Clone)]
pub struct FrameSource {
    /// Bus on which frames are requested.
    pub bus: Arc<dyn Bus>,
    /// Topic of the query.
    pub topic: String,
    /// Origin of the queries.
    pub me: Origin,
    /// Number of the surface.
    pub surface: u32,
}

/// Pulls frames until `stop` says so; rings `wake` when one has come.
pub fn pull(source: &FrameSource, inbox: &FrameInbox, wake: &Wake, stop: &Stop) {
    let mut puller = Puller {
        source,
        inbox,
        stop,
        plan: TilePlanner::default(),
        strikes: 0,
        told: BTreeSet::new(),
        newest: (0, Vec::new()),
        wait_ms: WAIT_MS,
    };
    let mut before = None;
    while !stop.requested() {
        match inbox.wanted() {
            Some(wanted) => {
                if before.replace(wanted) != Some(wanted) {
                    puller.wait_ms = WAIT_MS;
                }
                let shown = puller.turn(&wanted);
                *locked(&inbox.progress) = puller.plan.progress();
                match shown {
                    Some(shown) => {
                        locked(&inbox.replies).push(shown);
                        wake.ring();
                        puller.wait_ms = WAIT_MS;
                    }
                    None => puller.wait_ms = (2 * puller.wait_ms).min(REST_MS),
                }
            }
            None => {
                inbox.asking.wait(PAUSE);
            }
        }
    }
}

struct Puller<'a> {
    source: &'a FrameSource,
    inbox: &'a FrameInbox,
    stop: &'a Stop,
    plan: TilePlanner,
    strikes: u32,
    told: BTreeSet<String>,
    /// The journal state last passed to the window.
    newest: (u64, Vec<FrameHolds>),
    /// Time that the paint node may wait for a change, ms.
    wait_ms: u32,
}

/// Outcome of a query.
enum Told {
    Answer(Payload),
    Nothing,
    /// The view wants something else by now.
    Late,
}

impl Puller<'_> {
    /// One question, and what its answer brings.
    fn turn(&mut self, wanted: &Wanted) -> Option<Shown> {
        let asked = self.plan.next(wanted);
        let answer = match self.ask(&asked) {
            Ok(answer) => answer?,
            Err(error) => {
                self.tell(error.to_string());
                self.pause(LIMIT);
                return None;
            }
        };
        match FrameView::of(&answer) {
            Ok((_, reply)) => {
                *locked(&self.inbox.fault) = None;
                self.shown(&asked, &reply)
            }
            Err(error) => {
                self.tell(error.to_string());
                *locked(&self.inbox.fault) = Some(error);
                self.pause(LIMIT);
                None
            }
        }
    }

    fn tell(&mut self, what: String) {
        if self.told.insert(what.clone()) {
            tracing::warn!("{}: {what}", self.source.topic);
        }
    }

    /// Waits, but not where it is time to stop.
    fn pause(&self, limit: Duration) {
        let until = Instant::now() + limit;
        while !self.stop.requested() && Instant::now() < until {
            self.inbox.asking.wait(PAUSE);
        }
    }

    /// Queries with shared memory first, then without: a reply that is lost on one path arrives on the other.
    fn ask(&mut self, asked: &Asked) -> Result<Option<Payload>, BusError> {
        if self.strikes < STRIKES {
            match self.ask_once(asked, true)? {
                Told::Answer(answer) => {
                    self.strikes = 0;
                    return Ok(Some(answer));
                }
                Told::Late => return Ok(None),
                Told::Nothing if self.stop.requested() => return Ok(None),
                Told::Nothing => {}
            }
        }
        match self.ask_once(asked, false)? {
            Told::Answer(answer) => {
                self.strikes += 1;
                if self.strikes == STRIKES {
                    tracing::info!(
                        "pictures of the painting do not come through shared memory; from now on \
                         they go through the socket, which takes longer"
                    );
                }
                Ok(Some(answer))
            }
            Told::Nothing => {
                // The paint node is starting: the picture stays, and is requested again.
                self.pause(PAUSE);
                Ok(None)
            }
            Told::Late => Ok(None),
        }
    }

    fn ask_once(&self, asked: &Asked, shared: bool) -> Result<Told, BusError> {
        let FrameSource {
            bus,
            topic,
            me,
            surface,
        } = self.source;
        let (epoch, look) = self.plan.of();
        let wait_ms = match asked.part {
            Part::Base => 0,
            Part::Detail => self.wait_ms,
        };
        let request = FrameRequest {
            surface: *surface,
            since: asked.since,
            epoch,
            tiles: asked.tiles.to_request(),
            level: asked.level,
            wait_ms,
            look,
            shared,
        };
        let now_ns = bus.now_ns();
        let bytes = encode(me, Flags::NONE, 0, now_ns, now_ns, &request).map_err(|source| {
            BusError::Message {
                topic: topic.clone(),
                source,
            }
        })?;
        let asking = &self.inbox.asking;
        let limit = LIMIT + Duration::from_millis(wait_ms.into());
        let pending = bus.ask(topic, Qos::Data, bytes, limit, asking)?;
        let give_up = Instant::now() + limit + PAUSE;
        while !self.stop.requested() {
            match pending.try_recv() {
                Some(Answer::Bytes(answer)) => return Ok(Told::Answer(answer)),
                Some(Answer::Ended) => break,
                None => {}
            }
            let wanted = self.inbox.wanted();
            if wanted.is_some_and(|wanted| self.plan.is_late(asked, &wanted)) {
                return Ok(Told::Late);
            }
            let left = give_up.saturating_duration_since(Instant::now());
            if left.is_zero() {
                break;
            }
            asking.wait(left);
        }
        Ok(Told::Nothing)
    }

    /// Content of a reply for the window, if any.
    fn shown(&mut self, asked: &Asked, reply: &FrameView<'_>) -> Option<Shown> {
        let before = self.plan.atlas(asked.part);
        if !self.plan.take(asked, reply) {
            self.pause(PAUSE);
            return None;
        }
        let atlas = self.plan.atlas(asked.part);
        let tells = asked.part == Part::Detail && !reply.more && atlas.held == asked.tiles;
        let newest = (reply.journal, reply.holds.clone());
        let events = tells && self.newest != newest;
        if reply.tiles.is_empty() && before == atlas && !events {
            return None;
        }
        if tells {
            self.newest = newest;
        }
        let tiles = reply.tiles.iter().filter_map(|tile| {
            let (mut colour, height) = texels(tile.planes)?;
            if atlas.wet {
                tint_wet(&mut colour, tile.planes);
            }
            Some(ShownTile {
                x: tile.x,
                y: tile.y,
                colour,
                height,
            })
        });
        Some(Shown {
            part: asked.part,
            atlas,
            cells: reply.cells,
            tiles: tiles.collect(),
            journal: if tells { reply.journal } else { 0 },
            holds: if tells {
                reply.holds.clone()
            } else {
                Vec::new()
            },
        })
    }
}

/// The planes of a tile as texels of colour and gloss, and of height; `None` if the length is wrong. See
/// `DisplayTile::to_bytes` of `maulstick-appearance`.
#[must_use]
pub fn texels(planes: &[u8]) -> Option<(Vec<u8>, Vec<u8>)> {
    if planes.len() != HEIGHTS + 4 * TILE_CELLS {
        return None;
    }
    let mut colour = Vec::with_capacity(4 * HALVES);
    for cell in 0..TILE_CELLS {
        for plane in 0..4 {
            colour.extend_from_slice(&planes[plane * HALVES + 2 * cell..][..2]);
        }
    }
    Some((colour, planes[HEIGHTS..].to_vec()))
}

/// Tints the colours of [`texels`] where the paint of the same planes is wet.
fn tint_wet(colour: &mut [u8], planes: &[u8]) {
    let half = |bytes: &[u8]| f16::from_le_bytes([bytes[0], bytes[1]]).to_f32();
    for (cell, texel) in colour.chunks_exact_mut(8).enumerate() {
        let share = WET_SHARE * half(&planes[WETNESS + 2 * cell..]).clamp(0.0, 1.0);
        for (value, tint) in texel.chunks_exact_mut(2).zip(WET) {
            let own = half(value);
            value.copy_from_slice(&f16::from_f32(own + share * (tint - own)).to_le_bytes());
        }
    }
}

#[cfg(test)]
mod tests;
