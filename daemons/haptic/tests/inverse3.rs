//! The driver of Haply's Inverse3 against a service that speaks as Haply's does, or does not.

#[path = "../../../sim/num/tests/counting/mod.rs"]
mod counting;
#[path = "inverse3/messages.rs"]
mod messages;
#[path = "inverse3/misbehaving.rs"]
mod misbehaving;
#[path = "inverse3/service.rs"]
mod service;
mod wall;

use std::time::{Duration, Instant};

use counting::allocations;
use glam::DVec3;
use maulstick_haptic::device::driver::{DeviceError, Driver, Reading, Wrench};
use maulstick_haptic::drivers::inverse3::address::Address;
use maulstick_haptic::drivers::inverse3::connect_error::Refusal;
use maulstick_haptic::drivers::inverse3::{self, Inverse3};
use maulstick_haptics::Switch;
use maulstick_rig::config::DeviceSection;
use maulstick_types::stylus::axes;
use serde_json::{Value, json};
use service::{Act, Service, inventory, old_inventory, state, update};

/// Waits until `look` has it; None where that takes too long.
fn wait_for<T>(mut look: impl FnMut() -> Option<T>) -> Option<T> {
    let give_up = Instant::now() + Duration::from_secs(20);
    while Instant::now() < give_up {
        if let Some(seen) = look() {
            return Some(seen);
        }
        std::thread::yield_now();
    }
    None
}

fn at(address: &str) -> DeviceSection {
    DeviceSection {
        address: Some(address.to_owned()),
        ..DeviceSection::new("stylus", "inverse3", "round")
    }
}

fn opened(address: &str) -> Box<dyn Driver> {
    inverse3::open(&at(address)).expect("an Inverse3").driver
}

/// The reason why no device is connected to.
fn refusal(address: &str) -> Refusal {
    let address = Address::read(Some(address)).expect("an address");
    let error = Inverse3::connect(&address)
        .map(|_| ())
        .expect_err("refused");
    assert_eq!(error.url, address.url);
    error.refusal
}

fn push(force: DVec3) -> Wrench {
    Wrench {
        force,
        torque: DVec3::ZERO,
    }
}

/// The next reading.
fn reading(driver: &mut dyn Driver) -> Result<Option<Reading>, DeviceError> {
    let read = wait_for(|| driver.read(1e-3).transpose());
    read.transpose()
}

/// Beats with a force until `look` has seen enough.
fn run_ticks<T>(
    driver: &mut dyn Driver,
    force: DVec3,
    mut look: impl FnMut() -> Option<T>,
) -> Option<T> {
    wait_for(|| {
        driver.read(1e-3).expect("there");
        driver.write(push(force)).expect("there");
        look()
    })
}

/// A service that always tells the same state of the device 049D.
fn steady(first: Value) -> Service {
    Service::start(Act::Say(first), |_| Act::Say(update("049D", state())))
}

fn force(commands: &Value, dialect: &str) -> Option<[f64; 3]> {
    let parts = &commands["set_cursor_force"][dialect];
    Some([
        parts["x"].as_f64()?,
        parts["y"].as_f64()?,
        parts["z"].as_f64()?,
    ])
}

#[test]
fn states_are_read_and_forces_arrive_in_the_services_axes() {
    // Device (1, 2, 3) is Haply's (1, −3, 2).
    for (permutation, expected) in [
        ("XYZ", [1.0, -3.0, 2.0]),
        ("XZ-Y", [1.0, 2.0, 3.0]),
        ("X-YZ", [1.0, 3.0, 2.0]),
        ("ZXY", [2.0, 1.0, -3.0]),
    ] {
        let mut first = inventory();
        first["inverse3"][0]["config"]["basis"]["permutation"] = json!(permutation);
        let service = steady(first);
        let mut driver = opened(&service.url);
        let arrived = run_ticks(&mut *driver, DVec3::new(1.0, 2.0, 3.0), || {
            let heard = service.heard();
            let force = force(heard.newest("049D")?, "vector")?;
            (force == expected).then_some(())
        });
        assert_eq!(arrived, Some(()), "{permutation}");
    }
    let service = steady(inventory());
    let mut driver = opened(&service.url);
    let read = reading(&mut *driver).expect("there").expect("new");
    assert_eq!(read.handle.position, DVec3::new(0.01, 0.15, 0.12));
    assert_eq!(read.handle.velocity, DVec3::new(0.1, 0.3, -0.2));
    assert_eq!((read.switches, read.in_range), (0b101, true));
    let able = driver.abilities();
    assert!(able.senses & axes::ORIENTATION != 0 && able.max_force_n == 10.0);
}

