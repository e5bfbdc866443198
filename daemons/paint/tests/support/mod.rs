//! A brush and a paint node over a network in memory, a player, and the same without a bus.

#![allow(
    clippy::panic,
    dead_code,
    unreachable_pub,
    missing_docs,
    reason = "shared by test programs, each of which uses a part"
)]

use std::sync::{Arc, LazyLock};

use maulstick_brush::BrushFile;
use maulstick_brush_node::{BrushDevices, BrushNode, BrushSettings};
use maulstick_bus::credit::Stamp;
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, CreditSender, MemoryNet, Qos, Queue, Wake};
use maulstick_optics::PaintLibrary;
use maulstick_paint_node::PaintNode;
use maulstick_painting::picture::picture;
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_session::Offline;
use maulstick_types::brush::BrushConsumed;
use maulstick_types::command::TakeCommand;
use maulstick_types::command::{Command, CommandReply, CommandRequest, Outcome};
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample};
use maulstick_types::values::BrushName;
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Flags, Mixture, Origin, decode, encode, name_hash};

pub const START_NS: u64 = 1_000_000_000_000;

pub fn painting() -> Painting {
    painting_of("impasto")
}

/// A painting whose canvas has this paint model.
pub fn painting_of(model: &str) -> Painting {
    let setup = PaintingSetup {
        cells: [256, 192],
        model: model.to_owned(),
        ..PaintingSetup::default()
    };
    Painting::new(&setup, PaintLibrary::measured().expect("whole")).expect("a painting")
}

pub fn file() -> BrushFile {
    BrushFile::library("round")
        .expect("round")
        .scaled_to(4.0)
        .expect("scaled")
}

pub fn loads() -> Vec<Mixture> {
    ["Ultramarine Blue", "Pyrrole Red=0.5,Titanium White=0.5"]
        .map(|text| text.parse().expect("a mixture"))
        .to_vec()
}

/// A pen over the canvas.
pub fn pen(x: f64, y: f64, pressure: f64) -> StylusSample {
    StylusSample {
        pose: StylusPose::Contact {
            point_m: [x, y, 0.0],
            tilt_rad: DEFAULT_TILT_RAD,
            twist_rad: 0.0,
            pressure,
        },
        in_range: true,
        ..StylusSample::away()
    }
}

/// Two crossing strokes and a dot.
pub fn take() -> Vec<(u64, StylusSample)> {
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

pub fn offline() -> &'static [u8] {
    static OFFLINE: LazyLock<Vec<u8>> = LazyLock::new(|| offline_on(painting()));
    &OFFLINE
}

