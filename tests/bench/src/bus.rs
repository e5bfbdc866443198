//! Latency of a stylus sample from a device's process to that of the brush node: through the stream with credit,
//! decoded and in order, and through a bare zenoh put into a ring and a thread, in turn on the same link.

use std::io::{BufRead as _, BufReader, Write as _};
use std::process::{Command, Stdio};
use std::sync::Arc;
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
use zenoh::qos::{CongestionControl, Priority};

use crate::report::{Report, quantile, sorted};

/// Pairs that are measured.
const PAIRS: u64 = 4000;
/// Number of unmeasured pairs before them.
const WARM_UP: u64 = 400;
/// Topic of the bare put.
const BARE: &str = "bench/bare";
/// Bytes of a sample with its header, which the bare put carries too.
const BYTES: usize = 200;

fn fault(error: impl std::fmt::Display) -> UserError {
    UserError::failure(error.to_string())
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
    let mut lines = BufReader::new(child.stdout.take().ok_or_else(|| fault("no output"))?).lines();
    let (topics, wake) = (Topics::new("bench"), Wake::new());
    let origin = Origin {
        source: 1,
        epoch: 1,
    };
    let topic = topics.sample("near");
    let mut ours = CreditSender::<StylusSample>::new(&bus, &topics, &topic, origin, &wake)?;
    let bare = bus
        .raw_session()
        .declare_publisher(BARE)
        .congestion_control(CongestionControl::Drop)
        .priority(Priority::RealTime)
        .wait()
        .map_err(fault)?;
    // The far end reports the arrival of both.
    let sample = StylusSample::away();
    let send = |ours: &mut CreditSender<StylusSample>, which: u64| -> Result<(), UserError> {
        if which == 0 {
            let now_ns = bus.now_ns();
            ours.reset_credit();
            ours.send(
                Flags::NONE,
                Stamp {
                    now_ns,
                    event_ns: now_ns,
                },
                &sample,
            )?;
        } else {
            let mut bytes = vec![0; BYTES];
            bytes[..8].copy_from_slice(&bus.now_ns().to_le_bytes());
            bare.put(bytes).wait().map_err(fault)?;
        }
        Ok(())
    };
    let (to_us, ready) = std::sync::mpsc::channel();
    std::thread::spawn(move || {
        while let Some(Ok(line)) = lines.next() {
            if to_us.send(line).is_err() {
                break;
            }
        }
    });
    loop {
        send(&mut ours, 0)?;
        send(&mut ours, 1)?;
        match ready.recv_timeout(Duration::from_millis(20)) {
            Ok(line) if line == "ready" => break,
            Ok(line) => return Err(fault(line)),
            Err(std::sync::mpsc::RecvTimeoutError::Timeout) => {}
            Err(error) => return Err(fault(error)),
        }
    }
    for number in 0..2 * (PAIRS + WARM_UP) {
        send(&mut ours, number % 2)?;
        std::thread::sleep(Duration::from_micros(500));
    }
    child.stdin.take();
    let mut rows = [Vec::new(), Vec::new()];
    for (row, _) in rows.iter_mut().zip(0..2) {
        let line = ready.recv_timeout(Duration::from_secs(10)).map_err(fault)?;
        let all: Vec<f64> = line
            .split(' ')
            .filter_map(|cell| cell.parse().ok())
            .collect();
        *row = sorted(all[all.len().min(WARM_UP as usize)..].to_vec());
    }
    child.wait().map_err(fault)?;
    let [ours, bare] = rows;
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
    let bus = Arc::new(ZenohBus::open(&dial, clock)?);
    let wake = Wake::new();
    let topics = Topics::new("bench");
    let me = Origin {
        source: 2,
        epoch: 2,
    };
    let topic = topics.sample("*");
    let mut receiver = CreditReceiver::<StylusSample>::new(&*bus, &topics, &topic, me, &wake)?;
    let ring = bus
        .raw_session()
        .declare_subscriber(BARE)
        .with(RingChannel::new(1024))
        .wait()
        .map_err(fault)?;
    let (to_main, bare) = std::sync::mpsc::channel();
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
    let ended = Wake::new();
    let (end, at_end) = (
        Arc::new(std::sync::atomic::AtomicBool::new(false)),
        ended.clone(),
    );
    let flag = Arc::clone(&end);
    let rung = wake.clone();
    std::thread::spawn(move || {
        std::io::stdin().lines().for_each(drop);
        flag.store(true, std::sync::atomic::Ordering::SeqCst);
        rung.ring();
        at_end.ring();
    });
    let (mut ours, mut theirs) = (Vec::new(), Vec::new());
    let mut said = false;
    while !end.load(std::sync::atomic::Ordering::SeqCst) {
        wake.wait(Duration::from_millis(100));
        receiver.poll(&*bus)?;
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
