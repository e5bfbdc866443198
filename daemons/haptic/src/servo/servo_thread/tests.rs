//! The servo's thread over devices that misbehave.

use std::time::{Duration, Instant};

use glam::{DQuat, DVec3};
use maulstick_device::registration::{Registration, Similarity};
use maulstick_haptics::Switch;
use maulstick_haptics::contact::{Contact, HandleState};
use maulstick_num::geometry::{Rigid, canonical, rotation};
use maulstick_types::haptics::{ContactModel, ForceLaw};

use super::*;
use crate::device::driver::{Abilities, Driver, Reading, Wrench};
use crate::drivers::simulated::Simulated;
use crate::servo::clock::MonotonicClock;

mod forces;

#[test]
fn bins_double() {
    assert_eq!(
        (bin(0), bin(49_999), bin(50_000), bin(99_999), bin(100_000)),
        (0, 0, 1, 1, 2)
    );
    assert_eq!(bin(u64::MAX), BINS - 1);
}

/// A device that stands somewhere, with the point that it senses as its ferrule.
fn placed(device: impl Driver + 'static, rigid: Rigid, scale: f64) -> MountedDevice {
    let registration = Registration {
        to_desk: Similarity { rigid, scale },
        ferrule_m: DVec3::ZERO,
        corners: None,
    };
    MountedDevice::new(Box::new(device), registration, 0)
}

/// A servo on our own clock.
fn start(device: MountedDevice, limits: Limits) -> ServoThread {
    ServoThread::start(device, Box::new(MonotonicClock), limits).expect("started")
}

/// The first tick that `look` accepts.
fn tick(servo: &mut ServoThread, mut look: impl FnMut(&TickRecord) -> bool) -> Option<TickRecord> {
    let give_up = Instant::now() + Duration::from_secs(20);
    while Instant::now() < give_up {
        while let Ok(record) = servo.ticks.pop() {
            if look(&record) {
                return Some(record);
            }
        }
        std::thread::yield_now();
    }
    None
}

#[test]
fn the_servo_ticks_and_its_ticks_come_out_in_order() {
    let device = placed(Simulated::at_rest(), Rigid::IDENTITY, 1.0);
    let mut servo = start(device, Limits::default());
    let (mut count, mut last_ns) = (0, 0);
    let enough = tick(&mut servo, |record| {
        assert!(record.monotonic_ns > last_ns);
        last_ns = record.monotonic_ns;
        count += 1;
        count == 200
    });
    assert!(enough.is_some());
}

#[test]
fn ticks_that_do_not_fit_are_counted() {
    let device = placed(Simulated::at_rest(), Rigid::IDENTITY, 1.0);
    let limits = Limits::default();
    let previous = PreviousServo {
        memory: ServoMemory::fresh(limits),
        rearms: 0,
    };
    let mut servo = ServoThread::with_ring(device, Box::new(MonotonicClock), limits, previous, 4)
        .expect("started");
    let give_up = Instant::now() + Duration::from_secs(20);
    while servo.dropped() < 3 && Instant::now() < give_up {
        std::thread::yield_now();
    }
    assert!(servo.dropped() >= 3);
    assert_eq!(
        std::iter::from_fn(|| servo.ticks.pop().ok())
            .take(4)
            .count(),
        4
    );
}

/// A reading of what is held.
fn at(handle: HandleState) -> Reading {
    Reading {
        handle,
        switches: 0,
        in_range: true,
        is_permitted: true,
        motor_temperature: 0.0,
    }
}

/// A device that stands still and remembers the newest force written to it.
struct Still {
    handle: HandleState,
    written: Arc<[AtomicU64; 3]>,
}

impl Driver for Still {
    fn abilities(&self) -> Abilities {
        Simulated::at_rest().abilities()
    }

    fn read(&mut self, _: f64) -> Result<Option<Reading>, DeviceError> {
        Ok(Some(at(self.handle)))
    }

    fn write(&mut self, wrench: Wrench) -> Result<(), DeviceError> {
        for (cell, part) in self.written.iter().zip(wrench.force.to_array()) {
            cell.store(part.to_bits(), Ordering::Relaxed);
        }
        Ok(())
    }
}

/// A device whose reading fails after a while.
struct Failing(Still, u32);

impl Driver for Failing {
    fn abilities(&self) -> Abilities {
        self.0.abilities()
    }

    fn read(&mut self, dt: f64) -> Result<Option<Reading>, DeviceError> {
        self.1 += 1;
        assert!(self.1 < 100, "the seeded fault");
        self.0.read(dt)
    }

    fn write(&mut self, wrench: Wrench) -> Result<(), DeviceError> {
        // A force that nobody asked for, so that its end shows.
        let asked = Wrench {
            force: DVec3::X,
            ..wrench
        };
        self.0.write(if self.1 < 100 { asked } else { wrench })
    }
}

