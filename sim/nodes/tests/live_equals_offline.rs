//! A take played through the nodes, over a network that loses, delays and reorders, with nodes that
//! turn in any order, paints what the same take paints offline: byte for byte.

#![allow(clippy::panic, reason = "a test fails by it")]

use std::collections::BTreeMap;
use std::sync::Arc;

use maulstick_brush::BrushFile;
use maulstick_bus::credit::Stamp;
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, Class, CreditSender, Faults, MemoryNet, Queue, Wake};
use maulstick_nodes::{BrushNode, BrushSettings, Offline, PaintNode};
use maulstick_optics::PaintLibrary;
use maulstick_paint::picture::picture;
use maulstick_paint::{Painting, PaintingSetup};
use maulstick_types::brush::BrushConsumed;
use maulstick_types::command::{Command, CommandReply, CommandRequest, Outcome};
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample};
use maulstick_types::topics::Topics;
use maulstick_types::{Flags, Mixture, Origin, decode, encode, name_hash};
use proptest::prelude::*;

const START_NS: u64 = 1_000_000_000_000;

fn painting() -> Painting {
    let setup = PaintingSetup {
        cells: [256, 192],
        ..PaintingSetup::default()
    };
    Painting::new(&setup, PaintLibrary::measured().expect("whole")).expect("a painting")
}

fn file() -> BrushFile {
    BrushFile::library("round")
        .expect("round")
        .scaled_to(4.0)
        .expect("scaled")
}

fn loads() -> Vec<Mixture> {
    ["Ultramarine Blue", "Pyrrole Red=0.5,Titanium White=0.5"]
        .map(|text| text.parse().expect("a mixture"))
        .to_vec()
}

/// Two crossing strokes and a dot.
fn take() -> Vec<(u64, StylusSample)> {
    let pen = |x: f64, y: f64, pressure: f64| StylusSample {
        pose: StylusPose::Contact {
            point_m: [x, y, 0.0],
            tilt_rad: DEFAULT_TILT_RAD,
            twist_rad: 0.0,
            pressure,
        },
        in_range: true,
        ..StylusSample::away()
    };
    let mut samples = Vec::new();
    for i in 0..120u64 {
        let t = i as f64 / 60.0;
        let sample = match i {
            0..50 => pen(
                -0.025 + 0.05 * t,
                -0.01 + 0.01 * t,
                (4.0 * t * (0.85 - t)).max(0.0),
            ),
            50..80 => pen(0.0, 0.0, 0.0),
            80..110 => pen(0.01, 0.06 - 0.04 * t, 0.4),
            _ => pen(0.01, 0.06 - 0.04 * t, 0.0),
        };
        samples.push((i * 8_000_000, sample));
    }
    samples
}

fn offline() -> Vec<u8> {
    let mut offline = Offline::new(painting(), "main", file(), 0.5, loads()).expect("set up");
    for (time_ns, sample) in take() {
        offline
            .sample(START_NS + time_ns, &sample)
            .expect("painted");
    }
    let report = offline.painting_mut().report();
    assert_eq!(report.quanta_missing, 0);
    assert!(
        report.covered_cells > 500 && report.steps > 200,
        "{report:?}"
    );
    picture(offline.painting_mut(), 0).rgb
}

struct Live {
    net: MemoryNet,
    topics: Topics,
    brush: BrushNode,
    paint: PaintNode,
    player: CreditSender<StylusSample>,
    credit: Receiver<BrushConsumed>,
    sent: usize,
    epoch: u32,
}

fn settings() -> BrushSettings {
    BrushSettings {
        name: "main".into(),
        file: file(),
        depth_share: 0.5,
        devices: BTreeMap::new(),
        others: Vec::new(),
        foreign_priority: Some(0),
        epoch: 77,
    }
}

