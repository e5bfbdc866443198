//! What others do to a rig: a device in another language, and messages that are none.

#[path = "../support/mod.rs"]
mod support;

use std::io::{BufRead as _, BufReader};
use std::net::UdpSocket;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStderr, Command, Stdio};
use std::time::Duration;

use glam::{DQuat, DVec3};
use maulstick_bus::typed::Receiver;
use maulstick_bus::{Bus, Qos, Queue, Wake, ZenohBus};
use maulstick_num::geometry::{canonical, rotation};
use maulstick_types::command::{CommandRequest, TakeCommand};
use maulstick_types::paint::PaintStatus;
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample};
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Flags, HEADER_BYTES, Origin, Pose, encode};
use support::{Launcher, PATIENCE, Place, hear, join, listen, on_canvas, wait_for};

/// A pen that presses at `x`.
fn pressing(x: f64) -> StylusSample {
    StylusSample {
        pose: StylusPose::Contact {
            point_m: [x, 0.0, 0.0],
            tilt_rad: DEFAULT_TILT_RAD,
            twist_rad: 0.0,
            pressure: 0.5,
        },
        in_range: true,
        ..StylusSample::away()
    }
}

#[test]
fn a_sample_beyond_the_world_holds_nothing_up() {
    let place = Place::new();
    let mut launcher = Launcher::start(place.maulstick(&["up", "--headless"]));
    launcher.wait_says("is up");
    place.done(&["load", "Bone Black"]);
    let (bus, topics) = join(&place);
    let origin = Origin {
        source: 9,
        epoch: 9,
    };
    let topic = topics.sample("evil");
    let publisher = bus.publisher(&topic, Qos::RealTime).expect("declared");
    let mut number = 0;
    let mut send = |sample: StylusSample| {
        let now_ns = bus.now_ns();
        let bytes = encode(&origin, Flags::NONE, number, now_ns, now_ns, &sample).expect("encoded");
        number += 1;
        publisher.put(bytes).expect("sent");
    };
    // In contact, and within .1 s at the end of the world: followed cell by cell it would never end.
    let mut painted = 0.0;
    let patience = std::time::Instant::now() + PATIENCE;
    while painted <= 0.0 && std::time::Instant::now() < patience {
        for step in 0..20 {
            send(pressing(1e-3 * f64::from(step)));
            send(pressing(1e30));
            wait_for(Duration::from_millis(4), || None::<()>);
        }
        painted = on_canvas(&place);
    }
    assert!(painted > 0.0, "nothing is painted: {}", launcher.said());
    bus.close();
}

