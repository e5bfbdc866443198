//! Recordings through the whole daemon, over a bus in memory.

use std::path::Path;
use std::sync::Arc;

use maulstick_bus::bus::Token;
use maulstick_bus::typed::{Received, Receiver};
use maulstick_bus::{Bus, Faults, MemoryNet, Qos, Queue, Wake};
use maulstick_hid::daemon::{Daemon, HidSettings};
use maulstick_hid::device_source::{Found, HidSource, Ports};
use maulstick_hid::recording::{Event, Recorded};
use maulstick_hid::unfit::{Unfit, UnfitDevice};
use maulstick_rig::UserError;
use maulstick_rig::config::{CanvasSection, DeviceSection};
use maulstick_types::control::ControlSample;
use maulstick_types::stylus::{StylusInfo, StylusPose, StylusSample, StylusStatus, switch};
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Origin, name_hash};

use crate::support::{DESKTOP, DIGITIZER, Descriptor, deco_l, identity, spacemouse};

pub(crate) const START_NS: u64 = 1_000_000_000_000;

/// A rig in memory that hears a device called `pen`.
pub(crate) struct Rig {
    pub(crate) net: MemoryNet,
    pub(crate) daemon: Daemon,
    samples: Receiver<StylusSample>,
    controls: Receiver<ControlSample>,
    infos: Receiver<StylusInfo>,
    statuses: Receiver<StylusStatus>,
    brush: Option<Token>,
}

/// Nothing is plugged in.
struct Bare;

/// Ports at which there is nothing.
pub(crate) fn nothing_plugged_in() -> Box<dyn Ports> {
    Box::new(Bare)
}

impl Ports for Bare {
    fn list(&mut self) -> Result<Vec<Found>, UserError> {
        Ok(Vec::new())
    }

    fn open(&mut self, _: &Found) -> Result<Box<dyn HidSource>, UserError> {
        Err(UserError::failure("nothing is plugged in"))
    }
}

pub(crate) fn settings(driver: &str) -> HidSettings {
    HidSettings {
        device: DeviceSection::new("pen", driver, "main"),
        canvas: CanvasSection::default(),
        replay: None,
        record: None,
    }
}

impl Rig {
    pub(crate) fn new(settings: &HidSettings, ports: Box<dyn Ports>) -> Result<Self, UserError> {
        let net = MemoryNet::new(1, START_NS, Faults::default());
        let (bus, topics, wake): (Arc<dyn Bus>, _, _) =
            (Arc::new(net.bus()), Topics::new("studio"), Wake::new());
        let origin = Origin {
            source: name_hash("pen"),
            epoch: 1,
        };
        let (at, all) = (&*bus, Queue::Bounded(100_000));
        let samples = Receiver::new(at, &topics.sample("pen"), Qos::RealTime, all, &wake)?;
        let controls = Receiver::new(at, &topics.control("pen"), Qos::RealTime, all, &wake)?;
        let infos = Receiver::new(at, &topics.stylus_info("pen"), Qos::Cached, all, &wake)?;
        let topic = topics.stylus_status("pen");
        let statuses = Receiver::new(at, &topic, Qos::Background, all, &wake)?;
        let brush = Some(at.token(&topics.node("brush-main"))?);
        let daemon = Daemon::new(Arc::clone(&bus), &topics, &wake, origin, settings, ports)?;
        Ok(Self {
            net,
            daemon,
            samples,
            controls,
            infos,
            statuses,
            brush,
        })
    }

    /// Turns for so long, each step so far from the next, ns.
    pub(crate) fn run(&mut self, for_ns: u64, step_ns: u64) {
        for _ in 0..for_ns.div_ceil(step_ns) {
            self.daemon.poll().expect("turned");
            self.net.advance(step_ns);
        }
        self.daemon.poll().expect("turned");
        self.net.advance(1);
    }

    pub(crate) fn samples(&mut self) -> Vec<Received<StylusSample>> {
        std::iter::from_fn(|| self.samples.try_recv()).collect()
    }

    pub(crate) fn controls(&mut self) -> Vec<Received<ControlSample>> {
        std::iter::from_fn(|| self.controls.try_recv()).collect()
    }

    pub(crate) fn info(&mut self) -> Option<StylusInfo> {
        self.infos.newest().map(|received| received.message)
    }

    /// Reason in the newest status why there is no device, with advice.
    pub(crate) fn trouble(&mut self) -> String {
        let status = self.status().expect("told");
        let trouble = status.trouble();
        trouble.map_or(String::new(), |trouble| trouble.to_string())
    }

