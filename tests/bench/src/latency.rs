//! From a stylus sample to the first frame that holds it, for a puller without a window that asks
//! again at once, and in a window; a take is played at rate 1.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

use maulstick_brush::BrushFile;
use maulstick_bus::typed::{Receiver, ask};
use maulstick_bus::{Bus as _, BusError, Dial, Qos, Queue, RigClock, Wake, ZenohBus};
use maulstick_device::{Take, TakeSample};
use maulstick_rig::UserError;
use maulstick_types::Origin;
use maulstick_types::brush::{BrushState, solve_flags};
use maulstick_types::paint::{FrameReply, FrameRequest};
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample, axes};
use maulstick_types::wire::topics::Topics;

use crate::render::performance;
use crate::report::{Report, quantile, sorted};
use crate::running::{Running, fault, joined, maulstick};
use crate::window_latency;

/// Options of the usual brush on the usual cells.
pub(crate) const USUAL: [&str; 2] = ["--cell-mm", "0.25"];
/// Width of a broad brush, mm.
const BROAD_MM: f64 = 30.0;
/// Fine cells for it, mm.
const FINE_MM: &str = "0.125";
/// Largest 95th percentile of a broad brush's latencies by their median.
const MOST_BY_P50: f64 = 2.0;

/// A rig called `latency` in the folder `place` that plays a take at rate 1, with these options.
pub(crate) fn playing(place: &Path, take: &Path, options: &[&str]) -> Result<Command, UserError> {
    let mut command = Command::new(maulstick()?);
    command
        .args(["up", "--name", "latency", "--rate", "1"])
        .args(options)
        .args(["--load", "Bone Black", "--play"])
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
    broad(report, place.path(), usual)
}

/// Measures a broad brush on fine cells, and reports it beside the median of the usual one.
fn broad(report: &mut Report, place: &Path, usual: f64) -> Result<(), UserError> {
    let take = place.join("broad.mcap");
    let strokes = broad_strokes();
    strokes.write(&take)?;
    let seconds = strokes.length_ns() as f64 * 1e-9;
    let file = place.join("broad.toml");
    let flat = BrushFile::library("flat").map_err(fault)?;
    let text = flat
        .scaled_to(BROAD_MM)
        .map_err(fault)?
        .to_toml()
        .map_err(fault)?;
    std::fs::write(&file, text).map_err(fault)?;
    let file = file.display().to_string();
    let latencies = pulled(
        place,
        &take,
        &["--cell-mm", FINE_MM, "--brush", &file],
        seconds,
    )?;
    let all = sorted(latencies.milliseconds);
    let [p50, p95] = [0.5, 0.95].map(|share| quantile(&all, share));
    report.beside("broad.p50", p50, "ms", ("frame.p50", usual));
    report.row("broad.p95", p95, "ms");
    report.beside("broad.p95_by_p50", p95 / p50, "", ("target", MOST_BY_P50));
    let solves = latencies.solves.iter().sum::<usize>().max(1) as f64;
    for (name, count) in [
        "broad.steps_once",
        "broad.steps_twice",
        "broad.steps_four_times",
    ]
    .into_iter()
    .zip(latencies.solves)
    {
        report.row(name, count as f64 / solves, "share");
    }
    report.row(
        "broad.lost",
        latencies.lost as f64 / (all.len() + latencies.lost) as f64,
        "share",
    );
    Ok(())
}

/// Samples a second of the broad brush's pen.
const RATE_HZ: u64 = 250;
/// Speed of its hand, m/s; ways of so many metres, and so many of them.
const SPEED: f64 = 0.5;
const WAY_M: f64 = 0.2;
const WAYS: u64 = 24;
/// The pen is up for so many samples between two of them.
const UP: u64 = 50;

/// Strokes to and fro across the canvas, each a little above the last.
fn broad_strokes() -> Take {
    let down = (WAY_M / SPEED * RATE_HZ as f64) as u64;
    let samples = (0..WAYS * (down + UP)).map(|number| {
        let (way, at) = (number / (down + UP), number % (down + UP));
        let along = (at as f64 / down as f64).min(1.0) - 0.5;
        let x = WAY_M * if way % 2 == 0 { along } else { -along };
        let pressure = if at < down { 0.5 } else { 0.0 };
        TakeSample {
            time_ns: number * 1_000_000_000 / RATE_HZ,
            sample: StylusSample {
                senses: axes::POSITION | axes::PRESSURE | axes::TILT,
                pose: StylusPose::Contact {
                    point_m: [x, 0.006 * (way as f64 - 0.5 * WAYS as f64), 0.0],
                    tilt_rad: DEFAULT_TILT_RAD,
                    twist_rad: FRAC_PI_2,
                    pressure,
                },
                in_range: true,
                ..StylusSample::away()
            },
        }
    });
    Take {
        setup: None,
        device: "broad".into(),
        samples: samples.collect(),
    }
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
    let latencies = pull(&bus, &Topics::new("latency"), seconds, &mut rig);
    bus.close();
    latencies
}

struct Latencies {
    milliseconds: Vec<f64>,
    frames: usize,
    lost: usize,
    /// Solves of strokes by the length of their steps: once, twice, four times.
    solves: [usize; 3],
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
        solves: [0; 3],
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
            let solves = state.message.solves.iter();
            let flags: Vec<u32> = (solves.filter(|solve| solve.stroke > 0))
                .map(|solve| solve.flags)
                .collect();
            if !flags.is_empty() {
                waiting.insert(state.header.seq, state.header.event_ns);
            }
            for flags in flags {
                let longer = [solve_flags::TWICE, solve_flags::FOUR_TIMES];
                let length = longer.iter().rposition(|flag| flags & flag != 0);
                latencies.solves[length.map_or(0, |length| length + 1)] += 1;
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
