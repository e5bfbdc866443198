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
use maulstick_types::brush::BrushState;
use maulstick_types::paint::{FrameReply, FrameRequest};
use maulstick_types::topics::Topics;

use crate::render::performance;
use crate::report::{Report, quantile, sorted};
use crate::running::{Running, fault, joined, maulstick};
use crate::window_latency;

/// A rig called `latency` in the folder `place` that plays a take at rate 1.
pub(crate) fn playing(place: &Path, take: &Path) -> Result<Command, UserError> {
    let mut command = Command::new(maulstick()?);
    command
        .args(["up", "--name", "latency", "--rate", "1"])
        .args(["--cell-mm", "0.25", "--load", "Bone Black", "--play"])
        .arg(take)
        .current_dir(place)
        .env("XDG_RUNTIME_DIR", place);
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
    let mut command = playing(place.path(), &take)?;
    command.args(["--headless", "--snapshot", "end.png"]);
    let mut rig = Running::start(&mut command)?;
    let bus = joined_as(place.path(), "puller")?;
    let latencies = pull(&bus, &Topics::new("latency"), seconds, &mut rig)?;
    bus.close();
    let all = sorted(latencies.milliseconds);
    for (name, share) in [("frame.p50", 0.5), ("frame.p95", 0.95), ("frame.p99", 0.99)] {
        report.row(name, quantile(&all, share), "ms");
    }
    report.row("frame.rate", latencies.frames as f64 / seconds, "1/s");
    report.row(
        "frame.lost",
        latencies.lost as f64 / (all.len() + latencies.lost) as f64,
        "share",
    );
    Ok(())
}

struct Latencies {
    milliseconds: Vec<f64>,
    frames: usize,
    lost: usize,
}

fn pull(
    bus: &ZenohBus,
    topics: &Topics,
    seconds: f64,
    rig: &mut Running,
) -> Result<Latencies, UserError> {
    let wake = Wake::new();
    let me = Origin {
        source: 1,
        epoch: 1,
    };
    let topic = topics.brush_state("main");
    let class = Qos::RealTime;
    let mut states = Receiver::<BrushState>::new(bus, &topic, class, Queue::Ring(65_536), &wake)?;
    let mut waiting: BTreeMap<u64, u64> = BTreeMap::new();
    let mut latencies = Latencies {
        milliseconds: Vec::new(),
        frames: 0,
        lost: 0,
    };
    let (mut since, mut epoch, mut look) = (0, 0, 0);
    let give_up = Instant::now() + Duration::from_secs_f64(seconds + 30.0);
    while Instant::now() < give_up && !rig.has_ended()? {
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
        let limit = Duration::from_millis(500);
        let reply = match ask::<_, FrameReply>(bus, &topics.frame(), Qos::Data, me, &request, limit)
        {
            Ok(reply) => reply,
            Err(BusError::NoAnswer { .. }) => continue,
            Err(error) => return Err(error.into()),
        };
        let now_ns = bus.now_ns();
        (since, epoch, look) = (reply.version, reply.epoch, reply.look);
        latencies.frames += usize::from(!reply.tiles.is_empty());
        while let Some(state) = states.try_recv() {
            if state.message.solves.iter().any(|solve| solve.stroke > 0) {
                waiting.insert(state.header.seq, state.header.event_ns);
            }
        }
        let Some(held) = reply.holds.first() else {
            continue;
        };
        let rest = waiting.split_off(&held.next);
        for event_ns in std::mem::replace(&mut waiting, rest).into_values() {
            latencies
                .milliseconds
                .push(now_ns.saturating_sub(event_ns) as f64 * 1e-6);
        }
    }
    latencies.lost = waiting.len();
    Ok(latencies)
}
