//! Tablets through the kernel's event devices, from what sysfs says of them. Codes stand here as numbers of
//! `input-event-codes.h`, not by the names that the code reads.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use maulstick_device::pen::{End, Presence, Reading};
use maulstick_hid::device_source::Ports as _;
use maulstick_hid::evdev::capabilities::{Axis, Capabilities};
use maulstick_hid::evdev::grab::{Grab, event_nodes};
use maulstick_hid::evdev::pen::EvdevPen;
use maulstick_hid::evdev::ports::EventDevices;
use maulstick_hid::hidraw::closed;
use maulstick_hid::open::{Kind, means};
use maulstick_hid::unfit::Unfit;
use maulstick_types::stylus::axes;
use proptest::prelude::*;

use crate::support::identity;

pub(crate) const X: u16 = 0;
pub(crate) const Y: u16 = 1;
const Z: u16 = 2;
pub(crate) const PRESSURE: u16 = 0x18;
const DISTANCE: u16 = 0x19;
const TILT_X: u16 = 0x1A;
const TILT_Y: u16 = 0x1B;
pub(crate) const PEN: u16 = 0x140;
const RUBBER: u16 = 0x141;
pub(crate) const TOUCH: u16 = 0x14A;
const STYLUS: u16 = 0x14B;
const STYLUS2: u16 = 0x14C;

/// Axes and keys of an Intuos Pro M's pen as Linux has them: 200 counts a millimetre, 57 a radian of tilt.
pub(crate) fn intuos() -> Capabilities {
    let axis = |code, range, resolution| Axis {
        code,
        range,
        resolution,
    };
    Capabilities {
        axes: vec![
            axis(X, [0, 44_800], 200),
            axis(Y, [0, 29_600], 200),
            axis(Z, [-900, 899], 287),
            axis(PRESSURE, [0, 8191], 0),
            axis(DISTANCE, [0, 63], 0),
            axis(TILT_X, [-64, 63], 57),
            axis(TILT_Y, [-64, 63], 57),
        ],
        keys: vec![PEN, RUBBER, TOUCH, STYLUS, STYLUS2],
    }
}

/// A frame of (type, code, value).
fn frame(events: &[(u16, u16, i32)]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for (kind, code, value) in events {
        bytes.extend(kind.to_le_bytes());
        bytes.extend(code.to_le_bytes());
        bytes.extend(value.to_le_bytes());
    }
    bytes
}

fn read(pen: &mut EvdevPen, events: &[(u16, u16, i32)]) -> Reading {
    pen.decode(&frame(events)).expect("events")
}

pub(crate) fn near(got: f64, wanted: f64) {
    assert!((got - wanted).abs() < 1e-9, "{got} {wanted}");
}

#[test]
fn area_and_senses() {
    let pen = EvdevPen::of(&intuos()).expect("a pen");
    near(pen.area_m()[0], 0.224);
    near(pen.area_m()[1], 0.148);
    assert_eq!(
        pen.senses(),
        axes::POSITION
            | axes::PROXIMITY
            | axes::PRESSURE
            | axes::TILT
            | axes::TWIST
            | axes::SWITCHES
    );
}