#[test]
fn a_servo_that_fails_leaves_no_force() {
    let written = Arc::new([const { AtomicU64::new(0) }; 3]);
    let still = Still {
        handle: HandleState {
            position: DVec3::Z,
            orientation: DQuat::IDENTITY,
            velocity: DVec3::ZERO,
        },
        written: Arc::clone(&written),
    };
    let device = placed(Failing(still, 0), Rigid::IDENTITY, 1.0);
    let mut servo = start(device, Limits::default());
    tick(&mut servo, |_| true).expect("a tick");
    if let Some(thread) = servo.thread.take() {
        assert!(thread.join().is_err(), "the servo fails");
    }
    assert_eq!(f64::from_bits(written[0].load(Ordering::Relaxed)), 0.0);
}

/// A device whose place is no number; remembers whether its amplifiers are on.
struct Nowhere(Arc<AtomicBool>);

impl Driver for Nowhere {
    fn abilities(&self) -> Abilities {
        Simulated::at_rest().abilities()
    }

    fn read(&mut self, _: f64) -> Result<Option<Reading>, DeviceError> {
        Ok(Some(at(HandleState {
            position: DVec3::NAN,
            orientation: DQuat::IDENTITY,
            velocity: DVec3::ZERO,
        })))
    }

    fn write(&mut self, wrench: Wrench) -> Result<(), DeviceError> {
        assert_eq!(wrench, Wrench::ZERO);
        Ok(())
    }

    fn switch(&mut self, amplifiers: Switch) {
        self.0.store(amplifiers == Switch::On, Ordering::SeqCst);
    }
}

#[test]
fn a_fault_switches_the_amplifiers_off_and_arming_on_until_the_next() {
    let powered = Arc::new(AtomicBool::new(true));
    let device = placed(Nowhere(Arc::clone(&powered)), Rigid::IDENTITY, 1.0);
    let mut servo = start(device, Limits::default());
    let latched = tick(&mut servo, |record| record.tick.fault.is_some());
    assert!(latched.is_some());
    assert!(tick(&mut servo, |_| !powered.load(Ordering::SeqCst)).is_some());
    let control = ForceControl {
        rearms: 1,
        ..ForceControl::default()
    };
    servo.controls.write(control);
    let again = |record: &TickRecord| record.rearms == 1 && record.tick.fault.is_some();
    assert!(tick(&mut servo, again).is_some());
    assert!(!powered.load(Ordering::SeqCst));
}

#[test]
fn a_fault_outlasts_the_device_until_it_is_armed_anew() {
    let still = || Still {
        handle: HandleState {
            position: DVec3::Z,
            orientation: DQuat::IDENTITY,
            velocity: DVec3::ZERO,
        },
        written: Arc::default(),
    };
    let limits = Limits::default();
    let previous = PreviousServo {
        memory: ServoMemory {
            fault: Some(maulstick_haptics::Fault::Oscillation),
            ..ServoMemory::fresh(limits)
        },
        rearms: 3,
    };
    let device = placed(still(), Rigid::IDENTITY, 1.0);
    let mut servo =
        ServoThread::resume(device, Box::new(MonotonicClock), limits, previous).expect("started");
    let control = |rearms| ForceControl {
        rearms,
        ..ForceControl::default()
    };
    let in_fault = |servo: &mut ServoThread| {
        let mut ticks = 0;
        tick(servo, |record| {
            assert!(record.tick.fault.is_some());
            ticks += 1;
            ticks == 20
        })
        .is_some()
    };
    assert!(in_fault(&mut servo), "no settings have come yet");
    // The settings that the daemon sends to every servo that it starts.
    servo.controls.write(control(3));
    assert!(in_fault(&mut servo));
    servo.controls.write(control(4));
    assert!(tick(&mut servo, |record| record.tick.fault.is_none()).is_some());
}

/// A rigid wall of 100 N/m at the desk's z = 0, for a head of 25 mm.
fn wall() -> Contact {
    let mut wall = Contact::new(&ContactModel {
        viscous_n_s_m: 2.0,
        ..ContactModel::bare(
            ForceLaw::Rigid {
                stiffness_n_m: 100.0,
            },
            0.025,
        )
    })
    .expect("a model");
    // Nobody sends it again.
    wall.time_to_live_s = f64::INFINITY;
    wall
}

/// Difference of two states, m + m/s + rad.
fn apart(one: &HandleState, other: &HandleState) -> f64 {
    (one.position - other.position).length()
        + (one.velocity - other.velocity).length()
        + one.orientation.angle_between(other.orientation)
}

