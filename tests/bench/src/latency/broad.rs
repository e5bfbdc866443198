//! A live hand with a broad brush on fine cells, from its samples to the first frames that hold them. A take would wait
//! for its paint instead. `steps_once`, `steps_twice`, `steps_four_times` are the shares of the solves whose steps were
//! that long.

use std::f64::consts::FRAC_PI_2;
use std::path::Path;
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use maulstick_brush::BrushFile;
use maulstick_bus::credit::Stamp;
use maulstick_bus::{Bus, BusError, CreditSender, Wake, ZenohBus};
use maulstick_rig::UserError;
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample, axes};
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Flags, Origin};

use super::{GRACE, Puller, frame, joined_as, rig_with};
use crate::report::{Report, quantile, sorted};
use crate::running::{Running, fault};

/// Width of the brush, mm.
const BRUSH_MM: f64 = 30.0;
/// Side of a cell, mm.
const CELL_MM: &str = "0.125";
/// Target: the 95th percentile of the latencies in medians.
const MOST_BY_P50: f64 = 2.0;

/// Samples a second of the pen.
const RATE_HZ: u64 = 250;
/// Speed of the hand, m/s.
const SPEED_M_PER_S: f64 = 0.5;
/// Length of a stroke, m.
const STROKE_M: f64 = 0.2;
const STROKES: u64 = 24;
/// Samples between two strokes, of a pen that hovers.
const LIFT_SAMPLES: u64 = 50;
/// Delay of the hand after its creation, ns: by then its first sample is ready to be sent.
const LEAD_NS: u64 = 100_000_000;

/// Measures, and reports beside the median of the usual brush.
pub(crate) fn run(report: &mut Report, place: &Path, usual: f64) -> Result<(), UserError> {
    let file = place.join("broad.toml");
    let flat = BrushFile::library("flat").map_err(fault)?;
    let flat = flat.scaled_to(BRUSH_MM).map_err(fault)?;
    std::fs::write(&file, flat.to_toml().map_err(fault)?).map_err(fault)?;
    let file = file.display().to_string();
    let options = ["--headless", "--cell-mm", CELL_MM, "--brush", &file];
    let mut rig = Running::start(&mut rig_with(place, &options)?)?;
    let bus = Arc::new(joined_as(place, "hand")?);
    while frame(&bus, (0, 0, 0))?.is_none() {
        if rig.has_ended()? {
            return Err(fault("the rig has ended"));
        }
    }
    let puller = Puller::new(&bus)?;
    let begin_ns = bus.now_ns() + LEAD_NS;
    let hand = hand(Arc::clone(&bus), begin_ns);
    let last_ns = begin_ns + at_ns(SAMPLES - LIFT_SAMPLES - 1);
    let give_up = Instant::now() + Duration::from_nanos(LEAD_NS + at_ns(SAMPLES)) + GRACE;
    let latencies = puller.pull(
        give_up,
        |held_ns| Ok(held_ns >= last_ns || rig.has_ended()?),
    )?;
    hand.join().map_err(|_| fault("the hand has stopped"))??;
    bus.close();

    let all = sorted(latencies.milliseconds);
    let [p50, p95] = [0.5, 0.95].map(|share| quantile(&all, share));
    report.beside("broad.p50", p50, "ms", ("frame.p50", usual));
    report.row("broad.p95", p95, "ms");
    report.beside("broad.p95_by_p50", p95 / p50, "", ("target", MOST_BY_P50));
    let solves = latencies.solves.iter().sum::<usize>().max(1) as f64;
    let names = ["once", "twice", "four_times"].map(|times| format!("broad.steps_{times}"));
    for (name, count) in names.iter().zip(latencies.solves) {
        report.row(name, count as f64 / solves, "share");
    }
    let lost = latencies.lost as f64 / (all.len() + latencies.lost) as f64;
    report.row("broad.lost", lost, "share");
    Ok(())
}

/// Samples of a stroke.
const STROKE_SAMPLES: u64 = (STROKE_M / SPEED_M_PER_S * RATE_HZ as f64) as u64;
/// Number of all samples.
const SAMPLES: u64 = STROKES * (STROKE_SAMPLES + LIFT_SAMPLES);

/// Time of a sample after the first, ns.
fn at_ns(number: u64) -> u64 {
    number * 1_000_000_000 / RATE_HZ
}

/// Strokes to and fro across the canvas, each a little above the last.
fn sample(number: u64) -> StylusSample {
    let period = STROKE_SAMPLES + LIFT_SAMPLES;
    let (stroke, at) = (number / period, number % period);
    let along = (at as f64 / STROKE_SAMPLES as f64).min(1.0) - 0.5;
    let x = STROKE_M * if stroke % 2 == 0 { along } else { -along };
    StylusSample {
        senses: axes::POSITION | axes::PRESSURE | axes::TILT,
        pose: StylusPose::Contact {
            point_m: [x, 0.006 * (stroke as f64 - 0.5 * STROKES as f64), 0.0],
            tilt_rad: DEFAULT_TILT_RAD,
            twist_rad: FRAC_PI_2,
            pressure: if at < STROKE_SAMPLES { 0.5 } else { 0.0 },
        },
        in_range: true,
        ..StylusSample::away()
    }
}

/// A pen that sends its samples when they are due, with or without listeners.
fn hand(bus: Arc<ZenohBus>, begin_ns: u64) -> JoinHandle<Result<(), BusError>> {
    thread::spawn(move || {
        let (topics, wake) = (Topics::new("latency"), Wake::new());
        let me = Origin {
            source: maulstick_types::name_hash("hand"),
            epoch: 1,
        };
        let topic = topics.sample("hand");
        let mut samples = CreditSender::new(&*bus, &topics, &topic, me, &wake)?;
        for number in 0..SAMPLES {
            let event_ns = begin_ns + at_ns(number);
            thread::sleep(Duration::from_nanos(event_ns.saturating_sub(bus.now_ns())));
            let now_ns = bus.now_ns();
            samples.reset_credit();
            samples.serve(now_ns)?;
            samples.send(Flags::NONE, Stamp { now_ns, event_ns }, &sample(number))?;
        }
        Ok(())
    })
}
