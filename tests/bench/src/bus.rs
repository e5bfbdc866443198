//! Latency of a stylus sample from a device's process to that of the brush node: through the stream with credit,
//! decoded and in order, and through a bare zenoh put into a ring and a thread, in turn on the same link.

use std::io::{BufRead as _, BufReader, Write as _};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, mpsc};
use std::time::Duration;

use maulstick_bus::credit::Stamp;
use maulstick_bus::{
    Bus as _, CreditReceiver, CreditSender, Dial, RigClock, RigFolder, Wake, ZenohBus,
};
use maulstick_rig::UserError;
use maulstick_types::stylus::StylusSample;
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Flags, Origin};
use zenoh::Wait as _;
use zenoh::handlers::RingChannel;
use zenoh::pubsub::Publisher;
use zenoh::qos::{CongestionControl, Priority};

use crate::report::{Report, quantile, sorted};

/// Pairs that are measured.
const PAIRS: u64 = 4000;
/// Number of unmeasured pairs before them.
const WARM_UP: u64 = 400;
/// Time between two.
const APART: Duration = Duration::from_micros(500);
/// Topic of the bare put.
const BARE: &str = "bench/bare";
/// Bytes of a sample with its header, which the bare put carries too.
const BYTES: usize = 200;

fn fault(error: impl std::fmt::Display) -> UserError {
    UserError::failure(error.to_string())
}

/// Both ways of a sample over one link.
struct Link<'a> {
    bus: &'a ZenohBus,
    ours: CreditSender<StylusSample>,
    bare: Publisher<'a>,
    sample: StylusSample,
}

impl<'a> Link<'a> {
    fn new(bus: &'a ZenohBus) -> Result<Self, UserError> {
        let origin = Origin {
            source: 1,
            epoch: 1,
        };
        let (topics, wake) = (Topics::new("bench"), Wake::new());
        let topic = topics.sample("near");
        let bare = bus
            .raw_session()
            .declare_publisher(BARE)
            .congestion_control(CongestionControl::Drop)
            .priority(Priority::RealTime);
        Ok(Self {
            bus,
            ours: CreditSender::new(bus, &topics, &topic, origin, &wake)?,
            bare: bare.wait().map_err(fault)?,
            sample: StylusSample::away(),
        })
    }

    /// Sends a sample on the stream with credit.
    fn send(&mut self) -> Result<(), UserError> {
        let now_ns = self.bus.now_ns();
        let event_ns = now_ns;
        self.ours.reset_credit();
        self.ours
            .send(Flags::NONE, Stamp { now_ns, event_ns }, &self.sample)?;
        Ok(())
    }

    /// Puts the bytes of one.
    fn put(&self) -> Result<(), UserError> {
        let mut bytes = vec![0; BYTES];
        bytes[..8].copy_from_slice(&self.bus.now_ns().to_le_bytes());
        self.bare.put(bytes).wait().map_err(fault)
    }

    /// Sends both until the far end has received both.
    fn wait_until_ready(&mut self, ready: &mpsc::Receiver<String>) -> Result<(), UserError> {
        loop {
            self.send()?;
            self.put()?;
            match ready.recv_timeout(Duration::from_millis(20)) {
                Ok(line) if line == "ready" => return Ok(()),
                Ok(line) => return Err(fault(line)),
                Err(mpsc::RecvTimeoutError::Timeout) => {}
                Err(error) => return Err(fault(error)),
            }
        }
    }
}

/// The lines that a process prints.
fn lines_of(child: &mut Child) -> Result<mpsc::Receiver<String>, UserError> {
    let output = child.stdout.take().ok_or_else(|| fault("no output"))?;
    let mut lines = BufReader::new(output).lines();
    let (to_us, ready) = mpsc::channel();
    std::thread::spawn(move || {
        while let Some(Ok(line)) = lines.next() {
            if to_us.send(line).is_err() {
                break;
            }
        }
    });
    Ok(ready)
}

/// Latencies of a line, ns, sorted, without the unmeasured ones.
fn latencies(line: &str) -> Vec<f64> {
    let cells = line.split(' ').filter_map(|cell| cell.parse().ok());
    let all: Vec<f64> = cells.collect();
    sorted(all[all.len().min(WARM_UP as usize)..].to_vec())
}

