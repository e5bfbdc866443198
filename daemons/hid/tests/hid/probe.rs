//! Pens that show the corners of a canvas, of a tablet that senses a hovering pen and of one that does not.

use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::time::Duration;

use maulstick_device::corner_calibration::{CornerCalibration, HandReading, Progress};
use maulstick_hid::device_source::{Found, HidSource, Ports};
use maulstick_hid::probe;
use maulstick_hid::recording::{Event, Recorded};
use maulstick_rig::UserError;
use maulstick_rig::config::DeviceSection;

use crate::daemon::{stroke_report, write};
use crate::support::{DIGITIZER, deco_l, identity};

/// Range in which a tablet senses its pen.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Senses {
    Hover,
    Touch,
}

/// Counts of X of the corners that are shown.
const PLACES: [i64; 3] = [5000, 45_000, 25_000];

/// Reports, and how long after the one before each comes, ms: three touches that rest for so long.
fn reports(senses: Senses, rest_ms: u64) -> Vec<(u64, Vec<u8>)> {
    let tablet = deco_l();
    let near = i64::from(senses == Senses::Hover);
    let mut all = Vec::new();
    for x in PLACES {
        let mut say = |after_ms, tip, near| {
            all.push((after_ms, stroke_report(&tablet, tip, near, x, 4000 * tip)));
        };
        say(500, 0, near);
        say(5, 1, 1);
        say(5, 1, 1);
        say(rest_ms, 1, 1);
        say(5, 0, near);
        say(5, 0, 0);
    }
    all
}

struct Desk(VecDeque<Vec<u8>>, Vec<u8>);

impl Ports for Desk {
    fn list(&mut self) -> Result<Vec<Found>, UserError> {
        Ok(vec![Found {
            identity: identity(0x28BD, 0x0935, "Deco L"),
            usages: vec![(DIGITIZER, 0x02)],
        }])
    }

    fn open(&mut self, _: &Found) -> Result<Box<dyn HidSource>, UserError> {
        Ok(Box::new(Desk(self.0.clone(), self.1.clone())))
    }
}

impl HidSource for Desk {
    fn descriptor(&self) -> &[u8] {
        &self.1
    }

    fn read(&mut self, report: &mut [u8], _: Duration) -> Result<usize, UserError> {
        let said = self
            .0
            .pop_front()
            .ok_or_else(|| UserError::failure("gone"))?;
        report[..said.len()].copy_from_slice(&said);
        Ok(said.len())
    }

    fn write(&mut self, _: &[u8]) -> Result<(), UserError> {
        Ok(())
    }
}

/// The corners that are found, and how the probe ended.
fn shown(ports: &mut dyn Ports, device: &DeviceSection) -> (usize, Result<(), UserError>) {
    let (mut corners, mut found) = (CornerCalibration::new(), 0);
    let ended = probe::open(ports, device).expect("open").probe(|reading| {
        match reading {
            HandReading::Away => corners.lose(),
            HandReading::Sample(seen) => {
                found += usize::from(matches!(corners.see(&seen), Progress::Found(..)));
            }
        }
        match corners.all() {
            Some(_) => ControlFlow::Break(()),
            None => ControlFlow::Continue(()),
        }
    });
    (found, ended)
}

#[test]
fn a_tablet_shows_three_corners_whether_its_pen_hovers_or_not() {
    for senses in [Senses::Hover, Senses::Touch] {
        let said = reports(senses, 5).into_iter().map(|(_, report)| report);
        let mut desk = Desk(said.collect(), deco_l().bytes);
        let (found, ended) = shown(&mut desk, &DeviceSection::new("pen", "pen", "main"));
        assert_eq!((found, ended.is_ok()), (3, true), "{senses:?}");
    }
}

#[test]
fn a_tablet_that_is_lost_before_ends_the_probe_by_a_fault() {
    let said = reports(Senses::Touch, 5)
        .into_iter()
        .map(|(_, report)| report);
    let mut desk = Desk(said.take(10).collect(), deco_l().bytes);
    let (found, ended) = shown(&mut desk, &DeviceSection::new("pen", "pen", "main"));
    assert_eq!((found, ended.is_err()), (1, true));
}

#[test]
fn a_recorded_touch_that_rests_without_reports_is_one_touch() {
    for senses in [Senses::Hover, Senses::Touch] {
        let mut time_ns = 0;
        let events = reports(senses, 2000).into_iter().map(|(after_ms, report)| {
            time_ns += after_ms * 1_000_000;
            Event { time_ns, report }
        });
        let recorded = Recorded {
            identity: identity(0x28BD, 0x0935, "Deco L"),
            descriptor: deco_l().bytes,
            events: events.collect(),
        };
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("corners.hid");
        write(&path, &recorded);
        let mut device = DeviceSection::new("pen", "pen", "main");
        device.replay = Some(path);
        let (found, ended) = shown(&mut Desk(VecDeque::new(), Vec::new()), &device);
        assert_eq!((found, ended.is_ok()), (3, true), "{senses:?}");
    }
}
