//! Devices that are plugged in, made up below decoding: the daemon's own thread reads them.

use std::collections::VecDeque;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use maulstick_hid::device_source::{Found, HidSource, Identity, Ports};
use maulstick_hid::open::{Address, Kind, missing};
use maulstick_hid::recording;
use maulstick_hid::unfit::{Unfit, UnfitDevice};
use maulstick_rig::UserError;
use maulstick_types::stylus::StylusSample;

use crate::daemon::{Rig, settings, stroke_report};
use crate::support::{DESKTOP, DIGITIZER, Descriptor, deco_l, identity, pointer, spacemouse};

/// Next step of a made-up device.
#[derive(Clone, Debug)]
enum Deed {
    Report(Vec<u8>),
    Unplug,
}

/// A desk with devices on it, as the test has them.
#[derive(Default)]
struct Desk {
    found: Vec<(Found, Vec<u8>)>,
    deeds: VecDeque<Deed>,
    orders: Vec<Vec<u8>>,
    opened: Vec<String>,
    closed: Option<UserError>,
}

#[derive(Clone, Default)]
struct Plugs {
    desk: Arc<Mutex<Desk>>,
    /// Folder in the place of /dev.
    dev: Option<PathBuf>,
}

struct Device {
    plugs: Plugs,
    descriptor: Vec<u8>,
}

impl Plugs {
    fn with<T>(&self, deed: impl FnOnce(&mut Desk) -> T) -> T {
        deed(&mut self.desk.lock().expect("no panic"))
    }

    fn plug(&self, identity: Identity, descriptor: &Descriptor, usage: (u16, u16)) {
        let found = Found {
            identity,
            usages: vec![usage],
        };
        self.with(|desk| desk.found.push((found, descriptor.bytes.clone())));
    }

    fn say(&self, report: Vec<u8>) {
        self.with(|desk| desk.deeds.push_back(Deed::Report(report)));
    }
}

impl Ports for Plugs {
    fn list(&mut self) -> Result<Vec<Found>, UserError> {
        Ok(self.with(|desk| desk.found.iter().map(|(found, _)| found.clone()).collect()))
    }

    fn dev(&self) -> Option<&Path> {
        self.dev.as_deref()
    }

    fn open(&mut self, found: &Found) -> Result<Box<dyn HidSource>, UserError> {
        let descriptor = self.with(|desk| {
            desk.opened.push(found.identity.place.clone());
            match desk.closed.clone() {
                Some(fault) => Err(fault),
                None => Ok(desk
                    .found
                    .iter()
                    .find(|(known, _)| known == found)
                    .expect("listed")
                    .1
                    .clone()),
            }
        })?;
        Ok(Box::new(Device {
            plugs: self.clone(),
            descriptor,
        }))
    }
}

/// The error of a device that was pulled out.
fn unplugged() -> UserError {
    UserError::failure("the tablet was unplugged").help("plug it in again")
}

/// A status's trouble by an error.
fn trouble(error: &UserError) -> String {
    format!(
        "{}; {}",
        error.what,
        error.help.as_deref().unwrap_or_default()
    )
}

impl HidSource for Device {
    fn descriptor(&self) -> &[u8] {
        &self.descriptor
    }

    fn read(&mut self, report: &mut [u8], _: Duration) -> Result<usize, UserError> {
        match self.plugs.with(|desk| desk.deeds.pop_front()) {
            Some(Deed::Report(bytes)) => {
                report[..bytes.len()].copy_from_slice(&bytes);
                Ok(bytes.len())
            }
            Some(Deed::Unplug) => Err(unplugged()),
            None => {
                std::thread::yield_now();
                Ok(0)
            }
        }
    }

    fn write(&mut self, report: &[u8]) -> Result<(), UserError> {
        self.plugs.with(|desk| desk.orders.push(report.to_vec()));
        Ok(())
    }
}

const PEN: (u16, u16) = (DIGITIZER, 0x02);

fn tablet() -> (Plugs, Rig) {
    let plugs = Plugs::default();
    plugs.plug(identity(0x28BD, 0x0935, "Deco L"), &deco_l(), PEN);
    let rig = Rig::new(&settings("pen"), Box::new(plugs.clone())).expect("a daemon");
    (plugs, rig)
}

