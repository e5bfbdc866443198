//! Any take, however the hand leaps in it, gives the same painting with every paint model: live and offline, in memory and in
//! a file, which holds it when it is opened again.

mod support;

use std::path::Path;
use std::sync::Arc;

use maulstick_brush::{BrushFile, BrushModel};
use maulstick_brush_node::BrushSettings;
use maulstick_bus::{Bus, Faults, MemoryNet};
use maulstick_document::{Access, Document, DocumentSettings};
use maulstick_models::model_names;
use maulstick_optics::PaintLibrary;
use maulstick_painting::picture::picture;
use maulstick_painting::{Painting, PaintingSetup, Sequencer};
use maulstick_session::{Autosave, Offline};
use maulstick_types::brush::BrushState;
use maulstick_types::stylus::StylusSample;
use maulstick_types::{Message as _, Origin};
use proptest::prelude::*;
use support::{Live, START_NS, file, loads, painting_of, pen, turns};

type Take = Vec<(u64, StylusSample)>;

/// A painting as it is seen.
type Seen = Vec<u8>;

/// A brush of so many joints that the way of a leap is longer than a message.
fn brush() -> BrushFile {
    let mut file = file();
    file.spines.joints = 12;
    file
}

/// Samples anywhere on the canvas and beside it, mostly pressed: between two of them the hand may leap across all of it, or
/// half a metre away, faster than any hand. At the end it is lifted or not.
fn takes() -> impl Strategy<Value = Take> {
    let near = ((-0.018..0.018f64, -0.014..0.014f64), 1u64..60);
    let far = ((0.5..0.6f64, -0.014..0.014f64), 1u64..3);
    let place = prop_oneof![7 => near, 1 => far];
    let pressure = prop_oneof![3 => 0.1..1.0f64, 1 => Just(0.0)];
    let samples = prop::collection::vec((place, pressure), 2..8);
    (samples, any::<bool>()).prop_map(|(samples, lifts)| {
        let mut time_ns = 0;
        let mut take: Take = samples
            .into_iter()
            .map(|(((x, y), pause_ms), pressure)| {
                time_ns += pause_ms * 1_000_000;
                (time_ns, pen(x, y, pressure))
            })
            .collect();
        take.extend(lifts.then(|| (time_ns + 8_000_000, pen(0.0, 0.0, 0.0))));
        take
    })
}

/// Three samples in contact, as far apart as the canvas lets them be.
fn leap() -> Take {
    let at = |number: u64, x, y, pressure| (number * 10_000_000, pen(x, y, pressure));
    vec![
        at(0, -0.015, -0.011, 0.5),
        at(1, 0.015, 0.011, 0.5),
        at(2, -0.015, 0.011, 0.5),
        at(3, -0.015, 0.011, 0.0),
    ]
}

/// A stroke whose hand is half a metre away for a moment, in no time, and which ends as its pen is set down again.
fn fast() -> Take {
    let at = |ms: u64, x, y, pressure| (ms * 1_000_000, pen(x, y, pressure));
    vec![
        at(0, -0.01, -0.005, 0.0),
        at(10, -0.01, -0.005, 0.5),
        at(20, -0.005, -0.005, 0.5),
        at(21, 0.55, 0.0, 0.5),
        at(31, 0.55, 0.0, 0.0),
        at(60, 0.01, 0.005, 0.0),
        at(70, 0.01, 0.005, 0.5),
    ]
}

fn settings(path: &Path) -> DocumentSettings {
    DocumentSettings::new(path, Access::Paint)
}

/// A new file, and the painting that begins in it.
fn begun(model: &str, path: &Path) -> (Document, Painting) {
    let (document, _) = Document::open(&settings(path)).expect("begun");
    let setup = PaintingSetup {
        cells: [256, 192],
        model: model.to_owned(),
        ..PaintingSetup::default()
    };
    let library = PaintLibrary::measured().expect("whole");
    let pager = Arc::clone(document.pager());
    let painting = Painting::paged(&setup, library, pager).expect("a painting");
    (document, painting)
}

/// Picture of a file, with the brush where it was left.
fn in_file(path: &Path) -> Seen {
    let (document, opened) = Document::open(&settings(path)).expect("whole");
    let opened = opened.expect("a painting");
    let mut sequencer: Sequencer = opened.in_its_midst().expect("whole");
    let seen = picture(sequencer.painting_mut(), 0).rgb;
    document.close().expect("closed");
    seen
}

fn offline(model: &str, take: &Take) -> Seen {
    let painting = painting_of(model);
    let mut offline = Offline::new(painting, "main", brush(), 0.5, loads()).expect("set up");
    for (time_ns, sample) in take {
        let sampled = offline.sample(START_NS + time_ns, sample);
        sampled.expect("painted");
    }
    offline.end_take().expect("painted");
    assert_eq!(offline.painting_mut().report().quanta_missing, 0);
    picture(offline.painting_mut(), 0).rgb
}

