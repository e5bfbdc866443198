//! A painter who changes the brush between strokes, however far the paint is behind: a brush node and a paint node on a
//! network in memory, with the window's own queue of requests before them.

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;
use std::time::Duration;

use maulstick_brush::BrushFile;
use maulstick_brush_node::{BrushDevices, BrushNode, BrushSettings};
use maulstick_bus::bus::{Answer, Pending};
use maulstick_bus::credit::Stamp;
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, CreditSender, Faults, MemoryNet, Qos, Queue, Wake};
use maulstick_client::pending_orders::PendingSender;
use maulstick_client::request::Request;
use maulstick_client::stroke_barrier::{SampleNumber, StrokeBarrier};
use maulstick_optics::PaintLibrary;
use maulstick_paint_node::PaintNode;
use maulstick_painting::edits::{Clean, Handle, Load, Tune};
use maulstick_painting::{Painting, PaintingSetup};
use maulstick_types::brush::BrushState;
use maulstick_types::command::{
    BrushCommand, Command, CommandReply, CommandRequest, Outcome, PAINT_NODE,
};
use maulstick_types::paint::{Entry, JournalEntry};
use maulstick_types::scene::{BrushHandling, BrushMode, Tuning};
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample};
use maulstick_types::values::{BrushName, BrushToml};
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Flags, Mixture, Origin, decode, encode, name_hash};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng as _;

const MS: u64 = 1_000_000;
const START_NS: u64 = 1_000_000_000_000;
const BRUSH: &str = "main";
/// Changes in all.
const CHANGES: usize = 200;
/// The window looks at its queue so often, ms.
const FRAME_MS: u64 = 16;

/// Settings of a brush that paints, in words.
#[derive(Clone, Debug, Default, PartialEq)]
struct Setting {
    width_mm: f64,
    load: String,
    mode: String,
    stiffness: f64,
}

/// A command in flight, or one that waits for that before it.
struct Sending {
    request: CommandRequest,
    asked_ns: u64,
    pending: Option<(Pending, u64)>,
}

struct Studio {
    net: MemoryNet,
    topics: Topics,
    brush: BrushNode,
    paint: PaintNode,
    mouse: CreditSender<StylusSample>,
    sent: u64,
    barrier: StrokeBarrier,
    pending: PendingSender,
    queues: BTreeMap<String, VecDeque<Sending>>,
    number: u64,
    journal: Receiver<JournalEntry>,
    states: Receiver<BrushState>,
    random: Pcg32,
    /// The paint node is busy until then, ns.
    busy_ns: u64,
    /// Longest that the painting was behind, ns.
    behind_ns: u64,
}

fn file(width_mm: f64) -> BrushFile {
    let round = BrushFile::library("round").expect("round");
    round.scaled_to(width_mm).expect("scaled")
}

fn name() -> BrushName {
    BrushName::new(BRUSH).expect("valid")
}

