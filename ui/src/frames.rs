//! The threads that pull frames: for each surface one query in flight, asked again as soon as it is
//! answered.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use maulstick_bus::typed::ask;
use maulstick_bus::{Bus, BusError, Class, Wake};
use maulstick_paint::tile::TILE_CELLS;
use maulstick_rig::Stop;
use maulstick_types::Origin;
use maulstick_types::paint::{FrameReply, FrameRequest};

/// A frame that does not come within this time is asked for again.
const LIMIT: Duration = Duration::from_millis(500);
/// How long the paint node may wait for something to change, ms.
const WAIT_MS: u32 = 200;
/// Bytes of a plane of half floats.
const HALVES: usize = 2 * TILE_CELLS;
/// Where the heights begin in a tile's planes: behind red, green, blue, gloss and wetness.
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

/// What a reply brought.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shown {
    /// Cells of the surface at this level.
    pub cells: [u32; 2],
    /// The level.
    pub level: u32,
    /// Epoch of the paint node.
    pub epoch: u32,
    /// Whether further tiles come with the next reply.
    pub more: bool,
    /// Changed tiles.
    pub tiles: Vec<ShownTile>,
}

/// Replies that the window has not yet taken, and the level that it wants.
#[derive(Clone, Debug, Default)]
pub struct FrameInbox {
    replies: Arc<Mutex<Vec<Shown>>>,
    level: Arc<AtomicU32>,
}

impl FrameInbox {
    /// Takes what has come.
    #[must_use]
    pub fn take(&self) -> Vec<Shown> {
        std::mem::take(&mut *self.replies.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Asks for another level from the next frame on.
    pub fn want_level(&self, level: u32) {
        self.level.store(level, Ordering::Relaxed);
    }

    fn push(&self, shown: Shown) {
        self.replies
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(shown);
    }
}

/// Where frames come from.
#[derive(Clone)]
pub struct FrameSource {
    /// The bus.
    pub bus: Arc<dyn Bus>,
    /// The query.
    pub topic: String,
    /// Who asks.
    pub me: Origin,
    /// The surface.
    pub surface: u32,
}

/// Pulls frames until `stop` says so; rings `wake` when one has come.
pub fn pull(source: &FrameSource, inbox: &FrameInbox, wake: &Wake, stop: &Stop) {
    let (mut since, mut epoch, mut look, mut level) = (0, 0, 0, u32::MAX);
    while !stop.requested() {
        let wanted = inbox.level.load(Ordering::Relaxed);
        if wanted != level {
            (since, epoch, level) = (0, 0, wanted);
        }
        let request = FrameRequest {
            surface: source.surface,
            since,
            epoch,
            tiles: [0, 0, u32::MAX, u32::MAX],
            level,
            wait_ms: WAIT_MS,
            look,
        };
        let FrameSource { bus, topic, me, .. } = source;
        match ask::<_, FrameReply>(&**bus, topic, Class::Data, *me, &request, LIMIT) {
            Ok(reply) => {
                (since, epoch, look) = (reply.version, reply.epoch, reply.look);
                if !reply.tiles.is_empty() {
                    inbox.push(convert(&reply));
                    wake.ring();
                }
            }
            Err(BusError::NoAnswer { .. }) => {
                // The paint node is starting: the picture stays, and is asked for again.
                std::thread::sleep(Duration::from_millis(50));
            }
            Err(error) => tracing::warn!("{error}"),
        }
    }
}

fn convert(reply: &FrameReply) -> Shown {
    let tiles = reply.tiles.iter().filter_map(|tile| {
        let (colour, height) = texels(&tile.planes)?;
        Some(ShownTile {
            x: tile.x,
            y: tile.y,
            colour,
            height,
        })
    });
    Shown {
        cells: reply.cells,
        level: reply.level,
        epoch: reply.epoch,
        more: reply.more,
        tiles: tiles.collect(),
    }
}

/// The planes of a tile as texels of colour and gloss, and of height; none where the length is
/// wrong. See [`DisplayTile::to_bytes`](maulstick_paint::display::DisplayTile::to_bytes).
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

#[cfg(test)]
mod tests {
    use half::f16;
    use maulstick_paint::display::DisplayTile;

    use super::*;

    #[test]
    fn texels_are_the_planes_of_a_tile() {
        let plane = |from: f32| (0..TILE_CELLS).map(|i| from + i as f32 / 8192.0).collect();
        let tile = DisplayTile {
            rgb: [plane(0.0), plane(1.0), plane(2.0)],
            gloss: plane(0.5),
            wetness: plane(7.0),
            height: plane(0.25),
        };
        let (colour, height) = texels(&tile.to_bytes()).expect("whole");
        let half = |place: usize| f16::from_le_bytes([colour[2 * place], colour[2 * place + 1]]);
        for cell in [0, 1, 64, 4095] {
            let texel = [0, 1, 2, 3].map(|channel| half(4 * cell + channel).to_f32());
            let planes = [&tile.rgb[0], &tile.rgb[1], &tile.rgb[2], &tile.gloss];
            for (got, plane) in texel.iter().zip(planes) {
                assert!((got - plane[cell]).abs() < 2e-3, "{cell}: {texel:?}");
            }
            assert_eq!(height[4 * cell..][..4], tile.height[cell].to_le_bytes());
        }
        assert_eq!(texels(&tile.to_bytes()[1..]), None);
    }
}
