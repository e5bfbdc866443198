//! Views get every tile once, and whatever they ask for.

use std::collections::BTreeSet;

use maulstick_bus::bus::Answer;
use maulstick_bus::{Class, Faults, MemoryNet};
use maulstick_types::decode;

use maulstick_paint::look::Look;
use maulstick_paint::relief::Relief;

use super::*;

const ME: Origin = Origin {
    source: 9,
    epoch: 5,
};

struct Rig {
    net: MemoryNet,
    server: FrameServer,
    feed: Feed,
}

fn rig() -> Rig {
    rig_of([200, 130])
}

fn rig_of(cells: [u32; 2]) -> Rig {
    let net = MemoryNet::new(1, 0, Faults::default());
    let feed = Feed::new();
    let look = Look::new(maulstick_optics::Studio::daylight());
    {
        let mut fed = feed.lock();
        let bare = Arc::new(Bare {
            ground: vec![0.95; look.studio.wavelengths()],
            relief: Arc::new(Relief::flat(2.5e-4)),
            wells: Vec::new(),
        });
        let surface = FedSurface {
            cells,
            grid: cells.map(|cells| cells.div_ceil(64)),
            bare,
            tiles: BTreeMap::new(),
        };
        fed.surfaces.insert(0, surface);
        fed.look = Some(Arc::new(look));
    }
    let bus: Arc<dyn Bus> = Arc::new(net.bus());
    let server = FrameServer::new(bus, "frame", feed.clone(), &Wake::new(), ME).expect("one");
    Rig { net, server, feed }
}

fn ask(rig: &mut Rig, asked: &FrameRequest) -> Option<FrameReply> {
    let bytes = encode(&ME, Flags::NONE, 0, 0, 0, asked).expect("encoded");
    let limit = Duration::from_secs(1);
    let pending = rig
        .net
        .bus()
        .ask("frame", Class::Data, bytes, limit, &Wake::new())
        .expect("asked");
    rig.net.advance(1);
    rig.server.turn();
    rig.net.advance(1);
    match pending.try_recv() {
        Some(Answer::Bytes(bytes)) => Some(decode(&bytes).expect("a reply").1),
        _ => None,
    }
}

fn request(since: u64, epoch: u32, level: u32) -> FrameRequest {
    FrameRequest {
        surface: 0,
        since,
        epoch,
        tiles: [0, 0, 100, 100],
        level,
        wait_ms: 300,
    }
}

fn paint(rig: &Rig, id: TileId, version: u64) {
    let mut fed = rig.feed.lock();
    fed.version = version;
    if let Some(surface) = fed.surfaces.get_mut(&0) {
        surface.tiles.insert(id, (version, None));
    }
}

#[test]
fn a_new_view_gets_all_tiles_and_then_only_what_changed() {
    let mut rig = rig();
    paint(&rig, TileId { x: 1, y: 1 }, 7);
    let all = ask(&mut rig, &request(0, 0, 0)).expect("at once");
    assert_eq!(
        (all.tiles.len(), all.version, all.epoch),
        (12, BARE_VERSIONS + 7, 5)
    );
    assert_eq!(
        ask(&mut rig, &request(all.version, 5, 0)),
        None,
        "it waits for news"
    );
    paint(&rig, TileId { x: 3, y: 0 }, 8);
    let news = ask(&mut rig, &request(all.version, 5, 0)).expect("news");
    assert_eq!(
        news.tiles.iter().map(|t| (t.x, t.y)).collect::<Vec<_>>(),
        vec![(3, 0)]
    );
}

#[test]
fn an_unpainted_canvas_is_sent_once() {
    let mut rig = rig();
    let all = ask(&mut rig, &request(0, 0, 0)).expect("at once");
    assert_eq!(all.tiles.len(), 12);
    assert_eq!(
        ask(&mut rig, &request(all.version, 5, 0)),
        None,
        "it waits for news"
    );
}

#[test]
fn a_coarse_tile_is_news_when_any_of_its_cells_is() {
    let mut rig = rig();
    paint(&rig, TileId { x: 3, y: 2 }, 4);
    let news = ask(&mut rig, &request(BARE_VERSIONS + 3, 5, 2)).expect("news");
    assert_eq!((news.tiles.len(), news.cells), (1, [50, 33]));
}

#[test]
fn a_view_of_an_earlier_epoch_gets_everything_anew() {
    let mut rig = rig();
    assert_eq!(
        ask(&mut rig, &request(99, 4, 0)).map(|reply| reply.tiles.len()),
        Some(12)
    );
}

#[test]
fn a_large_bare_canvas_is_sent_in_parts_that_fit() {
    let mut rig = rig_of([2560, 2560]);
    let (mut since, mut seen) = (0, BTreeSet::new());
    for _ in 0..100 {
        let part = ask(&mut rig, &request(since, 5, 0)).expect("a part that fits");
        for tile in &part.tiles {
            assert!(seen.insert((tile.x, tile.y)), "sent twice");
        }
        since = part.version;
        if !part.more {
            break;
        }
    }
    assert_eq!(seen.len(), 1600);
    assert_eq!(
        ask(&mut rig, &request(since, 5, 0)),
        None,
        "it waits for news"
    );
    paint(&rig, TileId { x: 0, y: 0 }, 2);
    let news = ask(&mut rig, &request(since, 5, 0)).expect("news");
    assert_eq!(news.tiles.len(), 1);
}

#[test]
fn no_level_is_coarser_than_a_single_tile() {
    let mut rig = rig();
    paint(&rig, TileId { x: 3, y: 2 }, 4);
    for level in [2, 3, 16, u32::MAX] {
        let reply = ask(&mut rig, &request(0, 5, level)).expect("at once");
        assert_eq!((reply.level, reply.tiles.len()), (2, 1));
    }
}
