//! The driver of WoodenHaptics and Polhem styluses against their firmware: over a wire on a virtual
//! clock, and over a pair of pseudo-terminals.

#[path = "polhem/bench.rs"]
mod bench;
#[path = "polhem/button.rs"]
mod button;
#[path = "../../../sim/num/tests/counting/mod.rs"]
mod counting;
#[path = "polhem/firmware.rs"]
mod firmware;
#[path = "polhem/lines.rs"]
mod lines;
#[path = "polhem/terminal.rs"]
mod terminal;
mod wall;

use bench::{Cable, TickHarness};
use firmware::{Firmware, Reads, Style};
use glam::{DMat3, DVec3};
use maulstick_haptic::device::driver::Driver;
use maulstick_haptic::drivers::polhem::axes;
use maulstick_haptic::drivers::polhem::frame::{Length, Line, Pose};
use maulstick_haptic::drivers::polhem::handshake::{HandshakeError, handshake};
use maulstick_haptic::drivers::polhem::link::Wire;
use maulstick_haptics::Switch;
use maulstick_num::sin_cos;
use nix::errno::Errno;
use proptest::prelude::*;

/// All firmware that is known or thinkable, with the lines it is sent.
const KINDS: [(Style, Reads, Length); 4] = [
    (Style::Single, Reads::Lines, Length::Short),
    (Style::Double, Reads::Lines, Length::Short),
    (Style::Single, Reads::Lines, Length::Long),
    (Style::Double, Reads::Only64, Length::Long),
];

fn woken(firmware: Firmware, set: impl FnOnce(&Cable)) -> Result<Length, HandshakeError> {
    let mut cable = Cable::to(firmware);
    set(&cable);
    let clock = cable.clone();
    handshake(&mut cable, &mut || clock.advance(1e-3))
}

#[test]
fn waking_finds_out_which_lines_the_firmware_reads() {
    for (style, reads, length) in [
        (Style::Single, Reads::Lines, Length::Short),
        (Style::Double, Reads::Lines, Length::Short),
        (Style::Double, Reads::Only64, Length::Long),
    ] {
        let woken = woken(Firmware::new(style, reads), |_| {});
        assert_eq!(woken, Ok(length), "{style:?} {reads:?}");
    }
}

#[test]
fn a_stylus_that_wakes_late_and_through_garbage_is_woken() {
    let firmware = || Firmware::new(Style::Double, Reads::Lines);
    assert_eq!(
        woken(firmware(), |cable| cable.bench().losses = 4),
        Ok(Length::Short)
    );
    let garbled = woken(firmware(), |cable| {
        let mut bench = cable.bench();
        (bench.garbage, bench.piece, bench.latency_s) = (b"\x00\xff 1 2 nan\n".to_vec(), 3, 0.004);
    });
    assert_eq!(garbled, Ok(Length::Short));
}

#[test]
fn what_is_no_such_stylus_is_told_as_what_it_is() {
    let firmware = |reads| Firmware::new(Style::Double, reads);
    let silent = woken(firmware(Reads::Lines), |cable| {
        cable.bench().losses = usize::MAX;
    });
    assert_eq!(silent, Err(HandshakeError::Silent));
    let modem = woken(firmware(Reads::Lines), |cable| {
        let mut bench = cable.bench();
        // An overlong line drowns the answer, as at a wrong speed.
        bench.garbage = [b"AT+GMM\r\n".to_vec(), vec![b'x'; 200]].concat();
    });
    assert_eq!(modem, Err(HandshakeError::Foreign("AT+GMM".into())));
    let no_poses = woken(firmware(Reads::NoForces), |_| {});
    assert_eq!(no_poses, Err(HandshakeError::NoPoses));
    let broken = woken(firmware(Reads::Lines), |cable| {
        cable.bench().broken = Some(Errno::EIO);
    });
    assert_eq!(broken, Err(HandshakeError::Broken(Errno::EIO)));
}

