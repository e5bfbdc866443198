//! Plans the next request to the paint node, so that the atlases of a surface hold the tiles in view.
//!
//! An *atlas* shows one level. The *detail* holds the tiles in view and moves with it, strip by strip; the
//! *base*, of a coarse level, holds the whole surface, and is shown where the detail does not reach.

use maulstick_types::FrameView;

use super::tiles::{TileRect, Wanted};

/// Number of replies after which the base is updated while the detail covers the view; it is also updated when the
/// paint rests.
const BASE_EACH: u32 = 16;

/// One of the two sheets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Part {
    /// The whole surface, coarse.
    Base,
    /// The visible tiles, as fine as the view's pixels.
    #[default]
    Detail,
}

/// An atlas, as far as it is filled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AtlasState {
    /// Its number: another one is another picture.
    pub number: u64,
    /// Level of the pyramid, 0 the finest.
    pub level: u32,
    /// Tiles that it has room for, across and up.
    pub room: [u32; 2],
    /// The tiles that have come whole.
    pub held: TileRect,
    /// True if its wet paint is tinted.
    pub wet: bool,
}

/// A query.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Asked {
    /// The atlas it is for.
    pub part: Part,
    /// Level of the pyramid, 0 the finest.
    pub level: u32,
    /// Tiles.
    pub tiles: TileRect,
    /// Newer than this.
    pub since: u64,
    /// True if it waits for changes: other queries need not wait for it.
    pub waits: bool,
}

#[derive(Clone, Copy, Debug, Default)]
struct TileAtlas {
    state: AtlasState,
    /// Journal state of the tiles in the atlas.
    since: u64,
    /// The tiles in flight, and up to which version they have arrived.
    coming: Option<(TileRect, u64)>,
    /// Number of tiles that have arrived.
    arrived: u32,
    /// True if more changes of the tiles in the atlas are pending.
    more: bool,
}

impl TileAtlas {
    /// True if it has this level, room for `size` tiles, and the wanted tint of wet paint.
    fn takes(&self, level: u32, size: [u32; 2], wet: bool) -> bool {
        let AtlasState { room, .. } = self.state;
        let fits = (0..2).all(|i| size[i] <= room[i]);
        let own = self.state.level == level && self.state.wet == wet;
        self.state.number > 0 && own && fits
    }

    /// Lets go of what is not wanted, and sees what is missing.
    fn turn_to(&mut self, tiles: &TileRect) {
        let held = self.state.held.within(tiles);
        self.state.held = held;
        let strip = missing(&held, tiles);
        self.coming = match (self.coming, strip) {
            // The first picture may come whole although the view has moved a little meanwhile.
            (Some((rect, since)), Some(_)) if held.is_empty() && !rect.within(tiles).is_empty() => {
                Some((rect, since))
            }
            (Some((rect, since)), Some(strip)) if rect == strip => Some((rect, since)),
            (_, strip) => {
                self.arrived = 0;
                strip.map(|strip| (strip, 0))
            }
        };
    }

    fn asked(&self, part: Part) -> Asked {
        let (tiles, since) = self.coming.unwrap_or((self.state.held, self.since));
        Asked {
            part,
            level: self.state.level,
            tiles,
            since,
            waits: self.coming.is_none() && !self.more,
        }
    }
}

/// A strip next to `held`, as long as its side, that brings it closer to `wanted`.
fn missing(held: &TileRect, wanted: &TileRect) -> Option<TileRect> {
    if held.is_empty() {
        return (!wanted.is_empty()).then_some(*wanted);
    }
    (0..2).find_map(|i| {
        let mut strip = *held;
        if wanted.from[i] < held.from[i] {
            (strip.from[i], strip.to[i]) = (wanted.from[i], held.from[i]);
        } else if wanted.to[i] > held.to[i] {
            (strip.from[i], strip.to[i]) = (held.to[i], wanted.to[i]);
        } else {
            return None;
        }
        Some(strip)
    })
}

/// The smallest rectangle around two.
fn around(one: &TileRect, other: &TileRect) -> TileRect {
    if one.is_empty() {
        return *other;
    }
    TileRect {
        from: [0, 1].map(|i| one.from[i].min(other.from[i])),
        to: [0, 1].map(|i| one.to[i].max(other.to[i])),
    }
}

/// The state of a puller.
#[derive(Clone, Debug, Default)]
pub struct TilePlanner {
    atlases: [TileAtlas; 2],
    numbers: u64,
    epoch: u32,
    look: u64,
    /// Replies for the detail since the last query for the base.
    behind: u32,
    last: Part,
}

