//! Latency from a stylus sample to the first frame with it, for a puller without a window that asks again at once, and
//! in a window; a take is played at rate 1.

mod broad;
mod window;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use maulstick_bus::typed::{Receiver, ask};
use maulstick_bus::{Bus as _, BusError, Dial, Qos, Queue, RigClock, Wake, ZenohBus};
use maulstick_rig::UserError;
use maulstick_types::Origin;
use maulstick_types::brush::{BrushState, solve_flags};
use maulstick_types::paint::{FrameReply, FrameRequest};
use maulstick_types::wire::topics::Topics;

use crate::render::performance;
use crate::report::{Report, quantile, sorted};
use crate::running::{Running, fault, joined, maulstick};

/// Options of the usual brush on the usual cells.
pub(crate) const USUAL: [&str; 2] = ["--cell-mm", "0.25"];
/// Time after the hand's end after which a missing sample is lost.
pub(crate) const GRACE: Duration = Duration::from_secs(60);

/// A rig called `latency` in the folder `place` with black on its brush, with these options.
pub(crate) fn rig_with(place: &Path, options: &[&str]) -> Result<Command, UserError> {
    let mut command = Command::new(maulstick()?);
    command
        .args(["up", "--name", "latency", "--load", "Bone Black"])
        .args(options)
        .current_dir(place)
        .env("XDG_RUNTIME_DIR", place)
        .env("XDG_STATE_HOME", place.join("state"));
    Ok(command)
}

/// Such a rig that plays a take at rate 1.
pub(crate) fn playing(place: &Path, take: &Path, options: &[&str]) -> Result<Command, UserError> {
    let mut command = rig_with(place, options)?;
    command.args(["--rate", "1", "--play"]).arg(take);
    Ok(command)
}

/// A bus of that rig, once it runs, for a program called `name`.
pub(crate) fn joined_as(place: &Path, name: &str) -> Result<ZenohBus, UserError> {
    let path = place.join("maulstick/latency");
    let (folder, info) = joined(&path, Instant::now() + Duration::from_secs(30))?;
    let dial = Dial {
        name: name.into(),
        listen: Some(folder.locator(name)),
        connect: vec![info.endpoint.clone()],
    };
    let clock = RigClock::with_offset(info.clock_offset_ns);
    Ok(ZenohBus::open(&dial, clock)?)
}

/// Measures and reports.
pub(crate) fn run(report: &mut Report) -> Result<(), UserError> {
    let place = tempfile::tempdir().map_err(fault)?;
    let (take, seconds) = performance(place.path())?;
    window::run(report, place.path(), &take, seconds)?;
    let latencies = pulled(place.path(), &take, &USUAL, seconds)?;
    let all = sorted(latencies.milliseconds);
    let usual = quantile(&all, 0.5);
    for (name, share) in [("frame.p50", 0.5), ("frame.p95", 0.95), ("frame.p99", 0.99)] {
        report.row(name, quantile(&all, share), "ms");
    }
    report.row("frame.rate", latencies.frames as f64 / seconds, "1/s");
    report.row(
        "frame.lost",
        latencies.lost as f64 / (all.len() + latencies.lost) as f64,
        "share",
    );
    broad::run(report, place.path(), usual)
}

/// Latencies of a take in a rig with these options, for a puller without a window.
fn pulled(
    place: &Path,
    take: &Path,
    options: &[&str],
    seconds: f64,
) -> Result<Latencies, UserError> {
    let mut command = playing(place, take, options)?;
    command.args(["--headless", "--snapshot", "end.png"]);
    let mut rig = Running::start(&mut command)?;
    let bus = joined_as(place, "puller")?;
    let give_up = Instant::now() + Duration::from_secs_f64(seconds) + GRACE;
    let latencies = Puller::new(&bus)?.pull(give_up, |_| rig.has_ended());
    bus.close();
    latencies
}

/// Latencies of the solves of strokes.
pub(crate) struct Latencies {
    pub milliseconds: Vec<f64>,
    pub frames: usize,
    pub lost: usize,
    /// Solves by the length of their steps: once, twice, four times.
    pub solves: [usize; 3],
}

/// The next frame of the canvas after the one with these numbers, if there is one soon.
pub(crate) fn frame(
    bus: &ZenohBus,
    (since, epoch, look): (u64, u32, u64),
) -> Result<Option<FrameReply>, UserError> {
    let request = FrameRequest {
        surface: 0,
        since,
        epoch,
        tiles: [0, 0, u32::MAX, u32::MAX],
        level: 0,
        wait_ms: 100,
        look,
        shared: true,
    };
    let me = Origin {
        source: 1,
        epoch: 1,
    };
    let (topic, limit) = (Topics::new("latency").frame(), Duration::from_millis(500));
    match ask(bus, &topic, Qos::Data, me, &request, limit) {
        Ok(reply) => Ok(Some(reply)),
        Err(BusError::NoAnswer { .. }) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

/// A puller without a window, which follows the main brush from when it is made.
pub(crate) struct Puller<'a> {
    bus: &'a ZenohBus,
    states: Receiver<BrushState>,
    /// Times of the samples of solves that are in no frame yet, by their state, ns.
    waiting: BTreeMap<u64, Vec<u64>>,
    latencies: Latencies,
}

impl<'a> Puller<'a> {
    pub(crate) fn new(bus: &'a ZenohBus) -> Result<Self, UserError> {
        let topic = Topics::new("latency").brush_state("main");
        let queue = Queue::Ring(65_536);
        Ok(Self {
            bus,
            states: Receiver::new(bus, &topic, Qos::RealTime, queue, &Wake::new())?,
            waiting: BTreeMap::new(),
            latencies: Latencies {
                milliseconds: Vec::new(),
                frames: 0,
                lost: 0,
                solves: [0; 3],
            },
        })
    }

    /// Pulls frames until `ends` is true for the time of the newest sample in a frame, ns.
    pub(crate) fn pull(
        mut self,
        give_up: Instant,
        mut ends: impl FnMut(u64) -> Result<bool, UserError>,
    ) -> Result<Latencies, UserError> {
        let (mut newest, mut held_ns) = ((0, 0, 0), 0);
        while Instant::now() < give_up && !ends(held_ns)? {
            let Some(reply) = frame(self.bus, newest)? else {
                continue;
            };
            let now_ns = self.bus.now_ns();
            newest = (reply.version, reply.epoch, reply.look);
            self.latencies.frames += usize::from(!reply.tiles.is_empty());
            self.drain_inputs();
            let Some(held) = reply.holds.first() else {
                continue;
            };
            let rest = self.waiting.split_off(&held.next);
            let held = std::mem::replace(&mut self.waiting, rest).into_values();
            for event_ns in held.flatten() {
                let wait_ns = now_ns.saturating_sub(event_ns);
                self.latencies.milliseconds.push(wait_ns as f64 * 1e-6);
                held_ns = held_ns.max(event_ns);
            }
        }
        self.latencies.lost = self.waiting.values().map(Vec::len).sum();
        Ok(self.latencies)
    }

    /// Drains the states, and records their solves.
    fn drain_inputs(&mut self) {
        while let Some(state) = self.states.try_recv() {
            let solves = state.message.solves.iter().filter(|solve| solve.stroke > 0);
            for solve in solves {
                let times = self.waiting.entry(state.header.seq).or_default();
                times.push(solve.event_ns);
                let longer = [solve_flags::TWICE, solve_flags::FOUR_TIMES];
                let length = longer.iter().rposition(|flag| solve.flags & flag != 0);
                self.latencies.solves[length.map_or(0, |length| length + 1)] += 1;
            }
        }
    }
}
