//! Means by which a device is read, and names of those that cannot be.

use std::f64::consts::PI;

use maulstick_device::pen::{End, Presence};
use maulstick_hid::descriptor::{Defect, DescriptorError};
use maulstick_hid::open::{Kind, means};
use maulstick_hid::unfit::Unfit;
use maulstick_hid::wacom::Wacom;

use crate::support::{DESKTOP, DIGITIZER, deco_l, identity, pointer, spacemouse};

#[test]
fn refuses_what_is_no_tablet() {
    for usage in [
        (DESKTOP, 0x02),
        (DESKTOP, 0x06),
        (DIGITIZER, 0x05),
        (DIGITIZER, 0x04),
        (0xFF00, 0x01),
    ] {
        let why = unfit(Kind::Pen, &pointer(usage.0, usage.1).bytes);
        assert_eq!(why, Unfit::NoPen(vec![usage]));
    }
    let pen = unfit(Kind::SpaceMouse, &deco_l().bytes);
    assert!(matches!(pen, Unfit::NoMouse(usages) if usages.contains(&(DIGITIZER, 0x02))));
    let (defect, at) = (Defect::Cut, 2);
    let cut = DescriptorError::Item { defect, at };
    let why = unfit(Kind::Pen, &[0x05, 0x0D, 0x26, 0x01]);
    assert_eq!(why, Unfit::Descriptor(cut));
}

/// The reason why a device is not read.
fn unfit(kind: Kind, descriptor: &[u8]) -> Unfit {
    let identity = identity(0x1234, 0x0001, "Thing");
    let error = means(kind, &identity, descriptor).expect_err("refused");
    assert_eq!(error.identity, identity);
    error.why
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
fn refuses_pens_without_a_place_and_mice_of_unknown_makers() {
    let tip_alone = [
        0x05, 0x0D, 0x09, 2, 0xA1, 1, 0x85, 1, 0x09, 0x42, 0x75, 8, 0x95, 1, 0x81, 2, 0xC0,
    ];
    assert_eq!(unfit(Kind::Pen, &tip_alone), Unfit::NoPlace);
    let mouse = unfit(Kind::SpaceMouse, &spacemouse().bytes);
    assert_eq!(mouse, Unfit::UnknownMaker);
}