#[test]
fn a_pen_hovers_touches_leans_and_leaves() {
    let mut pen = EvdevPen::of(&intuos()).expect("a pen");
    let hovers = read(
        &mut pen,
        &[
            (3, X, 20_000),
            (3, Y, 4_000),
            (3, DISTANCE, 63),
            (1, PEN, 1),
        ],
    );
    assert_eq!(
        (hovers.presence, hovers.end),
        (Presence::Hovering, End::Tip)
    );
    // 100 mm from the left, 20 mm from the upper edge.
    near(hovers.point_m[0], 0.1);
    near(hovers.point_m[1], 0.128);
    near(hovers.height_m, 0.01);
    let touches = read(
        &mut pen,
        &[
            (1, TOUCH, 1),
            (3, PRESSURE, 8191),
            (3, TILT_X, 57),
            (3, TILT_Y, 57),
        ],
    );
    assert_eq!(touches.presence, Presence::Touching);
    near(touches.pressure, 1.0);
    // A radian to the right, and one toward the hand.
    let [x, y] = touches.tilt_rad.expect("it leans");
    near(x, 1.0);
    near(y, -1.0);
    let pressed = read(&mut pen, &[(1, STYLUS2, 1)]);
    assert_eq!(
        (pressed.switches, pressed.presence),
        (2, Presence::Touching)
    );
    let lifted = read(
        &mut pen,
        &[(1, TOUCH, 0), (1, STYLUS2, 0), (3, PRESSURE, 0)],
    );
    assert_eq!((lifted.switches, lifted.presence), (0, Presence::Hovering));
    assert_eq!(read(&mut pen, &[(1, PEN, 0)]).presence, Presence::Away);
    let turned = read(&mut pen, &[(1, RUBBER, 1)]);
    assert_eq!(
        (turned.presence, turned.end),
        (Presence::Hovering, End::Eraser)
    );
    assert_eq!(
        pen.decode(&frame(&[(4, 4, 0x0D)])),
        None,
        "it says nothing of a pen"
    );
}

#[test]
fn a_rotation_goes_clockwise_from_where_the_switches_point_to_the_right() {
    use std::f64::consts::FRAC_PI_2;
    let mut pen = EvdevPen::of(&intuos()).expect("a pen");
    let mut twist = |value| {
        read(&mut pen, &[(3, Z, value)])
            .twist_rad
            .expect("it turns")
    };
    near(twist(-900), -FRAC_PI_2);
    // Half a turn on, the switches point to the left: a quarter of a turn the other way from the hand's far side.
    assert!((twist(0) - FRAC_PI_2).abs() < 0.01);
    assert!(twist(-800) < -FRAC_PI_2);
}

#[test]
fn what_a_driver_leaves_out_is_taken_for_the_usual() {
    let bare = |change: fn(&mut Capabilities)| {
        let mut capabilities = intuos();
        change(&mut capabilities);
        EvdevPen::of(&capabilities)
    };
    // OpenTabletDriver's axes are those of the screen, 100,000 counts a millimetre: no tablet is that small.
    let screen = bare(|of| {
        (of.axes[0].range, of.axes[0].resolution) = ([0, 200_000], 100_000);
        (of.axes[1].range, of.axes[1].resolution) = ([0, 100_000], 100_000);
    })
    .expect("a pen");
    near(screen.area_m()[0], 0.25);
    near(screen.area_m()[1], 0.125);
    let mut flat = bare(|of| {
        of.axes
            .retain(|axis| ![PRESSURE, TILT_Y, Z, DISTANCE].contains(&axis.code));
        of.keys.retain(|key| *key != STYLUS && *key != STYLUS2);
        (of.axes[0].resolution, of.axes[1].resolution) = (0, 0);
    })
    .expect("a pen");
    assert_eq!(flat.senses(), axes::POSITION | axes::PROXIMITY);
    near(flat.area_m()[0], 0.224);
    let touch = read(&mut flat, &[(1, PEN, 1), (1, TOUCH, 1)]);
    near(touch.pressure, 0.5);
    assert_eq!((touch.tilt_rad, touch.twist_rad), (None, None));
    let mut untouched = bare(|of| of.keys.retain(|key| *key != TOUCH)).expect("a pen");
    let presence = |reading: Reading| reading.presence;
    assert_eq!(
        presence(read(&mut untouched, &[(1, PEN, 1)])),
        Presence::Hovering
    );
    assert_eq!(
        presence(read(&mut untouched, &[(3, PRESSURE, 1)])),
        Presence::Touching
    );
    for broken in [
        bare(|of| of.axes[0].range = [7, 7]),
        bare(|of| of.axes[1].range = [5, -5]),
        bare(|of| of.axes.clear()),
        bare(|of| of.keys = vec![TOUCH, 0x146]),
    ] {
        assert!(broken.is_none());
    }
}

