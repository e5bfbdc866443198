//! Recordings of event devices in the text of evemu.

use std::fmt::Write as _;

use maulstick_hid::evdev::evemu;
use maulstick_hid::recording::{self, LineFault, RecordingError};
use maulstick_types::stylus::{StylusPose, switch};

use crate::daemon::{Rig, nothing_plugged_in, settings};
use crate::evdev::{PEN, PRESSURE, TOUCH, X, Y, intuos, near};

/// A stroke of .4 s in evemu's text: near, a touch, along X, up, away.
fn recorded() -> String {
    let mut text = "# EVEMU 1.3\n# Input device name: \"Pen\"\nN: Wacom Intuos Pro M Pen\n\
        I: 0003 056a 0357 0110\nP: 01 00 00 00 00 00 00 00\nB: 00 0b 00 00 00 00 00 00 00\n"
        .to_owned();
    for line in 0..6 {
        let bits = if line == 5 {
            "01 1c 00 00 00 00 00 00"
        } else {
            "00 00 00 00 00 00 00 00"
        };
        writeln!(text, "B: 01 {bits}").expect("written");
    }
    for axis in intuos().axes {
        let [least, most] = axis.range;
        writeln!(
            text,
            "A: {:02x} {least} {most} 4 0 {}",
            axis.code, axis.resolution
        )
        .expect("written");
    }
    let mut say = |millis: u64, events: &[(u16, u16, i32)]| {
        for (kind, code, value) in events.iter().chain(&[(0, 0, 0)]) {
            let time = format!("{}.{:06}", millis / 1000, millis % 1000 * 1000);
            writeln!(
                text,
                "E: {time} {kind:04x} {code:04x} {value:04}\t# what it is"
            )
            .expect("written");
        }
    };
    say(0, &[(3, X, 11_200), (3, Y, 14_800), (1, PEN, 1)]);
    say(100, &[(1, TOUCH, 1), (3, PRESSURE, 4096)]);
    for step in 0..20_i32 {
        say(
            104 + 4 * u64::from(step.unsigned_abs()),
            &[(3, X, 11_200 + 1120 * step)],
        );
    }
    say(190, &[(1, TOUCH, 0), (3, PRESSURE, 0)]);
    say(200, &[(1, PEN, 0)]);
    text
}

#[test]
fn an_evemu_recording_paints_in_the_place_of_its_tablet() {
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), recorded()).expect("written");
    let mut settings = settings("evdev");
    settings.device.replay = Some(file.path().to_owned());
    let mut rig = Rig::new(&settings, nothing_plugged_in()).expect("a daemon");
    rig.run(400_000_000, 1_000_000);
    assert_eq!(rig.info().expect("told").driver, "evdev");
    let samples = rig.samples();
    let touching = samples
        .iter()
        .filter_map(|sample| match sample.message.pose {
            StylusPose::Contact {
                point_m, pressure, ..
            } if pressure > 0.0 => Some((point_m[0], pressure)),
            _ => None,
        });
    let touching: Vec<_> = touching.collect();
    assert!(touching.len() >= 21, "{}", touching.len());
    assert!(
        touching
            .iter()
            .all(|(_, pressure)| (pressure - 4096.0 / 8191.0).abs() < 1e-9)
    );
    // 19 steps of 1120 counts are 106.4 mm of the tablet's 224; the tablet covers the canvas.
    let canvas = &settings.canvas;
    let scale = (canvas.width_mm / 224.0).max(canvas.height_mm / 148.0);
    let along = touching[touching.len() - 1].0 - touching[0].0;
    near(along, 0.1064 * scale);
    let last = samples.last().expect("samples");
    assert!(!last.message.in_range && last.message.switches & switch::ERASER == 0);
}

#[test]
fn a_wrong_line_of_an_evemu_recording_is_named() {
    let last = recorded().lines().count() + 1;
    for (line, fault) in [
        ("A: 00 0", LineFault::Axis),
        ("E: 0.1 0003 0000 1", LineFault::Time("0.1".into())),
        ("E: 0.000001 0003 zz 1", LineFault::Event),
        ("I: 0003", LineFault::Identity("0003".into())),
        ("B: 01 xx", LineFault::Bits),
        ("what", LineFault::Line("what".into())),
    ] {
        let error = evemu::parse(&format!("{}{line}\n", recorded())).expect_err(line);
        assert_eq!(error, RecordingError { line: last, fault });
    }
    let older = format!(
        "{}E: 0.000001 0003 0000 1\nE: 0.000001 0000 0000 0\n",
        recorded()
    );
    let fault = |text: &str| evemu::parse(text).expect_err("refused").fault;
    assert_eq!(fault(&older), LineFault::Older);
    assert_eq!(fault("# EVEMU 1.3\n"), LineFault::NoAxis);
    let file = tempfile::NamedTempFile::new().expect("a file");
    std::fs::write(file.path(), "# EVEMU 1.3\nA: no\n").expect("written");
    let fault = recording::read(file.path()).expect_err("refused");
    let place = format!("{}:2", file.path().display());
    assert_eq!(fault.place, Some(place));
}
