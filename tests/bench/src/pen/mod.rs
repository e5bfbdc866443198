//! Latency of a pen's sample from its system to the brush node, on both paths: from a Wayland compositor's socket
//! through the thread of the window's pens, and from a tablet's reports through the HID daemon. Each path is a separate
//! process; they send in turn on the same bus, at the rate of pens. No window is drawn.

#[expect(dead_code, reason = "the tests of the window's pens use the rest")]
#[path = "../../../../daemons/window-pen/tests/pens/compositor.rs"]
mod compositor;
mod senders;

use std::io::Write as _;
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixStream;
use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use maulstick_bus::{Bus as _, CreditReceiver, Dial, RigClock, RigFolder, Wake, ZenohBus};
use maulstick_hid::recording::{self, Recorded};
use maulstick_rig::UserError;
use maulstick_types::Origin;
use maulstick_types::stylus::{StylusPose, StylusSample};
use maulstick_types::wire::topics::Topics;
use wayland_protocols::wp::tablet::zv2::server::zwp_tablet_tool_v2::{
    Capability, Type, ZwpTabletToolV2,
};
use wayland_server::DisplayHandle;

pub(crate) use self::senders::send;

use self::compositor::{Compositor, Do, NewTool};
use crate::report::{Report, quantile, sorted};
use crate::running::{Running, fault};

/// Names of the two pens on the bus.
const PENS: [&str; 2] = ["window", "hid"];
/// Full pressure of each; a sample's number is its pressure.
const FULL: [f64; 2] = [65_535.0, 8191.0];
/// Samples of each pen that are measured.
const SAMPLES: u16 = 2000;
/// Number of unmeasured samples before them: the first one is sent until the bus is ready.
const WARM_UP: u16 = 200;
const ALL: usize = 1 + (WARM_UP + SAMPLES) as usize;
/// Time between two samples, of the pens in turn: each has 250 a second.
const STEP: Duration = Duration::from_millis(2);
/// Longest wait for the two processes.
const PATIENCE: Duration = Duration::from_secs(20);
/// Longest wait for the last samples.
const GRACE: Duration = Duration::from_secs(1);

/// Measures and reports.
pub(crate) fn run(report: &mut Report) -> Result<(), UserError> {
    let base = tempfile::tempdir().map_err(fault)?;
    let folder = RigFolder::create_in(&base.path().join("rigs"), "bench")?;
    let clock = RigClock::start();
    let locator = folder.locator("brush");
    let dial = Dial {
        name: "brush".into(),
        listen: Some(locator.clone()),
        connect: Vec::new(),
    };
    let bus = ZenohBus::open(&dial, clock)?;
    let (compositor, window) = Compositor::start(true);
    let (reports, tablet) = UnixStream::pair().map_err(fault)?;
    let at = format!("{locator} {}", clock.offset_ns());
    let _senders = [
        sender(PENS[0], &at, window.into())?,
        sender(PENS[1], &at, tablet.into())?,
    ];
    let mut seams = Seams {
        window: near_pen(&compositor)?,
        reports,
        report: touch(recorded()?),
        clock,
    };
    let is_ready = AtomicBool::new(false);
    let (sent, arrived) = std::thread::scope(|scope| {
        let feeding = scope.spawn(|| feed(&mut seams, &is_ready));
        let arrived = receive(&bus, &is_ready, || feeding.is_finished());
        (feeding.join(), arrived)
    });
    let (sent, arrived) = (sent.map_err(|_| fault("the pens' thread fell"))??, arrived?);
    bus.close();
    let waits = [0, 1].map(|pen: usize| {
        let both = sent[pen].iter().zip(&arrived[pen]);
        let measured = both.skip(1 + usize::from(WARM_UP));
        let waits = measured.filter_map(|(sent_ns, at_ns)| Some((*at_ns)? - sent_ns));
        sorted(waits.map(|wait_ns| wait_ns as f64 * 1e-3).collect())
    });
    for (pen, waits) in PENS.iter().zip(&waits) {
        for (name, share) in [("p50", 0.5), ("p90", 0.9), ("p99", 0.99)] {
            report.row(&format!("pen.{pen}.{name}"), quantile(waits, share), "µs");
        }
        let share = waits.len() as f64 / f64::from(SAMPLES);
        report.row(&format!("pen.{pen}.received"), share, "share");
    }
    let [window, hid] = waits.map(|waits| quantile(&waits, 0.5));
    report.row("pen.ratio", window / hid, "");
    Ok(())
}

/// The process of a pen, which reads its system at `end`.
fn sender(pen: &str, at: &str, end: OwnedFd) -> Result<Running, UserError> {
    let mut command = Command::new(std::env::current_exe().map_err(fault)?);
    command
        .args(["bench", "--pen", &format!("{pen} {at}")])
        .stdin(end);
    Running::begin(&mut command)
}

/// A pen on the window, once that listens.
fn near_pen(compositor: &Compositor) -> Result<(ZwpTabletToolV2, DisplayHandle), UserError> {
    compositor.tool(NewTool {
        kind: Type::Pen,
        serial: 1,
        capabilities: vec![Capability::Pressure, Capability::Tilt],
    });
    compositor.act(0, &[Do::Near(0), Do::Down, Do::Tilt(20.0, 25.0)]);
    let lent = compositor.lend(0).recv_timeout(PATIENCE);
    lent.map_err(|_| {
        fault("no window comes to the compositor")
            .help("install libwayland-client, or see what its process says")
    })
}

