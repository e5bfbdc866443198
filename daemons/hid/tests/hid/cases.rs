//! The recordings of pens among the inputs that failed, as `tests/cases/README.md` lists them.

use maulstick_device::pen::{Presence, Reading};
use maulstick_hid::open::{Kind, Means, means};
use maulstick_hid::recording::parse;

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
