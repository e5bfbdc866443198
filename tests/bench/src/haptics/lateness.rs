//! Wake-up lateness of our servo compared with cyclictest, in turns, under the load of a painting rig.
//!
//! Both sleep to absolute deadlines a millisecond apart on a thread of SCHED_FIFO, priority 80, with memory locked, and
//! measure from the deadline to the first instruction after it. Ours is the whole servo over a simulated device; its
//! work in a tick delays no wake-up, as deadlines are absolute. Both keep the processor from sleeping deeply
//! (`/dev/cpu_dma_latency`): without that our ratio is 1.7. Beyond the 90th percentile both show the effect of a
//! virtual machine's host, so no tail is judged.

use std::time::{Duration, Instant};

use maulstick_device::registration::Registration;
use maulstick_haptic::MountedDevice;
use maulstick_haptic::drivers::simulated::Simulated;
use maulstick_haptic::servo::clock::MonotonicClock;
use maulstick_haptic::servo::servo_thread::ServoThread;
use maulstick_haptics::Limits;
use maulstick_rig::UserError;

use super::histogram::Histogram;
use super::load::Load;
use super::{cyclictest, fault};
use crate::report::Report;

/// Pairs, ours and the peer's in turns.
const PAIRS: usize = 10;
/// Ticks of each of a pair: 4 s.
const TICKS: u64 = 4000;
/// Silence after which ticks count as stopped.
const PATIENCE: Duration = Duration::from_secs(30);

/// Scheduling of our servo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scheduling {
    /// Real time, priority 80.
    Fifo,
    /// Like every other thread, where real time is not permitted.
    Other,
}

/// Measures and reports. Without the peer only our own numbers are reported, with a note.
pub(super) fn run(report: &mut Report) -> Result<(), UserError> {
    let place = tempfile::tempdir().map_err(fault)?;
    let (_, scheduling) = ours(10)?;
    let tried = match scheduling {
        Scheduling::Fifo => cyclictest::run(place.path(), 10),
        Scheduling::Other => {
            report.on("cpu; the servo without real-time priority");
            Err(
                fault("cyclictest, the peer of `lateness`, runs with real-time priority alone")
                    .help("add 'rtprio 99' for your user to /etc/security/limits.conf"),
            )
        }
    };
    let peer = tried.is_ok();
    if let Err(missing) = tried {
        eprintln!("{missing}");
    }
    let mut load = Load::start(place.path())?;
    let mut pairs = Vec::new();
    let (start, before_s) = (Instant::now(), load.seconds());
    for _ in 0..PAIRS {
        let (ours, _) = ours(TICKS)?;
        let theirs = if peer {
            Some(cyclictest::run(place.path(), TICKS)?)
        } else {
            None
        };
        load.check()?;
        pairs.push((ours, theirs));
    }
    let cores = (load.seconds() - before_s) / start.elapsed().as_secs_f64();
    report.row("lateness.load", cores, "cores");
    for (name, share) in [("lateness.p50", 0.5), ("lateness.p90", 0.9)] {
        let of = |(ours, theirs): &(Histogram, Option<Histogram>)| {
            let theirs = theirs.as_ref().map_or(f64::NAN, |it| it.quantile(share));
            (ours.quantile(share), theirs)
        };
        let values: Vec<(f64, f64)> = pairs.iter().map(of).collect();
        if peer {
            report.paired(name, "µs", "cyclictest", &values)
        } else {
            report.median(name, "µs", values.iter().map(|pair| pair.0).collect())
        }
    }
    Ok(())
}

/// Lateness of `ticks` ticks of our servo, and its scheduling.
fn ours(ticks: u64) -> Result<(Histogram, Scheduling), UserError> {
    let device = MountedDevice::new(Box::new(Simulated::at_rest()), Registration::IDENTITY, 0);
    let mut servo =
        ServoThread::start(device, Box::new(MonotonicClock), Limits::default()).map_err(fault)?;
    let scheduling = if servo.warnings.iter().any(|what| what.contains("real-time")) {
        Scheduling::Other
    } else {
        Scheduling::Fifo
    };
    let mut histogram = Histogram::default();
    let mut heard = Instant::now();
    let mut seen = 0;
    while seen < ticks {
        // Half of the ring comes together.
        std::thread::sleep(Duration::from_millis((ticks - seen).min(1000)));
        while seen < ticks
            && let Ok(record) = servo.ticks.pop()
        {
            histogram.add(record.late_ns / 1000, 1);
            (seen, heard) = (seen + 1, Instant::now());
        }
        if heard.elapsed() > PATIENCE {
            return Err(fault("the servo stands still"));
        }
    }
    Ok((histogram, scheduling))
}