impl Live {
    fn new(net: MemoryNet) -> Self {
        let (topics, wake) = (Topics::new("t"), Wake::new());
        let bus: Arc<dyn Bus> = Arc::new(net.bus());
        let brush = BrushNode::new(Arc::clone(&bus), &topics, &wake, settings()).expect("a brush");
        let origin = Origin {
            source: name_hash("player"),
            epoch: 3,
        };
        let topic = topics.sample("player");
        let player = CreditSender::new(&*bus, &topics, &topic, origin, &wake).expect("a player");
        let consumed = topics.brush_consumed("main");
        let credit =
            Receiver::new(&*bus, &consumed, Class::Control, Queue::Ring(64), &wake).expect("one");
        let paint = Self::paint_node(&bus, &topics, 5);
        Self {
            net,
            topics,
            brush,
            paint,
            player,
            credit,
            sent: 0,
            epoch: 3,
        }
    }

    fn paint_node(bus: &Arc<dyn Bus>, topics: &Topics, epoch: u32) -> PaintNode {
        let me = Origin {
            source: name_hash("paint"),
            epoch,
        };
        let mut node =
            PaintNode::new(Arc::clone(bus), topics, &Wake::new(), me, painting()).expect("paint");
        node.painting_mut().define_brush("main", file());
        node
    }

    /// One command, asked again until it is answered.
    fn command(&mut self, number: u64, command: Command) {
        let request = CommandRequest {
            client: 1,
            number,
            after: None,
            command,
        };
        let topic = self.topics.command("paint");
        let origin = Origin {
            source: 1,
            epoch: 1,
        };
        for _ in 0..1000 {
            let bytes = encode(&origin, Flags::NONE, 0, 0, 0, &request).expect("encoded");
            let limit = std::time::Duration::from_millis(100);
            let pending = self
                .net
                .bus()
                .ask(&topic, bytes, limit, &Wake::new())
                .expect("asked");
            for _ in 0..100 {
                self.net.advance(1_000_000);
                self.paint.turn().expect("turned");
                if let Some(maulstick_bus::bus::Answer::Bytes(bytes)) = pending.try_recv() {
                    let reply: CommandReply = decode(&bytes).expect("a reply").1;
                    assert!(matches!(reply.outcome, Outcome::Done { .. }), "{reply:?}");
                    return;
                }
            }
        }
        panic!("no answer to the command");
    }

    fn announce(&mut self, number: u64) {
        let (device, device_epoch) = (name_hash("player"), self.epoch);
        let brush = "main".to_owned();
        self.command(
            number,
            Command::Take {
                brush,
                device,
                device_epoch,
                loads: loads(),
            },
        );
    }

    fn player_turn(&mut self, samples: &[(u64, StylusSample)]) {
        let now_ns = self.net.bus().now_ns();
        while let Some(credit) = self.credit.try_recv() {
            let told = credit.message;
            if told.device == name_hash("player") {
                self.player.consumed(told.device_epoch, told.next, now_ns);
            }
        }
        while self.sent < samples.len() && self.player.has_credit() {
            let (time_ns, sample) = &samples[self.sent];
            let stamp = Stamp {
                now_ns,
                event_ns: START_NS + time_ns,
            };
            self.player
                .send(Flags::REPLAY, stamp, sample)
                .expect("sent");
            self.sent += 1;
        }
        self.player.serve(now_ns).expect("served");
    }

    /// Plays until all is painted; `order` decides who turns when. Stops early after `limit` turns.
    fn play(&mut self, order: &mut impl FnMut() -> u8, limit: usize) {
        let samples = take();
        for _ in 0..limit {
            match order() % 3 {
                0 => self.player_turn(&samples),
                1 => drop(self.brush.turn().expect("turned")),
                _ => drop(self.paint.turn().expect("turned")),
            }
            self.net.advance(700_000);
            let brush = Origin {
                source: name_hash("main"),
                epoch: 77,
            };
            let painted = self.paint.consumed(brush);
            if self.sent == samples.len()
                && self.player.outstanding() == 0
                && painted == self.brush.sent()
            {
                return;
            }
        }
    }
}

