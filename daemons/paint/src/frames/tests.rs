//! Views get every tile once, and whatever they ask for.

use std::collections::BTreeSet;

use maulstick_appearance::blank_surface::BlankSurface;
use maulstick_bus::bus::Answer;
use maulstick_bus::{Faults, MemoryNet, Qos};
use maulstick_types::decode;

use maulstick_appearance::display::{DisplayTile, WetFilms};
use maulstick_appearance::ground::Ground;
use maulstick_appearance::show_paint::Counted;
use maulstick_appearance::{Appearance, Bakery};
use maulstick_canvas::assets::Assets;
use maulstick_canvas::planes::TILE_CELLS;
use maulstick_canvas::relief::Relief;
use maulstick_optics::backend::{CpuFilms, FilmBackend};
use maulstick_optics::{Illuminant, PaintLibrary, Studio, StudioSettings, Under};

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
    let look = Appearance::new(maulstick_optics::Studio::daylight());
    {
        let mut fed = feed.lock();
        let bare = Arc::new(ShownSurface {
            shown: &Counted,
            blank: BlankSurface {
                cells,
                ground: Ground::Even(vec![0.95; look.studio.wavelengths()]),
                relief: Arc::new(Relief::flat(2.5e-4)),
                wells: Vec::new(),
            },
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
        .ask("frame", Qos::Data, bytes, limit, &Wake::new())
        .expect("asked");
    rig.net.advance(1);
    rig.server.poll();
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
        look: 0,
        shared: true,
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
fn a_view_gets_the_tiles_that_it_asks_for_however_old_they_are() {
    let mut rig = rig();
    paint(&rig, TileId { x: 1, y: 1 }, 7);
    paint(&rig, TileId { x: 3, y: 1 }, 8);
    let of = |tiles: [u32; 4], since: u64| FrameRequest {
        tiles,
        ..request(since, 5, 0)
    };
    let places = |reply: &FrameReply| -> BTreeSet<(u32, u32)> {
        reply.tiles.iter().map(|tile| (tile.x, tile.y)).collect()
    };
    let part = ask(&mut rig, &of([0, 1, 2, 3], 0)).expect("at once");
    assert_eq!(places(&part), [(0, 1), (1, 1), (0, 2), (1, 2)].into());
    paint(&rig, TileId { x: 2, y: 0 }, 9);
    let rest = of([0, 1, 2, 3], part.version);
    assert_eq!(ask(&mut rig, &rest), None, "that is beside it");
    // What comes into the view is asked for from the beginning.
    let strip = ask(&mut rig, &of([2, 1, 4, 3], 0)).expect("at once");
    assert_eq!(places(&strip), [(2, 1), (3, 1), (2, 2), (3, 2)].into());
    paint(&rig, TileId { x: 0, y: 1 }, 10);
    let news = ask(&mut rig, &of([0, 1, 4, 3], part.version)).expect("news");
    assert_eq!(places(&news), [(0, 1)].into());
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

/// A tile with a dry layer and a wet film, in slot 0.
fn dried(wet: f32, dry: f32) -> Arc<Tile> {
    let plane = |count: f32| -> Arc<[f32]> { vec![count; TILE_CELLS].into() };
    let lower = Tile::new([(0, plane(dry))].into_iter(), None);
    let lower = lower.dried(1, 1.0, &[]).expect("wet");
    Arc::new(Tile::new(
        [(0, plane(wet))].into_iter(),
        lower.dry().cloned(),
    ))
}

/// Unlit colours of a tile as an export computes them.
fn exported(rig: &Rig, tile: &Tile) -> [Vec<f32>; 3] {
    let fed = rig.feed.lock();
    let look = fed.look.as_ref().expect("a look");
    let id = TileId { x: 0, y: 0 };
    let ground = fed.surfaces[&0].bare.ground.tile(id);
    let stack = tile.dry().expect("dried");
    let sight = (&**look, &mut CpuFilms::new() as &mut dyn FilmBackend);
    let baked = Bakery::default().planes(sight, &Counted, 0, id, (stack, ground.under()));
    WetFilms::of(Some(tile)).shade(&look.studio, Under::Planes(&baked))
}

fn look_under(light: &str) -> Appearance {
    let library = PaintLibrary::measured().expect("whole");
    let settings = StudioSettings {
        light: Illuminant::named(light).expect("known"),
        samples: 8,
        ..StudioSettings::default()
    };
    let mut studio = Studio::new(&settings, library.paints());
    studio.add(library.find("Pyrrole Red").expect("known"));
    Appearance::new(studio)
}

#[test]
fn under_another_light_everything_comes_anew_as_an_export_has_it() {
    let mut rig = rig();
    let tile = dried(3000.0, 9000.0);
    let mut look = look_under("D65");
    rig.feed.lock().look = Some(Arc::new(look.clone()));
    paint(&rig, TileId { x: 0, y: 0 }, 7);
    let place = TileId { x: 0, y: 0 };
    let lay = |rig: &Rig, tile: &Arc<Tile>| {
        let mut fed = rig.feed.lock();
        let surface = fed.surfaces.get_mut(&0).expect("a surface");
        surface.tiles.insert(place, (7, Some(Arc::clone(tile))));
    };
    lay(&rig, &tile);
    let corner = |reply: &FrameReply| {
        let tile = reply.tiles.iter().find(|tile| (tile.x, tile.y) == (0, 0));
        DisplayTile::from_bytes(&tile.expect("the corner").planes).expect("whole")
    };
    let differ = |shown: &DisplayTile, exported: &[Vec<f32>; 3]| {
        let planes = shown.rgb.iter().zip(exported);
        planes.map(|(a, b)| (a[9] - b[9]).abs()).fold(0.0, f32::max)
    };
    let day = ask(&mut rig, &request(0, 0, 0)).expect("at once");
    let by_day = exported(&rig, &tile);
    assert!(differ(&corner(&day), &by_day) < 1e-3);
    assert_eq!(
        ask(&mut rig, &request(day.version, 5, 0)),
        None,
        "it waits for news"
    );
    // The lamp: the same versions, another look.
    look.relight(look_under("A").studio);
    rig.feed.lock().look = Some(Arc::new(look));
    let lamp = ask(&mut rig, &request(day.version, 5, 0)).expect("news");
    assert_eq!((lamp.tiles.len(), lamp.look), (12, day.look + 1));
    let by_lamp = exported(&rig, &tile);
    assert!(differ(&corner(&lamp), &by_lamp) < 1e-3);
    assert!(
        differ(&corner(&lamp), &by_day) > 1e-2,
        "the old bakery would pass"
    );
    assert_eq!(rig.feed.lock().baking, Progress { all: 1, done: 1 });
    let asked = FrameRequest {
        look: lamp.look,
        ..request(lamp.version, 5, 0)
    };
    assert_eq!(ask(&mut rig, &asked), None, "it waits for news");
}

/// A ground of a picture that goes from dark to light across the surface.
fn pictured(look: &Appearance, cells: [u32; 2]) -> Ground {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, cells[0], cells[1]);
    encoder.set_color(png::ColorType::Rgb);
    let row = (0..cells[0]).flat_map(|x| [60 + (x / 2) as u8, 90, 200 - (x / 2) as u8]);
    let raw: Vec<u8> = (0..cells[1]).flat_map(|_| row.clone()).collect();
    let mut writer = encoder.write_header().expect("a header");
    writer.write_image_data(&raw).expect("pixels");
    writer.finish().expect("whole");
    let mut embedded = Assets::default();
    let hash = embedded.add(bytes.into()).expect("taken");
    Ground::called(&format!("image:{hash}"), cells, &look.studio, &embedded).expect("a ground")
}

#[test]
fn a_picture_is_the_ground_of_each_tile_bare_and_painted() {
    let cells = [200, 130];
    let mut rig = rig_of(cells);
    let look = look_under("D65");
    let tile = dried(300.0, 900.0);
    let place = TileId { x: 0, y: 0 };
    {
        let mut fed = rig.feed.lock();
        let surface = fed.surfaces.get_mut(&0).expect("a surface");
        Arc::make_mut(&mut surface.bare).blank.ground = pictured(&look, cells);
        surface.tiles.insert(place, (7, Some(Arc::clone(&tile))));
        fed.look = Some(Arc::new(look.clone()));
    }
    let reply = ask(&mut rig, &request(0, 0, 0)).expect("at once");
    let shown = |x: u32| {
        let found = reply.tiles.iter().find(|tile| (tile.x, tile.y) == (x, 0));
        DisplayTile::from_bytes(&found.expect("a tile").planes).expect("whole")
    };
    let differ = |one: &[Vec<f32>; 3], other: &[Vec<f32>; 3]| {
        let cells = one.iter().flatten().zip(other.iter().flatten());
        cells.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
    };
    assert!(differ(&shown(0).rgb, &exported(&rig, &tile)) < 1e-3);
    let fed = rig.feed.lock();
    let ground = &fed.surfaces[&0].bare.ground;
    let films = WetFilms::default();
    let bare = |id: TileId| films.shade(&look.studio, ground.tile(id).under());
    assert!(differ(&shown(2).rgb, &bare(TileId { x: 2, y: 0 })) < 1e-3);
    assert!(differ(&shown(2).rgb, &bare(TileId { x: 1, y: 0 })) > 1e-2);
    let even = films.shade(&look.studio, Under::Even(ground.mean()));
    assert!(differ(&shown(2).rgb, &even) > 1e-2, "a fault would pass");
}

#[test]
fn a_look_of_a_brush_is_told_once_for_each_load_and_light() {
    use maulstick_brush::file::sections::Hair;
    use maulstick_bus::Queue;
    use maulstick_bus::typed::Receiver;
    use maulstick_model::brush::load::BrushLoad;
    use maulstick_types::brush::BrushLook;

    let mut rig = rig();
    let topics = Topics::new("t");
    rig.server = rig.server.telling_brushes(&topics);
    let bus = rig.net.bus();
    let key = topics.brush_look("main");
    let mut looks: Receiver<BrushLook> =
        Receiver::new(&bus, &key, Qos::Cached, Queue::Ring(16), &Wake::new()).expect("one");
    let mut told = |rig: &mut Rig| {
        rig.server.poll();
        rig.net.advance(1_000_000);
        std::iter::from_fn(|| looks.try_recv()).count()
    };
    assert_eq!(told(&mut rig), 0, "no brush is known");
    let carried = Carried {
        load: Arc::new(BrushLoad::clean(24)),
        hair: Hair::Sable,
        film_m: 1e-9,
        film_full: 1e4,
        full_load: 1e6,
    };
    rig.feed.lock().carried.insert("main".into(), carried);
    assert_eq!(told(&mut rig), 1);
    assert_eq!(told(&mut rig), 0, "nothing is new");
    if let Some(carried) = rig.feed.lock().carried.get_mut("main") {
        Arc::make_mut(&mut carried.load).add_film(0, 3, 5);
    }
    assert_eq!(told(&mut rig), 1, "another load");
    let look = Appearance::new(Studio::daylight());
    rig.feed.lock().look = Some(Arc::new(look));
    assert_eq!(told(&mut rig), 1, "another light");
}