/// The take on a painting, without a bus.
pub fn offline_on(painting: Painting) -> Vec<u8> {
    let mut offline = Offline::new(painting, "main", file(), 0.5, loads()).expect("set up");
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

pub struct Live {
    pub net: MemoryNet,
    pub topics: Topics,
    pub brush: BrushNode,
    pub paint: PaintNode,
    pub player: CreditSender<StylusSample>,
    pub credit: Receiver<BrushConsumed>,
    pub sent: usize,
    pub epoch: u32,
    /// Samples of the take that is played.
    pub of_take: usize,
}

pub fn settings() -> BrushSettings {
    BrushSettings {
        name: "main".into(),
        file: file(),
        depth_share: 0.5,
        devices: BrushDevices {
            foreign_priority: Some(0),
            ..BrushDevices::default()
        },
        epoch: 77,
    }
}

impl Live {
    pub fn new(net: MemoryNet) -> Self {
        Self::with(net, settings())
    }

    pub fn with(net: MemoryNet, settings: BrushSettings) -> Self {
        let (topics, wake) = (Topics::new("t"), Wake::new());
        let bus: Arc<dyn Bus> = Arc::new(net.bus());
        let brush = BrushNode::new(Arc::clone(&bus), &topics, &wake, settings).expect("a brush");
        let origin = Origin {
            source: name_hash("player"),
            epoch: 3,
        };
        let topic = topics.sample("player");
        let player = CreditSender::new(&*bus, &topics, &topic, origin, &wake).expect("a player");
        let consumed = topics.brush_consumed("main");
        let credit =
            Receiver::new(&*bus, &consumed, Qos::Control, Queue::Ring(64), &wake).expect("one");
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
            of_take: take().len(),
        }
    }

    pub fn paint_node(bus: &Arc<dyn Bus>, topics: &Topics, epoch: u32) -> PaintNode {
        Self::paint_node_on(bus, topics, epoch, painting())
    }

    pub fn paint_node_on(
        bus: &Arc<dyn Bus>,
        topics: &Topics,
        epoch: u32,
        painting: Painting,
    ) -> PaintNode {
        let me = Origin {
            source: name_hash("paint"),
            epoch,
        };
        let mut node =
            PaintNode::new(Arc::clone(bus), topics, &Wake::new(), me, painting).expect("paint");
        while !node.knows_brush("main") {
            node.poll().expect("turned");
        }
        node
    }

    /// One command, asked again until it is done.
    pub fn command(&mut self, number: u64, command: Command) {
        let outcome = self.ask("paint", number, command);
        assert!(matches!(outcome, Outcome::Done { .. }), "{outcome:?}");
    }

    /// One command to a node, asked again until it is done or refused.
    pub fn ask(&mut self, node: &str, number: u64, command: Command) -> Outcome {
        let request = CommandRequest {
            client: 1,
            number,
            after: None,
            command,
        };
        let topic = self.topics.command(node);
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
                .ask(&topic, Qos::Control, bytes, limit, &Wake::new())
                .expect("asked");
            for _ in 0..100 {
                self.net.advance(1_000_000);
                match node {
                    "paint" => self.paint.poll().expect("turned"),
                    _ => self.brush.poll().expect("turned"),
                };
                if let Some(maulstick_bus::bus::Answer::Bytes(bytes)) = pending.try_recv() {
                    let reply: CommandReply = decode(&bytes).expect("a reply").1;
                    if reply.outcome == Outcome::Waiting {
                        break;
                    }
                    return reply.outcome;
                }
            }
        }
        panic!("no answer to the command");
    }

    pub fn announce(&mut self, number: u64) {
        let (device, device_epoch) = (name_hash("player"), self.epoch);
        let brush = "main".to_owned();
        self.command(
            number,
            Command::from(TakeCommand::Begin {
                brush: BrushName::new(brush).expect("valid"),
                device,
                device_epoch,
                loads: loads(),
                again: false,
            }),
        );
    }

    /// Another device of this rig.
    pub fn device(&self, name: &str, source: u32) -> Device {
        let (topics, wake) = (&self.topics, Wake::new());
        let bus = self.net.bus();
        let origin = Origin { source, epoch: 11 };
        let (sample, consumed) = (topics.sample(name), topics.brush_consumed("main"));
        let credit = Receiver::new(&bus, &consumed, Qos::Control, Queue::Ring(64), &wake);
        Device {
            samples: CreditSender::new(&bus, topics, &sample, origin, &wake).expect("a device"),
            credit: credit.expect("subscribed"),
            net: self.net.clone(),
        }
    }

    pub fn player_turn(&mut self, samples: &[(u64, StylusSample)]) {
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
            self.sent += 1;
            let flags = if self.sent == self.of_take {
                Flags::REPLAY.with(Flags::LAST)
            } else {
                Flags::REPLAY
            };
            self.player.send(flags, stamp, sample).expect("sent");
        }
        self.player.serve(now_ns).expect("served");
    }

    /// Plays until all is painted; `order` decides who turns when. Stops early after `limit` turns.
    pub fn play(&mut self, order: &mut impl FnMut() -> u8, limit: usize) {
        self.play_take(&take(), order, limit);
    }

    /// The same with another take.
    pub fn play_take(
        &mut self,
        samples: &[(u64, StylusSample)],
        order: &mut impl FnMut() -> u8,
        limit: usize,
    ) {
        self.of_take = samples.len();
        for _ in 0..limit {
            match order() % 3 {
                0 => self.player_turn(samples),
                1 => drop(self.brush.poll().expect("turned")),
                _ => drop(self.paint.poll().expect("turned")),
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

/// A live device.
pub struct Device {
    pub samples: CreditSender<StylusSample>,
    credit: Receiver<BrushConsumed>,
    net: MemoryNet,
}

impl Device {
    /// Sends a sample, whoever listens.
    pub fn send(&mut self, sample: &StylusSample) {
        let now_ns = self.net.bus().now_ns();
        let stamp = Stamp {
            now_ns,
            event_ns: now_ns,
        };
        self.samples.reset_credit();
        self.samples.serve(now_ns).expect("served");
        self.samples.send(Flags::NONE, stamp, sample).expect("sent");
    }

    /// ReplyCache for what was lost.
    pub fn serve(&mut self) {
        let now_ns = self.net.bus().now_ns();
        self.samples.reset_credit();
        self.samples.serve(now_ns).expect("served");
    }

    /// Number of its samples that the brush has consumed.
    pub fn consumed(&mut self) -> u64 {
        let me = self.samples.origin();
        std::iter::from_fn(|| self.credit.try_recv())
            .map(|told| told.message)
            .filter(|told| (told.device, told.device_epoch) == (me.source, me.epoch))
            .map(|told| told.next)
            .last()
            .unwrap_or(0)
    }
}

/// A small generator of turns: no clock, no hash, the same every time.
pub fn turns(mut state: u64) -> impl FnMut() -> u8 {
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as u8
    }
}
