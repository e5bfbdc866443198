//! A stylus' button where it matters: as a clutch under the servo, and in a hand that shows places.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use glam::DVec3;
use maulstick_device::corners::{Glimpse, Touch};
use maulstick_device::fitting::{Fitting, Similarity};
use maulstick_haptic::Placed;
use maulstick_haptic::beat::{Beat, Before, Channels, Delivery, Ticked};
use maulstick_haptic::driver::Opened;
use maulstick_haptic::pace::OwnClock;
use maulstick_haptic::polhem::Polhem;
use maulstick_haptic::polhem::frame::Length;
use maulstick_haptic::showing::watch;
use maulstick_haptic::wish::Wish;
use maulstick_haptics::{Kept, Limits};

use super::bench::Cable;
use super::firmware::{Firmware, Reads, Style};

/// Encoder d, which tells the button.
const PRESSED: i16 = 10_042;
const RELEASED: i16 = 42;

fn cable() -> Cable {
    Cable::to(Firmware::new(Style::Double, Reads::Lines))
}

/// Beats until a tick is as it is wanted.
fn until(
    beat: &mut Beat,
    told: &mut rtrb::Consumer<Ticked>,
    mut is_wanted: impl FnMut(&Ticked) -> bool,
) -> bool {
    let give_up = Instant::now() + Duration::from_secs(20);
    while Instant::now() < give_up {
        assert!(beat.beat(0).is_continue(), "{:?}", beat.trouble());
        while let Ok(ticked) = told.pop() {
            if is_wanted(&ticked) {
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
    let fitting = Fitting {
        to_desk: Similarity::IDENTITY,
        ferrule_m: DVec3::ZERO,
        corners: None,
    };
    let polhem = Polhem::new(cable.clone(), Length::Short);
    let placed = Placed::new(Box::new(polhem), fitting, 1);
    let (ticks, mut told) = rtrb::RingBuffer::new(64);
    let (_, models) = triple_buffer::triple_buffer(&Delivery::default());
    let (_, wishes) = triple_buffer::triple_buffer(&Wish::default());
    let channels = Channels {
        ticks,
        models,
        wishes,
        stop: std::sync::Arc::default(),
        dropped: std::sync::Arc::default(),
    };
    let limits = Limits::default();
    let before = Before {
        kept: Kept::nothing(limits),
        armings: 0,
    };
    let mut beat = Beat::new(placed, limits, before, channels);

    press(RELEASED);
    assert!(until(&mut beat, &mut told, |ticked| ticked
        .reading
        .in_range));
    press(PRESSED);
    assert!(until(&mut beat, &mut told, |ticked| !ticked
        .reading
        .in_range));
    // Many times as long as the button is left unasked.
    let mut since_ns = None;
    assert!(until(&mut beat, &mut told, |ticked| {
        assert!(!ticked.reading.in_range && ticked.reading.switches == 1);
        ticked.monotonic_ns - *since_ns.get_or_insert(ticked.monotonic_ns) > 400_000_000
    }));
    press(RELEASED);
    assert!(until(&mut beat, &mut told, |ticked| ticked
        .reading
        .in_range));
}

fn opened(cable: &Cable) -> Opened {
    Opened {
        driver: Box::new(Polhem::new(cable.clone(), Length::Short)),
        pace: Box::new(OwnClock),
        what: String::new(),
    }
}

#[test]
fn a_hand_that_shows_a_place_is_seen_to_press() {
    let cable = cable();
    cable.bench().firmware.encoders[3] = PRESSED;
    let give_up = Instant::now() + Duration::from_secs(20);
    let mut is_seen = false;
    let watched = watch(opened(&cable), DVec3::ZERO, |glimpse| {
        is_seen |= matches!(glimpse, Glimpse::Seen(seen) if seen.touch == Touch::Down);
        match is_seen || Instant::now() > give_up {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    });
    assert_eq!((watched, is_seen), (Ok(()), true));
}

#[test]
fn whoever_looks_and_panics_ends_the_watching() {
    let watched = catch_unwind(AssertUnwindSafe(|| {
        watch(opened(&cable()), DVec3::ZERO, |_| {
            panic!("the seeded fault")
        })
    }));
    assert!(watched.is_err());
}
