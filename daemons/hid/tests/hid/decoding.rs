//! Reports of tablets, packed by their descriptors.

use std::f64::consts::PI;

use maulstick_device::pen::{End, Presence, Reading};
use maulstick_hid::descriptor::{self, Defect, DescriptorError};
use maulstick_hid::layout::Layout;
use maulstick_hid::tablet::Tablet;
use maulstick_hid::wacom::Wacom;
use maulstick_rig::config::{CanvasSection, DeviceSection};
use maulstick_types::stylus::axes;
use proptest::prelude::*;

use crate::support::{
    DESKTOP, DIGITIZER, Descriptor, WACOM, azimuths, deco_l, intuos_pro, intuos_s, pointer,
};

/// A range of 130,000 usages that is kept by Push, spent, and taken back for a collection of 8000 fields.
const KEPT_LOCALS: [u8; 28] = [
    0x05, 0x0D, 0x75, 0x01, 0x95, 0x01, 0x19, 0x00, 0x2B, 0xCF, 0xFB, 0x01, 0x00, 0xA4, 0x81, 0x00,
    0xB4, 0xA4, 0xA1, 0x01, 0x96, 0x40, 0x1F, 0x09, 0x30, 0x81, 0x02, 0xC0,
];

fn layout(descriptor: &Descriptor) -> Layout {
    let read = descriptor::read(&descriptor.bytes).expect("a descriptor");
    Layout::of(&read).expect("a pen")
}

/// Expected reading of a report, from the values that were packed, by the words of the specification.
struct Wanted {
    presence: Presence,
    end: End,
    point_m: [f64; 2],
    pressure: f64,
    tilt_rad: Option<[f64; 2]>,
    twist_rad: Option<f64>,
    switches: u32,
}

fn wanted(which: usize, values: &[((u16, u16), i64)]) -> Wanted {
    let get = |usage: (u16, u16)| {
        let found = values.iter().find(|(known, _)| *known == usage);
        found.map(|(_, value)| *value as f64)
    };
    let page = if which < 2 { WACOM } else { DIGITIZER };
    let dig = |usage| get((page, usage));
    let on = |usage| dig(usage) == Some(1.0);
    let (area, counts) = [
        ([0.263, 0.148], [52_600.0, 29_600.0]),
        ([0.152, 0.095], [15_200.0, 9500.0]),
        ([0.254, 0.1524], [50_800.0, 30_480.0]),
    ][which];
    let x = get((WACOM, 0x130)).or(get((DESKTOP, 0x30))).expect("x");
    let y = get((WACOM, 0x131)).or(get((DESKTOP, 0x31))).expect("y");
    let most = [8191.0, 4095.0, 8191.0][which];
    let touches = on(0x42) || on(0x45);
    let second = if which == 2 { on(0x46) } else { on(0x5A) };
    let lean = |usage: u16, sign: f64| {
        dig(usage).map(|degrees| sign * degrees.clamp(-85.0, 85.0).to_radians())
    };
    Wanted {
        presence: match (touches, on(0x32)) {
            (true, _) => Presence::Touching,
            (false, true) => Presence::Hovering,
            (false, false) => Presence::Away,
        },
        end: if on(0x3C) || on(0x45) {
            End::Eraser
        } else {
            End::Tip
        },
        point_m: [x / counts[0] * area[0], (1.0 - y / counts[1]) * area[1]],
        pressure: dig(0x30).expect("pressure") / most,
        tilt_rad: lean(0x3D, 1.0).zip(lean(0x3E, -1.0)).map(|(x, y)| [x, y]),
        // -900..899 stands for -180..179 degrees, clockwise.
        twist_rad: dig(0x41).map(|count| -(-180.0 + (count + 900.0) * 359.0 / 1799.0).to_radians()),
        switches: u32::from(on(0x44)) | u32::from(second) << 1,
    }
}

/// The largest difference, none where what is no number differs.
fn off(got: &Reading, wanted: &Wanted) -> Option<f64> {
    let exact = (got.presence, got.end, got.switches)
        == (wanted.presence, wanted.end, wanted.switches)
        && got.tilt_rad.is_some() == wanted.tilt_rad.is_some()
        && got.twist_rad.is_some() == wanted.twist_rad.is_some();
    let tilt = |tilt: Option<[f64; 2]>| tilt.unwrap_or_default();
    // −π and π are one angle.
    let turn = (got.twist_rad.unwrap_or(0.0) - wanted.twist_rad.unwrap_or(0.0)).abs();
    let pairs = [
        (got.point_m[0], wanted.point_m[0]),
        (got.point_m[1], wanted.point_m[1]),
        (got.pressure, wanted.pressure),
        (tilt(got.tilt_rad)[0], tilt(wanted.tilt_rad)[0]),
        (tilt(got.tilt_rad)[1], tilt(wanted.tilt_rad)[1]),
        (turn.min((turn - 2.0 * PI).abs()), 0.0),
    ];
    let most = pairs
        .iter()
        .map(|(got, wanted)| (got - wanted).abs())
        .fold(0.0, f64::max);
    exact.then_some(most)
}

