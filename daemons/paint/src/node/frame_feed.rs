//! State that the paint node hands to the frames: versions of tiles, the look, bare surfaces.

use std::collections::BTreeMap;
use std::sync::Arc;

use maulstick_painting::{Painting, Sequencer};
use maulstick_types::paint::FrameHolds;

use crate::frames::{FedSurface, Feed, FrameState, Progress};

/// Least time between two updates of the frames, ns.
const PERIOD_NS: u64 = 8_000_000;
/// Least time between two updates of the brushes' loads, ns.
const LOADS_PERIOD_NS: u64 = 66_000_000;
/// Time after a view asked for which it counts as there, ns.
const WATCHED_NS: u64 = 2_000_000_000;

/// Feed of the frames, and how far it is up to date.
pub(super) struct FrameFeed {
    feed: Feed,
    /// Newest tile version in the feed.
    version: u64,
    /// Version of the scene whose look is in the feed.
    scene: u64,
    /// Generation of that look.
    look: u64,
    /// Time of the last update, ns.
    updated_ns: u64,
    /// Time of the last update of the brushes' loads, ns.
    loads_ns: u64,
}

impl FrameFeed {
    /// A feed with the surfaces and the optics of a painting.
    pub(super) fn new(painting: &Painting) -> Self {
        let feed = Feed::new();
        let mut fed = feed.lock();
        fed.look = Some(Arc::clone(painting.look()));
        for surface in &painting.scene().surfaces {
            let (Some(store), Some(bare)) = (painting.store(surface.id), painting.bare(surface.id))
            else {
                continue;
            };
            let surface_fed = FedSurface {
                cells: store.cells(),
                grid: store.grid(),
                bare: Arc::clone(bare),
                tiles: BTreeMap::new(),
            };
            fed.surfaces.insert(surface.id, surface_fed);
        }
        feed_versions(&mut fed, painting, 1);
        fed.version = painting.versions();
        drop(fed);
        Self {
            feed,
            version: 1,
            scene: painting.scene().version,
            look: painting.look().generation(),
            updated_ns: 0,
            loads_ns: 0,
        }
    }

    /// The feed, for who serves the frames.
    pub(super) fn shared(&self) -> Feed {
        self.feed.clone()
    }

    /// Progress of baked tiles under another light.
    pub(super) fn baking(&self) -> Progress {
        self.feed.lock().baking
    }

    /// Updates the brushes' loads while a view wants them: as far as steps are settled, for the model waits for no
    /// view.
    pub(super) fn update_loads(&mut self, painting: &Painting, now_ns: u64) {
        if now_ns < self.loads_ns + LOADS_PERIOD_NS {
            return;
        }
        self.loads_ns = now_ns;
        let mut fed = self.feed.lock();
        if now_ns > fed.watched_ns.saturating_add(WATCHED_NS) {
            return;
        }
        let mut is_new = false;
        for (brush, carried) in painting.carried() {
            if !fed.carried.get(brush).is_some_and(|fed| fed.is(&carried)) {
                fed.carried.insert(brush.to_owned(), carried);
                is_new = true;
            }
        }
        // A paint may be new with them; another light comes with the surfaces.
        let known = fed.look.as_ref().map(|look| look.generation());
        if is_new && known == Some(painting.look().generation()) {
            fed.look = Some(Arc::clone(painting.look()));
        }
        drop(fed);
        if is_new {
            self.feed.ring();
        }
    }

    /// Updates the frames between two states, if their period is over.
    pub(super) fn update_while_painting(&mut self, sequencer: &mut Sequencer, now_ns: u64) {
        if now_ns >= self.updated_ns + PERIOD_NS {
            self.update(sequencer, now_ns);
        }
    }

    /// Updates the frames, if a view waits for them or the light is another.
    pub(super) fn update(&mut self, sequencer: &mut Sequencer, now_ns: u64) {
        let is_relit = self.look != sequencer.painting().look().generation();
        let is_due = now_ns >= self.updated_ns + PERIOD_NS && self.feed.lock().wanted;
        if !is_due && !is_relit {
            return;
        }
        self.updated_ns = now_ns;
        sequencer.painting_mut().commit();
        let painting = sequencer.painting();
        let has_tiles = painting.versions() > self.version;
        let mut fed = self.feed.lock();
        // The tiles may hold paints that are new too: both are handed over in one piece.
        if self.scene != painting.scene().version {
            self.scene = painting.scene().version;
            fed.look = Some(Arc::clone(painting.look()));
        }
        if has_tiles {
            feed_versions(&mut fed, painting, self.version);
            self.version = painting.versions();
        }
        if is_relit {
            self.look = painting.look().generation();
            feed_light(&mut fed, painting);
        }
        fed.version = self.version;
        fed.journal = sequencer.journal_next();
        fed.holds = holds(sequencer);
        if is_relit || has_tiles {
            fed.wanted = false;
            drop(fed);
            self.feed.ring();
        }
    }
}

/// Consumed states of each brush.
fn holds(sequencer: &Sequencer) -> Vec<FrameHolds> {
    let consumed = sequencer.consumed_all().into_iter();
    let holds = consumed.map(|(origin, next)| FrameHolds {
        brush: origin.source,
        epoch: origin.epoch,
        next,
    });
    holds.collect()
}

/// Hands over what surfaces show where nothing was painted, under another light, and how many tiles
/// are to be baked for it.
fn feed_light(fed: &mut FrameState, painting: &Painting) {
    for (number, surface) in &mut fed.surfaces {
        if let Some(bare) = painting.bare(*number) {
            surface.bare = Arc::clone(bare);
        }
    }
    fed.baking = Progress {
        all: fed
            .surfaces
            .values()
            .map(|surface| surface.dry_tiles().count() as u32)
            .sum(),
        done: 0,
    };
}

/// Adds the versions above `since` to what was fed.
fn feed_versions(fed: &mut FrameState, painting: &Painting, since: u64) {
    for (number, surface) in &mut fed.surfaces {
        let Some(store) = painting.store(*number) else {
            continue;
        };
        for (id, version) in store.iter().filter(|(_, version)| version.number > since) {
            surface
                .tiles
                .insert(id, (version.number, version.tile.clone()));
        }
    }
}