/// The same in a file: as it is then, and as the file has it.
fn offline_in_file(model: &str, take: &Take, path: &Path) -> [Seen; 2] {
    let (document, painting) = begun(model, path);
    let mut offline = Offline::new(painting, "main", brush(), 0.5, loads()).expect("set up");
    let mut autosave = Autosave::new(document, offline.sequencer_mut(), 0);
    let samples: Vec<(u64, &StylusSample)> = take
        .iter()
        .map(|(time_ns, sample)| (START_NS + time_ns, sample))
        .collect();
    let followed = offline.follow(&samples, |sequencer, number| {
        autosave.turn(sequencer, samples[number].0);
    });
    followed.expect("painted");
    let seen = picture(offline.painting_mut(), 0).rgb;
    let closed = autosave.close(offline.sequencer_mut());
    closed.expect("all of it is written");
    [seen, in_file(path)]
}

/// The nodes of a rig.
fn nodes(seed: u64) -> (Live, Arc<dyn Bus>) {
    let faults = Faults {
        loss: 0.1,
        delay_ns: 3_000_000,
    };
    let settings = BrushSettings {
        file: brush(),
        ..support::settings()
    };
    let live = Live::with(MemoryNet::new(seed, START_NS, faults), settings);
    let bus: Arc<dyn Bus> = Arc::new(live.net.bus());
    (live, bus)
}

/// The same by the nodes.
fn live(model: &str, take: &Take, seed: u64) -> Seen {
    let (mut live, bus) = nodes(seed);
    live.paint = Live::paint_node_on(&bus, &live.topics, 6, painting_of(model));
    live.announce(1);
    live.play_take(take, &mut turns(seed), 200_000);
    picture(live.paint.painting_mut(), 0).rgb
}

/// The same by the nodes, in a file.
fn live_in_file(model: &str, take: &Take, seed: u64, path: &Path) -> [Seen; 2] {
    let (mut live, bus) = nodes(seed);
    let (document, painting) = begun(model, path);
    live.paint = Live::paint_node_on(&bus, &live.topics, 6, painting).keeping(document, 0);
    live.announce(1);
    live.play_take(take, &mut turns(seed), 200_000);
    let seen = picture(live.paint.painting_mut(), 0).rgb;
    live.paint.close().expect("all of it is written");
    [seen, in_file(path)]
}

/// Paints a take in every way, and says which of them gave another painting.
fn differing(model: &str, take: &Take, seed: u64) -> Vec<&'static str> {
    let folder = tempfile::tempdir().expect("a folder");
    let expected = offline(model, take);
    let [in_memory, kept] = offline_in_file(model, take, &folder.path().join("offline.maul"));
    let [beside, live_kept] = live_in_file(model, take, seed, &folder.path().join("live.maul"));
    let ways = [
        ("offline beside a file", in_memory),
        ("the file written offline", kept),
        ("live", live(model, take, seed)),
        ("live beside a file", beside),
        ("the file written live", live_kept),
    ];
    let differ = ways.into_iter().filter(|(_, seen)| *seen != expected);
    differ.map(|(way, _)| way).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4, ..ProptestConfig::default() })]

    #[test]
    fn any_take_gives_the_same_live_offline_and_in_a_file(
        take in takes(),
        model in prop::sample::select(model_names().collect::<Vec<_>>()),
        seed in any::<u64>(),
    ) {
        prop_assert_eq!(differing(model, &take, seed), Vec::<&str>::new());
    }
}

#[test]
fn a_leap_of_the_hand_is_in_the_file_with_every_model() {
    for model in model_names() {
        assert_eq!(differing(model, &leap(), 1), Vec::<&str>::new(), "{model}");
    }
}

#[test]
fn a_take_that_is_too_fast_and_ends_as_its_pen_is_set_down_is_the_same_everywhere() {
    let mut model = BrushModel::new(brush(), 0.5);
    model.set_scene(painting_of("impasto").scene());
    let device = Origin {
        source: 1,
        epoch: 1,
    };
    for (time_ns, sample) in fast() {
        model.follow(device, START_NS + time_ns, &sample);
    }
    assert_eq!(model.too_fast(), 1);
    assert!(!model.finish().is_empty(), "it waits at the end");
    assert_eq!(differing("impasto", &fast(), 1), Vec::<&str>::new());
    let without_its_end = fast()[..6].to_vec();
    assert!(offline("impasto", &fast()) != offline("impasto", &without_its_end));
}

#[test]
fn a_leap_is_longer_than_a_message() {
    let mut model = BrushModel::new(brush(), 0.5);
    model.set_scene(painting_of("impasto").scene());
    let device = Origin {
        source: 1,
        epoch: 1,
    };
    let states = leap().into_iter().filter_map(|(time_ns, sample)| {
        let state = model.state(device, 0, START_NS + time_ns, &sample)?;
        Some(state.wire_bytes())
    });
    assert!(states.max() > Some(BrushState::MAX_BYTES));
}

#[test]
fn another_leap_would_be_seen() {
    let mut other = leap();
    other[1].1 = pen(0.0, 0.011, 0.5);
    assert!(offline("impasto", &leap()) != offline("impasto", &other));
}
