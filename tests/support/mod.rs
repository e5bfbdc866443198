//! Real processes for whole-rig tests: rigs of their own names in folders of their own.

#![allow(
    clippy::panic,
    dead_code,
    unreachable_pub,
    missing_docs,
    unused_imports,
    reason = "shared by test programs, each of which uses a part"
)]

pub mod display;
pub mod place;
pub mod replay;

use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Dial, Qos, Queue, RigClock, RigFolder, Wake, ZenohBus};
use maulstick_device::{Take, TakeSample};
use maulstick_types::Message;
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample, axes};
use maulstick_types::wire::topics::Topics;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;

/// Nothing in a test takes longer than this, unless it hangs.
pub const PATIENCE: Duration = Duration::from_secs(120);

pub use place::{COARSE, MAULSTICK, Place, fault, has};

impl Place {
    /// Processes of a rig in this place.
    pub fn processes(&self) -> Vec<(u32, String)> {
        let mark = self.folder.path().display().to_string();
        let mut found = Vec::new();
        for entry in std::fs::read_dir("/proc").into_iter().flatten().flatten() {
            let Ok(pid) = entry.file_name().to_string_lossy().parse::<u32>() else {
                continue;
            };
            let Ok(line) = std::fs::read(entry.path().join("cmdline")) else {
                continue;
            };
            let line = String::from_utf8_lossy(&line).replace('\0', " ");
            if line.contains("maulstick-") && line.contains(&mark) {
                found.push((pid, line));
            }
        }
        found
    }

    /// Process of a node of the rig, by its program.
    pub fn pid(&self, program: &str) -> Option<u32> {
        let name = format!("{program} ");
        self.processes()
            .into_iter()
            .find(|(_, line)| line.starts_with(&name))
            .map(|(pid, _)| pid)
    }

    /// What a command that must succeed prints as JSON.
    pub fn json(&self, args: &[&str]) -> serde_json::Value {
        serde_json::from_str(&self.text(args)).expect("JSON")
    }

    /// Writes `rig.toml`: the built-in settings with other lines in place of some.
    pub fn write_settings(&self, others: &[(&str, &str)]) {
        let mut settings = self.text(&["up", "--print-config"]);
        for (line, other) in others {
            assert!(settings.contains(line), "{line}");
            settings = settings.replace(line, other);
        }
        self.write("rig.toml", settings);
    }

    /// Waits until no process of a rig in this place is left.
    pub fn wait_empty(&self, limit: Duration) {
        let empty = wait_for(limit, || self.processes().is_empty().then_some(()));
        assert!(empty.is_some(), "left behind: {:?}", self.processes());
    }
}

/// Looks until something is there; none after `limit`.
pub fn wait_for<T>(limit: Duration, mut look: impl FnMut() -> Option<T>) -> Option<T> {
    let give_up = Instant::now() + limit;
    loop {
        if let Some(found) = look() {
            return Some(found);
        }
        if Instant::now() > give_up {
            return None;
        }
        std::thread::yield_now();
        std::thread::park_timeout(Duration::from_millis(2));
    }
}

/// Sends a signal to a process.
pub fn signal(pid: u32, signal: Signal) {
    kill(Pid::from_raw(pid as i32), signal).expect("the process is there");
}

/// A running launcher, whose messages are read as they come.
pub struct Launcher {
    child: Child,
    said: Arc<Mutex<String>>,
}

impl Launcher {
    pub fn start(mut command: Command) -> Self {
        let mut child = command
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("started");
        let said = Arc::new(Mutex::new(String::new()));
        let (to, from) = (Arc::clone(&said), child.stderr.take().expect("piped"));
        std::thread::spawn(move || {
            for line in BufReader::new(from).lines().map_while(Result::ok) {
                let mut said = to.lock().expect("unpoisoned");
                said.push_str(&line);
                said.push('\n');
            }
        });
        Self { child, said }
    }

    /// A rig without a window in a place, once it is up.
    pub fn up(place: &Place, args: &[&str]) -> Self {
        let mut launcher = Self::start(place.maulstick(&[&["up", "--headless"], args].concat()));
        launcher.wait_says("is up");
        launcher
    }

    /// Ends a rig as its painter does.
    pub fn close(mut self, place: &Place) {
        self.signal(Signal::SIGINT);
        self.wait(PATIENCE);
        place.wait_empty(PATIENCE);
    }

    pub fn pid(&self) -> u32 {
        self.child.id()
    }

    pub fn said(&self) -> String {
        self.said.lock().expect("unpoisoned").clone()
    }

    /// Waits until it has said something.
    pub fn wait_says(&mut self, text: &str) {
        let heard = wait_for(PATIENCE, || self.said().contains(text).then_some(()));
        assert!(heard.is_some(), "never said '{text}', but: {}", self.said());
    }

    /// Whether it has not ended yet.
    pub fn is_running(&mut self) -> bool {
        self.child.try_wait().expect("waited").is_none()
    }

    /// Waits for its end.
    pub fn wait(&mut self, limit: Duration) -> ExitStatus {
        wait_for(limit, || self.child.try_wait().expect("waited"))
            .unwrap_or_else(|| panic!("does not end; it said: {}", self.said()))
    }

