//! A reply of the paint node to a view, from the question until its tiles are read: through shared memory
//! and through the socket, in turn on the same link.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use maulstick_bus::{Bus as _, Dial, Payload, Qos, RigClock, RigFolder, Server, Wake, ZenohBus};
use maulstick_rig::UserError;
use maulstick_types::paint::{FrameReply, FrameTile};
use maulstick_types::{Flags, FrameView, Origin, encode, encode_into, encoded_bytes};

use crate::report::{Report, quantile, sorted};

/// Bytes of a tile's planes.
const TILE_BYTES: usize = 14 * 4096;
/// Numbers of tiles of a reply, and of requests for each: one; the change of a stroke between two frames; the greatest
/// reply; 33 MB, the size of a picture of 3840×2160.
const SIZES: [(usize, usize); 4] = [(1, 400), (8, 200), (216, 60), (577, 40)];
/// Memory for the largest reply, bytes.
const POOL_BYTES: usize = 40 << 20;
const ME: Origin = Origin {
    source: 1,
    epoch: 1,
};
const TOPIC: &str = "bench/frame";

fn fault(error: impl std::fmt::Display) -> UserError {
    UserError::failure(error.to_string())
}

fn reply(tiles: usize) -> FrameReply {
    let tile = |i: usize| FrameTile {
        x: i as u32,
        y: 0,
        planes: vec![i as u8; TILE_BYTES].into(),
    };
    FrameReply {
        surface: 0,
        epoch: 1,
        version: 1,
        level: 0,
        cells: [4096; 2],
        journal: 0,
        holds: Vec::new(),
        more: false,
        tiles: (0..tiles).map(tile).collect(),
        look: 0,
    }
}

/// Answers until it is told to stop; a request of one byte asks for a shared reply.
fn answer(server: &Server, wake: &Wake, reply: &FrameReply, stop: &AtomicBool) {
    while !stop.load(Ordering::Relaxed) {
        while let Some(request) = server.try_recv() {
            let sent = if request.bytes.len() == 1 {
                let length = encoded_bytes(reply).unwrap_or_default();
                request.answer_shared(length, &mut |into| {
                    encode_into(&ME, Flags::NONE, 0, 0, 0, reply, into).ok();
                })
            } else {
                let bytes = encode(&ME, Flags::NONE, 0, 0, 0, reply).unwrap_or_default();
                request.answer(bytes)
            };
            sent.ok();
        }
        wake.wait(Duration::from_millis(5));
    }
}

/// Reads every tile, like a view.
fn read(bytes: &Payload, into: &mut Vec<u8>) -> Result<usize, UserError> {
    let (_, view) = FrameView::of(bytes).map_err(fault)?;
    for tile in &view.tiles {
        into.clear();
        into.extend_from_slice(tile.planes);
    }
    Ok(view.tiles.len())
}

/// Measures and reports.
pub(crate) fn run(report: &mut Report) -> Result<(), UserError> {
    let base = tempfile::tempdir().map_err(fault)?;
    let folder = RigFolder::create_in(&base.path().join("rigs"), "bench")?;
    let clock = RigClock::start();
    let dial = |name: &str, connect: Vec<String>| Dial {
        name: name.into(),
        listen: Some(folder.locator(name)),
        connect,
    };
    let paint = ZenohBus::open_sharing(&dial("paint", Vec::new()), clock)?.lending(POOL_BYTES);
    let ui = ZenohBus::open_sharing(&dial("ui", vec![folder.locator("paint")]), clock)?;
    let mut scratch = Vec::new();
    for (tiles, rounds) in SIZES {
        let (serving, asking) = (Wake::new(), Wake::new());
        let server = paint.serve(TOPIC, 4, &serving)?;
        let stop = Arc::new(AtomicBool::new(false));
        let thread = {
            let (wake, stop) = (serving.clone(), Arc::clone(&stop));
            std::thread::spawn(move || answer(&server, &wake, &reply(tiles), &stop))
        };
        let mut times = [Vec::new(), Vec::new()];
        let mut shared = 0;
        let give_up = Instant::now() + Duration::from_secs(60);
        while times[1].len() < rounds && Instant::now() < give_up {
            for (way, times) in times.iter_mut().enumerate() {
                let limit = Duration::from_secs(2);
                let begun = Instant::now();
                let pending = ui.ask(TOPIC, Qos::Data, vec![0; 1 + way], limit, &asking)?;
                let Ok(bytes) = pending.wait(&asking) else {
                    continue;
                };
                if read(&bytes, &mut scratch)? == tiles {
                    times.push(begun.elapsed().as_secs_f64() * 1e3);
                    shared += usize::from(bytes.is_shared());
                }
            }
        }
        stop.store(true, Ordering::Relaxed);
        serving.ring();
        thread.join().map_err(|_| fault("the server fell"))?;
        // The first are slower: pages are touched, queries declared.
        let [ours, peer] = times.map(|all| sorted(all[all.len().min(5)..].to_vec()));
        let name = format!("reply.{tiles}_tiles");
        let what = if shared > 0 {
            "through the socket"
        } else {
            "through the socket, too"
        };
        report.beside(
            &name,
            quantile(&ours, 0.5),
            "ms",
            (what, quantile(&peer, 0.5)),
        );
    }
    ui.close();
    paint.close();
    Ok(())
}
