//! Reads a pen without a rig, for calibration.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use glam::DVec3;
use maulstick_device::corner_calibration::{HandReading, HandSample, Touch};
use maulstick_rig::UserError;
use maulstick_rig::config::DeviceSection;

use maulstick_device::pen::{Pen, Presence, Reading};

use crate::device_source::{HidSource, Identity, Ports};
use crate::open::{self, Address, Decoder, Kind, Means};
use crate::recording::{self, Event, LONGEST_REPORT};

/// Time without a report after which the last reading is repeated.
const SILENCE: Duration = Duration::from_millis(50);
/// The same of a recording, ns.
const SILENCE_NS: u64 = 50_000_000;

/// An open pen, or a recording of one.
pub struct ProbedPen {
    /// Description for the log.
    pub what: String,
    decoder: Decoder,
    reports: Reports,
}

enum Reports {
    Live(Box<dyn HidSource>),
    Played(Vec<Event>),
}

/// Opens the pen of a section of `rig.toml`, or the recording that is played in its place.
///
/// # Errors
/// [`UserError`] if it is missing, may not be read, or is not a pen.
pub fn open(ports: &mut dyn Ports, device: &DeviceSection) -> Result<ProbedPen, UserError> {
    let kind = Kind::of_section(device)?;
    let pen = |identity: &Identity, means: Means, reports| {
        let what = open::description(identity, &means);
        match means {
            Means::Pen(decoder) => Ok(ProbedPen {
                what,
                decoder,
                reports,
            }),
            Means::SpaceMouse => Err(UserError::usage(format!("{identity} has no pen"))),
        }
    };
    let Some(path) = &device.replay else {
        let address = Address::parse(device.address.as_deref())?;
        let opened = open::open(ports, kind, &address)?;
        return pen(
            &opened.identity,
            opened.means?,
            Reports::Live(opened.source),
        );
    };
    let recorded = recording::playable(kind, recording::read(path)?)
        .map_err(|fault| fault.at(path.display().to_string()))?;
    let means = open::means(kind, &recorded.identity, &recorded.descriptor)?;
    pen(&recorded.identity, means, Reports::Played(recorded.events))
}

impl ProbedPen {
    /// Hands the pen's readings, in the tablet's frame, to `look` until that breaks off.
    ///
    /// # Errors
    /// [`UserError`] if the tablet is lost or the recording ends before.
    pub fn probe(
        self,
        mut look: impl FnMut(HandReading) -> ControlFlow<()>,
    ) -> Result<(), UserError> {
        let Self {
            mut decoder,
            reports,
            ..
        } = self;
        let mut pen = Pen::default();
        let mut readings = Vec::with_capacity(3);
        let mut see = |report: &[u8], time_s: f64| {
            readings.clear();
            if let Some(said) = decoder.decode(report) {
                // A pen that goes while it touches is lifted in between, and only that shows the corner.
                pen.follow(said, &mut |reading| readings.push(reading));
            }
            if readings.is_empty() {
                readings.push(*pen.newest());
            }
            let mut seen = readings.iter().map(|reading| hand_reading(reading, time_s));
            seen.try_for_each(&mut look)
        };
        match reports {
            Reports::Played(events) => {
                let seconds = |time_ns: u64| time_ns as f64 * 1e-9;
                let mut seen_ns = events.first().map_or(0, |event| event.time_ns);
                for event in events {
                    while seen_ns + SILENCE_NS < event.time_ns {
                        seen_ns += SILENCE_NS;
                        if see(&[], seconds(seen_ns)).is_break() {
                            return Ok(());
                        }
                    }
                    seen_ns = event.time_ns;
                    if see(&event.report, seconds(seen_ns)).is_break() {
                        return Ok(());
                    }
                }
                Err(UserError::failure(
                    "the recording is over before three corners are shown",
                ))
            }
            Reports::Live(mut source) => {
                let (begin, mut report) = (Instant::now(), vec![0; LONGEST_REPORT]);
                loop {
                    let length = source.read(&mut report, SILENCE)?;
                    let now_s = begin.elapsed().as_secs_f64();
                    if see(&report[..length.min(LONGEST_REPORT)], now_s).is_break() {
                        return Ok(());
                    }
                }
            }
        }
    }
}

fn hand_reading(reading: &Reading, time_s: f64) -> HandReading {
    let touch = match reading.presence {
        Presence::Away => return HandReading::Away,
        Presence::Hovering => Touch::Up,
        Presence::Touching => Touch::Down,
    };
    let [x, y] = reading.point_m;
    HandReading::Sample(HandSample {
        point: DVec3::new(x, y, 0.0),
        handle: Some(DVec3::Z),
        touch,
        time_s,
    })
}