#[test]
fn a_servo_pushes_a_device_out_of_a_wall_and_leaves_no_force() {
    // 21 mm toward the user: a head of 25 mm is 4 mm deep in a wall of 100 N/m.
    let deep = || {
        let mut deep = inventory();
        deep["inverse3"][0]["state"] = json!({
            "cursor_position": { "x": 0.01, "y": -0.021, "z": 0.15 },
            "cursor_velocity": { "x": 0, "y": 0, "z": 0 }
        });
        deep
    };
    let service = Service::start(Act::Say(deep()), move |_| Act::Say(deep()));
    let newest = || force(service.heard().newest("049D")?, "vector");
    let felt = || newest().is_some_and(|[x, y, z]| x == 0.0 && z == 0.0 && (y + 0.4).abs() < 1e-9);
    assert!(wall::push(&at(&service.url), felt));
    let closed = wait_for(|| service.heard().closed.then_some(()));
    assert_eq!((closed, newest()), (Some(()), Some([0.0; 3])));
}

#[test]
fn a_service_before_3_5_is_spoken_to_as_it_wants() {
    let service = Service::start(Act::Say(old_inventory()), |_| {
        Act::Say(update("04BA", state()))
    });
    let mut driver = opened(&service.url);
    let heard = |driver: &mut dyn Driver, wanted: [f64; 3]| {
        run_ticks(driver, DVec3::new(0.0, 0.5, 0.0), || {
            let heard = service.heard();
            (force(heard.newest("04BA")?, "values")? == wanted).then_some(())
        })
    };
    assert_eq!(heard(&mut *driver, [0.0, 0.0, 0.5]), Some(()));
    driver.switch(Switch::Off);
    assert_eq!(heard(&mut *driver, [0.0; 3]), Some(()));
}

#[test]
fn amplifiers_that_rest_are_told_so_by_no_force_in_the_tick_that_rests() {
    let service = steady(inventory());
    let mut driver = opened(&service.url);
    let comes = |wanted: [f64; 3]| {
        let newest = force(service.heard().newest("049D")?, "vector")?;
        (newest == wanted).then_some(())
    };
    let pushed = [1.0, 0.0, 0.0];
    assert_eq!(
        run_ticks(&mut *driver, DVec3::X, || comes(pushed)),
        Some(())
    );
    driver.write(Wrench::ZERO).expect("there");
    driver.switch(Switch::Off);
    assert_eq!(wait_for(|| comes([0.0; 3])), Some(()));
    assert_eq!(
        run_ticks(&mut *driver, DVec3::X, || comes([0.0; 3])),
        Some(())
    );
    driver.switch(Switch::On);
    assert_eq!(
        run_ticks(&mut *driver, DVec3::X, || comes(pushed)),
        Some(())
    );
}

#[test]
fn a_grip_is_told_of_also_while_amplifiers_rest() {
    let handle = |pressed: bool| {
        let mut handle = inventory();
        handle["wireless_verse_grip"] = json!([]);
        handle["verse_grip"] = json!([{ "device_id": "12", "state": { "button": pressed } }]);
        handle
    };
    let service = Service::start(Act::Say(handle(false)), move |count| {
        Act::Say(handle(count > 50))
    });
    let mut driver = opened(&service.url);
    driver.switch(Switch::Off);
    let pressed = wait_for(|| {
        let read = driver.read(1e-3).expect("there")?;
        (read.switches == 1).then_some(())
    });
    assert_eq!(pressed, Some(()));
}

