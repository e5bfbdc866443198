//! From a stylus sample to the first frame of a window that holds it, completed by the graphics device.
//!
//! The window says of each frame which states of a brush are in it (`ui/presented`).

use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Qos, Queue, Wake, ZenohBus};
use maulstick_rig::UserError;
use maulstick_types::brush::BrushState;
use maulstick_types::stylus::TakeStatus;
use maulstick_types::window::Presented;
use maulstick_types::wire::topics::Topics;

use super::{USUAL, joined_as, playing};
use crate::report::{Report, quantile, sorted};
use crate::running::{Running, display, fault};

/// Width and height of the window, pixels.
const SIZE: [u32; 2] = [1280, 720];
/// Time after the take's end after which a missing sample is lost.
const GRACE: Duration = Duration::from_secs(2);
/// A pause between two depositing samples that is longer is no painting, ns.
const PAUSE_NS: u64 = 500_000_000;

/// Measures and reports, with a take of so many seconds.
pub(crate) fn run(
    report: &mut Report,
    place: &Path,
    take: &Path,
    seconds: f64,
) -> Result<(), UserError> {
    let (_server, name) = display(SIZE)?;
    let habits = place.join("config/maulstick");
    std::fs::create_dir_all(&habits).map_err(fault)?;
    let [width, height] = SIZE;
    let text = format!("size = [{width}.0, {height}.0]\nhas_painted = true\n");
    std::fs::write(habits.join("window.toml"), text).map_err(fault)?;
    let mut command = playing(place, take, &USUAL)?;
    command
        .env("DISPLAY", name)
        .env("XDG_CONFIG_HOME", place.join("config"));
    let mut rig = Running::start(&mut command)?;
    let bus = joined_as(place, "watcher")?;
    let seen = watch(&bus, seconds, &mut rig)?;
    bus.close();
    drop(rig);
    seen.report(report);
    Ok(())
}

/// Observations of a window.
#[derive(Default)]
struct Seen {
    /// Times of depositing samples that are in no frame yet, by the number of their state, ns.
    waiting: BTreeMap<u64, u64>,
    /// From those samples to the begin of the frame that held them, and to its completion, ms.
    begun_ms: Vec<f64>,
    completed_ms: Vec<f64>,
    /// Completions of frames, and times of depositing samples, ns.
    frames: Vec<u64>,
    painted: Vec<u64>,
    /// Time of the processor that a frame took, ms.
    draw_ms: Vec<f64>,
}

fn watch(bus: &ZenohBus, seconds: f64, rig: &mut Running) -> Result<Seen, UserError> {
    let (topics, wake) = (Topics::new("latency"), Wake::new());
    let states = topics.brush_state("main");
    let many = Queue::Ring(65_536);
    let mut states: Receiver<BrushState> = Receiver::new(bus, &states, Qos::RealTime, many, &wake)?;
    let quiet = Qos::Background;
    let mut frames: Receiver<Presented> =
        Receiver::new(bus, &topics.presented(), quiet, many, &wake)?;
    let mut takes: Receiver<TakeStatus> =
        Receiver::new(bus, &topics.take_status("*"), quiet, many, &wake)?;
    let mut seen = Seen::default();
    let mut give_up = Instant::now() + Duration::from_secs_f64(seconds + 60.0);
    let mut is_over = false;
    while Instant::now() < give_up && !rig.has_ended()? {
        wake.wait(Duration::from_millis(50));
        while let Some(state) = states.try_recv() {
            if state.message.solves.iter().any(|solve| solve.stroke > 0) {
                seen.waiting.insert(state.header.seq, state.header.event_ns);
                seen.painted.push(state.header.event_ns);
            }
        }
        while let Some(frame) = frames.try_recv() {
            seen.record(frame.header.event_ns, &frame.message);
        }
        let ends = std::iter::from_fn(|| takes.try_recv()).any(|take| take.message.end.is_some());
        if ends && !is_over {
            is_over = true;
            give_up = Instant::now() + GRACE;
        }
    }
    if is_over && !seen.frames.is_empty() {
        Ok(seen)
    } else {
        Err(
            UserError::failure("the window showed nothing, or the take did not end")
                .help("`maulstick up --play` on this display says why"),
        )
    }
}

impl Seen {
    fn record(&mut self, completed_ns: u64, frame: &Presented) {
        self.frames.push(completed_ns);
        self.draw_ms.push(frame.draw_ns as f64 * 1e-6);
        let Some(held) = frame.holds.first() else {
            return;
        };
        let rest = self.waiting.split_off(&held.next);
        for event_ns in std::mem::replace(&mut self.waiting, rest).into_values() {
            let since = |then_ns: u64| then_ns.saturating_sub(event_ns) as f64 * 1e-6;
            self.begun_ms.push(since(frame.begun_ns));
            self.completed_ms.push(since(completed_ns));
        }
    }

    /// Intervals between frames during painting, ms.
    fn periods(&self) -> Vec<f64> {
        let painting = |at_ns: u64| {
            let next = self.painted.partition_point(|painted| *painted < at_ns);
            let near = |place: Option<usize>| {
                place
                    .and_then(|place| self.painted.get(place))
                    .is_some_and(|painted| painted.abs_diff(at_ns) < PAUSE_NS)
            };
            near(Some(next)) && near(next.checked_sub(1))
        };
        let pairs = self.frames.windows(2);
        let pairs = pairs.filter(|pair| pair.iter().all(|at_ns| painting(*at_ns)));
        pairs
            .map(|pair| (pair[1] - pair[0]) as f64 * 1e-6)
            .collect()
    }

    fn report(self, report: &mut Report) {
        let periods = self.periods();
        let mean = periods.iter().sum::<f64>() / periods.len() as f64;
        let lost = self.waiting.len() as f64 / self.painted.len() as f64;
        let (completed, begun) = (sorted(self.completed_ms), sorted(self.begun_ms));
        let target = ("1.5 frame periods + 20 ms", 1.5 * mean + 20.0);
        report.beside("window.p50", quantile(&completed, 0.5), "ms", target);
        report.row("window.p95", quantile(&completed, 0.95), "ms");
        report.row("window.p99", quantile(&completed, 0.99), "ms");
        report.row("window.begun.p50", quantile(&begun, 0.5), "ms");
        report.row(
            "window.draw.p50",
            quantile(&sorted(self.draw_ms), 0.5),
            "ms",
        );
        report.beside("window.rate", 1e3 / mean, "1/s", ("asked for", 20.0));
        report.row("window.period.p95", quantile(&sorted(periods), 0.95), "ms");
        report.row("window.lost", lost, "share");
    }
}