#[test]
fn each_tick_brings_a_pose_and_takes_a_force_whatever_the_firmware() {
    for (style, reads, length) in KINDS {
        let mut harness = TickHarness::over(style, reads, length);
        let force = DVec3::new(0.5, -1.25, 2.0);
        assert_eq!(harness.ticks(500, force), 500, "{style:?} {reads:?}");
        assert_eq!(harness.felt(), force, "{style:?} {reads:?}");
        let reading = harness.tick(force).expect("there").expect("new");
        // x toward the user, y right, z up: mm.
        let expected = DVec3::new(13.383e-3, -148.002e-3, -59.276e-3);
        assert!((reading.handle.position - expected).length() < 1e-12);
        assert!(reading.handle.velocity.length() < 1e-9 && reading.in_range);
    }
}

#[test]
fn lines_of_a_length_that_the_firmware_does_not_read_bring_nothing() {
    let cable = Cable::to(Firmware::new(Style::Double, Reads::Only64));
    let short = Line::force(DVec3::X, Length::Short);
    cable.clone().write(short.as_bytes()).expect("sent");
    assert_eq!(cable.bench().firmware.commands, 0);
    let long = Line::force(DVec3::X, Length::Long);
    cable.clone().write(long.as_bytes()).expect("sent");
    assert_eq!(cable.bench().firmware.commands, 1);
}

#[test]
fn poses_in_pieces_are_put_together() {
    for piece in 2..=9 {
        let mut harness = TickHarness::over(Style::Double, Reads::Lines, Length::Short);
        harness.cable.bench().piece = piece;
        let read = harness.ticks(300, DVec3::X);
        // Four pieces a tick, 64 bytes a pose.
        let expected = 300 / 64_usize.div_ceil(4 * piece);
        assert!(read.abs_diff(expected) <= 1, "{piece}: {read} {expected}");
        assert_eq!(harness.polhem.lost(), 0, "{piece}");
    }
}

#[test]
fn after_a_lost_answer_there_is_no_force_until_the_dialogue_is_taken_up_again() {
    let mut harness = TickHarness::over(Style::Single, Reads::Lines, Length::Short);
    harness.ticks(100, DVec3::X);
    harness.cable.bench().losses = 1;
    let mut felt = Vec::new();
    for _ in 0..60 {
        harness.tick(DVec3::X).expect("there");
        felt.push(harness.felt().x);
    }
    assert_eq!(harness.polhem.lost(), 1);
    let without = felt.iter().filter(|newtons| **newtons == 0.0).count();
    assert!((5..20).contains(&without), "{felt:?}");
    assert_eq!(felt.last(), Some(&1.0), "{felt:?}");
    // With every answer there it would never have gone.
    assert_eq!(harness.ticks(60, DVec3::X), 60);
    assert_eq!((harness.polhem.lost(), harness.felt().x), (1, 1.0));
}

#[test]
fn a_late_answer_is_not_taken_for_the_next_one() {
    let mut harness = TickHarness::over(Style::Double, Reads::Lines, Length::Short);
    harness.ticks(100, DVec3::X);
    // The answer is given up after 10 ms, and comes a little before that to the probe.
    harness.cable.bench().latency_s = 0.0115;
    harness.tick(DVec3::X).expect("there");
    harness.cable.bench().latency_s = 0.004;
    let (mut lost, mut asked, mut compared) = (0, None, 0);
    for step in 0..300 {
        harness.cable.bench().firmware.pose[0] = f64::from(step);
        let reading = harness.tick(DVec3::X).expect("there");
        if harness.polhem.lost() > lost {
            (lost, asked) = (harness.polhem.lost(), None);
        }
        let Some(reading) = reading else { continue };
        // The answer to the line that was written with the reading before.
        let told = (reading.handle.position.z * 1e3).round() as i32;
        assert!(
            asked.is_none_or(|asked| asked == told),
            "{step}: {told} {asked:?}"
        );
        compared += usize::from(asked.is_some());
        asked = Some(step);
    }
    assert!(lost == 1 && compared > 40, "{lost} {compared}");
}

