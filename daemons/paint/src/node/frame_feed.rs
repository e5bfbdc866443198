//! State that the paint node hands over to the frames: versions of tiles, the look, bare surfaces.

use std::collections::BTreeMap;
use std::sync::Arc;

use maulstick_painting::Painting;
use maulstick_types::paint::FrameHolds;

use super::PaintNode;
use crate::frames::{FedSurface, FrameState, Progress};

/// Least time between two hand-overs to the frames, ns.
pub(super) const FEED_PERIOD_NS: u64 = 8_000_000;

/// Least time between two hand-overs of what brushes carry, and how long after a view asked they are
/// handed over, ns.
const CARRIED_PERIOD_NS: u64 = 66_000_000;
const WATCHED_NS: u64 = 2_000_000_000;

impl PaintNode {
    /// Hands over the brushes' loads while a view wants them: as far as steps are settled, for the model waits for no
    /// view.
    pub(super) fn hand_over_brushes(&mut self, now_ns: u64) {
        if now_ns < self.fed_brushes_ns + CARRIED_PERIOD_NS {
            return;
        }
        self.fed_brushes_ns = now_ns;
        let painting = self.sequencer.painting();
        let mut fed = self.feed.lock();
        if now_ns > fed.watched_ns.saturating_add(WATCHED_NS) {
            return;
        }
        let mut news = false;
        for (brush, carried) in painting.carried() {
            if !fed.carried.get(brush).is_some_and(|fed| fed.is(&carried)) {
                fed.carried.insert(brush.to_owned(), carried);
                news = true;
            }
        }
        // A paint may be new with them; another light comes with the surfaces.
        let known = fed.look.as_ref().map(|look| look.generation());
        if news && known == Some(painting.look().generation()) {
            fed.look = Some(Arc::clone(painting.look()));
        }
        drop(fed);
        if news {
            self.feed.ring();
        }
    }

    /// Surfaces and optics, before anything is painted.
    pub(super) fn feed_first(&self) {
        let painting = self.sequencer.painting();
        let mut fed = self.feed.lock();
        fed.look = Some(Arc::clone(painting.look()));
        for surface in &painting.scene().surfaces {
            let (Some(store), Some(bare)) = (painting.store(surface.id), painting.bare(surface.id))
            else {
                continue;
            };
            let (cells, grid) = (store.cells(), store.grid());
            fed.surfaces.insert(
                surface.id,
                FedSurface {
                    cells,
                    grid,
                    bare: Arc::clone(bare),
                    tiles: BTreeMap::new(),
                },
            );
        }
        feed_versions(&mut fed, painting, self.fed_version);
        fed.version = painting.versions();
    }

    /// Hands new versions over, if a view waits for them.
    pub(super) fn hand_over(&mut self, now_ns: u64) {
        let relit = self.fed_look != self.sequencer.painting().look().generation();
        let due = now_ns >= self.fed_ns + FEED_PERIOD_NS && self.feed.lock().wanted;
        if !due && !relit {
            return;
        }
        self.fed_ns = now_ns;
        self.sequencer.painting_mut().commit();
        let painting = self.sequencer.painting();
        let news = relit || painting.versions() > self.fed_version;
        let mut fed = self.feed.lock();
        // The tiles may hold paints that are new too: both are handed over in one piece.
        if self.fed_scene != painting.scene().version {
            self.fed_scene = painting.scene().version;
            fed.look = Some(Arc::clone(painting.look()));
        }
        if painting.versions() > self.fed_version {
            feed_versions(&mut fed, painting, self.fed_version);
            self.fed_version = painting.versions();
        }
        if relit {
            self.fed_look = painting.look().generation();
            feed_light(&mut fed, painting);
        }
        fed.version = self.fed_version;
        fed.journal = self.sequencer.journal_next();
        fed.holds = self
            .sequencer
            .consumed_all()
            .into_iter()
            .map(|(origin, next)| FrameHolds {
                brush: origin.source,
                epoch: origin.epoch,
                next,
            })
            .collect();
        if news {
            fed.wanted = false;
            drop(fed);
            self.feed.ring();
        }
    }
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
