//! Output of the node to the frames and to its clients.

use std::collections::BTreeSet;

use maulstick_appearance::display::WetFilms;
use maulstick_brush::{BrushFile, BrushModel};
use maulstick_bus::typed::{Receiver, Sender};
use maulstick_bus::{Faults, MemoryNet, Qos, Queue};
use maulstick_canvas::quantum::SLOTS;
use maulstick_optics::{PaintLibrary, Under};
use maulstick_painting::PaintingSetup;
use maulstick_painting::edits::{Dry, Fill, FillPaint, Load};
use maulstick_types::brush::{BRUSHES_MOST, BrushDef, BrushState};
use maulstick_types::command::{Command, CommandRequest, Outcome};
use maulstick_types::paint::PaintConsumed;
use maulstick_types::scene::CANVAS;
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample};
use maulstick_types::values::{BrushName, FilmThickness, Ticks};
use maulstick_types::{Flags, Header, Mixture, name_hash};

use super::*;

const BRUSH: Origin = Origin {
    source: 3,
    epoch: 4,
};

fn node(net: &MemoryNet) -> (PaintNode, BrushModel) {
    let bus: Arc<dyn Bus> = Arc::new(net.bus());
    let setup = PaintingSetup {
        cells: [256, 192],
        ..PaintingSetup::default()
    };
    let library = PaintLibrary::measured().expect("whole");
    let painting = Painting::new(&setup, library).expect("a painting");
    let file = BrushFile::library("round").expect("round");
    let mut model = BrushModel::new(file.clone(), 0.5);
    model.set_scene(painting.scene());
    let me = Origin {
        source: 1,
        epoch: 1,
    };
    let topics = Topics::new("t");
    let mut node = PaintNode::new(bus, &topics, &Wake::new(), me, painting).expect("a node");
    node.painting_mut().define_brush("main", file);
    (node, model)
}

fn load(node: &mut PaintNode, number: u64, paint: &str) {
    let command = Command::from(Load {
        mixture: Mixture::pure(paint),
        beside: None,
        brush: BrushName::main(),
    });
    let request = CommandRequest {
        client: 1,
        number,
        after: None,
        command,
    };
    let outcome = node.sequencer.command(request).outcome;
    assert!(matches!(outcome, Outcome::Done { .. }), "{outcome:?}");
}

/// A short stroke, as states that the sequencer accepts.
fn stroke(node: &mut PaintNode, model: &mut BrushModel) {
    for number in 0..20u64 {
        let sample = StylusSample {
            pose: StylusPose::Contact {
                point_m: [1e-3 * number as f64, 0.0, 0.0],
                tilt_rad: DEFAULT_TILT_RAD,
                twist_rad: 0.0,
                pressure: 0.5,
            },
            in_range: true,
            ..StylusSample::away()
        };
        let event_ns = 1_000_000_000 + number * 8_000_000;
        let state = model
            .state(BRUSH, number, event_ns, &sample)
            .expect("a state");
        let header = Header {
            version: 1,
            schema: 0,
            source: BRUSH.source,
            epoch: BRUSH.epoch,
            flags: Flags::NONE,
            length: 0,
            seq: number,
            event_ns,
            sent_ns: event_ns,
        };
        let (_, painted) = node.sequencer.state("main", &header, &state);
        painted.expect("painted");
    }
}

#[test]
fn the_frames_know_a_paint_as_soon_as_a_tile_has_it() {
    let net = MemoryNet::new(1, 1_000_000_000, Faults::default());
    let (mut node, mut model) = node(&net);
    load(&mut node, 1, "Bone Black");
    stroke(&mut node, &mut model);
    let feed = node.feed();
    feed.lock().wanted = true;
    node.feed.update(&mut node.sequencer, 2_000_000_000);
    let fed = feed.lock();
    let look = fed.look.as_ref().expect("a look");
    let surface = &fed.surfaces[&CANVAS];
    let painted = surface.tiles.values().filter_map(|(_, tile)| tile.as_ref());
    // Shading a paint that the studio does not have is out of bounds.
    let shown = painted.map(|tile| {
        WetFilms::of(Some(tile)).shade(&look.studio, Under::Even(surface.bare.ground.mean()))
    });
    assert!(shown.count() > 0, "nothing was painted");
}

/// Has the node carry out a command.
fn ask(node: &mut PaintNode, number: u64, command: Command) {
    let request = CommandRequest {
        client: 1,
        number,
        after: None,
        command,
    };
    let outcome = node.sequencer.command(request).outcome;
    assert!(matches!(outcome, Outcome::Done { .. }), "{outcome:?}");
}

/// Command that fills the canvas.
fn fill() -> Command {
    Command::from(Fill {
        paint: FillPaint::Mixture {
            mixture: Mixture::pure("Bone Black"),
        },
        thickness: FilmThickness::new(3e-5).expect("in range"),
        surface: CANVAS,
    })
}

/// Command that dries the canvas in this time.
fn over(ticks: u32) -> Command {
    Command::from(Dry {
        over: Some(Ticks::new(ticks).expect("in range")),
        ..Dry::whole(CANVAS)
    })
}