/// Turns, while time passes, until samples have come that satisfy.
fn until(rig: &mut Rig, is_enough: impl Fn(&[StylusSample]) -> bool) -> Vec<StylusSample> {
    let (mut told, limit) = (Vec::new(), Instant::now() + Duration::from_secs(60));
    while !is_enough(&told) {
        assert!(Instant::now() < limit, "too few: {told:?}");
        rig.run(1_000_000, 1_000_000);
        told.extend(rig.samples().into_iter().map(|told| told.message));
        std::thread::yield_now();
    }
    told
}

fn has_left(told: &[StylusSample]) -> bool {
    told.last().is_some_and(|last| !last.in_range)
}

fn attempts(plugs: &Plugs) -> usize {
    plugs.with(|desk| desk.opened.len())
}

#[test]
fn a_stroke_of_a_device_loses_no_sample() {
    let (plugs, mut rig) = tablet();
    let tablet = deco_l();
    for x in 0..3000 {
        plugs.say(stroke_report(&tablet, 1, 1, x, 4000));
    }
    plugs.say(stroke_report(&tablet, 0, 0, 0, 0));
    let told = until(&mut rig, has_left);
    let mut places = Vec::new();
    for sample in told.iter().filter(|sample| !sample.in_air()) {
        let maulstick_types::stylus::StylusPose::Contact { point_m, .. } = sample.pose else {
            panic!("a pen has no ferrule");
        };
        // A pen that is told of again is where it was.
        if places.last() != Some(&point_m[0]) {
            places.push(point_m[0]);
        }
    }
    assert_eq!(places.len(), 3000);
    assert!(places.is_sorted());
    // XP-Pen's tablet was told to report.
    assert_eq!(plugs.with(|desk| desk.orders.clone()), [[0x02, 0xB0, 0x04]]);
}

#[test]
fn unplugged_in_a_stroke_the_pen_is_lifted_and_found_again() {
    let (plugs, mut rig) = tablet();
    let tablet = deco_l();
    plugs.say(stroke_report(&tablet, 1, 1, 25_400, 4000));
    until(&mut rig, |told| {
        told.last().is_some_and(|last| !last.in_air())
    });
    let there = plugs.with(|desk| {
        desk.deeds.push_back(Deed::Unplug);
        std::mem::take(&mut desk.found)
    });
    let told = until(&mut rig, has_left);
    let [.., lifted, away] = &told[..] else {
        panic!("it was lifted before it left: {told:?}");
    };
    assert!(lifted.in_range && lifted.in_air() && !away.in_range);
    rig.run(200_000_000, 10_000_000);
    assert_eq!(rig.trouble(), trouble(&unplugged()));
    rig.run(3_000_000_000, 50_000_000);
    assert_eq!(
        rig.trouble(),
        trouble(&missing(Kind::Pen, &Address::Any, &[]))
    );
    plugs.with(|desk| desk.found = there);
    plugs.say(stroke_report(&tablet, 1, 1, 30_000, 4000));
    rig.run(1_500_000_000, 50_000_000);
    until(&mut rig, |told| {
        told.last().is_some_and(|last| !last.in_air())
    });
    rig.run(200_000_000, 10_000_000);
    assert_eq!(rig.trouble(), "");
}

#[test]
fn a_machine_that_slept_does_not_catch_up() {
    let (plugs, mut rig) = tablet();
    plugs.say(stroke_report(&deco_l(), 0, 1, 25_400, 0));
    until(&mut rig, |told| !told.is_empty());
    // Awake, a pen that rests is told of 20 times a second.
    rig.run(1_000_000_000, 10_000_000);
    let awake = rig.samples().len();
    assert!((19..=21).contains(&awake), "{awake}");
    rig.net.advance(3_600_000_000_000);
    rig.run(1_000_000_000, 10_000_000);
    let after = rig.samples().len();
    assert!((19..=21).contains(&after), "{after}");
}

