//! Orders of the start and of the end, however it ends.

use std::panic::{AssertUnwindSafe, catch_unwind};

use glam::DVec3;
use maulstick_haptic::device::driver::Wrench;
use maulstick_haptics::Switch;
use maulstick_libhd::{Call, Script};

use crate::bench::{calls, disorder, open, place, play, section, serve, tick, wait, wall};

fn pressed() -> Script {
    Script {
        position: [0.0, 0.0, 21.0],
        ..Script::default()
    }
}

/// The calls of a servo that presses and is ended.
fn ended() -> Vec<Call> {
    let control = play(&pressed());
    let mut servo = serve();
    wall(&mut servo);
    tick(&mut servo, |record| record.force.z > 0.39);
    drop(servo);
    let log = calls(&control);
    assert_eq!(disorder(&log), None);
    log
}

#[test]
fn a_servo_that_ends_takes_its_force_back_first() {
    let log = ended();
    let at = |what: Call| place(&log, |call| *call == what);
    let (clamped, powered) = (at(Call::Enable(0x4001)), at(Call::Enable(0x4000)));
    assert!(clamped < powered && powered < at(Call::Rate(1000)));
    let scheduled = at(Call::Schedule(u16::MAX));
    assert!(powered < scheduled && scheduled < at(Call::Start));
    let last = log.iter().rev().find(|call| matches!(call, Call::End(_)));
    assert_eq!(last, Some(&Call::End([0.0; 3])));
    assert_eq!(log.last(), Some(&Call::DisableDevice(0)));
}

#[test]
fn the_log_shows_every_disorder() {
    let log = ended();
    let last = log.iter().rposition(|call| matches!(call, Call::End(_)));
    let stop = place(&log, |call| *call == Call::Stop);
    let with = |at: usize, call: Call| {
        let mut log = log.clone();
        log[at] = call;
        disorder(&log)
    };
    let last = last.expect("a frame");
    assert!(with(last, Call::End([0.0, 0.0, 0.4])).is_some());
    assert!(with(last, Call::Check(0x5000)).is_some());
    assert!(with(stop, Call::Check(0x5000)).is_some());
    assert!(with(stop + 1, Call::DisableDevice(0)).is_some());
    assert!(with(stop, Call::Error(0x400)).is_some());
}

#[test]
fn a_servo_that_panics_within_a_frame_ends_it_without_force() {
    let control = play(&pressed());
    let mut opened = open(&section()).expect("opened");
    let mut frames = 0;
    let ended = catch_unwind(AssertUnwindSafe(|| {
        let driver = &mut opened.driver;
        opened.clock.run(&mut |_| {
            driver.read(1e-3).expect("there");
            frames += 1;
            assert!(frames < 20, "the seeded fault");
            let torque = DVec3::ZERO;
            let force = DVec3::X;
            driver.write(Wrench { force, torque }).expect("written");
            std::ops::ControlFlow::Continue(())
        })
    }));
    assert!(ended.is_err(), "it goes on beyond the scheduler");
    drop(opened);
    let log = calls(&control);
    assert_eq!(disorder(&log), None);
    let given = log
        .iter()
        .filter(|call| **call == Call::End([1.0, 0.0, 0.0]));
    assert_eq!(given.count(), 19);
}

#[test]
fn a_servo_that_ends_between_frames_with_force_takes_it_back_in_one_more() {
    let control = play(&pressed());
    let mut opened = open(&section()).expect("opened");
    let driver = &mut opened.driver;
    let ran = opened.clock.run(&mut |_| {
        driver.read(1e-3).expect("there");
        let torque = DVec3::ZERO;
        let force = DVec3::X;
        driver.write(Wrench { force, torque }).expect("written");
        std::ops::ControlFlow::Break(())
    });
    assert_eq!(ran, Ok(()));
    drop(opened);
    let log = calls(&control);
    assert_eq!(disorder(&log), None);
    let ends = log.iter().filter(|call| matches!(call, Call::End(_)));
    assert_eq!(
        ends.collect::<Vec<_>>(),
        [&Call::End([1.0, 0.0, 0.0]), &Call::End([0.0; 3])]
    );
}

#[test]
fn a_device_that_was_opened_and_never_ran_is_let_go() {
    let control = play(&pressed());
    let mut opened = open(&section()).expect("opened");
    assert_eq!(opened.driver.write(Wrench::ZERO), Ok(()));
    opened.driver.switch(Switch::Off);
    drop(opened);
    let log = calls(&control);
    assert_eq!(log.last(), Some(&Call::DisableDevice(0)));
    assert!(
        !log.iter()
            .any(|call| matches!(call, Call::Error(_) | Call::Stop))
    );
}

#[test]
fn amplifiers_are_switched_within_a_frame() {
    let control = play(&pressed());
    let mut servo = serve();
    wall(&mut servo);
    tick(&mut servo, |record| record.force.z > 0.39);
    let settings = |switch| maulstick_haptic::servo::force_control::ForceControl {
        switch,
        ..Default::default()
    };
    servo.controls.write(settings(Switch::Off));
    wait("the amplifiers off", || {
        calls(&control).contains(&Call::Disable(0x4000))
    });
    servo.controls.write(settings(Switch::On));
    while servo.ticks.pop().is_ok() {}
    wait("the amplifiers on", || {
        let log = calls(&control);
        let ons = log.iter().filter(|call| **call == Call::Enable(0x4000));
        ons.count() == 2
    });
    tick(&mut servo, |record| record.force.z > 0.39);
    drop(servo);
    assert_eq!(disorder(&calls(&control)), None);
}