#[test]
fn garbage_between_answers_changes_no_reading() {
    for garbage in [
        &b"\x00\xff\xfe garbage\n"[..],
        b"nan nan nan 0 0 0 0 0\n",
        b"1e999 0 0 0 0 0 0 0\n",
        b"\n\n  \r\n",
        b"1 2 3 4 5 6 7 8 9\n99999 0 0 0 0 0 0\n",
    ] {
        let mut harness = TickHarness::over(Style::Double, Reads::Lines, Length::Short);
        let clean = harness.tick(DVec3::X).expect("there").expect("new");
        harness.cable.bench().garbage = garbage.to_vec();
        assert_eq!(harness.ticks(100, DVec3::X), 100);
        let garbled = harness.tick(DVec3::X).expect("there").expect("new");
        assert_eq!(garbled.handle.position, clean.handle.position);
        assert_eq!(harness.felt(), DVec3::X);
    }
}

#[test]
fn a_host_that_stalls_leaves_no_force_after_the_watchdogs_time() {
    let mut harness = TickHarness::over(Style::Single, Reads::Lines, Length::Short);
    harness.ticks(10, DVec3::Y);
    harness.cable.advance(0.09);
    assert_eq!(harness.felt(), DVec3::Y);
    harness.cable.advance(0.02);
    assert_eq!(harness.felt(), DVec3::ZERO);
    // The tick that comes after all finds the answer of long ago, and the force comes back.
    harness.ticks(10, DVec3::Y);
    assert_eq!(harness.felt(), DVec3::Y);
}

#[test]
fn amplifiers_that_rest_have_no_current_while_poses_go_on() {
    // Also where they were switched off while the button was asked for.
    for phase in 0..60 {
        let mut harness = TickHarness::over(Style::Double, Reads::Lines, Length::Short);
        harness.ticks(200 + phase, DVec3::ZERO);
        harness.polhem.switch(Switch::Off);
        for _ in 0..300 {
            assert!(harness.tick(DVec3::X).expect("there").is_some(), "{phase}");
            assert_eq!(harness.cable.bench().firmware.currents, [0; 3]);
        }
        harness.polhem.switch(Switch::On);
        harness.ticks(10, DVec3::X);
        assert_eq!(harness.felt(), DVec3::X);
    }
}

#[test]
fn a_wire_that_is_full_gets_the_line_later() {
    let mut harness = TickHarness::over(Style::Double, Reads::Lines, Length::Short);
    harness.ticks(10, DVec3::X);
    harness.cable.bench().room = 0;
    harness.ticks(3, DVec3::X * 2.0);
    assert_eq!(harness.felt(), DVec3::X);
    harness.cable.bench().room = usize::MAX;
    harness.ticks(3, DVec3::X * 2.0);
    assert_eq!((harness.felt(), harness.polhem.lost()), (DVec3::X * 2.0, 0));
}

#[test]
fn a_line_that_is_cut_off_pushes_nobody() {
    for room in 2..63 {
        let mut harness = TickHarness::over(Style::Single, Reads::Lines, Length::Short);
        harness.ticks(10, DVec3::X);
        harness.cable.bench().room = room;
        let mut felt = Vec::new();
        for _ in 0..20 {
            harness.tick(DVec3::X).expect("there");
            felt.push(harness.felt());
        }
        let wrong = |newtons: &DVec3| *newtons != DVec3::X && *newtons != DVec3::ZERO;
        assert!(!felt.iter().any(wrong), "{room}: {felt:?}");
        harness.cable.bench().room = usize::MAX;
        harness.ticks(40, DVec3::X);
        assert_eq!(harness.felt(), DVec3::X, "{room}");
    }
}

#[test]
fn a_force_beyond_the_devices_is_cut_to_it_and_one_that_is_no_number_is_none() {
    let mut harness = TickHarness::over(Style::Single, Reads::Lines, Length::Short);
    harness.ticks(10, DVec3::new(30.0, 0.0, -40.0));
    assert!((harness.felt() - DVec3::new(3.0, 0.0, -4.0)).length() < 1e-3);
    for wrong in [f64::NAN, f64::INFINITY] {
        harness.ticks(10, DVec3::new(0.0, wrong, 1.0));
        assert_eq!(harness.felt(), DVec3::ZERO);
    }
    harness.ticks(10, DVec3::splat(1e100));
    assert!((harness.felt().length() - 5.0).abs() < 2e-3);
    // Uncut, the amplifiers would have refused it.
    let uncut = b"30000 0 -30000 2 0 0 0\n";
    harness.cable.clone().write(uncut).expect("sent");
    assert_eq!(harness.felt(), DVec3::ZERO);
}