#[test]
fn a_device_that_is_not_there_is_looked_for_each_second() {
    let plugs = Plugs::default();
    plugs.plug(identity(0x28BD, 0x0935, "Deco L"), &deco_l(), PEN);
    let denied = UserError::failure("you may not read it")
        .help("`maulstick device allow` installs the rule");
    plugs.with(|desk| desk.closed = Some(denied.clone()));
    let mut rig = Rig::new(&settings("pen"), Box::new(plugs.clone())).expect("a daemon");
    rig.run(5_500_000_000, 10_000_000);
    assert_eq!(attempts(&plugs), 6);
    assert_eq!(rig.trouble(), trouble(&denied));
    assert!(rig.samples().is_empty());
}

#[test]
fn a_node_that_appears_is_opened_once_udev_is_done_with_it() {
    let dev = tempfile::tempdir().expect("a folder");
    let plugs = Plugs {
        dev: Some(dev.path().to_owned()),
        ..Plugs::default()
    };
    let mut rig = Rig::new(&settings("pen"), Box::new(plugs.clone())).expect("a daemon");
    rig.run(200_000_000, 10_000_000);
    plugs.plug(identity(0x28BD, 0x0935, "Deco L"), &deco_l(), PEN);
    std::fs::write(dev.path().join("sda1"), "").expect("made");
    rig.run(200_000_000, 10_000_000);
    assert_eq!(attempts(&plugs), 0, "that is a disk");
    let node = dev.path().join("hidraw3");
    std::fs::write(&node, "").expect("made");
    rig.run(80_000_000, 10_000_000);
    let all = std::fs::Permissions::from_mode(0o666);
    std::fs::set_permissions(&node, all).expect("set");
    rig.run(80_000_000, 10_000_000);
    assert_eq!(attempts(&plugs), 0, "its permissions may change again");
    rig.run(30_000_000, 10_000_000);
    assert_eq!(attempts(&plugs), 1, "before a second is over");
    rig.run(100_000_000, 10_000_000);
    assert_eq!(rig.trouble(), "");
}

/// A device of several.
fn at(vendor: u16, product: u16, place: &str) -> Identity {
    Identity {
        place: place.into(),
        ..identity(vendor, product, "Thing")
    }
}

/// A mouse, two tablets and a 6-DOF mouse, and a device that calls itself a pen and describes none.
fn several() -> Plugs {
    let plugs = Plugs::default();
    plugs.plug(
        at(0x1, 0x1, "/dev/hidraw0"),
        &pointer(DESKTOP, 0x02),
        (DESKTOP, 0x02),
    );
    plugs.plug(at(0x2, 0x2, "/dev/hidraw1"), &pointer(DIGITIZER, 0x05), PEN);
    plugs.plug(at(0x28BD, 0x0935, "/dev/hidraw2"), &deco_l(), PEN);
    plugs.plug(at(0x28BD, 0x0935, "/dev/hidraw3"), &deco_l(), PEN);
    plugs.plug(
        at(0x256F, 0xC635, "/dev/hidraw4"),
        &spacemouse(),
        (DESKTOP, 0x08),
    );
    plugs
}

/// Places that a daemon opens, and its trouble.
fn opened(driver: &str, address: Option<&str>) -> (Vec<String>, String) {
    let plugs = several();
    let mut settings = settings(driver);
    settings.device.address = address.map(str::to_owned);
    let mut rig = Rig::new(&settings, Box::new(plugs.clone())).expect("a daemon");
    rig.run(200_000_000, 100_000_000);
    (plugs.with(|desk| desk.opened.clone()), rig.trouble())
}

#[test]
fn opens_the_first_that_suits_or_the_named() {
    for (driver, address, places) in [
        ("pen", None, &["/dev/hidraw1", "/dev/hidraw2"][..]),
        ("pen", Some("/dev/hidraw3"), &["/dev/hidraw3"]),
        ("pen", Some("28bd:0935"), &["/dev/hidraw2"]),
        ("spacemouse", None, &["/dev/hidraw4"]),
    ] {
        let places = places.iter().map(ToString::to_string).collect();
        assert_eq!(opened(driver, address), (places, String::new()));
    }
}

