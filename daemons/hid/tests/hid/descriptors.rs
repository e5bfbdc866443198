//! Descriptors as real devices have them: with thousands of fields of their makers', ranges that were forgotten, and reports
//! that are shorter than described.

use std::f64::consts::PI;

use maulstick_device::pen::Reading;
use maulstick_hid::descriptor;
use maulstick_hid::layout::Layout;
use maulstick_hid::open::{Kind, means};

use crate::support::{DESKTOP, DIGITIZER, Descriptor, deco_l, identity};

/// A pen whose angles stand behind a physical range and a unit of X and Y; `reset` takes both back.
fn leaning(range: [i64; 2], unit: i64, reset: bool, angles: &[(u16, [i64; 2])]) -> Descriptor {
    let mut all = Descriptor::default();
    all.page(DIGITIZER).usage(0x02).begin(1).report(7);
    all.range(0, 1).usage(0x42).usage(0x32).input(1).pad(6);
    all.page(DESKTOP).usage(0x30).usage(0x31).range(0, 32_767);
    all.physical(range, unit, 0x0D).input(16);
    all.page(DIGITIZER).usage(0x30).range(0, 8191).input(16);
    if reset {
        all.physical([0, 0], 0, 0);
    }
    for (usage, [least, most]) in angles {
        all.usage(*usage).range(*least, *most).input(16);
    }
    all.end();
    all
}

fn read(tablet: &Descriptor, values: &[(u16, i64)]) -> Reading {
    let layout = Layout::of(&descriptor::read(&tablet.bytes).expect("sound")).expect("a pen");
    let values: Vec<_> = values
        .iter()
        .map(|(usage, value)| ((DIGITIZER, *usage), *value))
        .collect();
    layout.decode(&tablet.pack(7, &values)).expect("a pen's")
}

#[test]
fn an_angle_is_not_read_by_the_range_of_a_length() {
    let near = |got: f64, degrees: f64| (got - degrees.to_radians()).abs() < 1e-9;
    let tilts = [
        (0x3D, [-127, 127]),
        (0x3E, [-127, 127]),
        (0x41, [-180, 180]),
    ];
    let leans = [(0x3F, [-180, 180]), (0x40, [-90, 90])];
    let cubic_inch = 0x33;
    for (range, unit) in [
        ([0, 2048], cubic_inch),
        ([0, 21_600], 0x11),
        ([0, 2048], 0x13),
        ([0, 2048], 0),
        ([-100, 100], 0x11),
        ([0, 2048], 0x14),
    ] {
        for reset in [false, true] {
            let tablet = leaning(range, unit, reset, &tilts);
            let reading = read(&tablet, &[(0x3D, 60), (0x3E, -30), (0x41, 45)]);
            let [x, y] = reading.tilt_rad.expect("tilts");
            let twist = reading.twist_rad.expect("a twist");
            let right = near(x, 60.0) && near(y, 30.0) && near(twist, -45.0);
            assert!(right, "{range:?} {unit:x} {reset}: {x} {y} {twist}");
            let tablet = leaning(range, unit, reset, &leans);
            let [x, y] = read(&tablet, &[(0x3F, 90), (0x40, 45)])
                .tilt_rad
                .expect("tilts");
            assert!(
                near(x, 0.0) && near(y, 45.0),
                "{range:?} {unit:x} {reset}: {x} {y}"
            );
        }
    }
}

#[test]
fn a_unit_of_angle_counts_where_its_range_is_one() {
    let tilt = |range: [i64; 2], unit: i64, exponent: u8| {
        let mut tablet = Descriptor::default();
        tablet.page(DIGITIZER).usage(0x02).begin(1).report(7);
        tablet.range(0, 1).usage(0x42).usage(0x32).input(1).pad(6);
        tablet.page(DESKTOP).usage(0x30).usage(0x31);
        tablet.range(0, 32_767).input(16);
        tablet.page(DIGITIZER).usage(0x3D).usage(0x3E);
        tablet.range(-100, 100).physical(range, unit, exponent);
        tablet.input(8).end();
        read(&tablet, &[(0x3D, 50)]).tilt_rad.expect("tilts")[0]
    };
    for (range, unit, exponent, wanted) in [
        ([-60, 60], 0x14, 0, PI / 6.0),
        ([-6000, 6000], 0x14, 0x0E, PI / 6.0),
        ([-1000, 1000], 0x12, 0x0D, 0.5),
        ([-60, 60], 0, 0, PI / 6.0),
        // The exponent is a length's.
        ([-60, 60], 0x14, 0x0D, PI / 6.0),
        ([0, 0], 0, 0, 50_f64.to_radians()),
    ] {
        let got = tilt(range, unit, exponent);
        assert!(
            (got - wanted).abs() < 1e-9,
            "{range:?} {unit:x} {exponent}: {got}"
        );
    }
}