#[test]
fn paint_dries_by_the_clock_of_the_node_and_each_tick_is_in_the_journal() {
    let net = MemoryNet::new(1, 1_000_000_000, Faults::default());
    let (mut node, _) = node(&net);
    ask(&mut node, 1, fill());
    net.advance(5_000_000_000);
    node.poll().expect("a turn");
    assert_eq!(node.sequencer.painting().clock().ticks, 0, "nothing dries");
    ask(&mut node, 2, over(90));
    let begun = node.sequencer.journal_next();
    for turn in 0..=200u64 {
        node.poll().expect("a turn");
        let ticks = node.sequencer.painting().clock().ticks;
        assert_eq!(ticks, (turn * 7 * 60 / 1000).min(90), "turn {turn}");
        net.advance(7_000_000);
        if ticks < 90 {
            assert!(node.sequencer.painting().is_drying());
        }
    }
    let ticks = node.sequencer.painting().clock().ticks;
    assert_eq!(node.sequencer.journal_next(), begun + ticks);
    net.advance(2_000_000_000);
    for _ in 0..3 {
        node.poll().expect("a turn");
    }
    let painting = node.sequencer.painting();
    assert!(!painting.is_drying());
    let store = painting.store(CANVAS).expect("a canvas");
    assert_eq!(store.counts(), [0; SLOTS]);
}

#[test]
fn a_node_that_stood_still_catches_up_bit_by_bit() {
    let net = MemoryNet::new(1, 1_000_000_000, Faults::default());
    let (mut node, _) = node(&net);
    let before = node.sequencer.painting().clock().ticks;
    ask(&mut node, 1, fill());
    ask(&mut node, 2, over(3600));
    node.poll().expect("a turn");
    net.advance(4_000_000_000);
    node.poll().expect("a turn");
    assert_eq!(node.sequencer.painting().clock().ticks, before + 60);
    for _ in 0..9 {
        node.poll().expect("a turn");
    }
    assert_eq!(node.sequencer.painting().clock().ticks, before + 240);
}

/// Sends a brush's file, and returns whether the painting knows it then.
fn introduced(node: &mut PaintNode, net: &MemoryNet, brush: &str) -> bool {
    let origin = Origin {
        source: name_hash(brush),
        epoch: 1,
    };
    let topic = Topics::new("t").brush_def(brush);
    let mut sender = Sender::new(&net.bus(), &topic, Qos::Cached, origin).expect("a sender");
    let toml = BrushFile::library_text("round").expect("round").to_owned();
    let def = BrushDef {
        brush: brush.to_owned(),
        hash: name_hash(&toml),
        toml,
        head_length_m: 0.03,
    };
    sender.send(0, 0, &def).expect("sent");
    net.advance(1);
    node.poll().expect("a turn");
    node.knows_brush(brush)
}

#[test]
fn a_painting_gets_no_more_brushes_than_it_may_have_and_is_painted_on() {
    let net = MemoryNet::new(1, 1_000_000_000, Faults::default());
    let (mut node, _) = node(&net);
    let known = (0..200).filter(|number| introduced(&mut node, &net, &format!("b{number}")));
    // The first is there already.
    assert_eq!(known.count(), BRUSHES_MOST - 1);
    assert!(introduced(&mut node, &net, "b0"), "it may be changed");
}

#[test]
fn a_painting_of_before_with_hundreds_of_brushes_is_painted_on() {
    let net = MemoryNet::new(1, 1_000_000_000, Faults::default());
    let (mut node, _) = node(&net);
    let file = BrushFile::library("round").expect("round");
    let header = |brush: &str| Header {
        version: 1,
        schema: 0,
        source: name_hash(brush),
        epoch: 1,
        flags: Flags::NONE,
        length: 0,
        seq: 0,
        event_ns: 0,
        sent_ns: 0,
    };
    let nothing = BrushState {
        device: 1,
        device_epoch: 1,
        device_seq: 0,
        solves: Vec::new(),
    };
    for number in 0..300 {
        let brush = format!("b{number}");
        node.painting_mut().define_brush(&brush, file.clone());
        let (_, consumed) = node.sequencer.state(&brush, &header(&brush), &nothing);
        consumed.expect("consumed");
    }
    let topic = Topics::new("t").paint_consumed();
    let credit = Receiver::<PaintConsumed>::new(
        &net.bus(),
        &topic,
        Qos::Control,
        Queue::Ring(64),
        &Wake::new(),
    );
    let mut credit = credit.expect("subscribed");
    let mut told = |node: &mut PaintNode| {
        node.poll().expect("a turn");
        net.advance(1);
        let messages = std::iter::from_fn(|| credit.try_recv());
        let credits = messages.flat_map(|received| received.message.brushes);
        credits
            .map(|credit| credit.brush)
            .collect::<BTreeSet<u32>>()
    };
    assert!(told(&mut node).is_empty(), "none of them is there");
    assert!(introduced(&mut node, &net, "b7"));
    assert_eq!(told(&mut node), BTreeSet::from([name_hash("b7")]));
    for number in 0..300 {
        introduced(&mut node, &net, &format!("b{number}"));
    }
    node.outputs.credit_mut().send_again();
    assert_eq!(
        told(&mut node).len(),
        300,
        "in as many messages as it takes"
    );
}