/// A program of `tests/python` that has been told of the rig in a place.
fn python(place: &Place, program: &str, options: &[&str]) -> Child {
    let root: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let python = root.join("target/test-venv/bin/python");
    assert!(
        python.exists(),
        "run ./test: it installs eclipse-zenoh for Python"
    );
    let endpoint = place.done(&["endpoint", "--json"]);
    let mut child = Command::new(python)
        .arg(root.join("tests/python").join(program))
        .args(options)
        .stdin(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("started");
    let mut stdin = child.stdin.take().expect("piped");
    std::io::Write::write_all(&mut stdin, &endpoint.stdout).expect("written");
    child
}

#[test]
fn a_device_in_python_paints() {
    let place = Place::new();
    let launcher = Launcher::up(&place, &[]);
    let stylus = python(&place, "stylus.py", &[]);
    let ended = stylus.wait_with_output().expect("ended");
    assert!(
        ended.status.success(),
        "{}",
        String::from_utf8_lossy(&ended.stderr)
    );
    let painted = wait_for(PATIENCE, || (on_canvas(&place) > 0.0).then_some(()));
    assert!(painted.is_some(), "{}", launcher.said());
}

/// A message as a program of the next version of its contract sends it: with a field more at its end.
fn of_next_version(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.extend(1.5f64.to_le_bytes());
    bytes[2] += 1;
    let length = u32::try_from(bytes.len() - HEADER_BYTES).expect("short");
    bytes[20..24].copy_from_slice(&length.to_le_bytes());
    bytes
}

#[test]
fn a_device_of_a_later_version_paints() {
    let place = Place::new();
    let launcher = Launcher::up(&place, &[]);
    place.done(&["load", "Bone Black"]);
    let (bus, topics) = join(&place);
    let origin = Origin {
        source: 11,
        epoch: 11,
    };
    let topic = topics.sample("newer");
    let publisher = bus.publisher(&topic, Qos::RealTime).expect("declared");
    let mut number = 0;
    let painted = wait_for(PATIENCE, || {
        let now_ns = bus.now_ns();
        let sample = pressing(1e-4 * (number % 400) as f64);
        let bytes = encode(&origin, Flags::NONE, number, now_ns, now_ns, &sample).expect("encoded");
        publisher.put(of_next_version(bytes)).expect("sent");
        number += 1;
        (number % 50 == 0 && on_canvas(&place) > 0.0).then_some(())
    });
    assert!(painted.is_some(), "{}", launcher.said());
}

/// A datagram as OpenTrack sends it: cm and degrees.
fn datagram(numbers: [f64; 6]) -> Vec<u8> {
    numbers.into_iter().flat_map(f64::to_le_bytes).collect()
}

/// The tracker's program and the socket that it listens on; dropped, it ends.
struct Tracker {
    program: Child,
    /// What it says; it could not say more once this were closed.
    _said: BufReader<ChildStderr>,
    socket: UdpSocket,
}

impl Tracker {
    fn start(place: &Place, device: &str) -> Self {
        let mut program = python(place, "tracker.py", &["--port", "0", "--device", device]);
        let mut said = BufReader::new(program.stderr.take().expect("piped"));
        let mut line = String::new();
        said.read_line(&mut line).expect("text");
        let address = line.trim_end().strip_prefix("listening on ");
        let socket = UdpSocket::bind("127.0.0.1:0").expect("a socket");
        socket.connect(address.expect(&line)).expect("there");
        Self {
            program,
            _said: said,
            socket,
        }
    }

    /// Sends a pose among datagrams that are none.
    fn send(&self, pose: [f64; 6]) {
        let good = datagram(pose);
        let far = datagram([1e9, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let none = datagram([f64::NAN, 0.0, 0.0, 0.0, 0.0, 0.0]);
        for bytes in [&good[..47], &far, &none, &good, &[]] {
            self.socket.send(bytes).expect("sent");
        }
    }
}

impl Drop for Tracker {
    fn drop(&mut self) {
        self.program.kill().ok();
        self.program.wait().ok();
    }
}

/// The ferrule of a sample, if it is one.
fn held(sample: &StylusSample) -> Option<&Pose> {
    match &sample.pose {
        StylusPose::Ferrule { pose } => Some(pose),
        StylusPose::Contact { .. } => None,
    }
}

/// Sends a pose until its sample comes, and returns the ferrule. It is known by its place along x; the first samples may
/// be missed.
fn tracked(tracker: &Tracker, heard: &mut Receiver<StylusSample>, pose: [f64; 6]) -> Option<Pose> {
    wait_for(PATIENCE, || {
        tracker.send(pose);
        while let Some(received) = heard.try_recv() {
            let sample = received.message;
            assert_eq!(sample.fault(), None, "{sample:?}");
            let ferrule = held(&sample).expect("a ferrule");
            let is_it = (ferrule.position_m[0] - 0.01 * pose[0]).abs() < 1e-9;
            if sample.in_range && is_it {
                return Some(ferrule.clone());
            }
        }
        None
    })
}

/// Orientation of angles, degrees.
fn turned(yaw: f64, pitch: f64, roll: f64) -> DQuat {
    let about = |axis: DVec3, degrees: f64| rotation(axis, degrees.to_radians());
    canonical(about(DVec3::Y, yaw) * about(DVec3::X, pitch) * about(DVec3::Z, roll))
}

/// Yaw, pitch and roll, degrees: a turn by each angle alone tells which is which.
const ANGLES: [[f64; 3]; 6] = [
    [0.0, 0.0, 0.0],
    [40.0, 0.0, 0.0],
    [0.0, -25.0, 0.0],
    [0.0, 0.0, 130.0],
    [40.0, -25.0, 130.0],
    [200.0, 300.0, -190.0],
];

#[test]
fn a_tracker_holds_the_ferrule_until_it_falls_silent() {
    let place = Place::new();
    let launcher = Launcher::up(&place, &[]);
    let (bus, topics) = join(&place);
    let mut heard = listen::<StylusSample>(&bus, &topics.sample("wand"), Qos::RealTime);
    let tracker = Tracker::start(&place, "wand");
    let mut off = [0.0f64; 2];
    for (number, [yaw, pitch, roll]) in ANGLES.into_iter().enumerate() {
        let pose = [1.0 + number as f64, -2.0, 30.0, yaw, pitch, roll];
        let ferrule = tracked(&tracker, &mut heard, pose);
        let ferrule = ferrule.unwrap_or_else(|| panic!("{number}: {}", launcher.said()));
        assert!((ferrule.position_m[1] + 0.02).abs() < 1e-9);
        assert!((ferrule.position_m[2] - 0.3).abs() < 1e-9);
        let told = DQuat::from_array(ferrule.orientation);
        // Turned in the other order as a seeded fault.
        let orders = [turned(yaw, pitch, roll), turned(pitch, yaw, roll)];
        for (off, expected) in off.iter_mut().zip(orders) {
            *off = off.max(told.angle_between(expected));
        }
    }
    assert!(off[0] < 1e-6 && off[1] > 0.1, "{off:?}");
    // Silence: once, where it was.
    let away = hear(&mut heard, |sample| !sample.in_range).expect("it leaves");
    assert!((held(&away).expect("a ferrule").position_m[0] - 0.06).abs() < 1e-9);
    bus.close();
}

/// Bytes that are no message: an unknown schema, a wrong length, a hostile length inside the body, a cut, a surplus.
fn hostile() -> Vec<Vec<u8>> {
    let origin = Origin {
        source: 9,
        epoch: 9,
    };
    let mark = CommandRequest {
        client: 1,
        number: 1,
        after: None,
        command: TakeCommand::Mark.into(),
    };
    let good = encode(&origin, Flags::NONE, 0, 1, 1, &mark).expect("encoded");
    let mut hostile = vec![Vec::new(), vec![0; 7], vec![0xff; 5000]];
    for (at, byte) in [(4, 0x55), (20, 0x01), (48 + 16 + 1, 0xff)] {
        let mut bytes = good.clone();
        bytes[at] ^= byte;
        hostile.push(bytes);
    }
    hostile.push(good[..good.len() - 1].to_vec());
    hostile.push([&good[..], &[0]].concat());
    hostile
}

/// Sends messages to all that listen, and asks all that answer with them.
fn attack(bus: &ZenohBus, topics: &Topics, messages: &[Vec<u8>], wake: &Wake) {
    for topic in [
        topics.sample("evil"),
        topics.brush_state("main"),
        topics.contact_model("phantom"),
        topics.scene(),
        topics.paint_consumed(),
        topics.brush_consumed("main"),
        topics.brush_def("x"),
    ] {
        let publisher = bus.publisher(&topic, Qos::Data).expect("declared");
        for bytes in messages {
            publisher.put(bytes.clone()).expect("sent");
        }
    }
    for topic in [
        topics.command("paint"),
        topics.frame(),
        topics.gap("brush/main/state"),
    ] {
        for bytes in messages {
            let limit = Duration::from_millis(50);
            let asked = bus.ask(&topic, Qos::Control, bytes.clone(), limit, wake);
            drop(asked.expect("asked"));
        }
    }
}

#[test]
fn hostile_messages_are_counted_and_dropped() {
    let place = Place::new();
    let launcher = Launcher::up(&place, &[]);
    let before = place.processes();
    let (bus, topics) = join(&place);
    let wake = Wake::new();
    let (topic, class) = (topics.paint_status(), Qos::Background);
    let mut status = Receiver::<PaintStatus>::new(&bus, &topic, class, Queue::Latest, &wake)
        .expect("subscribed");
    let hostile = hostile();
    let told = wait_for(PATIENCE, || {
        attack(&bus, &topics, &hostile, &wake);
        status.newest().filter(|status| status.message.refused > 10)
    });
    assert!(told.is_some(), "nothing was counted: {}", launcher.said());
    assert_eq!(
        place.processes(),
        before,
        "a node fell: {}",
        launcher.said()
    );
    place.done(&["load", "Bone Black"]);
    assert_eq!(on_canvas(&place), 0.0);
    let said = launcher.said();
    let warnings = said.lines().filter(|line| line.contains("schema")).count();
    assert!((1..20).contains(&warnings), "it says it once: {said}");
    bus.close();
}