#[test]
fn what_is_no_pen_is_said_to_be_none() {
    let unfit = |bytes: &[u8]| {
        let fault = means(Kind::EventPen, &identity(1, 2, "Thing"), bytes);
        fault.expect_err("refused").why
    };
    let mut still = intuos();
    still.axes[0].range = [3, 3];
    assert_eq!(unfit(&still.to_bytes()), Unfit::NoAxes);
    assert_eq!(unfit(&[0x05, 0x0D]), Unfit::NoEvents);
}

/// A machine in a folder, with event devices as sysfs has them.
struct Machine(tempfile::TempDir);

impl Machine {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    fn ports(&self) -> EventDevices {
        EventDevices {
            sys: self.0.path().to_owned(),
            dev: "/dev".into(),
        }
    }

    fn add(&self, node: &str, name: &str, id: (&str, &str), bits: (&str, &str)) {
        let device = self.0.path().join("class/input").join(node).join("device");
        for (file, text) in [
            ("name", name),
            ("id/bustype", "0003"),
            ("id/vendor", id.0),
            ("id/product", id.1),
            ("capabilities/key", bits.0),
            ("capabilities/abs", bits.1),
        ] {
            let path = device.join(file);
            std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
            std::fs::write(path, format!("{text}\n")).expect("written");
        }
    }
}

#[test]
fn pens_are_known_by_their_bits_which_everybody_may_read() {
    let machine = Machine::new();
    // Bits 0x140 and on are in the sixth word from the right: pen, touch, two switches. Axes 0, 1, 0x18 and on.
    let pen = ("1c01 0 0 0 0 0", "1d000003");
    machine.add("event10", "Wacom Intuos Pro M Pen", ("056a", "0357"), pen);
    machine.add(
        "event2",
        "OpenTabletDriver Virtual Tablet",
        ("4f54", "4444"),
        pen,
    );
    machine.add(
        "event3",
        "Keyboard",
        ("046d", "c31c"),
        ("fffffffffffffffe", "0"),
    );
    machine.add("mouse0", "Wacom Intuos Pro M Pen", ("056a", "0357"), pen);
    let found = machine.ports().list().expect("listed");
    let brief: Vec<_> = found
        .iter()
        .map(|found| {
            (
                found.identity.to_string(),
                found.identity.place.as_str(),
                found.usages.len(),
            )
        })
        .collect();
    assert_eq!(
        brief,
        [
            (
                "4f54:4444 OpenTabletDriver Virtual Tablet".into(),
                "/dev/input/event2",
                1
            ),
            ("046d:c31c Keyboard".into(), "/dev/input/event3", 0),
            (
                "056a:0357 Wacom Intuos Pro M Pen".into(),
                "/dev/input/event10",
                1
            ),
        ]
    );
}

#[test]
fn a_node_that_is_no_event_device_does_not_open() {
    let mut found = Machine::new();
    found.add("event0", "Pen", ("1", "2"), ("1c01 0 0 0 0 0", "1d000003"));
    let mut ports = EventDevices {
        dev: found.0.path().to_owned(),
        ..found.ports()
    };
    let listed = ports.list().expect("listed");
    let fault = ports.open(&listed[0]).err().expect("refused");
    let gone = closed(&listed[0].identity, &ErrorKind::NotFound.into());
    assert_eq!(fault, gone);
    found.0 = {
        let folder = found.0;
        std::fs::create_dir_all(folder.path().join("input")).expect("made");
        std::fs::write(folder.path().join("input/event0"), b"text").expect("written");
        folder
    };
    let fault = ports.open(&listed[0]).err().expect("refused");
    assert_eq!(fault.place, gone.place);
    assert_ne!(fault.what, gone.what);
}