impl Studio {
    fn new(seed: u64) -> Self {
        let faults = Faults {
            loss: 0.0,
            delay_ns: 4 * MS,
        };
        let net = MemoryNet::new(seed, START_NS, faults);
        let (topics, wake) = (Topics::new("t"), Wake::new());
        let bus: Arc<dyn Bus> = Arc::new(net.bus());
        let settings = BrushSettings {
            name: BRUSH.into(),
            file: file(3.0),
            depth_share: 0.5,
            devices: BrushDevices {
                foreign_priority: Some(0),
                ..BrushDevices::default()
            },
            epoch: 77,
        };
        let brush = BrushNode::new(Arc::clone(&bus), &topics, &wake, settings).expect("a brush");
        let setup = PaintingSetup {
            cells: [160, 120],
            ..PaintingSetup::default()
        };
        let library = PaintLibrary::measured().expect("whole");
        let painting = Painting::new(&setup, library).expect("a painting");
        let me = |name: &str| Origin {
            source: name_hash(name),
            epoch: 5,
        };
        let paint = PaintNode::new(Arc::clone(&bus), &topics, &wake, me(PAINT_NODE), painting);
        let topic = topics.sample("mouse");
        let mouse = CreditSender::new(&*bus, &topics, &topic, me("mouse"), &wake);
        let listen = |topic: &str| (topic.to_owned(), Queue::Ring(1 << 16));
        let (topic, queue) = listen(&topics.journal());
        let journal = Receiver::new(&*bus, &topic, Qos::Data, queue, &wake).expect("listens");
        let (topic, queue) = listen(&topics.brush_state(BRUSH));
        let states = Receiver::new(&*bus, &topic, Qos::Control, queue, &wake).expect("listens");
        Self {
            barrier: StrokeBarrier::new(&*bus, &topics).expect("listens"),
            pending: PendingSender::new(&*bus, &topics).expect("sends"),
            mouse: mouse.expect("a mouse"),
            paint: paint.expect("a paint node"),
            sent: 0,
            queues: BTreeMap::new(),
            number: 0,
            random: Pcg32::new(seed, 7),
            busy_ns: 0,
            behind_ns: 0,
            net,
            topics,
            brush,
            journal,
            states,
        }
    }

    fn now_ns(&self) -> u64 {
        self.net.bus().now_ns()
    }

    fn dice(&mut self, sides: u32) -> u32 {
        self.random.next_u32() % sides
    }

    /// A millisecond goes by. The paint node does some states at a time and is then busy, so it is behind.
    fn pass(&mut self) {
        self.net.advance(MS);
        self.mouse.reset_credit();
        self.mouse.serve(self.now_ns()).expect("served");
        self.brush.poll().expect("turned");
        if self.now_ns() >= self.busy_ns {
            let before = self.paint.consumed(Origin {
                source: name_hash(BRUSH),
                epoch: 77,
            });
            self.paint.poll().expect("turned");
            let after = self.paint.consumed(Origin {
                source: name_hash(BRUSH),
                epoch: 77,
            });
            self.busy_ns = self.now_ns() + (after - before) * u64::from(self.dice(45)) * MS;
            self.behind_ns = self.behind_ns.max(self.busy_ns - self.now_ns());
        }
        if (self.now_ns() / MS).is_multiple_of(FRAME_MS) {
            self.frame();
        }
    }

    /// A frame of the window: its queue is looked at.
    fn frame(&mut self) {
        let now_ns = self.now_ns();
        self.barrier.drain(now_ns);
        while let Some(ready) = self.barrier.next_ready(now_ns) {
            let Request::Command { node, command } = ready.request else {
                panic!("no command");
            };
            self.number += 1;
            let request = CommandRequest {
                client: 1,
                number: self.number,
                after: ready.after,
                command,
            };
            let sending = Sending {
                request,
                asked_ns: ready.asked_ns,
                pending: None,
            };
            self.queues.entry(node).or_default().push_back(sending);
        }
        self.send_first(now_ns);
        let queued = self
            .queues
            .values()
            .flatten()
            .map(|sending| sending.asked_ns);
        let oldest = queued.chain(self.barrier.oldest_ns()).min();
        self.pending.send(now_ns, oldest).expect("told");
    }

    /// Sends the first request of each queue, and takes the answers.
    fn send_first(&mut self, now_ns: u64) {
        for (node, queue) in &mut self.queues {
            let Some(first) = queue.front_mut() else {
                continue;
            };
            let topic = self.topics.command(node);
            let (pending, asked_ns) = first.pending.get_or_insert_with(|| {
                let me = Origin {
                    source: 1,
                    epoch: 1,
                };
                let bytes = encode(&me, Flags::NONE, 0, now_ns, now_ns, &first.request);
                let limit = Duration::from_millis(300);
                let bus = self.net.bus();
                let asked = bus.ask(
                    &topic,
                    Qos::Control,
                    bytes.expect("encoded"),
                    limit,
                    &Wake::new(),
                );
                (asked.expect("asked"), now_ns)
            });
            match pending.try_recv() {
                Some(Answer::Bytes(bytes)) => {
                    let reply: CommandReply = decode(&bytes).expect("a reply").1;
                    match reply.outcome {
                        Outcome::Waiting => first.pending = None,
                        Outcome::Done { .. } => drop(queue.pop_front()),
                        Outcome::Refused { what, .. } => panic!("refused: {what}"),
                    }
                }
                Some(Answer::Ended) => first.pending = None,
                None if now_ns > *asked_ns + 300 * MS => first.pending = None,
                None => {}
            }
        }
    }