/// A small generator of turns: no clock, no hash, the same every time.
fn turns(mut state: u64) -> impl FnMut() -> u8 {
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as u8
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, ..ProptestConfig::default() })]

    #[test]
    fn over_any_network_in_any_order(
        seed in any::<u64>(),
        loss in 0.0..0.3f64,
        delay_ms in 0u64..40,
    ) {
        let faults = Faults { loss, delay_ns: delay_ms * 1_000_000 };
        let mut live = Live::new(MemoryNet::new(seed, START_NS, faults));
        live.announce(1);
        live.play(&mut turns(seed), 200_000);
        prop_assert!(picture(live.paint.painting_mut(), 0).rgb == offline());
        prop_assert_eq!(live.paint.painting_mut().report().quanta_missing, 0);
    }

    #[test]
    fn also_when_paint_dies_in_the_middle_and_the_take_is_played_again(
        seed in any::<u64>(),
        loss in 0.0..0.2f64,
        dies_after in 50usize..1500,
    ) {
        let faults = Faults { loss, delay_ns: 5_000_000 };
        let mut live = Live::new(MemoryNet::new(seed, START_NS, faults));
        live.announce(1);
        let mut order = turns(seed);
        live.play(&mut order, dies_after);
        let bus: Arc<dyn Bus> = Arc::new(live.net.bus());
        live.paint = Live::paint_node(&bus, &live.topics, 6);
        // The brush is still sending the take that died with the paint.
        live.play(&mut order, 40);
        live.epoch = 4;
        live.announce(2);
        live.player.restart(4);
        live.sent = 0;
        live.play(&mut order, 200_000);
        prop_assert!(picture(live.paint.painting_mut(), 0).rgb == offline());
    }
}

#[test]
fn a_take_that_nobody_announced_paints_nothing() {
    let mut live = Live::new(MemoryNet::new(1, START_NS, Faults::default()));
    live.play(&mut turns(1), 20_000);
    let report = live.paint.painting_mut().report();
    assert_eq!((report.covered_cells, report.steps), (0, 0));
}

#[test]
fn a_single_sample_less_would_be_seen() {
    let mut offline_painting =
        Offline::new(painting(), "main", file(), 0.5, loads()).expect("set up");
    for (i, (time_ns, sample)) in take().into_iter().enumerate() {
        if i != 30 {
            offline_painting
                .sample(START_NS + time_ns, &sample)
                .expect("painted");
        }
    }
    assert!(picture(offline_painting.painting_mut(), 0).rgb != offline());
}

#[test]
fn a_live_brush_merges_while_paint_is_busy_and_keeps_the_path() {
    let mut live = Live::new(MemoryNet::new(1, START_NS, Faults::default()));
    live.command(
        1,
        Command::Load {
            brush: "main".into(),
            mixture: loads()[0].clone(),
        },
    );
    let samples = take();
    let mut states = 0;
    for (number, (time_ns, sample)) in samples.iter().enumerate() {
        let now_ns = live.net.bus().now_ns();
        let stamp = Stamp {
            now_ns,
            event_ns: now_ns,
        };
        assert!(*time_ns < u64::MAX);
        live.player.forgive();
        live.player.send(Flags::NONE, stamp, sample).expect("sent");
        live.net.advance(8_000_000);
        live.brush.turn().expect("turned");
        // Paint has its turn only now and then.
        if number % 12 == 0 {
            live.paint.turn().expect("turned");
        }
        states = live.brush.sent();
    }
    for _ in 0..200 {
        live.net.advance(5_000_000);
        live.brush.turn().expect("turned");
        live.paint.turn().expect("turned");
    }
    assert!(
        states < samples.len() as u64 * 3 / 4,
        "{states} states of {} samples",
        samples.len()
    );
    let merged = live.paint.painting_mut().report();
    let mut offline =
        Offline::new(painting(), "main", file(), 0.5, vec![loads()[0].clone()]).expect("set up");
    for (time_ns, sample) in &samples {
        offline.sample(START_NS + time_ns, sample).expect("painted");
    }
    let whole = offline.painting_mut().report();
    assert_eq!(merged.quanta_missing, 0);
    let near = |a: u64, b: u64| (a as f64 / b as f64 - 1.0).abs() < 0.03;
    assert!(
        near(merged.covered_cells, whole.covered_cells),
        "{merged:?} {whole:?}"
    );
}