/// Measures and reports.
pub(crate) fn run(report: &mut Report) -> Result<(), UserError> {
    let base = tempfile::tempdir().map_err(fault)?;
    let folder = RigFolder::create_in(&base.path().join("rigs"), "bench")?;
    let (clock, locator) = (RigClock::start(), folder.locator("near"));
    let dial = Dial {
        name: "near".into(),
        listen: Some(locator.clone()),
        connect: Vec::new(),
    };
    let bus = ZenohBus::open(&dial, clock)?;
    let mut child = Command::new(std::env::current_exe().map_err(fault)?)
        .args(["bench", "--far-end"])
        .arg(format!("{locator} {}", clock.offset_ns()))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .map_err(fault)?;
    let ready = lines_of(&mut child)?;
    let mut link = Link::new(&bus)?;
    link.wait_until_ready(&ready)?;
    for _ in 0..PAIRS + WARM_UP {
        link.send()?;
        std::thread::sleep(APART);
        link.put()?;
        std::thread::sleep(APART);
    }
    child.stdin.take();
    let next = || {
        let line = ready.recv_timeout(Duration::from_secs(10));
        line.map(|line| latencies(&line)).map_err(fault)
    };
    let (ours, bare) = (next()?, next()?);
    child.wait().map_err(fault)?;
    for (name, share) in [
        ("sample.p50", 0.5),
        ("sample.p90", 0.9),
        ("sample.p99", 0.99),
    ] {
        let peer = ("bare zenoh put", quantile(&bare, share) / 1e3);
        report.beside(name, quantile(&ours, share) / 1e3, "µs", peer);
    }
    report.row("sample.received", ours.len() as f64 / PAIRS as f64, "share");
    Ok(())
}

/// Latencies of the bare puts, ns.
fn bare_latencies(bus: &ZenohBus, clock: RigClock) -> Result<mpsc::Receiver<u64>, UserError> {
    let ring = bus
        .raw_session()
        .declare_subscriber(BARE)
        .with(RingChannel::new(1024))
        .wait()
        .map_err(fault)?;
    let (to_main, bare) = mpsc::channel();
    std::thread::spawn(move || {
        while let Ok(sample) = ring.recv() {
            let now_ns = clock.now_ns();
            let bytes = sample.payload().to_bytes();
            let mut stamp = [0; 8];
            stamp.copy_from_slice(&bytes[..8]);
            if to_main.send(now_ns - u64::from_le_bytes(stamp)).is_err() {
                break;
            }
        }
    });
    Ok(bare)
}

/// A flag that is set, and rung for, at the end of the standard input.
fn end_of_input(wake: &Wake) -> Arc<AtomicBool> {
    let (end, wake) = (Arc::new(AtomicBool::new(false)), wake.clone());
    let flag = Arc::clone(&end);
    std::thread::spawn(move || {
        std::io::stdin().lines().for_each(drop);
        flag.store(true, Ordering::SeqCst);
        wake.ring();
    });
    end
}

/// The receiving process: prints `ready` once it has received both, and at the end of its input the latencies of ours
/// and of the bare ones, ns.
pub(crate) fn far_end(argument: &str) -> Result<(), UserError> {
    let (locator, offset) = argument.split_once(' ').ok_or_else(|| fault("no clock"))?;
    let clock = RigClock::with_offset(offset.parse().map_err(fault)?);
    let dial = Dial {
        name: "far".into(),
        listen: Some(locator.replace("near.sock", "far.sock")),
        connect: vec![locator.to_owned()],
    };
    let bus = ZenohBus::open(&dial, clock)?;
    let wake = Wake::new();
    let topics = Topics::new("bench");
    let me = Origin {
        source: 2,
        epoch: 2,
    };
    let topic = topics.sample("*");
    let mut receiver = CreditReceiver::<StylusSample>::new(&bus, &topics, &topic, me, &wake)?;
    let bare = bare_latencies(&bus, clock)?;
    let end = end_of_input(&wake);
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    let mut said = false;
    while !end.load(Ordering::SeqCst) {
        wake.wait(Duration::from_millis(100));
        receiver.poll(&bus)?;
        while let Some(received) = receiver.pop() {
            ours.push(clock.now_ns() - received.header.sent_ns);
        }
        theirs.extend(bare.try_iter());
        if !said && !ours.is_empty() && !theirs.is_empty() {
            said = true;
            ours.clear();
            theirs.clear();
            println!("ready");
            std::io::stdout().flush().map_err(fault)?;
        }
    }
    theirs.extend(bare.try_iter());
    for row in [ours, theirs] {
        let cells: Vec<String> = row.iter().map(u64::to_string).collect();
        println!("{}", cells.join(" "));
    }
    Ok(())
}
