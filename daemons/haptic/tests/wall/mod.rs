//! A servo over a device as a rig opens it by the name of its driver, at a wall.

use std::time::{Duration, Instant};

use maulstick_device::registration::Registration;
use maulstick_haptic::MountedDevice;
use maulstick_haptic::device::open::{HapticSettings, open};
use maulstick_haptic::servo::channels::Delivery;
use maulstick_haptic::servo::servo_thread::ServoThread;
use maulstick_haptics::Limits;
use maulstick_haptics::contact::Contact;
use maulstick_rig::RigConfig;
use maulstick_rig::config::DeviceSection;
use maulstick_types::haptics::{ContactModel, ForceLaw};

/// A rigid wall of 100 N/m at z = 0, for a head of 25 mm.
fn wall() -> Contact {
    let law = ForceLaw::Rigid {
        stiffness_n_m: 100.0,
    };
    let mut wall = Contact::new(&ContactModel::bare(law, 0.025)).expect("a model");
    // Nobody sends it again.
    wall.time_to_live_s = f64::INFINITY;
    wall
}

/// Opens the device, holds it at the wall, and waits until `is_felt`; then ends the servo.
pub(crate) fn push(device: &DeviceSection, mut is_felt: impl FnMut() -> bool) -> bool {
    let settings = HapticSettings {
        device: device.clone(),
        hand: None,
    };
    let config = RigConfig::default();
    let opened = open(&config, &settings).expect("the device");
    // However late the ticks of a busy machine come, and deep in the wall, the force comes up.
    let limits = Limits {
        engage_n: f64::MAX,
        engage_s: 1e-3,
        longest_tick_s: 1e3,
        ..Limits::default()
    };
    let registration = Registration::of(device, &config.canvas).expect("a registration");
    let placed = MountedDevice::new(opened.driver, registration, 0);
    let mut servo = ServoThread::start(placed, opened.clock, limits).expect("started");
    servo.models.write(Delivery {
        model: Some(wall()),
        sender: None,
        number: 1,
    });
    let give_up = Instant::now() + Duration::from_secs(20);
    while Instant::now() < give_up && !servo.has_ended() {
        if is_felt() {
            return true;
        }
        while servo.ticks.pop().is_ok() {}
        std::thread::yield_now();
    }
    false
}
