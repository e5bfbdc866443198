use half::f16;
use maulstick_bus::typed::Reader;
use maulstick_bus::{Faults, MemoryNet, Request, Server};
use maulstick_types::paint::{FrameReply, FrameTile};

use super::*;
use crate::frames::tiles::TileRect;

const PAINT: Origin = Origin {
    source: 1,
    epoch: 5,
};

/// A puller on a bus of its own, and the node that it asks.
struct Pulled {
    net: MemoryNet,
    server: Server,
    inbox: FrameInbox,
    stop: Stop,
    thread: Option<std::thread::JoinHandle<()>>,
}

impl Pulled {
    fn new() -> Self {
        let net = MemoryNet::new(1, 0, Faults::default());
        let bus: Arc<dyn Bus> = Arc::new(net.bus());
        let server = bus.serve("frame", 16, &Wake::new()).expect("served");
        let (inbox, wake) = (FrameInbox::default(), Wake::new());
        let stop = Stop::on_signals(&wake).expect("handlers");
        let source = FrameSource {
            bus,
            topic: "frame".into(),
            me: PAINT,
            surface: 0,
        };
        inbox.want(Wanted {
            tiles: TileRect::up_to([2, 1]),
            room: [2, 1],
            ..Wanted::default()
        });
        let (its, stops) = (inbox.clone(), stop.clone());
        let thread = std::thread::spawn(move || pull(&source, &its, &wake, &stops));
        Self {
            net,
            server,
            inbox,
            stop,
            thread: Some(thread),
        }
    }

    /// The next request, after some time.
    fn asked(&self) -> (Request, FrameRequest) {
        let give_up = Instant::now() + Duration::from_secs(60);
        loop {
            self.net.advance(1_000_000);
            if let Some(request) = self.server.try_recv() {
                let read = Reader::default().read("frame", &request.bytes);
                let (_, asked) = read.expect("a question");
                return (request, asked);
            }
            assert!(Instant::now() < give_up, "it asks nothing");
            std::thread::yield_now();
        }
    }

    fn answer(&self, request: Request, reply: &FrameReply) {
        let bytes = encode(&PAINT, Flags::NONE, 0, 0, 0, reply).expect("encoded");
        request.answer(bytes).expect("answered");
    }
}

impl Drop for Pulled {
    fn drop(&mut self) {
        self.stop.request();
        self.inbox.wake();
        if let Some(thread) = self.thread.take() {
            thread.join().expect("it ends");
        }
    }
}

fn reply(version: u64, tiles: &[u32]) -> FrameReply {
    let tile = |x: &u32| FrameTile {
        x: *x,
        y: 0,
        planes: vec![0; HEIGHTS + 4 * TILE_CELLS].into(),
    };
    FrameReply {
        surface: 0,
        epoch: PAINT.epoch,
        version,
        level: 0,
        cells: [128, 64],
        journal: version,
        holds: vec![FrameHolds {
            brush: 1,
            epoch: 1,
            next: 10 * version,
        }],
        more: false,
        tiles: tiles.iter().map(tile).collect(),
        look: 1,
    }
}

#[test]
fn what_is_lost_in_shared_memory_comes_through_the_socket() {
    let pulled = Pulled::new();
    let mut asked_shared = Vec::new();
    for version in 1..8 {
        let (mut request, mut asked) = pulled.asked();
        asked_shared.push(asked.shared);
        if asked.shared {
            // The answer is lost.
            drop(request);
            (request, asked) = pulled.asked();
            assert!(!asked.shared, "it is asked for once more without");
        }
        assert_eq!(asked.since, version - 1, "nothing is skipped");
        pulled.answer(request, &reply(version, &[0, 1]));
    }
    let (lost, rest) = asked_shared.split_at(STRIKES as usize);
    assert!(lost.iter().all(|shared| *shared), "{asked_shared:?}");
    assert!(rest.iter().all(|shared| !*shared), "{asked_shared:?}");
}

#[test]
fn the_window_is_told_what_the_picture_holds_even_where_no_tile_changed() {
    let pulled = Pulled::new();
    for (version, tiles) in [(1, &[0, 1][..]), (2, &[]), (2, &[]), (3, &[1])] {
        let (request, _) = pulled.asked();
        pulled.answer(request, &reply(version, tiles));
    }
    drop(pulled.asked());
    let told: Vec<_> = pulled
        .inbox
        .take()
        .into_iter()
        .map(|shown| (shown.journal, shown.holds[0].next, shown.tiles.len()))
        .collect();
    assert_eq!(told, [(1, 10, 2), (2, 20, 0), (3, 30, 1)]);
}

#[test]
fn a_view_at_rest_asks_less_and_less_often_until_something_changes() {
    let pulled = Pulled::new();
    let mut waits = Vec::new();
    let mut answer = |version, tiles: &[u32]| {
        let (request, asked) = pulled.asked();
        waits.push(asked.wait_ms);
        pulled.answer(request, &reply(version, tiles));
    };
    answer(1, &[0, 1]);
    for _ in 0..5 {
        answer(1, &[]);
    }
    answer(2, &[1]);
    answer(2, &[]);
    assert_eq!(waits, [200, 200, 400, 800, 1600, 1600, 1600, 200]);
}

#[test]
fn a_paint_node_of_another_version_is_a_fault_until_it_is_gone() {
    let pulled = Pulled::new();
    let (request, _) = pulled.asked();
    let mut bytes = encode(&PAINT, Flags::NONE, 0, 0, 0, &reply(1, &[0])).expect("encoded");
    bytes[4] ^= 1;
    request.answer(bytes).expect("answered");
    let (request, _) = pulled.asked();
    assert!(
        matches!(
            pulled.inbox.fault(),
            Some(DecodeError::UnknownSchema { .. })
        ),
        "{:?}",
        pulled.inbox.fault()
    );
    pulled.answer(request, &reply(1, &[0, 1]));
    drop(pulled.asked());
    assert_eq!(pulled.inbox.fault(), None);
    assert_eq!(pulled.inbox.take().len(), 1);
}

#[test]
fn wet_paint_is_tinted_and_dry_paint_is_not() {
    let plane = |value: f32| f16::from_f32(value).to_le_bytes().repeat(TILE_CELLS);
    let mut planes = [0.5, 0.5, 0.5, 0.25, 0.0].map(plane).concat();
    planes.extend([0; 4 * TILE_CELLS]);
    planes[WETNESS + 14..][..2].copy_from_slice(&f16::ONE.to_le_bytes());
    let (mut colour, _) = texels(&planes).expect("whole");
    let dry = colour.clone();
    tint_wet(&mut colour, &planes);
    let texel = |colour: &[u8], cell: usize| colour[8 * cell..8 * (cell + 1)].to_vec();
    assert_eq!(texel(&colour, 6), texel(&dry, 6));
    let half = |at: usize| f16::from_le_bytes([colour[at], colour[at + 1]]).to_f32();
    let wet = [0, 1, 2, 3].map(|channel| half(56 + 2 * channel));
    assert!(wet[0] < 0.3 && wet[2] > 0.7 && wet[3] == 0.25, "{wet:?}");
}
