//! 6-DOF mice, report by report.

use glam::DQuat;
use maulstick_hid::spacemouse::{DECAY_NS, SILENCE_NS, SpaceMouse};
use maulstick_num::geometry::rotation;
use maulstick_types::control::ControlSample;
use proptest::prelude::*;

fn mouse() -> SpaceMouse {
    SpaceMouse::new(0x256F, 0xC635, DQuat::IDENTITY)
}

fn words(id: u8, counts: &[i16]) -> Vec<u8> {
    let bytes = counts.iter().flat_map(|count| count.to_le_bytes());
    std::iter::once(id).chain(bytes).collect()
}

#[test]
fn a_push_toward_the_hand_is_down_the_desk_and_one_down_is_into_it() {
    let mut mouse = mouse();
    assert!(mouse.follow(&words(1, &[350, 350, 350]), 0));
    assert_eq!(mouse.sample(0).push, [1.0, -1.0, -1.0]);
    assert!(mouse.follow(&words(2, &[-350, 350, -350]), 0));
    assert_eq!(mouse.sample(0).turn, [-1.0, -1.0, 1.0]);
    // −30 of the stop's 350, less the dead zone.
    mouse.follow(&[1, 0, 0, 0xE2, 0xFF, 0, 0], 0);
    let push = mouse.sample(0).push[1];
    assert!(
        (push - (30.0 / 350.0 - 0.03) / 0.97).abs() < 1e-12,
        "{push}"
    );
}

#[test]
fn six_axes_in_one_report_are_those_of_two() {
    let counts = [10, -200, 350, -350, 77, 5];
    let (mut split, mut combined) = (mouse(), mouse());
    split.follow(&words(1, &counts[..3]), 0);
    split.follow(&words(2, &counts[3..]), 0);
    combined.follow(&words(1, &counts), 0);
    assert_eq!(split.sample(0), combined.sample(0));
    // One axis off is another sample.
    combined.follow(&words(1, &[10, -200, 350, -350, 78, 5]), 0);
    assert_ne!(split.sample(0), combined.sample(0));
}

#[test]
fn a_hand_that_rests_on_the_cap_does_not_push() {
    let mut mouse = mouse();
    mouse.follow(&words(1, &[10, -10, 9]), 0);
    assert_eq!(mouse.sample(0).push, [0.0; 3]);
    mouse.follow(&words(1, &[11, 0, 0]), 0);
    let push = mouse.sample(0).push[0];
    assert!(push > 0.0 && push < 0.01, "{push}");
}

#[test]
fn buttons_are_bits_of_one_to_eight_bytes() {
    let mut mouse = mouse();
    mouse.follow(&[3, 1], 0);
    assert_eq!(mouse.sample(0).switches, 1);
    mouse.follow(&[3, 2, 0, 0, 0x80], 0);
    assert_eq!(mouse.sample(0).switches, 0x8000_0002);
    mouse.follow(&[3, 0, 0, 0, 0, 0, 0, 0, 1, 0xFF], 0);
    assert_eq!(mouse.sample(0).switches, 1 << 56);
    mouse.follow(&[3, 0, 0], 0);
    assert_eq!(mouse.sample(0).switches, 0);
}

#[test]
fn the_battery_is_no_hand() {
    let mut mouse = mouse();
    assert!(!mouse.follow(&[0x17, 80, 0], 0));
    assert!(!mouse.follow(&[], 0) && !mouse.follow(&[1, 0, 0], 0) && !mouse.follow(&[3], 0));
    assert_eq!(mouse.sample(0), ControlSample::at_rest());
}

#[test]
fn a_mouse_that_falls_silent_while_pushed_comes_to_rest() {
    let mut mouse = mouse();
    mouse.follow(&words(1, &[350, 0, 0]), 1_000);
    let push = |mouse: &mut SpaceMouse, after| mouse.sample(1_000 + after).push[0];
    assert_eq!(push(&mut mouse, SILENCE_NS), 1.0);
    let half = push(&mut mouse, SILENCE_NS + DECAY_NS / 2);
    assert!((half - 0.5).abs() < 1e-12, "{half}");
    assert!(mouse.is_deflected());
    assert_eq!(push(&mut mouse, SILENCE_NS + DECAY_NS), 0.0);
    assert!(!mouse.is_deflected());
    // One report is enough to go on.
    mouse.follow(&words(1, &[350, 0, 0]), 2_000_000_000);
    assert_eq!(mouse.sample(2_000_000_000).push[0], 1.0);
}

#[test]
fn a_mouse_that_lies_sideways_is_turned() {
    let quarter = rotation(glam::DVec3::Z, std::f64::consts::FRAC_PI_2);
    let mut mouse = SpaceMouse::new(0x046D, 0xC626, quarter);
    mouse.follow(&words(1, &[350, 0, 0]), 0);
    let push = mouse.sample(0).push;
    assert!(
        push[0].abs() < 1e-12 && (push[1] - 1.0).abs() < 1e-12,
        "{push:?}"
    );
}

proptest! {
    #[test]
    fn no_bytes_make_a_mouse_panic(
        reports in prop::collection::vec(prop::collection::vec(any::<u8>(), 0..16), 0..6),
        turn in -3.0..3.0_f64,
        times in prop::collection::vec(0..500_000_000_u64, 6),
    ) {
        let axis = glam::DVec3::new(0.6, 0.0, 0.8);
        let mut mouse = SpaceMouse::new(0x256F, 0xC652, rotation(axis, turn));
        let mut now_ns = 0;
        for (report, step) in reports.iter().zip(times) {
            mouse.follow(report, now_ns);
            now_ns += step;
            prop_assert_eq!(mouse.sample(now_ns).fault(), None);
        }
    }
}
