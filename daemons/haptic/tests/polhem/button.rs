//! A stylus' button where it matters: as a clutch under the servo, and in a hand that shows places.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use glam::DVec3;
use maulstick_device::corner_calibration::{HandReading, Touch};
use maulstick_device::registration::{Registration, Similarity};
use maulstick_haptic::MountedDevice;
use maulstick_haptic::device::driver::Opened;
use maulstick_haptic::device::probe::probe;
use maulstick_haptic::drivers::polhem::Polhem;
use maulstick_haptic::drivers::polhem::frame::Length;
use maulstick_haptic::servo::clock::MonotonicClock;
use maulstick_haptic::servo::force_control::ForceControl;
use maulstick_haptic::servo::{
    channels::{Channels, Delivery, TickRecord},
    servo_loop::{PreviousServo, ServoLoop},
};
use maulstick_haptics::{Limits, ServoMemory};

use super::bench::Cable;
use super::firmware::{Firmware, Reads, Style};

/// Encoder d, which tells the button.
const PRESSED: i16 = 10_042;
const RELEASED: i16 = 42;

fn cable() -> Cable {
    Cable::to(Firmware::new(Style::Double, Reads::Lines))
}

/// Ticks until a record is as wanted.
fn until(
    servo: &mut ServoLoop,
    told: &mut rtrb::Consumer<TickRecord>,
    mut is_wanted: impl FnMut(&TickRecord) -> bool,
) -> bool {
    let give_up = Instant::now() + Duration::from_secs(20);
    while Instant::now() < give_up {
        assert!(servo.tick(0).is_continue(), "{:?}", servo.error());
        while let Ok(record) = told.pop() {
            if is_wanted(&record) {
                return true;
            }
        }
        std::thread::yield_now();
    }
    false
}

#[test]
fn a_clutch_at_the_button_holds_for_as_long_as_it_is_pressed() {
    let cable = cable();
    let press = |d| cable.bench().firmware.encoders[3] = d;
    let registration = Registration {
        to_desk: Similarity::IDENTITY,
        ferrule_m: DVec3::ZERO,
        corners: None,
    };
    let polhem = Polhem::new(cable.clone(), Length::Short);
    let placed = MountedDevice::new(Box::new(polhem), registration, 1);
    let (ticks, mut told) = rtrb::RingBuffer::new(64);
    let (_, models) = triple_buffer::triple_buffer(&Delivery::default());
    let (_, guides) = triple_buffer::triple_buffer(&Delivery::default());
    let (_, fluids) = triple_buffer::triple_buffer(&Delivery::default());
    let (_, controls) = triple_buffer::triple_buffer(&ForceControl::default());
    let channels = Channels {
        ticks,
        models,
        guides,
        fluids,
        controls,
        stop: std::sync::Arc::default(),
        dropped: std::sync::Arc::default(),
    };
    let limits = Limits::default();
    let previous = PreviousServo {
        memory: ServoMemory::fresh(limits),
        rearms: 0,
    };
    let mut servo = ServoLoop::new(placed, limits, previous, channels);

    press(RELEASED);
    assert!(until(&mut servo, &mut told, |record| record
        .reading
        .in_range));
    press(PRESSED);
    assert!(until(&mut servo, &mut told, |record| !record
        .reading
        .in_range));
    // Many times as long as the button is left unasked.
    let mut since_ns = None;
    assert!(until(&mut servo, &mut told, |record| {
        assert!(!record.reading.in_range && record.reading.switches == 1);
        record.monotonic_ns - *since_ns.get_or_insert(record.monotonic_ns) > 400_000_000
    }));
    press(RELEASED);
    assert!(until(&mut servo, &mut told, |record| record
        .reading
        .in_range));
}

fn opened(cable: &Cable) -> Opened {
    Opened {
        driver: Box::new(Polhem::new(cable.clone(), Length::Short)),
        clock: Box::new(MonotonicClock),
        what: String::new(),
    }
}

#[test]
fn a_hand_that_shows_a_place_is_seen_to_press() {
    let cable = cable();
    cable.bench().firmware.encoders[3] = PRESSED;
    let give_up = Instant::now() + Duration::from_secs(20);
    let mut is_seen = false;
    let probed = probe(opened(&cable), DVec3::ZERO, |reading| {
        is_seen |= matches!(reading, HandReading::Sample(seen) if seen.touch == Touch::Down);
        if is_seen || Instant::now() > give_up {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    assert_eq!((probed, is_seen), (Ok(()), true));
}

#[test]
fn a_panic_of_the_caller_ends_the_probe() {
    let probed = catch_unwind(AssertUnwindSafe(|| {
        probe(opened(&cable()), DVec3::ZERO, |_| {
            panic!("the seeded fault")
        })
    }));
    assert!(probed.is_err());
}