    pub(crate) fn status(&mut self) -> Option<StylusStatus> {
        self.statuses.newest().map(|received| received.message)
    }
}

/// A report of the Deco L.
pub(crate) fn stroke_report(
    tablet: &Descriptor,
    tip: i64,
    near: i64,
    x: i64,
    pressure: i64,
) -> Vec<u8> {
    tablet.pack(
        2,
        &[
            ((DIGITIZER, 0x42), tip),
            ((DIGITIZER, 0x32), near),
            ((DESKTOP, 0x30), x),
            ((DESKTOP, 0x31), 15_240),
            ((DIGITIZER, 0x30), pressure),
            ((DIGITIZER, 0x3D), 30),
        ],
    )
}

/// A pen that hovers, touches, rests for .3 s without a report, goes on, and is snatched away.
fn stroke() -> Recorded {
    let tablet = deco_l();
    let mut events = Vec::new();
    let mut say = |millis: u64, report: Vec<u8>| {
        events.push(Event {
            time_ns: millis * 1_000_000,
            report,
        });
    };
    for step in 0..10 {
        say(20 + 5 * step, stroke_report(&tablet, 0, 1, 10_160, 0));
    }
    for step in 0..20_u64 {
        let x = 10_160 + 1000 * i64::try_from(step).expect("few");
        say(70 + 5 * step, stroke_report(&tablet, 1, 1, x, 4000));
    }
    say(465, stroke_report(&tablet, 1, 1, 30_160, 0));
    say(470, stroke_report(&tablet, 0, 0, 0, 0));
    Recorded {
        identity: identity(0x28BD, 0x0935, "Deco L"),
        descriptor: tablet.bytes,
        events,
    }
}

pub(crate) fn write(path: &Path, recorded: &Recorded) {
    let lines: String = recorded.events.iter().map(Event::line).collect();
    std::fs::write(path, format!("{}{lines}", recorded.heading(0))).expect("written");
}

fn played(step_ns: u64) -> Rig {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("stroke.hid");
    write(&path, &stroke());
    let mut settings = settings("pen");
    settings.replay = Some(path);
    let mut rig = Rig::new(&settings, nothing_plugged_in()).expect("a daemon");
    rig.run(700_000_000, step_ns);
    rig
}

fn contact(sample: &StylusSample) -> ([f64; 3], f64) {
    match &sample.pose {
        StylusPose::Contact {
            point_m, pressure, ..
        } => (*point_m, *pressure),
        StylusPose::Ferrule { .. } => panic!("a pen has no ferrule"),
    }
}

#[test]
fn a_recorded_stroke_is_played_as_it_was_made() {
    let samples = played(1_000_000).samples();
    let told: Vec<_> = samples
        .iter()
        .map(|received| {
            let since = received.header.event_ns - START_NS;
            let (point, pressure) = contact(&received.message);
            (since, point, pressure, received.message.in_range)
        })
        .collect();
    // 254 x 152.4 mm on 256 x 256: a count of X is 8.4 µm.
    let scale = 0.256 / 0.1524;
    let x = |count: f64| (count / 50_800.0 - 0.5) * 0.254 * scale;
    let touches: Vec<_> = told
        .iter()
        .filter(|(.., pressure, _)| *pressure > 0.0)
        .collect();
    // Times are from the first report.
    assert_eq!(told[0].0, 0);
    assert_eq!(touches[0].0, 50_000_000);
    for (step, (since, point, pressure, near)) in touches[..20].iter().enumerate() {
        assert_eq!(*since, 50_000_000 + 5_000_000 * step as u64);
        assert!(
            (point[0] - x(10_160.0 + 1000.0 * step as f64)).abs() < 1e-12,
            "{point:?}"
        );
        assert!(point[1].abs() < 1e-12 && (pressure - 4000.0 / 8191.0).abs() < 1e-12 && *near);
    }
    // The rest is filled, so that the stroke goes on; then a touch without pressure is one.
    let fills = &touches[20..touches.len() - 1];
    assert_eq!(
        fills
            .iter()
            .map(|told| told.0 / 1_000_000)
            .collect::<Vec<_>>(),
        [195, 245, 295, 345, 395]
    );
    let last = touches[touches.len() - 1];
    assert_eq!((last.0, last.2), (445_000_000, 1.0 / 8192.0));
    // Snatched away, it is lifted where it was first.
    let end: Vec<_> = told[told.len() - 2..]
        .iter()
        .map(|told| (told.1, told.2, told.3))
        .collect();
    assert_eq!(end, [(last.1, 0.0, true), (last.1, 0.0, false)]);
    assert!(told.is_sorted_by(|a, b| a.0 < b.0), "time goes on");
}

