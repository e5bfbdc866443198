//! Recordings as text, and those of pens among the inputs that failed, as `tests/cases/README.md` lists them.

use maulstick_device::pen::{Presence, Reading};
use maulstick_hid::open::{Kind, Means, means};
use maulstick_hid::recorder::Recorder;
use maulstick_hid::recording::{
    Event, LONGEST_REPORT, LineFault, Recorded, RecordingError, parse, read,
};
use proptest::prelude::*;

use crate::support::{deco_l, identity};

fn text(devices: &[Recorded]) -> String {
    let mut text = String::from("# a recording\n");
    for (number, device) in (0..).zip(devices) {
        text += &device.heading(number);
        for event in &device.events {
            text += &event.line();
        }
    }
    text
}

fn device() -> impl Strategy<Value = Recorded> {
    let event = (0..100_000_u64, prop::collection::vec(any::<u8>(), 1..20));
    let numbers = (any::<u16>(), any::<u16>(), "[A-Za-z ]{0,12}");
    (
        prop::collection::vec(any::<u8>(), 1..60),
        prop::collection::vec(event, 0..12),
        numbers,
    )
        .prop_map(|(descriptor, events, (vendor, product, name))| {
            let mut time_ns = 0;
            let events = events.into_iter().map(|(micros, report)| {
                time_ns += micros * 1000;
                Event { time_ns, report }
            });
            Recorded {
                identity: identity(vendor, product, name.trim()),
                descriptor,
                events: events.collect(),
            }
        })
}

proptest! {
    #[test]
    fn what_is_written_is_read_again(devices in prop::collection::vec(device(), 1..4)) {
        prop_assert_eq!(parse(&text(&devices)), Ok(devices));
    }

    #[test]
    fn no_mutation_of_a_recording_makes_the_reader_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..8),
        cut in any::<prop::sample::Index>(),
    ) {
        const WHOLE: &str = "D: 0\nR: 3 05 0d 09\nN: a pen\nP: usb\nI: 3 056a 0357\n\
                             E: 000000.004000 2 06 20\n# c\nD: 1\nR: 1 06\nE: 000001.500000 1 ff\n";
        let mut bytes = WHOLE.as_bytes().to_vec();
        for (at, byte) in &changes {
            let at = at.index(bytes.len());
            bytes[at] = *byte;
        }
        bytes.truncate(cut.index(bytes.len()) + 1);
        match parse(&String::from_utf8_lossy(&bytes)) {
            Ok(devices) => for device in devices {
                prop_assert!((1..=4096).contains(&device.descriptor.len()));
                let times: Vec<_> = device.events.iter().map(|event| event.time_ns).collect();
                prop_assert!(times.is_sorted() && times.iter().all(|at| *at <= 100_001_000_000_000));
            },
            Err(error) => prop_assert!(error.line >= 1),
        }
    }
}

#[test]
fn a_wrong_line_is_named_by_its_number() {
    let sound = "# two devices\nD: 0\nR: 2 05 0d\nI: 3 056a 0357\nE: 000000.000000 1 07\n";
    let wrong = |line: &str| parse(&format!("{sound}{line}\n")).expect_err("wrong");
    for (line, fault) in [
        ("hello", LineFault::Line("hello".into())),
        ("X: 1", LineFault::Kind("X".into())),
        ("E: 1 2 3", LineFault::Time("1".into())),
        ("E: 1.5 1 ff", LineFault::Time("1.5".into())),
        (
            "E: 000001.000000 3 01 02",
            LineFault::Bytes {
                announced: 3,
                found: 2,
            },
        ),
        ("E: 000001.000000 1 0g", LineFault::Byte("0g".into())),
        ("E: 000001.000000 x", LineFault::Count(LONGEST_REPORT)),
        ("I: 3 056a", LineFault::Identity("3 056a".into())),
        ("R: 1 05", LineFault::TwoDescriptors),
        ("D: one", LineFault::Device("one".into())),
    ] {
        assert_eq!(wrong(line), RecordingError { line: 6, fault }, "{line}");
    }
    let late = wrong("E: 000002.000000 1 07\nE: 000001.000000 1 07");
    assert_eq!((late.line, late.fault), (7, LineFault::Older));
    let fault = |text: &str| parse(text).expect_err("refused").fault;
    assert_eq!(fault(""), LineFault::NoDevice);
    assert_eq!(fault("N: a pen\n"), LineFault::NoDescriptor(0));
}

