//! Lines as both sides write them, and as nobody should.

use glam::DVec3;
use maulstick_haptic::drivers::polhem::frame::{
    Answer, FARTHEST_MM, FARTHEST_RAD, Length, Line, Lines, ParsedLine, read,
};
use proptest::prelude::*;

/// The example of the devices' own host.
const POSE: &[u8] = b" -59.276   13.383 -148.002   0.0919 -1.8483  1.0370 -1.9512 0";

#[test]
fn a_force_is_the_line_that_the_devices_own_host_writes() {
    let force = DVec3::new(1.5, -0.25, 0.0004);
    for (length, bytes) in [(Length::Short, 63), (Length::Long, 64)] {
        let line = Line::force(force, length);
        let mut expected = b"1500 -250 0 2 0 0 0".to_vec();
        expected.resize(bytes - 1, b' ');
        expected.push(b'\n');
        assert_eq!(line.as_bytes(), expected);
        let asked = Line::encoders(length);
        assert!(asked.as_bytes().starts_with(b"0 0 0 0 0 0 0 ") && asked.as_bytes().len() == bytes);
    }
}

#[test]
fn a_pose_is_read_as_it_is_printed() {
    let Some(ParsedLine::Answer(Answer::Pose(pose))) = read(POSE) else {
        panic!("no pose");
    };
    assert_eq!(pose.position_mm, [-59.276, 13.383, -148.002]);
    assert_eq!(pose.angles_rad, [0.0919, -1.8483, 1.0370, -1.9512]);
    assert_eq!(pose.info, 0);
}

#[test]
fn encoders_are_read_and_tell_the_button() {
    let pressed = |line: &[u8]| match read(line) {
        Some(ParsedLine::Answer(Answer::Encoders(encoders))) => Some(encoders.is_pressed()),
        _ => None,
    };
    assert_eq!(pressed(b"8298 -10771 19756 0 30 0 1       "), Some(false));
    assert_eq!(pressed(b"8298 -10771 19756 5001 30 0 0"), Some(true));
    assert_eq!(pressed(b"8298 -10771 19756 5001 30 0"), None);
}

#[test]
fn what_is_almost_a_line_is_none() {
    for line in [
        &b"-59.276 13.383 -148.002 0.0919 -1.8483 1.0370 -1.9512"[..],
        b"-59.276 13.383 -148.002 0.0919 -1.8483 1.0370 -1.9512 0 0",
        b"-59.276 13.383 -148.002 0.0919 -1.8483 1.0370 -1.9512 0.5",
        b"-59.276 13.383 -148.002 0.0919 -1.8483 1.0370 inf 0",
        b"NaN 13.383 -148.002 0.0919 -1.8483 1.0370 0.0 0",
        b"-1000.1 13.383 -148.002 0.0919 -1.8483 1.0370 0.0 0",
        b"0 0 0 0 0 0 12.6 0",
        b"0 0 0 0 0 40000 0",
        b"-59.276 13.383 -148.002\x00 0.0919 -1.8483 1.0370 -1.9512 0",
        b"OK",
    ] {
        assert_eq!(read(line), Some(ParsedLine::Garbage), "{line:?}");
    }
    for line in [&b""[..], b"   ", b"\r", b" \t "] {
        assert_eq!(read(line), None);
    }
}

#[test]
fn a_line_that_does_not_end_is_dropped_as_a_whole() {
    let mut lines = Lines::default();
    let bytes = [&[b' '; 500][..], POSE, b"\n", POSE, b"\n"].concat();
    let heard: Vec<ParsedLine> = bytes.iter().filter_map(|byte| lines.push(*byte)).collect();
    assert_eq!(heard.len(), 2);
    assert_eq!(heard[0], ParsedLine::Garbage);
    assert_eq!(Some(heard[1]), read(POSE));
}

/// True if an answer's numbers are in their ranges.
fn is_sound(heard: &ParsedLine) -> bool {
    match heard {
        ParsedLine::Answer(Answer::Pose(pose)) => {
            pose.position_mm.iter().all(|mm| mm.abs() <= FARTHEST_MM)
                && pose
                    .angles_rad
                    .iter()
                    .all(|angle| angle.abs() <= FARTHEST_RAD)
        }
        ParsedLine::Answer(Answer::Encoders(_)) | ParsedLine::Garbage => true,
    }
}

/// Bytes of which lines are made, and a few others.
fn byte() -> impl Strategy<Value = u8> {
    prop_oneof![
        6 => prop::sample::select(&b"0123456789.-+e \n\tinfaNE"[..]),
        1 => any::<u8>(),
    ]
}

proptest! {
    #[test]
    fn no_bytes_make_a_polhem_line_panic_or_leave_its_range(
        bytes in prop::collection::vec(byte(), 0..160),
    ) {
        let mut lines = Lines::default();
        for byte in bytes {
            if let Some(heard) = lines.push(byte) {
                prop_assert!(is_sound(&heard), "{heard:?}");
            }
        }
    }

    #[test]
    fn no_mutation_of_a_pose_line_leaves_its_range(
        changes in prop::collection::vec((0..POSE.len(), byte()), 1..4),
        cut in 0..POSE.len(),
    ) {
        let mut line = POSE.to_vec();
        for (place, byte) in changes {
            line[place] = byte;
        }
        for line in [&line[..], &line[cut..], &line[..cut]] {
            if let Some(heard) = read(line) {
                prop_assert!(is_sound(&heard), "{heard:?}");
            }
        }
    }

    /// Whatever is asked, no motor is asked for more than the device has.
    #[test]
    fn no_force_makes_a_line_that_the_device_does_not_read(
        x in any::<f64>(), y in any::<f64>(), z in any::<f64>(),
    ) {
        let line = Line::force(DVec3::new(x, y, z), Length::Short);
        let text = std::str::from_utf8(line.as_bytes()).expect("text");
        let numbers: Vec<i16> = text.split_whitespace().map(|n| n.parse().expect("i16")).collect();
        prop_assert_eq!(numbers.len(), 7);
        prop_assert!(numbers[..3].iter().all(|mn| mn.abs() <= 5000));
        prop_assert_eq!(&numbers[3..], &[2, 0, 0, 0]);
    }
}
