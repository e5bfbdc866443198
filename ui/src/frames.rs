//! The thread that pulls frames: one query in flight, asked again as soon as it is answered.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use eframe::egui::{Color32, Context};
use maulstick_bus::typed::ask;
use maulstick_bus::{Bus, BusError, Class};
use maulstick_optics::colour::{SrgbTable, clamp_chromaticity};
use maulstick_paint::display::DisplayTile;
use maulstick_rig::Stop;
use maulstick_types::Origin;
use maulstick_types::paint::{FrameReply, FrameRequest};
use maulstick_types::scene::CANVAS;

/// A frame that does not come within this time is asked for again.
const LIMIT: Duration = Duration::from_millis(500);
/// How long the paint node may wait for something to change, ms.
const WAIT_MS: u32 = 200;

/// A tile ready for the screen: rows upward from the lowest.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownTile {
    /// Column.
    pub x: u32,
    /// Row, 0 at the bottom.
    pub y: u32,
    /// 64×64 pixels.
    pub pixels: Vec<Color32>,
}

/// What a reply brought.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shown {
    /// Cells of the canvas at this level.
    pub cells: [u32; 2],
    /// The level.
    pub level: u32,
    /// Epoch of the paint node.
    pub epoch: u32,
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

/// Pulls frames until `stop` says so.
pub fn pull(
    bus: &dyn Bus,
    topic: &str,
    me: Origin,
    inbox: &FrameInbox,
    context: &Context,
    stop: &Stop,
) {
    let table = SrgbTable::default();
    let (mut since, mut epoch, mut level) = (0, 0, u32::MAX);
    while !stop.requested() {
        let wanted = inbox.level.load(Ordering::Relaxed);
        if wanted != level {
            (since, epoch, level) = (0, 0, wanted);
        }
        let request = FrameRequest {
            surface: CANVAS,
            since,
            epoch,
            tiles: [0, 0, u32::MAX, u32::MAX],
            level,
            wait_ms: WAIT_MS,
        };
        match ask::<_, FrameReply>(bus, topic, Class::Data, me, &request, LIMIT) {
            Ok(reply) => {
                (since, epoch) = (reply.version, reply.epoch);
                if !reply.tiles.is_empty() {
                    inbox.push(convert(&reply, &table));
                    context.request_repaint();
                }
            }
            Err(BusError::NoAnswer { .. }) => {
                // The paint node is starting: the picture stays, and is asked for again.
                std::thread::sleep(Duration::from_millis(50));
            }
            Err(error) => tracing::warn!("{error}"),
        }
    }
    context.request_repaint();
}

fn convert(reply: &FrameReply, table: &SrgbTable) -> Shown {
    let tiles = reply
        .tiles
        .iter()
        .filter_map(|tile| {
            let shown = DisplayTile::from_bytes(&tile.planes)?;
            let pixel = |cell: usize| {
                let rgb = clamp_chromaticity([0, 1, 2].map(|channel| shown.rgb[channel][cell]));
                let [r, g, b] = rgb.map(|channel| table.byte(channel));
                Color32::from_rgb(r, g, b)
            };
            let pixels = (0..shown.height.len()).map(pixel).collect();
            Some(ShownTile {
                x: tile.x,
                y: tile.y,
                pixels,
            })
        })
        .collect();
    Shown {
        cells: reply.cells,
        level: reply.level,
        epoch: reply.epoch,
        tiles,
    }
}