/// The tablet of the example.
fn recorded() -> Result<Recorded, UserError> {
    let text = include_str!("../../../../docs/examples/pen.hid");
    let mut devices = recording::parse(text).map_err(|error| fault(error.to_string()))?;
    devices.pop().ok_or_else(|| fault("no tablet"))
}

/// A report of its pen that touches.
fn touch(recorded: Recorded) -> Vec<u8> {
    let report = recorded.events.into_iter().next().map(|event| event.report);
    let mut report = report.unwrap_or_default();
    if let Some(switches) = report.get_mut(1) {
        *switches |= 1;
    }
    report
}

/// Writes a number into a report.
fn number(report: &mut [u8], number: u16) {
    for (byte, own) in report.iter_mut().skip(6).zip(number.to_le_bytes()) {
        *byte = own;
    }
}

/// The two seams, at which samples get their times.
struct Seams {
    window: (ZwpTabletToolV2, DisplayHandle),
    reports: UnixStream,
    report: Vec<u8>,
    clock: RigClock,
}

impl Seams {
    /// Sends a sample of a pen; its time, ns.
    fn send(&mut self, pen: usize, sample: u16) -> Result<u64, UserError> {
        if pen == 1 {
            number(&mut self.report, sample);
            let now_ns = self.clock.now_ns();
            self.reports.write_all(&self.report).map_err(fault)?;
            return Ok(now_ns);
        }
        let (tool, display) = &mut self.window;
        let now_ns = self.clock.now_ns();
        tool.motion(f64::from(sample), 100.0);
        tool.pressure(u32::from(sample));
        tool.frame((now_ns / 1_000_000) as u32);
        display.flush_clients().map_err(fault)?;
        Ok(now_ns)
    }
}

/// Sends all samples, at the rate of a pen, once both pens are received; their times, ns. Until then each sends a
/// sample occasionally, because samples without a listener are lost.
fn feed(seams: &mut Seams, is_ready: &AtomicBool) -> Result<[Vec<u64>; 2], UserError> {
    let give_up = Instant::now() + PATIENCE;
    while !is_ready.load(Ordering::Acquire) {
        if Instant::now() > give_up {
            return Err(fault("the pens are not heard"));
        }
        for pen in [0, 1] {
            seams.send(pen, 1)?;
        }
        std::thread::sleep(10 * STEP);
    }
    let mut sent = [vec![0], vec![0]];
    for sample in 2..=ALL as u16 {
        for (pen, sent) in sent.iter_mut().enumerate() {
            sent.push(seams.send(pen, sample)?);
            std::thread::sleep(STEP);
        }
    }
    Ok(sent)
}

/// Receives the samples like the brush node until `is_over`; returns the time of each first arrival, ns.
fn receive(
    bus: &ZenohBus,
    is_ready: &AtomicBool,
    is_over: impl Fn() -> bool,
) -> Result<[Vec<Option<u64>>; 2], UserError> {
    let (topics, wake) = (Topics::new("bench"), Wake::new());
    let me = Origin {
        source: 1,
        epoch: 1,
    };
    let mut samples =
        CreditReceiver::<StylusSample>::new(bus, &topics, &topics.sample("*"), me, &wake)?;
    let keys = PENS.map(|pen| topics.sample(pen));
    let mut arrived = [vec![None; ALL], vec![None; ALL]];
    let mut end = None;
    while end.is_none_or(|end| Instant::now() < end) {
        if end.is_none() && is_over() {
            end = Some(Instant::now() + GRACE);
        }
        wake.wait(Duration::from_millis(100));
        samples.poll(bus)?;
        while let Some(received) = samples.pop() {
            let now_ns = bus.now_ns();
            let pen = keys.iter().position(|key| *key == received.key);
            let StylusPose::Contact { pressure, .. } = received.message.pose else {
                continue;
            };
            // A repetition of the newest sample is not the first.
            let first = pen.and_then(|pen| {
                let number = (pressure * FULL[pen]).round() as usize;
                arrived[pen].get_mut(number.checked_sub(1)?)
            });
            if let Some(first) = first {
                first.get_or_insert(now_ns);
            }
        }
        if arrived.iter().all(|all| all.iter().flatten().count() > 0) {
            is_ready.store(true, Ordering::Release);
        }
    }
    Ok(arrived)
}

#[cfg(test)]
mod tests {
    use maulstick_hid::open::{Kind, Means, means};

    use super::*;

    #[test]
    fn the_daemon_reads_a_report_s_number() {
        let recorded = recorded().expect("a tablet");
        let means = means(Kind::Pen, &recorded.identity, &recorded.descriptor);
        let Ok(Means::Pen(mut decoder)) = means else {
            unreachable!("it is a pen");
        };
        let mut report = touch(recorded);
        for sample in 1..=ALL as u16 {
            number(&mut report, sample);
            let reading = decoder.decode(&report).expect("a pen's");
            assert_eq!((reading.pressure * FULL[1]).round(), f64::from(sample));
        }
    }
}
