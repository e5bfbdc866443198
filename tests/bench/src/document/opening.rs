//! Time until a painting is displayed, and can be painted on.

use std::sync::Arc;
use std::time::{Duration, Instant};

use maulstick_bus::bus::Answer;
use maulstick_bus::{Bus, Faults, MemoryNet, Qos, Wake};
use maulstick_document::{Access, Document, DocumentSettings};
use maulstick_paint_node::PaintNode;
use maulstick_paint_node::frames::FrameServer;
use maulstick_rig::UserError;
use maulstick_types::paint::{FrameReply, FrameRequest};
use maulstick_types::scene::CANVAS;
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Flags, Origin, decode, encode};

use super::fault;
use super::hand::{Easel, Took};
use crate::report::{Report, quantile, sorted};

const CELLS: u32 = 4096;
const STROKES: usize = 300;
const STROKE_M: f64 = 0.06;
/// A window of a thousand pixels shows a canvas of 4,096 cells so: every fourth cell.
const LEVEL: u32 = 2;
const ROUNDS: usize = 5;

/// Time to the picture, and to the paint node's first stroke, ms.
fn once(path: &std::path::Path) -> Result<[f64; 2], UserError> {
    let begun = Instant::now();
    let ms = |since: Instant| 1e3 * since.elapsed().as_secs_f64();
    let settings = DocumentSettings {
        memory: 512 << 20,
        ..DocumentSettings::new(path, Access::Paint)
    };
    let (document, opened) = Document::open(&settings).map_err(fault)?;
    let opened = opened.ok_or_else(|| fault("the painting is gone"))?;
    let since = opened.snapshot().versions;
    let sequencer = opened.sequencer().map_err(fault)?;
    let net = MemoryNet::new(1, 0, Faults::default());
    let bus: Arc<dyn Bus> = Arc::new(net.bus());
    let topics = Topics::new("bench");
    let me = Origin {
        source: 1,
        epoch: 1,
    };
    let wake = Wake::new();
    let node = PaintNode::resume(Arc::clone(&bus), &topics, &wake, me, sequencer)?;
    let frames = FrameServer::new(Arc::clone(&bus), &topics.frame(), node.feed(), &wake, me)?;
    let mut frames = frames.with_tile_cache(document.tile_cache());
    let mut node = node.keeping(document, since);
    let mut asked = FrameRequest {
        surface: CANVAS,
        since: 0,
        epoch: 0,
        tiles: [0, 0, 16, 16],
        level: LEVEL,
        wait_ms: 0,
        look: 0,
        shared: false,
    };
    let mut more = true;
    while more {
        let bytes = encode(&me, Flags::NONE, 0, 0, 0, &asked).map_err(fault)?;
        let limit = Duration::from_secs(60);
        let query = bus.ask(&topics.frame(), Qos::Data, bytes, limit, &Wake::new())?;
        net.advance(1);
        frames.poll();
        net.advance(1);
        let Some(Answer::Bytes(bytes)) = query.try_recv() else {
            return Err(fault("no frame came"));
        };
        let reply: FrameReply = decode(&bytes).map_err(fault)?.1;
        (asked.since, asked.epoch, asked.look) = (reply.version, reply.epoch, reply.look);
        more = reply.more;
    }
    let seen = ms(begun);
    node.poll()?;
    let ready = ms(begun);
    node.close().map_err(fault)?;
    Ok([seen, ready])
}

pub(super) fn run(report: &mut Report) -> Result<(), UserError> {
    let folder = tempfile::tempdir().map_err(fault)?;
    let path = folder.path().join("open.maul");
    let mut easel = Easel::new(&path, CELLS, 512 << 20, 2 << 30)?;
    let mut took = Took::default();
    for stroke in 0..STROKES {
        if stroke % 20 == 0 {
            easel.load()?;
        }
        easel.stroke(STROKE_M, &mut took)?;
    }
    easel.autosave.close(&mut easel.sequencer).map_err(fault)?;
    let first = once(&path)?[0];
    report.row(
        "document: first frame of 4096², never shown before",
        first,
        "ms",
    );
    let mut times = Vec::new();
    for _ in 0..ROUNDS {
        times.push(once(&path)?);
    }
    let median = |i: usize| quantile(&sorted(times.iter().map(|t| t[i]).collect()), 0.5);
    report.row(
        "document: first frame of 4096², shown before",
        median(0),
        "ms",
    );
    report.row("document: ready to be painted on", median(1), "ms");
    Ok(())
}
