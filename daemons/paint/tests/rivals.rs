//! A second sender under the name of a device, a brush or the paint node: nobody is muted for good.

mod support;

use maulstick_brush::BrushFile;
use maulstick_bus::typed::{Receiver, Sender};
use maulstick_bus::{Bus, Faults, MemoryNet, Qos, Queue, Wake};
use maulstick_painting::edits::Load;
use maulstick_types::brush::{BrushDef, BrushState};
use maulstick_types::command::Command;
use maulstick_types::paint::PaintStatus;
use maulstick_types::scene::Scene;
use maulstick_types::stylus::StylusSample;
use maulstick_types::values::BrushName;
use maulstick_types::{Flags, Message, Origin, encode, name_hash};
use support::{Device, Live, START_NS, loads, pen};

/// Fault of a scene, and its cause.
type Change = (&'static str, fn(&mut Scene));

/// Two seconds, in turns of 2 ms.
const TWO_SECONDS: u32 = 1000;

/// A painting rig with a loaded brush and a mouse.
struct Rig {
    live: Live,
    mouse: Device,
    steps: u32,
}

impl Rig {
    fn new() -> Self {
        let mut live = Live::new(MemoryNet::new(1, START_NS, Faults::default()));
        let load = Command::from(Load {
            mixture: loads()[0].clone(),
            beside: None,
            brush: BrushName::main(),
        });
        live.command(1, load);
        let mouse = live.device("mouse", 5);
        let mut rig = Self {
            live,
            mouse,
            steps: 0,
        };
        assert!(rig.paints(), "at the start");
        rig
    }

    fn turn(&mut self) {
        self.live.net.advance(1_000_000);
        self.live.brush.poll().expect("turned");
        self.live.net.advance(1_000_000);
        self.live.paint.poll().expect("turned");
    }

    /// True if a short stroke becomes paint.
    fn paints(&mut self) -> bool {
        let before = self.live.paint.painting_mut().report().steps;
        for _ in 0..20 {
            self.steps += 1;
            let x = 1e-3 * f64::from(self.steps % 40) - 0.02;
            self.mouse.send(&pen(x, 0.0, 0.5));
            for _ in 0..4 {
                self.turn();
            }
        }
        self.mouse.send(&pen(0.0, 0.0, 0.0));
        self.turn();
        self.live.paint.painting_mut().report().steps > before
    }

    /// Sends one message as anybody may.
    fn stray<M: Message>(&mut self, topic: &str, origin: Origin, flags: Flags, seq: u64, m: &M) {
        let bus = self.live.net.bus();
        let now_ns = bus.now_ns();
        let bytes = encode(&origin, flags, seq, now_ns, now_ns, m).expect("encoded");
        let publisher = bus.publisher(topic, Qos::RealTime).expect("declared");
        publisher.put(bytes).expect("sent");
        self.turn();
    }

    /// The device is silent for two seconds, then paints as before.
    fn is_back(&mut self, what: &str) {
        for _ in 0..TWO_SECONDS {
            self.turn();
        }
        assert!(self.paints(), "{what}");
    }
}

fn origin(source: u32, epoch: u32) -> Origin {
    Origin { source, epoch }
}

#[test]
fn a_stray_sample_mutes_no_device() {
    let mut rig = Rig::new();
    let topic = rig.live.topics.sample("mouse");
    let hover = pen(0.0, 0.0, 0.0);
    let strays = [
        ("another epoch", 12, Flags::NONE, 3),
        ("another epoch's first", 13, Flags::FIRST, 0),
        ("a leap", 11, Flags::NONE, 1_000_000),
    ];
    for (what, epoch, flags, seq) in strays {
        rig.stray(&topic, origin(5, epoch), flags, seq, &hover);
        rig.is_back(what);
    }
}

#[test]
fn a_stray_state_mutes_no_brush_and_is_counted() {
    let mut rig = Rig::new();
    let (topic, wake) = (rig.live.topics.brush_state("main"), Wake::new());
    let bus = rig.live.net.bus();
    let status = rig.live.topics.paint_status();
    let mut statuses: Receiver<PaintStatus> =
        Receiver::new(&bus, &status, Qos::Background, Queue::Ring(4), &wake).expect("one");
    let empty = BrushState {
        device: 5,
        device_epoch: 11,
        device_seq: 0,
        solves: Vec::new(),
    };
    let strays = [
        ("another epoch", 78, Flags::NONE, 3),
        ("another epoch's first", 79, Flags::FIRST, 0),
        ("a leap", 77, Flags::NONE, 1_000_000),
    ];
    for (what, epoch, flags, seq) in strays {
        rig.stray(&topic, origin(name_hash("main"), epoch), flags, seq, &empty);
        rig.is_back(what);
    }
    let told = statuses.newest().expect("a status").message;
    assert!(told.refused >= 2, "{}", told.refused);
}

#[test]
fn a_scene_that_is_none_is_dropped_and_a_foreign_one_is_contradicted() {
    let mut rig = Rig::new();
    let topic = rig.live.topics.scene();
    let scene = rig.live.paint.painting_mut().scene().clone();
    let changes: [Change; 5] = [
        ("NaN", |scene| {
            scene.surfaces[0].pose.position_m[2] = f64::NAN
        }),
        ("no zoom", |scene| scene.surfaces[0].zoom = 0.0),
        ("no light", |scene| scene.light.intensity = f64::INFINITY),
        ("a canvas far away", |scene| {
            scene.surfaces[0].pose.position_m[2] = -50.0
        }),
        ("no surface, of the last version", |scene| {
            scene.surfaces.clear();
            scene.version = u64::MAX;
        }),
    ];
    for (what, change) in changes {
        let mut foreign = scene.clone();
        change(&mut foreign);
        // As from the paint node itself, and as from another.
        for epoch in [5, 6] {
            rig.stray(
                &topic,
                origin(name_hash("paint"), epoch),
                Flags::NONE,
                900,
                &foreign,
            );
            rig.is_back(what);
        }
    }
    for change in [changes[0].1, changes[1].1, changes[2].1] {
        let mut faulty = scene.clone();
        change(&mut faulty);
        assert!(faulty.fault().is_some() && scene.fault().is_none());
    }
}

#[test]
fn a_foreign_brush_file_is_contradicted() {
    let mut rig = Rig::new();
    let topic = rig.live.topics.brush_def("main");
    let toml = BrushFile::library_text("flat").expect("flat").to_owned();
    let def = BrushDef {
        brush: "main".into(),
        hash: name_hash(&toml),
        toml,
        head_length_m: 0.0,
    };
    rig.stray(&topic, origin(name_hash("main"), 99), Flags::FIRST, 0, &def);
    rig.is_back("a foreign brush file");
}

#[test]
fn of_two_senders_of_one_stream_a_receiver_follows_the_newer_and_says_so_once() {
    let net = MemoryNet::new(1, START_NS, Faults::default());
    let (bus, wake) = (net.bus(), Wake::new());
    let class = Qos::RealTime;
    let mut heard: Receiver<StylusSample> =
        Receiver::new(&bus, "t/pen", class, Queue::Ring(64), &wake).expect("subscribed");
    let mut pens: Vec<Sender<_>> = [1, 2]
        .map(|epoch| Sender::new(&bus, "t/pen", class, origin(5, epoch)).expect("a pen"))
        .into();
    let mut both = |pens: &mut [Sender<_>], which: &[usize]| {
        let mut epochs = Vec::new();
        for _ in 0..200 {
            for pen_number in which {
                let now_ns = bus.now_ns();
                pens[*pen_number]
                    .send(now_ns, now_ns, &pen(0.0, 0.0, 0.0))
                    .expect("sent");
            }
            net.advance(10_000_000);
            epochs.extend(std::iter::from_fn(|| heard.try_recv()).map(|m| m.header.epoch));
        }
        (epochs, heard.refusals().len())
    };
    assert_eq!(both(&mut pens, &[0]), (vec![1; 200], 0));
    assert_eq!(both(&mut pens, &[1, 0]), (vec![2; 200], 1));
    let (back, told) = both(&mut pens, &[0]);
    assert_eq!((back.len(), back.last(), told), (151, Some(&1), 0));
}