#[test]
fn an_amplifier_refuses_what_is_beyond_it_and_the_dialogue_goes_on() {
    let mut harness = TickHarness::over(Style::Single, Reads::Lines, Length::Short);
    harness.cable.bench().firmware.escon_max = 3000;
    assert_eq!(harness.ticks(10, DVec3::X * 4.0), 10);
    assert_eq!(harness.felt(), DVec3::ZERO);
    harness.ticks(10, DVec3::X * 2.0);
    assert_eq!(harness.felt(), DVec3::X * 2.0);
}

/// Text of the error that ticks end in.
fn error_of(harness: &mut TickHarness) -> &'static str {
    (0..3000)
        .find_map(|_| harness.tick(DVec3::X).err())
        .map_or("none", |error| error.what)
}

#[test]
fn a_device_that_is_gone_is_told_as_how_it_went() {
    let mut harness = TickHarness::over(Style::Single, Reads::Lines, Length::Short);
    assert_eq!(error_of(&mut harness), "none");
    harness.cable.bench().losses = usize::MAX;
    assert_eq!(
        error_of(&mut harness),
        "the stylus does not answer any more"
    );
    let mut harness = TickHarness::over(Style::Single, Reads::Lines, Length::Short);
    harness.cable.bench().garbage = vec![b'#'; 300];
    let what = "the stylus sends only what cannot be read";
    assert_eq!(error_of(&mut harness), what);
    for errno in [Errno::EIO, Errno::ENODEV, Errno::ENXIO] {
        let mut harness = TickHarness::over(Style::Single, Reads::Lines, Length::Short);
        harness.cable.bench().broken = Some(errno);
        assert_eq!(error_of(&mut harness), "the stylus is unplugged");
    }
}

#[test]
fn the_last_word_is_no_force_even_while_another_is_on_its_way() {
    for latency_s in [0.0, 1.0] {
        let mut harness = TickHarness::over(Style::Double, Reads::Lines, Length::Short);
        harness.ticks(10, DVec3::X);
        harness.cable.bench().latency_s = latency_s;
        harness.tick(DVec3::X).expect("there");
        let cable = harness.cable.clone();
        assert!((cable.bench().firmware.force()[1] - 1.0).abs() < 1e-9);
        drop(harness);
        assert_eq!(cable.bench().firmware.force(), [0.0; 3]);
        let last = cable.bench().sent.last().cloned();
        assert!(last.is_some_and(|line| line.starts_with(b"0 0 0 2 0 0 0")));
    }
}

#[test]
fn the_button_is_asked_for_where_there_is_no_force_and_costs_no_late_tick() {
    let mut harness = TickHarness::over(Style::Double, Reads::Lines, Length::Short);
    let switches = |harness: &mut TickHarness, force| {
        harness.ticks(100, force);
        let reading = (0..3).find_map(|_| harness.tick(force).expect("there"));
        reading.map(|reading| reading.switches)
    };
    assert_eq!(switches(&mut harness, DVec3::ZERO), Some(0));
    harness.cable.bench().firmware.encoders[3] = 10_042;
    assert_eq!(switches(&mut harness, DVec3::ZERO), Some(1));
    harness.cable.bench().firmware.encoders[3] = 42;
    // A force is not taken from the hand to look at the button.
    assert_eq!(switches(&mut harness, DVec3::X), Some(1));
    assert_eq!(switches(&mut harness, DVec3::ZERO), Some(0));
    harness.cable.bench().firmware.encoders[3] = 10_042;
    harness.polhem.switch(Switch::Off);
    assert_eq!(switches(&mut harness, DVec3::ZERO), Some(1));
    harness.cable.bench().firmware.encoders[3] = 42;
    assert_eq!(switches(&mut harness, DVec3::X), Some(0));
    assert!(harness.longest_s < 0.0015, "{}", harness.longest_s);
}