#[test]
fn opens_nothing_else() {
    for (driver, address, identity, why) in [
        (
            "pen",
            "0001:0001",
            at(0x1, 0x1, "/dev/hidraw0"),
            Unfit::NoPen(vec![(DESKTOP, 0x02)]),
        ),
        (
            "spacemouse",
            "/dev/hidraw2",
            at(0x28BD, 0x0935, "/dev/hidraw2"),
            Unfit::NoMouse(vec![(DIGITIZER, 0x02)]),
        ),
    ] {
        let places = vec![identity.place.clone()];
        let unfit = UnfitDevice { identity, why };
        assert_eq!(
            opened(driver, Some(address)),
            (places, trouble(&unfit.into()))
        );
    }
    for address in ["0009:0001", "/dev/hidraw9"] {
        let parsed = Address::parse(Some(address)).expect("an address");
        let there = several().list().expect("listed");
        let absent = missing(Kind::Pen, &parsed, &there);
        assert_eq!(opened("pen", Some(address)), (Vec::new(), trouble(&absent)));
    }
    let mut wrong = settings("pen");
    wrong.device.address = Some("tablet".into());
    let fault = Rig::new(&wrong, Box::new(several()))
        .err()
        .expect("refused");
    let parsed = Address::parse(Some("tablet")).expect_err("no address");
    assert_eq!(fault, parsed);
}

#[test]
fn a_mouse_s_light_goes_on() {
    let plugs = Plugs::default();
    plugs.plug(
        identity(0x046D, 0xC626, "SpaceNavigator"),
        &spacemouse(),
        (DESKTOP, 0x08),
    );
    let mut rig = Rig::new(&settings("spacemouse"), Box::new(plugs.clone())).expect("a daemon");
    rig.run(1_000_000, 1_000_000);
    assert_eq!(plugs.with(|desk| desk.orders.clone()), [[0x04, 0x01]]);
}

#[test]
fn what_a_device_says_is_recorded_and_plays_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("pen.hid");
    let plugs = Plugs::default();
    plugs.plug(identity(0x28BD, 0x0935, "Deco L"), &deco_l(), PEN);
    let mut settings = settings("pen");
    settings.record = Some(path.clone());
    let mut rig = Rig::new(&settings, Box::new(plugs.clone())).expect("a daemon");
    let said: Vec<_> = (0..50)
        .map(|x| stroke_report(&deco_l(), 1, 1, 100 * x, 4000))
        .collect();
    said.iter().for_each(|report| plugs.say(report.clone()));
    plugs.say(stroke_report(&deco_l(), 0, 0, 0, 0));
    until(&mut rig, has_left);
    rig.daemon.end().expect("written");
    let recorded = recording::read(&path).expect("a recording");
    let reports: Vec<_> = recorded[0]
        .events
        .iter()
        .map(|event| event.report.clone())
        .collect();
    assert_eq!(reports[..50], said);
    assert_eq!((reports.len(), recorded[0].identity.product), (51, 0x0935));
}

#[test]
fn a_tablet_that_cannot_be_read_can_be_recorded_by_its_address() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("odd.hid");
    let plugs = Plugs::default();
    let odd = pointer(0xFF00, 0x01);
    plugs.plug(identity(0x5543, 0x0081, "Odd"), &odd, (0xFF00, 0x01));
    let mut settings = settings("pen");
    settings.device.address = Some("5543:0081".into());
    settings.record = Some(path.clone());
    let mut rig = Rig::new(&settings, Box::new(plugs.clone())).expect("a daemon");
    rig.run(200_000_000, 10_000_000);
    let unfit = UnfitDevice {
        identity: identity(0x5543, 0x0081, "Odd"),
        why: Unfit::NoPen(vec![(0xFF00, 0x01)]),
    };
    assert_eq!(rig.trouble(), trouble(&unfit.into()));
    plugs.say(vec![1, 2, 3]);
    plugs.with(|desk| desk.deeds.push_back(Deed::Unplug));
    // Whoever knows that it was unplugged has heard what it said before.
    let limit = Instant::now() + Duration::from_secs(60);
    while rig
        .status()
        .is_none_or(|status| status.trouble != unplugged().what)
    {
        assert!(Instant::now() < limit, "it is not read");
        rig.run(100_000_000, 10_000_000);
        std::thread::yield_now();
    }
    assert!(rig.samples().is_empty());
    rig.daemon.end().expect("written");
    let recorded = recording::read(&path).expect("a recording");
    assert_eq!(recorded[0].descriptor, odd.bytes);
    let reports = recorded[0].events.iter().map(|event| &event.report[..]);
    assert!(reports.eq([[1, 2, 3]]), "{recorded:?}");
}