#[test]
fn reports_of_several_devices_may_alternate() {
    let text = "D: 0\nR: 1 05\nD: 1\nR: 1 06\nE: 0.000001 1 aa\nD: 0\nE: 0.000002 1 bb\n";
    let devices = parse(text).expect("sound");
    let reports: Vec<_> = devices
        .iter()
        .map(|device| device.events[0].report[0])
        .collect();
    assert_eq!(reports, [0xBB, 0xAA]);
}

#[test]
fn a_recorder_s_file_is_there_once_it_is_whole_and_is_what_was_heard() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("pen.hid");
    let tablet = deco_l();
    let identity = identity(0x28BD, 0x0935, "Deco L");
    let event = |time_ns, byte| Event {
        time_ns,
        report: vec![2, byte],
    };
    let mut recorder = Recorder::begin(&path).expect("begun");
    recorder.device(&identity, &tablet.bytes);
    recorder.event(&event(5_000_000_000, 1));
    recorder.event(&event(5_004_000_000, 2));
    // Unplugged and plugged in again, it is the same device.
    recorder.device(&identity, &tablet.bytes);
    recorder.event(&event(7_000_000_000, 3));
    assert!(!path.exists());
    recorder.end().expect("written");
    let recorded = read(&path).expect("a recording");
    let wanted = Recorded {
        identity,
        descriptor: tablet.bytes,
        events: vec![event(0, 1), event(4_000_000, 2), event(2_000_000_000, 3)],
    };
    assert_eq!(recorded, [wanted]);
}

#[test]
fn a_recording_that_cannot_be_written_is_refused_at_once() {
    let fault = Recorder::begin(std::path::Path::new("/none/pen.hid")).expect_err("refused");
    assert!(fault.place.is_some_and(|place| place.contains("/none")));
}

/// Readings of the pen in a recording, one for each of its reports.
fn readings(recording: &str) -> Vec<Reading> {
    let devices = parse(recording).expect("a recording");
    let [device] = &devices[..] else {
        panic!("{} devices", devices.len());
    };
    let found = means(Kind::Pen, &device.identity, &device.descriptor);
    let Ok(Means::Pen(mut pen)) = found else {
        panic!("{found:?}");
    };
    let reports = device.events.iter().map(|event| &event.report);
    reports
        .map(|report| pen.decode(report).expect("a pen's"))
        .collect()
}

#[test]
fn every_report_of_a_pen_is_read() {
    for (recording, tilt_degrees) in [
        (
            include_str!("../../../../tests/cases/05-pen-laptop-blobs.hid"),
            0.0,
        ),
        (
            include_str!("../../../../tests/cases/06-pen-keypad.hid"),
            0.0,
        ),
        (
            include_str!("../../../../tests/cases/07-tilt-leak.hid"),
            60.0,
        ),
        (
            include_str!("../../../../tests/cases/07b-tilt-reset.hid"),
            60.0,
        ),
        (
            include_str!("../../../../tests/cases/08-tail-missing.hid"),
            0.0,
        ),
    ] {
        let readings = readings(recording);
        assert_eq!(readings.len(), 250);
        // It comes near, is pressed from the seventh report on, and goes at the last.
        let is_away = |reading: &Reading| reading.presence == Presence::Away;
        assert!(!is_away(&readings[0]) && is_away(&readings[249]));
        assert_eq!(readings[0].pressure, 0.0);
        let pressed = &readings[7];
        assert!(
            (pressed.pressure - 4000.0 / 8191.0).abs() < 1e-9,
            "{pressed:?}"
        );
        for reading in readings.iter().filter(|reading| !is_away(reading)) {
            let [across, along] = reading.tilt_rad.expect("tilts").map(f64::to_degrees);
            assert!((across - tilt_degrees).abs() < 1e-9, "{reading:?}");
            assert!(along.abs() < 1e-9, "{reading:?}");
        }
    }
}