#[test]
fn a_turned_shifted_and_scaled_device_feels_the_desk_where_it_is() {
    // What the hand does on the desk: the tip 4 mm below the wall, sliding along x.
    let on_desk = HandleState {
        position: DVec3::new(0.01, -0.02, 0.021),
        orientation: DQuat::IDENTITY,
        velocity: DVec3::new(0.1, 0.0, 0.0),
    };
    let asked = DVec3::new(-0.2, 0.0, 0.4);
    let turned = Rigid {
        rotation: canonical(rotation(DVec3::new(0.6, 0.0, 0.8), 2.0)),
        translation: DVec3::new(0.3, -0.1, 0.2),
    };
    for (rigid, scale) in [(Rigid::IDENTITY, 1.0), (turned, 1.0), (turned, 2.0)] {
        let to_desk = Similarity { rigid, scale };
        let written = Arc::new([const { AtomicU64::new(0) }; 3]);
        let still = Still {
            handle: HandleState {
                position: to_desk.point_back(on_desk.position),
                orientation: to_desk.turned_back(on_desk.orientation),
                velocity: to_desk.turn_back(on_desk.velocity) / scale,
            },
            written: Arc::clone(&written),
        };
        // However late the ticks of a busy machine come, the force comes up; and this hand cannot come up
        // from the wall first.
        let limits = Limits {
            engage_s: 1e-3,
            engage_n: f64::INFINITY,
            longest_tick_s: 1e3,
            ..Limits::default()
        };
        let mut servo = start(placed(still, rigid, scale), limits.scaled(scale));
        servo.models.write(Delivery {
            model: Some(wall()),
            sender: None,
            number: 1,
        });
        // The tick after the first is there once the force of the first is written.
        let (mut seen, expected) = (0, asked / scale);
        let felt = tick(&mut servo, |record| {
            seen += u32::from((record.force - expected).length() < 1e-12);
            seen == 2
        });
        let felt = felt.expect("the force on the hand");
        let off = apart(&felt.reading.handle, &on_desk);
        assert!(off < 1e-7, "{:?}", felt.reading.handle);
        assert!((felt.tick.cap_n - 3.0).abs() < 1e-12, "the device's own");
        let written = DVec3::from_array(
            [0, 1, 2].map(|i| f64::from_bits(written[i].load(Ordering::Relaxed))),
        );
        assert!(
            (written - to_desk.turn_back(expected)).length() < 1e-12,
            "{written} in the device frame"
        );
    }
}

/// A device whose height, m, and switches a test sets.
#[derive(Clone, Default)]
struct Moved {
    height: Arc<AtomicU64>,
    switches: Arc<AtomicU64>,
}

impl Moved {
    fn put(&self, height: f64, switches: u64) {
        self.height.store(height.to_bits(), Ordering::SeqCst);
        self.switches.store(switches, Ordering::SeqCst);
    }
}

impl Driver for Moved {
    fn abilities(&self) -> Abilities {
        Simulated::at_rest().abilities()
    }

    fn read(&mut self, _: f64) -> Result<Option<Reading>, DeviceError> {
        let switches = self.switches.load(Ordering::SeqCst) as u32;
        let position = DVec3::Z * f64::from_bits(self.height.load(Ordering::SeqCst));
        Ok(Some(Reading {
            switches,
            ..at(HandleState {
                position,
                orientation: DQuat::IDENTITY,
                velocity: DVec3::ZERO,
            })
        }))
    }

    fn write(&mut self, _: Wrench) -> Result<(), DeviceError> {
        Ok(())
    }
}

#[test]
fn a_clutch_in_mid_stroke_takes_the_force_away_until_the_hand_has_come_up() {
    for (clutch, lets_go) in [(1, true), (0, false)] {
        let device = Moved::default();
        let registration = Registration {
            to_desk: Similarity::IDENTITY,
            ferrule_m: DVec3::ZERO,
            corners: None,
        };
        let limits = Limits {
            engage_s: 1e-3,
            longest_tick_s: 1e3,
            ..Limits::default()
        };
        device.put(0.03, 0);
        let placed = MountedDevice::new(Box::new(device.clone()), registration, clutch);
        let mut servo = start(placed, limits);
        servo.models.write(Delivery {
            model: Some(wall()),
            sender: None,
            number: 1,
        });
        let pressed = |record: &TickRecord| (record.force.z - 0.4).abs() < 1e-9;
        let up =
            |record: &TickRecord| !record.tick.waiting && record.reading.handle.position.z > 0.025;
        tick(&mut servo, |record| up(record) && !record.tick.resting).expect("begun");
        device.put(0.021, 0);
        tick(&mut servo, pressed).expect("the wall");
        device.put(0.021, 1);
        let handle = tick(&mut servo, |record| record.reading.switches == 1).expect("a tick");
        if !lets_go {
            assert!(pressed(&handle), "the seeded fault: no clutch");
            continue;
        }
        assert!(handle.force == DVec3::ZERO && handle.tick.resting && !handle.reading.in_range);
        device.put(0.06, 1);
        device.put(0.06, 0);
        let released = |record: &TickRecord| record.reading.switches == 0;
        let on = tick(&mut servo, released).expect("let go");
        assert!(
            (on.reading.handle.position.z - 0.021).abs() < 1e-12,
            "no jump"
        );
        assert!(on.force == DVec3::ZERO && on.tick.waiting && on.reading.in_range);
        // Up by a centimetre, and down again.
        device.put(0.07, 0);
        tick(&mut servo, |record| up(record)).expect("come up");
        device.put(0.06, 0);
        tick(&mut servo, pressed).expect("the wall again");
    }
}
