//! A rig without a window that paints as fast as it can, as load.

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use maulstick_bus::typed::Receiver;
use maulstick_bus::{Dial, Qos, Queue, RigClock, Wake, ZenohBus};
use maulstick_device::{Take, TakeSample};
use maulstick_rig::UserError;
use maulstick_types::brush::BrushState;
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample, axes};
use maulstick_types::wire::topics::Topics;

use super::fault;
use crate::running::{joined, maulstick};

/// Samples a second of its take.
const RATE_HZ: u64 = 250;
/// Length of its take, s.
const LENGTH_S: u64 = 400;
/// Frequency of a hand that moves to and fro over 20 cm, Hz: at 1 m/s, 4,000 cells a second, the brush and the paint
/// need a core each.
const TURNS_HZ: f64 = 2.5;
/// Longest time for a rig to begin to paint.
const PATIENCE: Duration = Duration::from_secs(60);

/// The rig; it ends with this value.
pub(super) struct Load(Child);

impl Drop for Load {
    fn drop(&mut self) {
        self.0.kill().ok();
        self.0.wait().ok();
    }
}

impl Load {
    /// Starts it and waits until it paints.
    ///
    /// # Errors
    /// A [`UserError`] where it does not.
    pub(super) fn start(place: &Path) -> Result<Self, UserError> {
        const NAME: &str = "load";
        let take = place.join("load.mcap");
        to_and_fro().write(&take)?;
        let child = Command::new(maulstick()?)
            .args(["up", "--headless", "--name", NAME, "--rate", "1"])
            .args(["--load", "Bone Black", "--play"])
            .arg(&take)
            .current_dir(place)
            .env("XDG_RUNTIME_DIR", place)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .map_err(fault)?;
        let mut load = Self(child);
        let path = place.join("maulstick").join(NAME);
        let give_up = Instant::now() + PATIENCE;
        let (_, info) = joined(&path, give_up)?;
        let dial = Dial {
            name: "bench".into(),
            listen: None,
            connect: vec![info.endpoint],
        };
        let bus = ZenohBus::open(&dial, RigClock::with_offset(info.clock_offset_ns))?;
        let (topic, wake) = (Topics::new(NAME).brush_state("main"), Wake::new());
        let queue = Queue::Ring(64);
        let mut states = Receiver::<BrushState>::new(&bus, &topic, Qos::RealTime, queue, &wake)?;
        let paints = |state: BrushState| state.solves.iter().any(|solve| solve.stroke > 0);
        while !states.try_recv().is_some_and(|state| paints(state.message)) {
            load.check()?;
            if Instant::now() > give_up {
                return Err(fault("the rig that is to be the load does not paint"));
            }
            wake.wait(Duration::from_millis(10));
        }
        drop(states);
        bus.close();
        Ok(load)
    }

    /// Processor time that its nodes have had, s.
    pub(super) fn seconds(&self) -> f64 {
        let processes = std::fs::read_dir("/proc").into_iter().flatten().flatten();
        let lines = processes.filter_map(|it| std::fs::read_to_string(it.path().join("stat")).ok());
        let nodes = lines.filter_map(|line| parent_and_time(&line));
        let ours = nodes.filter(|(parent, _)| *parent == self.0.id());
        ours.map(|(_, seconds)| seconds).sum()
    }

    /// Checks that it is still running.
    ///
    /// # Errors
    /// A [`UserError`] where it has ended: later measurements lacked the load.
    pub(super) fn check(&mut self) -> Result<(), UserError> {
        match self.0.try_wait().map_err(fault)? {
            None => Ok(()),
            Some(status) => Err(fault(format!("the load has ended: {status}"))),
        }
    }
}

/// Unit of processor time in Linux, per second (`USER_HZ`).
const USER_HZ: f64 = 100.0;

/// Parent of a process, and its processor time, s, from its line in `/proc`.
fn parent_and_time(stat: &str) -> Option<(u32, f64)> {
    // Its name, in parentheses, may hold anything.
    let (_, rest) = stat.rsplit_once(") ")?;
    let cells: Vec<&str> = rest.split(' ').collect();
    let number = |place: usize| cells.get(place)?.parse::<u64>().ok();
    let parent = u32::try_from(number(1)?).ok()?;
    Some((parent, (number(11)? + number(12)?) as f64 / USER_HZ))
}

/// A hand that goes to and fro, well pressed.
fn to_and_fro() -> Take {
    let samples = (0..LENGTH_S * RATE_HZ).map(|number| {
        let turns = number as f64 / RATE_HZ as f64 * TURNS_HZ;
        let x = 0.4 * (turns.fract() - 0.5).abs() - 0.1;
        TakeSample {
            time_ns: number * 1_000_000_000 / RATE_HZ,
            sample: StylusSample {
                senses: axes::POSITION | axes::PRESSURE | axes::TILT,
                pose: StylusPose::Contact {
                    // Adjacent strokes, each of which meets the paint of others.
                    point_m: [x, 0.02 * (turns * 0.07).fract(), 0.0],
                    tilt_rad: DEFAULT_TILT_RAD,
                    twist_rad: 0.0,
                    pressure: 0.7,
                },
                in_range: true,
                ..StylusSample::away()
            },
        }
    });
    Take {
        setup: None,
        device: "load".into(),
        samples: samples.collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_processor_time_of_a_node_is_read_whatever_it_is_called() {
        let line = "28183 (a ) b (c) S 714 1 1 0 -1 4194560 2 0 0 0 130 20 7 9 20 0 5 0 10 11";
        assert_eq!(parent_and_time(line), Some((714, 1.5)));
        assert_eq!(parent_and_time("28183 (a) S 714"), None);
    }
}