#[test]
fn a_force_that_is_not_answered_is_taken_back_once_and_comes_again_with_the_answers() {
    // The answer to the force comes too late, with that to what took it back.
    let service = Service::start(Act::Say(inventory()), |count| match count {
        50 => Act::Rest,
        51 => Act::Twice(update("049D", state())),
        _ => Act::Say(update("049D", state())),
    });
    let mut driver = opened(&service.url);
    let done = || (service.heard().messages.len() > 300).then_some(());
    assert_eq!(run_ticks(&mut *driver, DVec3::X, done), Some(()));
    let heard = service.heard();
    let told = |count: usize| {
        let commands = &heard.messages[count]["inverse3"][0]["commands"];
        force(commands, "vector").expect("a force")
    };
    assert!((50..54).any(|count| told(count) == [0.0; 3]));
    assert!((52..300).any(|count| told(count) == [1.0, 0.0, 0.0]));
}

#[test]
fn a_device_gives_the_force_of_its_kind_and_one_that_nobody_knows_the_least() {
    for (kind, newtons) in [("inverse3", 10.0), ("minverse", 3.0), ("inverse9", 3.0)] {
        let mut first = inventory();
        first["inverse3"][0]["config"]["type"] = json!(kind);
        let service = steady(first);
        let mut driver = opened(&service.url);
        let able = driver.abilities();
        assert_eq!(able.max_force_n, newtons, "{kind}");
        assert!((able.continuous_force_n - 0.3 * newtons).abs() < 1e-12);
        let cut = run_ticks(&mut *driver, DVec3::X * 100.0, || {
            let newest = force(service.heard().newest("049D")?, "vector")?;
            (newest == [newtons, 0.0, 0.0]).then_some(())
        });
        assert_eq!(cut, Some(()), "{kind}");
    }
}

#[test]
fn a_force_beyond_the_devices_is_cut_to_it_and_one_that_is_no_number_is_none() {
    let service = steady(inventory());
    let mut driver = opened(&service.url);
    let mut arrives = |asked: DVec3, wanted: [f64; 3]| {
        run_ticks(&mut *driver, asked, || {
            let got = force(service.heard().newest("049D")?, "vector")?;
            let off = got.iter().zip(wanted).map(|(a, b)| (a - b).abs());
            (off.fold(0.0, f64::max) < 1e-9).then_some(())
        })
    };
    assert_eq!(arrives(DVec3::X * 4.0, [4.0, 0.0, 0.0]), Some(()));
    assert_eq!(
        arrives(DVec3::new(30.0, 40.0, 0.0), [6.0, 0.0, 8.0]),
        Some(())
    );
    assert_eq!(arrives(DVec3::new(f64::NAN, 1.0, 0.0), [0.0; 3]), Some(()));
}

#[test]
fn a_force_that_is_not_renewed_is_none() {
    let service = steady(inventory());
    let mut driver = opened(&service.url);
    let newest = || force(service.heard().newest("049D")?, "vector");
    let pushed = || (newest()? == [1.0, 0.0, 0.0]).then_some(());
    assert_eq!(run_ticks(&mut *driver, DVec3::X, pushed), Some(()));
    assert_eq!(wait_for(|| (newest()? == [0.0; 3]).then_some(())), Some(()));
}

#[test]
fn the_last_word_is_no_force_and_then_the_connection_is_closed() {
    let service = steady(inventory());
    let mut driver = opened(&service.url);
    let pushed = || (force(service.heard().newest("049D")?, "vector")? != [0.0; 3]).then_some(());
    assert_eq!(run_ticks(&mut *driver, DVec3::Y, pushed), Some(()));
    drop(driver);
    assert_eq!(wait_for(|| service.heard().closed.then_some(())), Some(()));
    let last = service
        .heard()
        .newest("049D")
        .and_then(|c| force(c, "vector"));
    assert_eq!(last, Some([0.0; 3]));
}

#[test]
fn the_last_word_is_no_force_also_where_the_service_has_gone_silent() {
    let service = Service::start(Act::Say(inventory()), |count| match count {
        0..50 => Act::Say(update("049D", state())),
        _ => Act::Rest,
    });
    let mut driver = opened(&service.url);
    let silent = wait_for(|| {
        driver.write(push(DVec3::X)).expect("there");
        (service.heard().messages.len() > 50).then_some(())
    });
    assert_eq!(silent, Some(()));
    drop(driver);
    let last = || {
        service
            .heard()
            .newest("049D")
            .and_then(|c| force(c, "vector"))
    };
    assert_eq!(wait_for(|| service.heard().closed.then_some(())), Some(()));
    assert_eq!(last(), Some([0.0; 3]));
}