impl TilePlanner {
    /// Epoch and look that all is of.
    #[must_use]
    pub fn of(&self) -> (u32, u64) {
        (self.epoch, self.look)
    }

    /// State of an atlas.
    #[must_use]
    pub fn atlas(&self, part: Part) -> AtlasState {
        self.atlases[part as usize].state
    }

    /// Tiles that have arrived of those in flight, and those in all.
    #[must_use]
    pub fn progress(&self) -> [u32; 2] {
        let coming = self.atlases.iter().filter_map(|atlas| {
            let (rect, _) = atlas.coming?;
            let [across, up] = rect.size();
            Some([atlas.arrived, across * up])
        });
        coming.fold([0; 2], |sum, own| [sum[0] + own[0], sum[1] + own[1]])
    }

    fn begin(&mut self, part: Part, level: u32, room: [u32; 2], wet: bool) {
        self.numbers += 1;
        self.atlases[part as usize] = TileAtlas {
            state: AtlasState {
                number: self.numbers,
                level,
                room,
                held: TileRect::NONE,
                wet,
            },
            ..TileAtlas::default()
        };
    }

    /// The next query for a view that wants this.
    pub fn next(&mut self, wanted: &Wanted) -> Asked {
        if !self.atlases[1].takes(wanted.level, wanted.tiles.size(), wanted.wet) {
            self.begin(Part::Detail, wanted.level, wanted.room, wanted.wet);
        }
        self.atlases[1].turn_to(&wanted.tiles);
        let mut due = false;
        if let Some(level) = wanted.base {
            if !self.atlases[0].takes(level, wanted.base_tiles, wanted.wet) {
                self.begin(Part::Base, level, wanted.base_tiles, wanted.wet);
            }
            self.atlases[0].turn_to(&TileRect::up_to(wanted.base_tiles));
            due = self.atlases[0].coming.is_some()
                || self.atlases[0].more
                || self.atlases[1].coming.is_some()
                || self.behind >= BASE_EACH;
        }
        let part = if due && self.last == Part::Detail {
            Part::Base
        } else {
            Part::Detail
        };
        self.last = part;
        let mut asked = self.atlases[part as usize].asked(part);
        if part == Part::Base {
            self.behind = 0;
            asked.waits = false;
        }
        asked
    }

    /// True if a query that waits for changes delays what the view wants by now.
    #[must_use]
    pub fn is_late(&self, asked: &Asked, wanted: &Wanted) -> bool {
        let detail = &self.atlases[1];
        let own = detail.state.level == wanted.level && detail.state.wet == wanted.wet;
        let same = own && detail.state.held == wanted.tiles;
        let base = wanted
            .base
            .is_none_or(|level| self.atlases[0].takes(level, wanted.base_tiles, wanted.wet));
        asked.waits && !(same && base)
    }

    /// Reads a reply; false if it is of no use and everything is requested again.
    pub fn take(&mut self, asked: &Asked, reply: &FrameView<'_>) -> bool {
        if reply.cells.contains(&0) {
            (self.epoch, self.look) = (reply.epoch, reply.look);
            return false;
        }
        if reply.level != asked.level {
            self.atlases = Default::default();
            return false;
        }
        if reply.epoch != self.epoch {
            // Another start of the paint node: pictures of its own.
            for part in [Part::Base, Part::Detail] {
                let AtlasState {
                    level, room, wet, ..
                } = self.atlas(part);
                if self.atlases[part as usize].state.number > 0 {
                    self.begin(part, level, room, wet);
                }
            }
            self.atlases[asked.part as usize].coming = Some((asked.tiles, 0));
        } else if reply.look != self.look {
            // All are sent again, into the same pictures.
            for atlas in &mut self.atlases {
                atlas.since = 0;
                atlas.more = true;
            }
        }
        (self.epoch, self.look) = (reply.epoch, reply.look);
        let atlas = &mut self.atlases[asked.part as usize];
        match &mut atlas.coming {
            Some((_, since)) if reply.more => {
                *since = reply.version;
                atlas.arrived += reply.tiles.len() as u32;
            }
            Some((tiles, _)) => {
                let whole = atlas.state.held.is_empty();
                atlas.since = if whole {
                    reply.version
                } else {
                    atlas.since.min(reply.version)
                };
                atlas.state.held = around(&atlas.state.held, tiles);
                atlas.coming = None;
            }
            None => {
                atlas.since = reply.version;
                atlas.more = reply.more;
            }
        }
        if asked.part == Part::Detail {
            let rests = asked.waits && reply.tiles.is_empty();
            self.behind += if rests { BASE_EACH } else { 1 };
        }
        true
    }
}

#[cfg(test)]
mod tests;