    fn sample(&mut self, x_mm: f64, y_mm: f64, pressure: f64) {
        let pose = StylusPose::Contact {
            point_m: [x_mm * 1e-3, y_mm * 1e-3, 0.0],
            tilt_rad: DEFAULT_TILT_RAD,
            twist_rad: 0.0,
            pressure,
        };
        let sample = StylusSample {
            pose,
            in_range: true,
            ..StylusSample::away()
        };
        let (now_ns, event_ns) = (self.now_ns(), self.now_ns());
        let stamp = Stamp { now_ns, event_ns };
        self.mouse.send(Flags::NONE, stamp, &sample).expect("sent");
        self.sent += 1;
    }

    /// A stroke; when it began and ended, ns.
    fn stroke(&mut self) -> [u64; 2] {
        let (x, y) = (
            f64::from(self.dice(24)) - 15.0,
            f64::from(self.dice(20)) - 10.0,
        );
        self.sample(x, y, 0.0);
        self.pass();
        let begun_ns = self.now_ns();
        let samples = 3 + self.dice(4);
        for i in 0..samples {
            self.sample(x + 1.5 * f64::from(i), y, 0.5);
            for _ in 0..8 {
                self.pass();
            }
        }
        let ended_ns = self.now_ns();
        self.sample(x + 1.5 * f64::from(samples), y, 0.0);
        [begun_ns, ended_ns]
    }

    fn ask(&mut self, command: impl Into<Command>) {
        let newest = SampleNumber {
            device: name_hash("mouse"),
            epoch: 5,
            seq: self.sent - 1,
        };
        let now_ns = self.now_ns();
        self.barrier
            .push(now_ns, (Request::of(command), now_ns), [newest]);
    }

    /// A change of the brush; what it is painted with then.
    fn change(&mut self, mut setting: Setting) -> Setting {
        match self.dice(4) {
            0 => {
                setting.width_mm = 2.0 + 0.5 * f64::from(self.dice(5));
                let toml = file(setting.width_mm).to_toml().expect("written");
                let toml = BrushToml::new(toml).expect("short");
                let brush = name();
                self.ask(BrushCommand::Define { brush, toml });
            }
            1 if self.dice(3) == 0 => {
                setting.load = String::new();
                self.ask(Clean { brush: name() });
            }
            1 => {
                let paints = [
                    "Bone Black",
                    "Pyrrole Red",
                    "Titanium White",
                    "Yellow Ochre",
                ];
                let mixture = Mixture::pure(paints[self.dice(4) as usize]);
                setting.load = mixture.to_string();
                self.ask(Load {
                    mixture,
                    beside: None,
                    brush: name(),
                });
            }
            2 => {
                let modes = [BrushMode::Normal, BrushMode::NoPush, BrushMode::Vacuum];
                let mode = modes[self.dice(3) as usize].clone();
                setting.mode = format!("{mode:?}");
                let handling = BrushHandling {
                    mode,
                    ..BrushHandling::normal(BRUSH)
                };
                self.ask(Handle::try_from(&handling).expect("in range"));
            }
            _ => {
                setting.stiffness = 0.5 + 0.25 * f64::from(self.dice(5));
                let tuning = Tuning {
                    brush: BRUSH.to_owned(),
                    stiffness: setting.stiffness,
                    wetness: 0.0,
                };
                self.ask(Tune::try_from(&tuning).expect("in range"));
            }
        }
        setting
    }

