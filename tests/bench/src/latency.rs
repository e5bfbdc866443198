//! From a stylus sample to the first frame that holds it, for a puller without a window that asks
//! again at once, and in a window; a take is played at rate 1.

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

use crate::broad;
use crate::render::performance;
use crate::report::{Report, quantile, sorted};
use crate::running::{Running, fault, joined, maulstick};
use crate::window_latency;

/// Options of the usual brush on the usual cells.
pub(crate) const USUAL: [&str; 2] = ["--cell-mm", "0.25"];
/// What is not in a frame this long after the hand has ended is lost.
const GRACE: Duration = Duration::from_secs(60);

/// A rig called `latency` in the folder `place` with black on its brush, with these options.
pub(crate) fn rig_with(place: &Path, options: &[&str]) -> Result<Command, UserError> {
    let mut command = Command::new(maulstick()?);
    command
        .args(["up", "--name", "latency", "--load", "Bone Black"])
        .args(options)
        .current_dir(place)
        .env("XDG_RUNTIME_DIR", place);
    Ok(command)
}

/// Such a rig that plays a take at rate 1.
pub(crate) fn playing(place: &Path, take: &Path, options: &[&str]) -> Result<Command, UserError> {
    let mut command = rig_with(place, options)?;
    command.args(["--rate", "1", "--play"]).arg(take);
    Ok(command)
}

/// A bus of that rig, once it is there, for a program called `name`.
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
    window_latency::run(report, place.path(), &take, seconds)?;
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
    let latencies = pull(&bus, give_up, |_| rig.has_ended());
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

/// Asks for frames until it is told to end: whether frames hold all solves is given.
pub(crate) fn pull(
    bus: &ZenohBus,
    give_up: Instant,
    mut ends: impl FnMut(bool) -> Result<bool, UserError>,
) -> Result<Latencies, UserError> {
    let topics = Topics::new("latency");
    let wake = Wake::new();
    let topic = topics.brush_state("main");
    let class = Qos::RealTime;
    let mut states = Receiver::<BrushState>::new(bus, &topic, class, Queue::Ring(65_536), &wake)?;
    let mut waiting: BTreeMap<u64, Vec<u64>> = BTreeMap::new();
    let mut latencies = Latencies {
        milliseconds: Vec::new(),
        frames: 0,
        lost: 0,
        solves: [0; 3],
    };
    let mut newest = (0, 0, 0);
    while Instant::now() < give_up && !ends(waiting.is_empty())? {
        let Some(reply) = frame(bus, newest)? else {
            continue;
        };
        let now_ns = bus.now_ns();
        newest = (reply.version, reply.epoch, reply.look);
        latencies.frames += usize::from(!reply.tiles.is_empty());
        while let Some(state) = states.try_recv() {
            let solves = state.message.solves.iter().filter(|solve| solve.stroke > 0);
            for solve in solves {
                let times = waiting.entry(state.header.seq).or_default();
                times.push(solve.event_ns);
                let longer = [solve_flags::TWICE, solve_flags::FOUR_TIMES];
                let length = longer.iter().rposition(|flag| solve.flags & flag != 0);
                latencies.solves[length.map_or(0, |length| length + 1)] += 1;
            }
        }
        let Some(held) = reply.holds.first() else {
            continue;
        };
        let rest = waiting.split_off(&held.next);
        let held = std::mem::replace(&mut waiting, rest)
            .into_values()
            .flatten();
        let waits = held.map(|event_ns| now_ns.saturating_sub(event_ns) as f64 * 1e-6);
        latencies.milliseconds.extend(waits);
    }
    latencies.lost = waiting.values().map(Vec::len).sum();
    Ok(latencies)
}