fn tablets() -> [(Descriptor, u8); 3] {
    [(intuos_pro(), 30), (intuos_s(), 16), (deco_l(), 2)]
}

fn values(of: &Descriptor, report: u8, shares: &[f64]) -> Vec<((u16, u16), i64)> {
    let fields = of.of(report).into_iter().zip(shares.iter().cycle());
    fields
        .map(|(field, share)| {
            let [least, most] = field.range;
            (
                field.usage,
                least + (share * (most - least) as f64).round() as i64,
            )
        })
        .collect()
}

proptest! {
    #[test]
    fn what_a_tablet_packs_is_what_is_read(
        which in 0..3_usize,
        shares in prop::collection::vec(0.0..=1.0_f64, 20),
        beyond in prop::collection::vec(any::<u8>(), 0..8),
    ) {
        let (tablet, report) = &tablets()[which];
        let values = values(tablet, *report, &shares);
        let mut bytes = tablet.pack(*report, &values);
        // A longer report than described has the same at its beginning.
        bytes.extend(beyond);
        let got = layout(tablet).decode(&bytes).expect("a pen's");
        let off = off(&got, &wanted(which, &values));
        prop_assert!(off.is_some_and(|off| off < 1e-9), "{off:?} {got:?} {values:?}");
    }

    #[test]
    fn no_bytes_make_a_descriptor_panic(
        start in 0..24_usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        bytes in prop::collection::vec(any::<u8>(), 0..48),
        report in prop::collection::vec(any::<u8>(), 0..24),
    ) {
        thread_local!(static STARTS: Vec<Vec<u8>> = {
            let all = [azimuths(), pointer(DIGITIZER, 2), deco_l(), intuos_s(), intuos_pro()];
            let all = all.into_iter().map(|descriptor| descriptor.bytes);
            all.chain([KEPT_LOCALS.to_vec()]).collect()
        });
        // Long descriptors take long, and most bytes are none.
        let at = [0, 0, 0, 1, 1, 2, 3, 4, 5, 5, 5].get(start);
        let mut text = at.map_or(bytes, |at| STARTS.with(|starts| starts[*at].clone()));
        for (at, byte) in &changes {
            if !text.is_empty() {
                let at = at.index(text.len());
                text[at] = *byte;
            }
        }
        if let Some(layout) = descriptor::read(&text).ok().and_then(|read| Layout::of(&read)) {
            check(&layout, &report);
            let mut first = report;
            first.splice(..first.len().min(1), [1]);
            check(&layout, &first);
        }
    }

    #[test]
    fn no_bytes_make_a_report_panic(
        which in 0..3_usize,
        reports in prop::collection::vec(prop::collection::vec(any::<u8>(), 0..40), 1..8),
        // What Intuos 4 says of a pen that comes near, is there, and goes.
        flags in prop::collection::vec(
            prop::option::of(prop::sample::select(vec![0xC2_u8, 0xA0, 0xA1, 0x20, 0x80])), 8,
        ),
        product in prop::sample::select(vec![0x0357_u16, 0x0317]),
    ) {
        let report = &reports[0];
        thread_local!(static LAYOUTS: [(Layout, u8); 3] = tablets().map(|(tablet, id)| (layout(&tablet), id)));
        LAYOUTS.with(|layouts| {
            let (layout, id) = &layouts[which];
            check(layout, report);
            let mut numbered = report.clone();
            if let Some(first) = numbered.first_mut() {
                *first = *id;
            }
            check(layout, &numbered);
        });
        // What a table's tablet says hangs on what it said before.
        let mut table = Wacom::of(0x056A, product).expect("known");
        for (report, flags) in reports.iter().zip(flags) {
            let mut numbered = report.clone();
            if let Some(first) = numbered.first_mut() {
                *first = if product == 0x0357 { 0x10 } else { 2 };
            }
            if let (Some(second), Some(flags)) = (numbered.get_mut(1), flags) {
                *second = flags;
            }
            if let Some(reading) = table.decode(&numbered) {
                fits(&reading, table.area_m(), table.senses());
            }
        }
    }
}

