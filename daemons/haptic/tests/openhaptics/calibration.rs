//! Calibration of a device.

use glam::DVec3;
use maulstick_haptic::drivers::openhaptics::calibration_state::CalibrationState;
use maulstick_haptic::servo::servo_thread::ServoThread;
use maulstick_libhd::{Call, Event, Script};

use crate::bench::{calls, disorder, listen, place, play, serve, tick, told, wait, wall};

const OK: u32 = 0x5000;
const NEEDS_UPDATE: u32 = 0x5001;
const NEEDS_MANUAL_INPUT: u32 = 0x5002;

/// A device of these styles and states.
fn script(styles: i32, calibration: &[u32]) -> Script {
    Script {
        styles,
        calibration: calibration.to_vec(),
        position: [0.0, 0.0, 21.0],
        ..Script::default()
    }
}

/// How often the user was asked to put the arm into its reset position.
fn asked() -> usize {
    let words = CalibrationState::Reset.words().expect("an instruction");
    told().matches(words).count()
}

/// So many more ticks, each out of range and without force.
fn forceless(servo: &mut ServoThread, ticks: usize) {
    let mut left = ticks;
    tick(servo, |record| {
        assert!(!record.reading.in_range && record.force == DVec3::ZERO);
        left -= 1;
        left == 0
    });
}

#[test]
fn encoders_are_set_to_zero_where_the_user_says_that_the_arm_stands_right() {
    for state in [NEEDS_UPDATE, NEEDS_MANUAL_INPUT] {
        // A button that is held as the device is opened says nothing.
        let control = play(&Script {
            buttons: 1,
            ..script(1, &[state, OK])
        });
        listen();
        let mut servo = serve();
        wall(&mut servo);
        wait("the words", || asked() > 0);
        forceless(&mut servo, 100);
        for buttons in [0, 2] {
            control.happen(&Event::Buttons(buttons)).expect("happens");
            tick(&mut servo, |record| {
                record.reading.switches == buttons as u32
            });
            forceless(&mut servo, 100);
        }
        let updates = || {
            let log = calls(&control);
            log.iter()
                .filter(|call| matches!(call, Call::Update(_)))
                .count()
        };
        assert_eq!(updates(), 0);
        control.happen(&Event::Buttons(1)).expect("happens");
        tick(&mut servo, |record| {
            record.reading.in_range && record.force.z > 0.39
        });
        drop(servo);
        assert_eq!(updates(), 1);
        assert_eq!(asked(), 1, "{}", told());
        assert_eq!(disorder(&calls(&control)), None);
    }
}

#[test]
fn encoders_that_have_their_zero_keep_it() {
    let control = play(&script(1, &[OK]));
    let mut servo = serve();
    tick(&mut servo, |record| record.reading.in_range);
    drop(servo);
    let log = calls(&control);
    assert!(!log.iter().any(|call| matches!(call, Call::Update(_))));
}

#[test]
fn other_styles_are_updated_while_the_scheduler_runs() {
    // All styles: by itself. The inkwell and the encoders: the inkwell.
    for (styles, style) in [(7, 2), (5, 4)] {
        let control = play(&script(styles, &[NEEDS_UPDATE, OK]));
        let mut servo = serve();
        let first = tick(&mut servo, |_| true);
        assert!(!first.reading.in_range && !first.reading.is_permitted);
        tick(&mut servo, |record| record.reading.in_range);
        drop(servo);
        let log = calls(&control);
        let start = place(&log, |call| *call == Call::Start);
        let updated = place(&log, |call| *call == Call::Update(style));
        assert!(start < updated);
        let frames = log[start..updated]
            .iter()
            .filter(|call| matches!(call, Call::Begin(_)));
        assert!(
            frames.count() >= 2,
            "frames have seen that it does not know its place"
        );
        assert_eq!(disorder(&log), None);
    }
}

#[test]
fn a_device_that_needs_the_user_says_so_and_gives_no_force_until_then() {
    for (styles, words) in [
        (4, "put the stylus into the inkwell"),
        (2, "move the stylus slowly through all of its reach"),
        (0, "calibrate it by the vendor's setup program"),
    ] {
        let control = play(&script(styles, &[NEEDS_MANUAL_INPUT]));
        listen();
        let mut servo = serve();
        wall(&mut servo);
        wait("the words", || told().contains(words));
        let checks = || {
            let log = calls(&control);
            let checks = log.iter().filter(|call| matches!(call, Call::Check(_)));
            checks.count()
        };
        wait("two more looks", || {
            while let Ok(record) = servo.ticks.pop() {
                assert!(!record.reading.in_range && record.force == DVec3::ZERO);
            }
            checks() >= 4
        });
        let states = match styles {
            0 => vec![OK],
            _ => vec![NEEDS_UPDATE, OK],
        };
        control
            .happen(&Event::Calibration(states))
            .expect("happens");
        tick(&mut servo, |record| {
            record.reading.in_range && record.force.z > 0.39
        });
        wait("the good news", || {
            told().contains("phantom: the device is calibrated")
        });
        drop(servo);
        assert_eq!(told().matches(words).count(), 1, "{}", told());
        assert_eq!(disorder(&calls(&control)), None);
    }
}

#[test]
fn a_device_that_loses_its_place_is_out_of_range_until_it_is_updated() {
    let control = play(&script(2, &[OK]));
    let mut servo = serve();
    wall(&mut servo);
    tick(&mut servo, |record| record.force.z > 0.39);
    let lost = Event::Calibration(vec![NEEDS_UPDATE, OK]);
    control.happen(&lost).expect("happens");
    let record = tick(&mut servo, |record| !record.reading.in_range);
    assert_eq!(record.force, DVec3::ZERO);
    tick(&mut servo, |record| record.force.z > 0.39);
    drop(servo);
    let log = calls(&control);
    assert!(log.contains(&Call::Update(2)));
    assert_eq!(disorder(&log), None);
}

#[test]
fn encoders_that_lose_their_zero_give_no_force_until_the_button() {
    let control = play(&script(1, &[OK]));
    listen();
    let mut servo = serve();
    wall(&mut servo);
    tick(&mut servo, |record| record.force.z > 0.39);
    let lost = Event::Calibration(vec![NEEDS_UPDATE, OK]);
    control.happen(&lost).expect("happens");
    tick(&mut servo, |record| !record.reading.in_range);
    forceless(&mut servo, 100);
    wait("the words", || asked() > 0);
    control.happen(&Event::Buttons(1)).expect("happens");
    tick(&mut servo, |record| record.force.z > 0.39);
    drop(servo);
    assert_eq!(disorder(&calls(&control)), None);
}

#[test]
fn calibration_is_looked_at_within_frames_only() {
    let control = play(&script(2, &[NEEDS_UPDATE, OK]));
    let mut servo = serve();
    tick(&mut servo, |record| record.reading.in_range);
    drop(servo);
    let mut is_open = false;
    for call in calls(&control) {
        match call {
            Call::Begin(_) => is_open = true,
            Call::End(_) => is_open = false,
            Call::Check(_) | Call::Update(_) => assert!(is_open, "{call:?}"),
            _ => {}
        }
    }
}