#[test]
fn what_is_played_does_not_depend_on_when_the_daemon_turns() {
    let run = |step_ns| {
        let samples = played(step_ns).samples();
        let times = samples
            .into_iter()
            .map(|told| (told.header.event_ns, told.message));
        times.collect::<Vec<_>>()
    };
    let fine = run(250_000);
    assert_eq!(fine, run(7_300_000));
    assert_eq!(fine, run(90_000_000));
    // A comparison of fewer samples fails.
    assert_ne!(fine[1..], run(7_300_000)[..]);
}

#[test]
fn after_a_recording_the_pen_is_away_and_the_daemon_stays() {
    let mut rig = played(5_000_000);
    let before = rig.samples().len() as u64;
    rig.run(2_000_000_000, 20_000_000);
    assert!(rig.samples().is_empty());
    let (status, info) = (rig.status().expect("told"), rig.info().expect("told"));
    assert_eq!((status.samples, status.trouble.as_str()), (before, ""));
    assert_eq!((info.driver.as_str(), info.drives), ("pen", 0));
    assert!((info.workspace_m[4] - 0.128).abs() < 1e-12, "{info:?}");
}

#[test]
fn a_recording_waits_for_its_brush() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("stroke.hid");
    write(&path, &stroke());
    let mut settings = settings("pen");
    settings.replay = Some(path);
    settings.device.brush = "other".into();
    let mut rig = Rig::new(&settings, nothing_plugged_in()).expect("a daemon");
    rig.run(2_000_000_000, 10_000_000);
    assert!(rig.samples().is_empty());
    let topic = Topics::new("studio").node("brush-other");
    rig.brush = Some(rig.net.bus().token(&topic).expect("declared"));
    rig.run(700_000_000, 10_000_000);
    let samples = rig.samples();
    assert!(samples.len() > 30, "{}", samples.len());
    assert!(samples[0].header.event_ns >= START_NS + 2_000_000_000);
}

#[test]
fn a_brush_that_came_and_went_is_none_to_begin_for() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("stroke.hid");
    write(&path, &stroke());
    let mut settings = settings("pen");
    settings.replay = Some(path);
    let mut rig = Rig::new(&settings, nothing_plugged_in()).expect("a daemon");
    // Both tokens wait when the daemon takes its first turn.
    rig.brush = None;
    rig.net.advance(1_000_000);
    rig.run(2_000_000_000, 10_000_000);
    assert!(rig.samples().is_empty());
}

#[test]
fn a_pen_whose_tablet_never_says_that_it_is_away_is_after_a_second_of_silence() {
    let mut tablet = Descriptor::default();
    tablet.page(DIGITIZER).usage(0x02).begin(1).report(2);
    tablet.range(0, 1).usage(0x42).input(1).pad(7);
    tablet.page(DESKTOP).usage(0x30).range(0, 40_000).input(16);
    tablet.usage(0x31).range(0, 20_000).input(16).end();
    let event = |millis: u64, tip: i64| Event {
        time_ns: millis * 1_000_000,
        report: tablet.pack(2, &[((DIGITIZER, 0x42), tip), ((DESKTOP, 0x30), 9000)]),
    };
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("pen.hid");
    let recorded = Recorded {
        identity: identity(0x1234, 1, "Pen"),
        descriptor: tablet.bytes.clone(),
        // It rests for 3 s while it touches, and then hovers for 5.
        events: vec![event(0, 1), event(3000, 0), event(8000, 1)],
    };
    write(&path, &recorded);
    let mut settings = settings("pen");
    settings.replay = Some(path);
    let run = |step_ns| {
        let mut rig = Rig::new(&settings, nothing_plugged_in()).expect("a daemon");
        rig.run(9_000_000_000, step_ns);
        let told = rig.samples().into_iter();
        told.map(|told| ((told.header.event_ns - START_NS) / 1_000_000, told.message))
            .collect::<Vec<_>>()
    };
    let told = run(10_000_000);
    let away: Vec<_> = told
        .iter()
        .filter(|(_, sample)| !sample.in_range)
        .map(|(millis, _)| *millis)
        .collect();
    assert_eq!(away.len(), 2, "{away:?}");
    assert!((4000..4002).contains(&away[0]), "{away:?}");
    let touches = told.iter().filter(|(_, sample)| !sample.in_air());
    assert!(touches.count() > 60, "a touch rests as long as it likes");
    assert_eq!(told, run(770_000_000));
}