#[test]
fn of_two_devices_the_one_that_is_named_is_read_and_pushed() {
    let two = |z: f64| {
        let mut message = update("049D", state());
        let mut other = state();
        other["cursor_position"]["z"] = json!(z);
        let other = update("0AAA", other)["inverse3"][0].clone();
        message["inverse3"]
            .as_array_mut()
            .expect("a list")
            .push(other);
        message
    };
    let mut first = two(0.25);
    first["session_id"] = json!(1);
    let service = Service::start(Act::Say(first), move |_| Act::Say(two(0.25)));
    let several = refusal(&service.url);
    let there = ["049D", "0AAA"].map(str::to_owned).to_vec();
    assert_eq!(several, Refusal::Several(there.clone()));
    let unknown = refusal(&format!("{}#0BBB", service.url));
    let no_device = Refusal::NoDevice("0BBB".to_owned(), there);
    assert_eq!(unknown, no_device);
    let grip = refusal(&format!("{}#0AAA+9", service.url));
    let no_grip = Refusal::NoGrip("9".to_owned(), vec!["61548".to_owned()]);
    assert_eq!(grip, no_grip);

    let mut driver = opened(&format!("{}#0AAA+61548", service.url));
    let read = reading(&mut *driver).expect("there").expect("new");
    assert_eq!(read.handle.position.y, 0.25);
    let pushed = || (force(service.heard().newest("0AAA")?, "vector")? != [0.0; 3]).then_some(());
    assert_eq!(run_ticks(&mut *driver, DVec3::Y, pushed), Some(()));
    let asked_of = |message: &Value| message["inverse3"][0]["device_id"].clone();
    assert!(
        service
            .heard()
            .messages
            .iter()
            .all(|message| asked_of(message) == "0AAA")
    );
}

#[test]
fn a_state_of_long_ago_is_nothing_new() {
    let service = Service::start(Act::Say(inventory()), |count| match count {
        0 => Act::Say(update("049D", state())),
        _ => Act::Rest,
    });
    let silent = || {
        let heard = service.heard();
        let last = heard.last?;
        (heard.messages.len() == 3 && last.elapsed() > Duration::from_millis(60)).then_some(())
    };
    let mut driver = opened(&service.url);
    assert_eq!(wait_for(silent), Some(()));
    // Its only state came, as the next question shows, and has never been read.
    assert!(!matches!(driver.read(1e-3), Ok(Some(_))));
}

#[test]
fn without_a_grip_there_is_no_orientation_and_without_velocities_they_are_found() {
    let still = |x: f64| {
        json!({ "inverse3": [{ "device_id": "049D", "state": {
            "cursor_position": { "x": x, "y": 0.0, "z": 0.1 } } }] })
    };
    let service = Service::start(Act::Say(still(0.0)), move |count| {
        Act::Say(still(1e-6 * count.min(900_000) as f64))
    });
    let mut driver = opened(&service.url);
    assert_eq!(driver.abilities().senses, axes::POSITION | axes::VELOCITY);
    let mut before = None;
    for _ in 0..50 {
        let read = reading(&mut *driver).expect("there").expect("new");
        assert!(before.is_none_or(|x| x < read.handle.position.x));
        before = Some(read.handle.position.x);
        if before.is_some_and(|x| x > 0.0) && read.handle.velocity.x > 0.0 {
            return;
        }
    }
    panic!("no velocity");
}

#[test]
fn reading_and_writing_allocate_nothing() {
    let service = steady(inventory());
    let mut driver = opened(&service.url);
    let (mut ticks, mut counted) = (0, 0);
    let done = wait_for(|| {
        let mut came = false;
        counted += allocations(|| {
            came = driver.read(1e-3).is_ok_and(|reading| reading.is_some());
            driver.write(push(DVec3::X)).ok();
            driver.switch(Switch::On);
        });
        ticks += usize::from(came);
        (ticks == 200).then_some(())
    });
    assert_eq!((done, counted), (Some(()), 0));
    assert!(allocations(|| drop(std::hint::black_box(Box::new(1)))) > 0);
}