#[test]
fn the_question_for_the_button_is_no_stall_however_slow_the_exchange() {
    for (latency_s, exchange_s) in [(0.0015, 0.002), (0.0025, 0.003)] {
        let mut harness = TickHarness::over(Style::Single, Reads::Lines, Length::Short);
        harness.cable.bench().latency_s = latency_s;
        for step in 0..600 {
            harness.cable.bench().firmware.pose[1] += 0.1;
            let reading = harness.tick(DVec3::ZERO).expect("there");
            let speed = reading.map_or(0.1, |reading| reading.handle.velocity.x);
            assert!(step < 100 || (speed - 0.1).abs() < 1e-3, "{speed}");
        }
        assert!(
            harness.longest_s < exchange_s + 5e-4,
            "{}",
            harness.longest_s
        );
    }
}

#[test]
fn the_last_word_is_read_also_after_a_line_that_was_cut_off() {
    for left in 1..30 {
        let mut harness = TickHarness::over(Style::Single, Reads::Lines, Length::Short);
        harness.ticks(10, DVec3::Z);
        harness.cable.bench().left = left;
        harness.tick(DVec3::Z).expect("there");
        let cable = harness.cable.clone();
        cable.bench().left = usize::MAX;
        drop(harness);
        assert_eq!(cable.bench().firmware.currents, [0; 3], "{left}");
    }
}

#[test]
fn a_moving_stylus_has_its_velocity() {
    let mut harness = TickHarness::over(Style::Single, Reads::Lines, Length::Short);
    let mut read = DVec3::ZERO;
    for _ in 0..49 {
        harness.cable.bench().firmware.pose[1] += 0.1;
        let reading = harness.tick(DVec3::X).expect("there").expect("new");
        read = reading.handle.velocity;
    }
    assert!((read - DVec3::X * 0.1).length() < 1e-3, "{read}");
}

/// A turn about an axis of the device's own frame, as a matrix.
fn turn(axis: usize, angle: f64) -> DMat3 {
    let (s, c) = sin_cos(angle);
    let columns = match axis {
        0 => [[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]],
        1 => [[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]],
        _ => [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]],
    };
    DMat3::from_cols_array_2d(&columns)
}

fn posed(angles_rad: [f64; 4]) -> Pose {
    Pose {
        position_mm: [0.0; 3],
        angles_rad,
        info: 0,
    }
}

proptest! {
    /// R = R_z(t_A)·R_y(−λ)·R_x(t_D)·R_y(t_E), by matrices in the device's own frame; the far end of the
    /// stylus is its x, the bristles' end of the brush its −z.
    #[test]
    fn the_orientation_is_the_product_of_the_gimbals_turns(
        a in -3.0..3.0f64, l in -3.0..3.0f64, d in -3.0..3.0f64, e in -3.0..3.0f64,
    ) {
        let theirs = turn(2, a) * turn(1, -l) * turn(0, d) * turn(1, e);
        let ours = axes::orientation(&posed([a, l, d, e]));
        for (axis, brush) in [(DVec3::X, DVec3::Z), (DVec3::Y, DVec3::X), (DVec3::Z, DVec3::Y)] {
            let expected = axes::to_device(theirs * axis);
            prop_assert!((ours * brush - expected).length() < 1e-12);
        }
    }
}

#[test]
fn a_gimbal_that_turns_the_other_way_is_another_orientation() {
    let angles = [0.0919, -1.8483, 1.0370, -1.9512];
    let ours = axes::orientation(&posed(angles)) * DVec3::Z;
    for place in 0..4 {
        let mut wrong = angles;
        wrong[place] = -wrong[place];
        let other = axes::orientation(&posed(wrong)) * DVec3::Z;
        assert!((ours - other).length() > 0.05, "{place}");
    }
}

#[test]
fn a_stylus_held_straight_points_away_from_the_user_and_one_turned_left_to_the_left() {
    let straight = axes::orientation(&posed([0.0; 4]));
    assert!((straight * DVec3::NEG_Z - DVec3::NEG_Z).length() < 1e-12);
    // The base turns by t_A about what is up: the far end goes to the right, so the tip to the left.
    let turned = axes::orientation(&posed([std::f64::consts::FRAC_PI_2, 0.0, 0.0, 0.0]));
    assert!((turned * DVec3::NEG_Z - DVec3::NEG_X).length() < 1e-12);
    let v = DVec3::new(1.0, 2.0, 3.0);
    assert_eq!(axes::to_theirs(axes::to_device(v)), v);
}