#[test]
fn a_height_is_not_read_by_the_range_of_the_tablet() {
    let mut tablet = Descriptor::default();
    tablet.page(DIGITIZER).usage(0x02).begin(1).report(7);
    tablet.range(0, 1).usage(0x42).usage(0x32).input(1).pad(6);
    tablet
        .page(DESKTOP)
        .usage(0x30)
        .usage(0x31)
        .range(0, 21_600);
    tablet.physical([0, 21_600], 0x11, 0x0D).input(16);
    tablet.usage(0x32).range(0, 255).input(8).end();
    // HID's Z points down.
    let highest = read(&tablet, &[]).height_m;
    assert!((highest - 0.01).abs() < 1e-12, "{highest}");
}

/// A report of a maker's own behind a pen: its page, its head, and how many fields of a byte.
fn blob(page: u16, head: u8, count: u16) -> Vec<u8> {
    let ([low, high], [few, many]) = (page.to_le_bytes(), count.to_le_bytes());
    vec![
        0x06, low, high, 0x09, 1, 0xA1, 1, 0x85, 9, 0x15, 0, 0x26, 0xFF, 0, 0x75, 8, 0x96, few,
        many, 0x09, 2, head, 2, 0xC0,
    ]
}

#[test]
fn what_is_not_read_does_not_count() {
    let identity = identity(0x1234, 0x5678, "Pen");
    let reads = |tail: &[u8]| {
        let mut tablet = deco_l();
        let report = tablet.pack(2, &[((DESKTOP, 0x30), 25_400)]);
        tablet.bytes.extend(tail);
        let found = means(Kind::Pen, &identity, &tablet.bytes);
        let Ok(maulstick_hid::open::Means::Pen(mut pen)) = found else {
            panic!("{found:?}");
        };
        let reading = pen.decode(&report).expect("a pen's");
        assert!((reading.point_m[0] - 0.127).abs() < 1e-9, "{reading:?}");
    };
    // Inputs, outputs and features of 40,000 fields, on pages of makers and of lamps.
    for head in [0x81, 0x91, 0xB1] {
        for page in [0xFF00, 0xFF0B, 0x01FF, 0x59] {
            reads(&blob(page, head, 40_000).repeat(3));
        }
    }
    // A keypad whose keys have no usages.
    reads(&[
        0x05, 0x01, 0x09, 0x07, 0xA1, 1, 0x85, 6, 0x15, 0, 0x25, 1, 0x75, 1, 0x95, 8, 0x81, 2, 0xC0,
    ]);
    // As many on a pen's page are a fault.
    let mut tablet = deco_l();
    tablet.bytes.extend(blob(DIGITIZER, 0x81, 40_000));
    assert!(means(Kind::Pen, &identity, &tablet.bytes).is_err());
}

#[test]
fn a_report_without_the_tail_of_its_description_is_read() {
    let mut tablet = deco_l();
    let whole = tablet.pack(2, &[((DESKTOP, 0x30), 25_400), ((DIGITIZER, 0x3D), 30)]);
    // Bytes of the maker's own behind the tilts, within the pen's collections.
    tablet.bytes.truncate(tablet.bytes.len() - 2);
    tablet.bytes.extend([
        0x06, 0x00, 0xFF, 0x09, 1, 0x15, 0, 0x26, 0xFF, 0, 0x75, 8, 0x95, 4, 0x81, 2, 0xC0, 0xC0,
    ]);
    let layout = Layout::of(&descriptor::read(&tablet.bytes).expect("sound")).expect("a pen");
    let read = layout.decode(&whole).expect("a pen's");
    let tilt = read.tilt_rad.expect("tilts");
    assert!((read.point_m[0] - 0.127).abs() < 1e-9 && (tilt[0] - PI / 6.0).abs() < 1e-9);
}