    pub fn signal(&self, which: Signal) {
        signal(self.pid(), which);
    }
}

impl Drop for Launcher {
    fn drop(&mut self) {
        self.child.kill().ok();
        self.child.wait().ok();
    }
}

/// Whether two files are the same, said in few words if not.
pub fn assert_same(one: &[u8], two: &[u8], what: &str) {
    let differs = one.iter().zip(two).position(|(a, b)| a != b);
    assert!(
        one == two,
        "{what}: {} and {} bytes, first difference at {differs:?}",
        one.len(),
        two.len()
    );
}

/// A client of the rig in a place.
pub fn join(place: &Place) -> (ZenohBus, Topics) {
    let (_, info) = RigFolder::join_at(&place.path("maulstick/studio")).expect("a rig");
    let dial = Dial {
        name: "test".into(),
        listen: None,
        connect: vec![info.endpoint],
    };
    let clock = RigClock::with_offset(info.clock_offset_ns);
    (
        ZenohBus::open(&dial, clock).expect("joined"),
        Topics::new(&info.rig),
    )
}

/// Hears a topic from now on.
pub fn listen<M: Message>(bus: &ZenohBus, topic: &str, qos: Qos) -> Receiver<M> {
    Receiver::new(bus, topic, qos, Queue::Ring(1024), &Wake::new()).expect("subscribed")
}

/// The next message that `wanted` accepts.
pub fn hear<M: Message>(heard: &mut Receiver<M>, mut wanted: impl FnMut(&M) -> bool) -> Option<M> {
    wait_for(PATIENCE, || {
        while let Some(received) = heard.try_recv() {
            if wanted(&received.message) {
                return Some(received.message);
            }
        }
        None
    })
}

/// Forgets what was heard until now.
pub fn drain<M: Message>(heard: &mut Receiver<M>) {
    while heard.try_recv().is_some() {}
}

/// What `painting info --check` says of a painting in a file.
pub fn info(place: &Place, file: &str) -> serde_json::Value {
    let output = place.done(&["painting", "info", "--check", "--json", file]);
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// Cubic metres of paint on the canvas.
pub fn on_canvas(place: &Place) -> f64 {
    account(place, "canvas")
}

/// Cubic metres of paint in an account of the ledger.
pub fn account(place: &Place, name: &str) -> f64 {
    place.done(&["snapshot", "-o", "p.png", "--ledger", "l.json"]);
    let ledger: serde_json::Value = serde_json::from_slice(&place.bytes("l.json")).expect("JSON");
    assert_eq!(ledger["quanta_missing"], 0);
    ledger["accounts_m3"][name].as_f64().expect("a number")
}

/// A take of a hand that moves to and fro on the canvas, fully pressed, for three minutes; each four
/// seconds it lifts for half of one, for force begins only above the canvas.
pub fn press_for_minutes(path: &Path) {
    let samples = (0..18_000u64).map(|number| {
        let way = (number % 400) as f64 / 400.0;
        let x = 0.2 * (way - 0.5).abs() - 0.05;
        let pressure = match way {
            way if way > 0.875 => 0.0,
            way => (8.0 * way).clamp(0.01, 1.0),
        };
        TakeSample {
            time_ns: number * 10_000_000,
            sample: StylusSample {
                senses: axes::POSITION | axes::PRESSURE | axes::TILT,
                pose: StylusPose::Contact {
                    point_m: [x, 0.0, 0.0],
                    tilt_rad: DEFAULT_TILT_RAD,
                    twist_rad: 0.0,
                    pressure,
                },
                in_range: true,
                ..StylusSample::away()
            },
        }
    });
    let take = Take {
        setup: None,
        device: "hand".into(),
        samples: samples.collect(),
    };
    take.write(path).expect("written");
}

/// Whether the tip of the undeformed head is a millimetre below the canvas at the least.
pub fn pressed(sample: &StylusSample, head_length_m: f64) -> bool {
    let StylusPose::Ferrule { pose } = &sample.pose else {
        return false;
    };
    // The bristles lie along −z of the brush.
    let [x, y, ..] = pose.orientation;
    let tip_z = pose.position_m[2] - head_length_m * (1.0 - 2.0 * (x * x + y * y));
    sample.in_range && tip_z < -1e-3
}

/// Python of the tests, with the packages that `./test` installs.
pub fn python(place: &Place, program: &str, words: &[&str]) -> Command {
    let root: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let python = root.join("target/test-venv/bin/python");
    assert!(
        python.exists(),
        "run ./test: it installs zenoh, mcap and matplotlib for Python"
    );
    let mut command = Command::new(python);
    command
        .arg(root.join("tests/python").join(program))
        .args(words)
        .env("XDG_RUNTIME_DIR", place.path(""));
    command
}

/// What a program prints that must succeed.
pub fn printed(command: &mut Command, input: &[u8]) -> String {
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("started");
    child
        .stdin
        .take()
        .expect("piped")
        .write_all(input)
        .expect("read");
    let output = child.wait_with_output().expect("ended");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    String::from_utf8(output.stdout)
        .expect("text")
        .trim()
        .to_owned()
}