    /// With what each solve in contact was painted: its time, and the settings by the journal.
    fn painted(&mut self, mut setting: Setting) -> Vec<(u64, Setting)> {
        let mut states = BTreeMap::new();
        while let Some(state) = self.states.try_recv() {
            states.insert(state.header.seq, state.message);
        }
        let mut entries = BTreeMap::new();
        while let Some(entry) = self.journal.try_recv() {
            entries.insert(entry.message.index, entry.message.entry);
        }
        let mut painted = Vec::new();
        for entry in entries.into_values() {
            match entry {
                Entry::Brush { toml, .. } => {
                    let file = BrushFile::parse(&toml).expect("a brush");
                    setting.width_mm = file.head.width_mm;
                }
                Entry::Command { command, .. } => {
                    if let Some(load) = command.edit::<Load>() {
                        setting.load = load.mixture.to_string();
                    } else if command.edit::<Clean>().is_some() {
                        setting.load = String::new();
                    } else if let Some(handle) = command.edit::<Handle>() {
                        setting.mode = format!("{:?}", handle.mode);
                    } else {
                        let tune: Tune = command.edit().expect("no other edit");
                        setting.stiffness = Tuning::from(tune).stiffness;
                    }
                }
                Entry::States { from, to, .. } => {
                    let solves = (from..=to).flat_map(|seq| &states[&seq].solves);
                    let touching = solves.filter(|solve| !solve.contacts.is_empty());
                    painted.extend(touching.map(|solve| (solve.event_ns, setting.clone())));
                }
                _ => {}
            }
        }
        painted
    }
}

#[test]
fn each_stroke_is_painted_with_what_was_asked_for_before_it_however_late_the_paint_is() {
    let mut studio = Studio::new(3);
    for _ in 0..100 {
        studio.pass();
    }
    let first = Setting {
        width_mm: 3.0,
        load: String::new(),
        mode: format!("{:?}", BrushMode::Normal),
        stiffness: 1.0,
    };
    let (mut setting, mut changes) = (first.clone(), 0);
    let mut expected = Vec::new();
    studio.stroke();
    while changes < CHANGES {
        // Some changes come at once after the stroke, and the next stroke at once after them.
        for _ in 0..=studio.dice(3) {
            for _ in 0..[0, 1, 20, 60][studio.dice(4) as usize] {
                studio.pass();
            }
            setting = studio.change(setting);
            changes += 1;
        }
        // The window sends what was asked for with its frame.
        studio.frame();
        for _ in 0..5 + [0, 10, 40, 150][studio.dice(4) as usize] {
            studio.pass();
        }
        expected.push((studio.stroke(), setting.clone()));
    }
    let end_ns = studio.now_ns() + 20_000 * MS;
    while studio.now_ns() < end_ns {
        studio.pass();
    }
    assert!(!studio.barrier.is_waiting() && studio.queues.values().all(VecDeque::is_empty));
    assert!(
        studio.behind_ns > 100 * MS,
        "the paint is never late: {} ms",
        studio.behind_ns / MS
    );
    let painted = studio.painted(first);
    let (mut strokes, mut wrong) = (0, Vec::new());
    for ([from_ns, to_ns], wanted) in &expected {
        let own = painted
            .iter()
            .filter(|(at_ns, _)| (*from_ns..=*to_ns).contains(at_ns));
        let own: Vec<_> = own.collect();
        strokes += usize::from(!own.is_empty());
        let fault = own.iter().find(|(_, setting)| setting != wanted);
        wrong.extend(fault.map(|(at_ns, found)| (at_ns - from_ns, wanted, found)));
    }
    assert_eq!(strokes, expected.len(), "strokes are missing");
    assert!(
        wrong.is_empty(),
        "{} of {strokes}: {:#?}",
        wrong.len(),
        &wrong[..wrong.len().min(3)]
    );
}