#[test]
fn the_event_devices_of_a_tablet_are_those_below_its_hid_device() {
    let folder = tempfile::tempdir().expect("a folder");
    for path in [
        "hidraw3/device/input/input7/event12",
        "hidraw3/device/input/input8/event9",
        "hidraw3/device/input/input8/mouse1",
        "hidraw3/device/input/input10/event11",
        "hidraw4/device/input/input9/event1",
        "hidraw5/device",
    ] {
        std::fs::create_dir_all(folder.path().join("class/hidraw").join(path)).expect("made");
    }
    // A pen, a mouse, and the keys of the tablet's pad.
    for (input, keys) in [
        ("input7", "1c01 0 0 0 0 0"),
        ("input8", "10000 0 0 0 0"),
        ("input10", "fff 0 0 0 0"),
    ] {
        let path = folder
            .path()
            .join("class/hidraw/hidraw3/device/input")
            .join(input);
        std::fs::create_dir_all(path.join("capabilities")).expect("made");
        std::fs::write(path.join("capabilities/key"), keys).expect("written");
    }
    let nodes = |of: &str| event_nodes(folder.path(), Path::new("/dev"), Path::new(of));
    assert_eq!(
        nodes("/dev/hidraw3"),
        ["/dev/input/event12", "/dev/input/event9"].map(PathBuf::from)
    );
    assert!(nodes("/dev/hidraw5").is_empty() && nodes("/dev/hidraw6").is_empty());
    let (_, fault) = Grab::all(&["/dev/input/event-none".into()]);
    let fault = fault.expect("refused");
    assert_eq!(fault.place.as_deref(), Some("/dev/input/event-none"));
}

proptest! {
    #[test]
    fn whatever_bytes_come_the_reading_is_within_its_bounds(
        frames in prop::collection::vec(prop::collection::vec(any::<u8>(), 0..80), 0..20),
        events in prop::collection::vec((0..4_u16, prop::sample::select(vec![X, Y, Z, PRESSURE, DISTANCE, TILT_X, TILT_Y, PEN, TOUCH]), any::<i32>()), 0..40),
    ) {
        let mut pen = EvdevPen::of(&intuos()).expect("a pen");
        let own = events.iter().map(|event| frame(&[*event]));
        for bytes in frames.into_iter().chain(own) {
            let Some(reading) = pen.decode(&bytes) else {
                continue;
            };
            let [x, y] = reading.point_m;
            prop_assert!((0.0..=0.2241).contains(&x) && (0.0..=0.1481).contains(&y));
            prop_assert!((0.0..=1.0).contains(&reading.pressure));
            prop_assert!((0.0..=0.01).contains(&reading.height_m));
            prop_assert!(reading.tilt_rad.is_some_and(|tilt| tilt.iter().all(|tilt| tilt.abs() < 1.5)));
            prop_assert!(reading.twist_rad.is_some_and(|twist| twist.abs() < 3.15));
        }
    }

    #[test]
    fn capabilities_come_back_from_their_bytes_and_others_are_refused(
        axes in prop::collection::vec((any::<u16>(), any::<[i32; 2]>(), any::<i32>()), 0..10),
        keys in prop::collection::vec(any::<u16>(), 0..10),
        other in prop::collection::vec(any::<u8>(), 0..60),
    ) {
        let axes = axes.into_iter().map(|(code, range, resolution)| Axis { code, range, resolution });
        let made = Capabilities { axes: axes.collect(), keys };
        let bytes = made.to_bytes();
        prop_assert_eq!(Capabilities::from_bytes(&bytes), Some(made));
        prop_assert_eq!(Capabilities::from_bytes(&other), None);
        for end in 0..bytes.len().min(6) {
            prop_assert_eq!(Capabilities::from_bytes(&bytes[..end]), None);
        }
    }
}