#[test]
fn the_example_in_the_documents_has_a_hover_a_stroke_and_an_eraser() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/examples/pen.hid");
    let mut settings = settings("pen");
    settings.device.replay = Some(path);
    let mut rig = Rig::new(&settings, nothing_plugged_in()).expect("a daemon");
    rig.run(3_000_000_000, 4_000_000);
    let samples = rig.samples();
    let count = |wanted: fn(&StylusSample) -> bool| {
        samples.iter().filter(|told| wanted(&told.message)).count()
    };
    let erases = |sample: &StylusSample| sample.switches & switch::ERASER != 0;
    assert!(count(|sample| sample.in_range && sample.in_air()) > 10);
    assert!(
        samples
            .iter()
            .filter(|told| !told.message.in_air() && !erases(&told.message))
            .count()
            > 50
    );
    assert!(
        samples
            .iter()
            .filter(|told| !told.message.in_air() && erases(&told.message))
            .count()
            > 20
    );
    assert!(samples.iter().all(|told| told.message.fault().is_none()));
    assert!(!samples.last().expect("samples").message.in_range);
}

#[test]
fn a_recording_of_something_else_is_refused_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("mouse.hid");
    let recorded = Recorded {
        identity: identity(0x256F, 0xC635, "SpaceMouse Compact"),
        descriptor: spacemouse().bytes,
        events: Vec::new(),
    };
    write(&path, &recorded);
    let mut pen = settings("pen");
    pen.replay = Some(path.clone());
    let fault = Rig::new(&pen, nothing_plugged_in()).err().expect("refused");
    let unfit = UnfitDevice {
        identity: recorded.identity,
        why: Unfit::NoPen(vec![(DESKTOP, 0x08)]),
    };
    let place = path.display().to_string();
    assert_eq!(fault, UserError::from(unfit).at(place));
    let mut mouse = settings("spacemouse");
    mouse.replay = Some(path);
    let mut rig = Rig::new(&mouse, nothing_plugged_in()).expect("a daemon");
    rig.run(10_000_000, 1_000_000);
    // One that says nothing is over when it begins, not before the rig did.
    let told = rig.controls();
    assert!(!told.is_empty() && told.iter().all(|told| told.header.event_ns >= START_NS));
}

#[test]
fn a_recorded_mouse_pushes_and_comes_to_rest() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("mouse.hid");
    let event = |millis: u64, report: &[u8]| Event {
        time_ns: millis * 1_000_000,
        report: report.to_vec(),
    };
    let recorded = Recorded {
        identity: identity(0x256F, 0xC635, "SpaceMouse Compact"),
        descriptor: spacemouse().bytes,
        events: vec![
            event(0, &[1, 0x5E, 1, 0, 0, 0, 0]),
            event(8, &[2, 0, 0, 0, 0, 0x5E, 1]),
            event(16, &[3, 2, 0]),
            // Its receiver was pulled out, and something else came a second later.
            event(1016, &[0x17, 80, 0]),
        ],
    };
    write(&path, &recorded);
    let mut settings = settings("spacemouse");
    settings.replay = Some(path);
    let mut rig = Rig::new(&settings, nothing_plugged_in()).expect("a daemon");
    rig.run(900_000_000, 5_000_000);
    let told = rig.controls();
    let at = |millis: u64| {
        let until = START_NS + millis * 1_000_000;
        let mut before = told.iter().filter(|told| told.header.event_ns <= until);
        before.next_back().expect("told").message.clone()
    };
    assert_eq!((at(0).push, at(0).turn), ([1.0, 0.0, 0.0], [0.0; 3]));
    assert_eq!((at(16).turn, at(16).switches), ([0.0, 0.0, -1.0], 2));
    assert_eq!(at(200).push, [1.0, 0.0, 0.0]);
    let falling = at(260).push[0];
    assert!(falling > 0.1 && falling < 0.9, "{falling}");
    assert_eq!((at(400).push, at(400).turn), ([0.0; 3], [0.0; 3]));
    assert!(told.iter().all(|told| told.message.fault().is_none()));
    assert!(rig.samples().is_empty(), "it is no stylus");
    let info = rig.info().expect("it is listed all the same");
    assert_eq!(
        (info.driver.as_str(), info.senses, info.drives),
        ("spacemouse", 0, 0)
    );
    assert!(rig.status().expect("told").samples > 10);
}