/// Whatever was read, the sample that follows from it is in range.
fn check(layout: &Layout, report: &[u8]) {
    if let Some(reading) = layout.decode(report) {
        fits(&reading, layout.area_m(), layout.senses());
    }
}

fn fits(reading: &Reading, area_m: [f64; 2], senses: u32) {
    let device = DeviceSection::new("pen", "pen", "main");
    let tablet = Tablet::fit(area_m, senses, &device, &CanvasSection::default()).expect("fitted");
    let sample = tablet.sample(reading);
    assert_eq!(sample.fault(), None, "{reading:?} {area_m:?}");
}

#[test]
fn the_comparison_finds_a_field_that_is_one_bit_off() {
    for (which, (tablet, report)) in tablets().into_iter().enumerate() {
        for field in tablet.of(report) {
            let mut values = values(&tablet, report, &[0.25]);
            let sound = wanted(which, &values);
            let serials = matches!(
                field.usage,
                (WACOM, 0x5B | 0x5C | 0x77 | 0x132 | 0x36 | 0xD03)
            );
            for (usage, value) in &mut values {
                if *usage == field.usage {
                    *value += 1;
                }
            }
            let got = layout(&tablet)
                .decode(&tablet.pack(report, &values))
                .expect("a pen's");
            let finds = off(&got, &sound).is_none_or(|off| off > 1e-9);
            assert_eq!(finds, !serials, "{field:?}");
        }
    }
}

#[test]
fn wacoms_own_page_is_read_and_the_standard_one_beside_it_is_not() {
    let tablet = intuos_pro();
    let layout = layout(&tablet);
    let standard = tablet.pack(6, &[((DIGITIZER, 0x32), 1), ((DESKTOP, 0x30), 13_150)]);
    assert_eq!(layout.decode(&standard), None);
    let own = tablet.pack(30, &[((WACOM, 0x32), 1), ((WACOM, 0x130), 26_300)]);
    let middle = layout.decode(&own).expect("a pen's").point_m[0];
    assert!((middle - 0.1315).abs() < 1e-12, "{middle}");
    assert_ne!(layout.senses() & axes::TWIST, 0);
}

#[test]
fn a_tablet_of_the_standard_page_alone_is_read_by_it() {
    let mut tablet = intuos_pro();
    // Nothing of the second collection.
    let cut = tablet
        .bytes
        .windows(3)
        .position(|three| three == [0x06, 0x0D, 0xFF]);
    tablet.bytes.truncate(cut.expect("Wacom's page"));
    let report = tablet.pack(
        6,
        &[
            ((DIGITIZER, 0x32), 1),
            ((DIGITIZER, 0x3C), 1),
            ((DESKTOP, 0x30), 26_300),
            ((DIGITIZER, 0x3D), 3000),
            ((DIGITIZER, 0x3E), 6000),
        ],
    );
    let reading = layout(&tablet).decode(&report).expect("a pen's");
    assert_eq!(
        (reading.presence, reading.end),
        (Presence::Hovering, End::Eraser)
    );
    let tilt = reading.tilt_rad.expect("tilts");
    assert!((reading.point_m[0] - 0.263).abs() < 1e-12);
    assert!(
        (reading.point_m[1] - 0.148).abs() < 1e-12,
        "y counts toward the hand"
    );
    assert!(
        (tilt[0] - PI / 6.0).abs() < 1e-12 && (tilt[1] + PI / 3.0).abs() < 1e-12,
        "{tilt:?}"
    );
    // Z of HID points down: 0 is the highest.
    assert!(
        (reading.height_m - 0.01).abs() < 1e-12,
        "{}",
        reading.height_m
    );
}

#[test]
fn azimuth_and_altitude_are_tilts_too() {
    let tablet = azimuths();
    let layout = layout(&tablet);
    // 40,000 counts of 5080 an inch.
    assert!((layout.area_m()[0] - 0.2).abs() < 1e-12 && (layout.area_m()[1] - 0.1).abs() < 1e-12);
    for (azimuth, altitude, wanted) in [
        (0, 600, [PI / 6.0, 0.0]),
        (900, 600, [0.0, PI / 6.0]),
        (1800, 450, [-PI / 4.0, 0.0]),
        (2700, 900, [0.0, 0.0]),
    ] {
        let values = [
            ((DIGITIZER, 0x32), 1),
            ((DIGITIZER, 0x3F), azimuth),
            ((DIGITIZER, 0x40), altitude),
            ((DIGITIZER, 0x41), 250),
        ];
        let got = layout.decode(&tablet.pack(1, &values)).expect("a pen's");
        let tilt = got.tilt_rad.expect("tilts");
        let off = (tilt[0] - wanted[0]).abs().max((tilt[1] - wanted[1]).abs());
        assert!(off < 1e-9, "{azimuth} {altitude}: {tilt:?} {wanted:?}");
        // A quarter of once round, clockwise.
        let twist = got.twist_rad.expect("a twist");
        assert!((twist + PI / 2.0).abs() < 1e-12, "{twist}");
    }
}

