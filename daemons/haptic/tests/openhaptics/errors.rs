//! Errors while it runs.

use glam::DVec3;
use maulstick_haptic::device::driver::DeviceError;
use maulstick_haptic::drivers::openhaptics::device::UNREADABLE;
use maulstick_haptic::drivers::openhaptics::vendor_clock::DEAD;
use maulstick_haptic::servo::servo_thread::ServoThread;
use maulstick_libhd::script::Scheduler;
use maulstick_libhd::{Call, Control, Event, Moment, Script};

use crate::bench::{
    calls, disorder, listen, open, place, play, refusal, section, serve, tick, told, wait, wall,
};

/// Pressed 4 mm into the wall.
fn pressed() -> Script {
    Script {
        position: [0.0, 0.0, 21.0],
        ..Script::default()
    }
}

/// Reason why a servo over a device has ended.
fn end(mut servo: ServoThread) -> DeviceError {
    wait("the end", || {
        while servo.ticks.pop().is_ok() {}
        servo.has_ended()
    });
    servo.error().expect("an error")
}

/// Serves until there is force, and has something happen then that ends the servo.
fn lost(control: &Control, event: &Event) -> DeviceError {
    let mut servo = serve();
    wall(&mut servo);
    tick(&mut servo, |record| record.force.z > 0.39);
    control.happen(event).expect("happens");
    end(servo)
}

/// The forces of a log's frames, N.
fn forces(calls: &[Call]) -> Vec<DVec3> {
    calls
        .iter()
        .filter_map(|call| match call {
            Call::End(force) => Some(DVec3::from_array(*force)),
            _ => None,
        })
        .collect()
}

#[test]
fn errors_of_the_force_are_told_once_and_the_servo_goes_on() {
    for (code, words) in [
        (0x200, "the motors are warm"),
        (0x201, "a force was beyond"),
        (0x202, "a force changed faster"),
        (0x203, "the stylus was faster"),
        (0x204, "a trouble with its motors"),
    ] {
        let moment = |frame, event| Moment { frame, event };
        let control = play(&Script {
            moments: vec![
                moment(200, Event::Error(code, 0)),
                moment(210, Event::ErrorAtEnd(code, 0)),
            ],
            ..pressed()
        });
        listen();
        let mut servo = serve();
        wall(&mut servo);
        tick(&mut servo, |record| record.force.z > 0.39);
        wait("both errors", || {
            while servo.ticks.pop().is_ok() {}
            let log = calls(&control);
            let errors = log.iter().filter(|call| **call == Call::Error(code));
            errors.count() == 2
        });
        wait("the words", || told().contains(words));
        tick(&mut servo, |record| record.force.z > 0.39);
        drop(servo);
        assert_eq!(told().matches(words).count(), 1, "{}", told());
        assert!(told().contains("phantom: "), "{}", told());
        // The errors are the only disorder.
        let mut log = calls(&control);
        log.retain(|call| *call != Call::Error(code));
        assert_eq!(disorder(&log), None);
    }
}

#[test]
fn every_other_error_ends_the_servo_without_force() {
    for code in [
        0x100, 0x101, 0x102, 0x103, 0x104, 0x300, 0x302, 0x303, 0x304, 0x400, 0x401, 0x402, 0x500,
        0x501, 0x600, 0x7abc,
    ] {
        for event in [Event::Error(code, -28), Event::ErrorAtEnd(code, -28)] {
            let control = play(&pressed());
            let error = lost(&control, &event);
            assert_eq!(error.code, i64::from(code), "{error}");
            let mut log = calls(&control);
            let at = place(&log, |call| *call == Call::Error(code));
            // The frame that was open, and one that takes the force back.
            assert!(forces(&log[at..]).len() <= 2, "{code:#x}");
            log.retain(|call| *call != Call::Error(code));
            assert_eq!(disorder(&log), None, "{code:#x}");
            let forces = forces(&log);
            assert!(forces.iter().any(|force| force.z > 0.39), "{code:#x}");
            assert_eq!(forces.last(), Some(&DVec3::ZERO));
        }
    }
}

#[test]
fn a_device_that_is_unplugged_is_lost_and_found_again() {
    let control = play(&pressed());
    listen();
    let error = lost(&control, &Event::Unplug);
    assert_eq!(
        error.to_string(),
        "the haptic device does not answer (0x302)"
    );
    assert!(told().contains("(0x302, internal -28)"), "{}", told());
    let mut log = calls(&control);
    // The last call may still be on its way back as the scheduler is told to stop.
    log.retain(|call| !matches!(call, Call::Returned(..)));
    assert_eq!(forces(&log).last(), Some(&DVec3::ZERO));
    let end = place(&log, |call| *call == Call::Stop);
    assert!(matches!(
        log[end + 1..],
        [Call::Unschedule(_), Call::DisableDevice(0)]
    ));
    let fault = refusal(&section());
    assert_eq!(fault.help.as_deref(), Some(error.help), "{fault}");
    control.happen(&Event::Plug).expect("happens");
    let mut servo = serve();
    wall(&mut servo);
    tick(&mut servo, |record| record.force.z > 0.39);
}

#[test]
fn a_scheduler_that_does_not_take_the_servo_is_an_error() {
    let refused = Script {
        schedule_error: Some(0x501),
        ..Script::default()
    };
    let no_clock = Script {
        start_error: Some(0x304),
        ..Script::default()
    };
    for (script, code) in [(refused, 0x501), (no_clock, 0x304)] {
        let control = play(&script);
        assert_eq!(end(serve()).code, code);
        assert_eq!(calls(&control).last(), Some(&Call::DisableDevice(0)));
        drop(control);
        let _control = play(&Script::default());
        assert!(open(&section()).is_ok());
    }
}

#[test]
fn a_scheduler_that_never_calls_or_calls_no_more_is_an_error() {
    let in_order = |control: &Control, error: DeviceError| {
        assert_eq!(error, DEAD);
        let log = calls(control);
        let end = place(&log, |call| *call == Call::Stop);
        assert!(matches!(
            log[end + 1..],
            [Call::Unschedule(_), Call::DisableDevice(0)]
        ));
    };
    let control = play(&Script {
        scheduler: Scheduler::Dead,
        ..pressed()
    });
    in_order(&control, end(serve()));
    drop(control);
    let control = play(&pressed());
    in_order(&control, lost(&control, &Event::Stall));
}

#[test]
fn a_device_that_says_no_place_gives_no_force_and_is_lost_in_the_end() {
    let control = play(&pressed());
    let error = lost(&control, &Event::Axes([[0.0; 3]; 3]));
    assert_eq!(error, UNREADABLE);
    let log = calls(&control);
    let forces = forces(&log);
    let without = forces.iter().rev();
    let without = without.take_while(|force| **force == DVec3::ZERO).count();
    // Over the first few, which may be chance, the force is held.
    assert!((990..=1000).contains(&without), "{without}");
    assert!(forces[forces.len() - 1001].z > 0.39);
    assert_eq!(disorder(&log), None);
}
