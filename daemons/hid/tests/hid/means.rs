//! Means by which a device is read, and names of those that cannot be.

use std::f64::consts::PI;

use maulstick_device::pen::{End, Presence};
use maulstick_hid::open::{Kind, means};
use maulstick_hid::wacom::Wacom;

use crate::support::{DESKTOP, DIGITIZER, Descriptor, deco_l, identity, pointer, spacemouse};

#[test]
fn what_is_no_tablet_says_what_it_is() {
    let told = |descriptor: &Descriptor, kind| {
        let identity = identity(0x1234, 0x0001, "Thing");
        means(kind, &identity, &descriptor.bytes)
            .expect_err("refused")
            .to_string()
    };
    for (page, usage, word) in [
        (DESKTOP, 0x02, "a mouse"),
        (DESKTOP, 0x06, "a keyboard"),
        (DIGITIZER, 0x05, "a touch pad"),
        (DIGITIZER, 0x04, "a touch screen"),
        (0xFF00, 0x01, "a format of its maker's own"),
    ] {
        let fault = told(&pointer(page, usage), Kind::Pen);
        assert!(
            fault.contains(word) && fault.contains("1234:0001 Thing"),
            "{fault}"
        );
        assert!(fault.contains("help:"), "{fault}");
    }
    assert!(told(&deco_l(), Kind::SpaceMouse).contains("is a pen, no 6-DOF mouse"));
    let mut cut = Descriptor::default();
    cut.bytes = vec![0x05, 0x0D, 0x26, 0x01];
    let fault = told(&cut, Kind::Pen);
    assert!(fault.contains("describes itself wrongly: an item is cut off at byte 2"));
    assert!(fault.contains("evdev"), "{fault}");
}

#[test]
fn intuos_of_wacoms_tables_are_read_by_them() {
    let mut pro2 = Wacom::of(0x056A, 0x0357).expect("known");
    let mut report = vec![0_u8; 20];
    report[..12].copy_from_slice(&[0x10, 0x23, 0x80, 0x57, 0, 0xA0, 0x73, 0, 0xFF, 0x1F, 30, 60]);
    let reading = pro2.decode(&report).expect("a pen's");
    assert_eq!(
        (reading.presence, reading.switches),
        (Presence::Touching, 1)
    );
    assert!((reading.point_m[0] - 0.112).abs() < 1e-12, "{reading:?}");
    assert!(reading.point_m[1].abs() < 1e-12 && (reading.pressure - 1.0).abs() < 1e-12);
    let tilt = reading.tilt_rad.expect("tilts");
    assert!((tilt[0] - PI / 6.0).abs() < 1e-12 && (tilt[1] + PI / 3.0).abs() < 1e-12);
    report[1] = 0x30;
    let eraser = pro2.decode(&report).expect("a pen's");
    assert_eq!(
        (eraser.presence, eraser.end),
        (Presence::Hovering, End::Eraser)
    );
    report[1] = 0;
    assert_eq!(
        pro2.decode(&report).expect("a pen's").presence,
        Presence::Away
    );

    let mut pro1 = Wacom::of(0x056A, 0x0315).expect("known");
    // An eraser (tool 0x80A) comes near, touches with 2047 of 2047, and goes.
    assert_eq!(pro1.decode(&[2, 0xC2, 0x80, 0xA0, 0, 0, 0, 0, 0, 0]), None);
    let touch = [2, 0xE3, 0x57, 0x50, 0x36, 0x92, 0xFF, 0xC0 | 0x20, 0x40, 0];
    let mut late = Wacom::of(0x056A, 0x0315).expect("known");
    assert_eq!(late.decode(&touch), None, "which end it is is not known");
    let reading = pro1.decode(&touch).expect("a pen's");
    assert_eq!(
        (reading.presence, reading.end),
        (Presence::Touching, End::Eraser)
    );
    assert_eq!(reading.switches, 1);
    assert!(
        (reading.pressure - 1.0).abs() < 1e-12,
        "{}",
        reading.pressure
    );
    assert!((reading.point_m[0] - 0.223_52).abs() < 1e-12, "{reading:?}");
    assert!(reading.point_m[1].abs() < 1e-12, "{reading:?}");
    let tilt = reading.tilt_rad.expect("tilts");
    assert!(tilt[0].abs() < 1e-12 && tilt[1].abs() < 1e-12, "{tilt:?}");
    // Gone, or about to go.
    for flags in [0x20, 0x21, 0x80] {
        let gone = pro1.decode(&[2, flags, 0, 0, 0, 0, 0, 0, 0, 0]);
        assert_eq!(gone.expect("a pen's").presence, Presence::Away, "{flags:x}");
    }
    assert!(Wacom::of(0x1234, 0x0315).is_none());
}

#[test]
fn a_wacom_of_the_tables_needs_no_pen_in_its_descriptor() {
    // An interface of the maker's own format with one report of so many bytes after its number.
    let interface = |id: u8, bytes: u8| {
        let head = [0x06, 0x00, 0xFF, 0x09, 1, 0xA1, 1, 0x85, id, 0x09, 1];
        [&head[..], &[0x75, 8, 0x95, bytes, 0x81, 2, 0xC0]].concat()
    };
    for (product, id, bytes, fits) in [
        (0x0357, 0x10, 26, true),
        (0x0357, 0x11, 26, false),
        (0x0315, 2, 9, true),
        // The touch of an Intuos 5.
        (0x0315, 2, 63, false),
        (0x0315, 3, 9, false),
    ] {
        let identity = identity(0x056A, product, "Intuos");
        let means = means(Kind::Pen, &identity, &interface(id, bytes));
        assert_eq!(means.is_ok(), fits, "{product:x} {id} {bytes}: {means:?}");
    }
}

#[test]
fn a_pen_without_a_place_and_a_mouse_of_another_maker_are_called_that() {
    let told = |kind, descriptor: &[u8]| {
        let identity = identity(0x1234, 0x0001, "Thing");
        means(kind, &identity, descriptor)
            .expect_err("refused")
            .what
    };
    let tip_alone = [
        0x05, 0x0D, 0x09, 2, 0xA1, 1, 0x85, 1, 0x09, 0x42, 0x75, 8, 0x95, 1, 0x81, 2, 0xC0,
    ];
    let pen = told(Kind::Pen, &tip_alone);
    assert!(
        pen.contains("a pen whose reports do not say where"),
        "{pen}"
    );
    let mouse = told(Kind::SpaceMouse, &spacemouse().bytes);
    assert!(mouse.contains("6-DOF mouse of an unknown maker"), "{mouse}");
}