#[test]
fn a_greatest_value_without_room_for_a_sign_is_read_all_the_same() {
    let mut tablet = Descriptor::default();
    tablet
        .page(DIGITIZER)
        .usage(0x02)
        .begin(1)
        .report(1)
        .range(0, 1);
    tablet.usage(0x42).usage(0x32).input(1).pad(6);
    tablet.page(DESKTOP).usage(0x30).unsigned(0x24, 50_800);
    tablet
        .physical([0, 0], 0x11, 0x0D)
        .unsigned(0x44, 50_800)
        .input(16);
    tablet.usage(0x31).unsigned(0x24, 0xFFFF);
    tablet.physical([0, 25_000], 0x11, 0x0D).input(16);
    tablet
        .page(DIGITIZER)
        .usage(0x30)
        .range(0, -1)
        .input(8)
        .end();
    let layout = layout(&tablet);
    let [width, height] = layout.area_m();
    assert!(
        (width - 0.508).abs() < 1e-12 && (height - 0.25).abs() < 1e-12,
        "{width} {height}"
    );
    let values = [
        ((DIGITIZER, 0x42), 1),
        ((DESKTOP, 0x30), 40_640),
        ((DIGITIZER, 0x30), 0xFF),
    ];
    let reading = layout.decode(&tablet.pack(1, &values)).expect("a pen's");
    assert!(
        (reading.point_m[0] - 0.8 * 0.508).abs() < 1e-12,
        "{reading:?}"
    );
    assert!((reading.pressure - 1.0).abs() < 1e-12, "{reading:?}");
}

#[test]
fn a_report_is_read_from_where_it_has_the_pen_and_another_s_is_none() {
    for (tablet, report) in tablets() {
        let layout = layout(&tablet);
        let values: Vec<_> = values(&tablet, report, &[0.75]);
        let whole = tablet.pack(report, &values);
        let wanted = layout.decode(&whole).expect("a pen's");
        // Tilts, twist, height and serial numbers may be left off.
        let needed = tablet.of(report).into_iter().filter(|field| {
            matches!(
                field.usage.1,
                0x30 | 0x31 | 0x32 | 0x3C | 0x42 | 0x45 | 0x130 | 0x131
            )
        });
        let needed = needed
            .map(|field| (field.bit + field.bits).div_ceil(8))
            .max();
        let needed = needed.expect("a pen");
        for length in 0..whole.len() {
            let read = layout.decode(&whole[..length]);
            assert_eq!(read.is_some(), length >= needed, "{length} of {needed}");
            if let Some(read) = read {
                assert_eq!(
                    (read.point_m, read.pressure, read.presence, read.end),
                    (wanted.point_m, wanted.pressure, wanted.presence, wanted.end)
                );
                assert!(read.tilt_rad.is_none() || read.tilt_rad == wanted.tilt_rad);
            }
        }
        let mut other = whole;
        other[0] = 99;
        assert_eq!(layout.decode(&other), None);
    }
}

#[test]
fn a_descriptor_that_asks_for_too_much_is_refused_before_it_is_read() {
    let defect = |bytes: &[u8]| match descriptor::read(bytes).map(drop) {
        Err(DescriptorError::Item { defect, .. }) => defect,
        other => panic!("{other:?}"),
    };
    let with = |tail: &[u8]| defect(&[&[0x05, 0x0D], tail].concat());
    // A billion fields; a billion usages; a usage before any page; globals that were never saved.
    let fields = [0x09, 1, 0x75, 1, 0x97, 0, 0, 0, 0x40, 0x81, 2];
    assert_eq!(with(&fields), Defect::Long);
    let usages = [0x19, 0, 0x2B, 0, 0, 0, 0x40, 0x75, 1, 0x95, 1, 0x81, 2];
    assert_eq!(with(&usages), Defect::Greedy);
    assert_eq!(with(&[0xB4]), Defect::NotSaved);
    assert_eq!(defect(&[0x09, 1, 0xA1, 1]), Defect::NoPage);
    let deep: Vec<u8> = [0x09, 1, 0xA1, 1].repeat(13);
    assert_eq!(with(&deep), Defect::Greedy);
    // Push keeps no usages, so the collection has none.
    assert!(descriptor::read(&KEPT_LOCALS).is_ok());
}
