//! The servo's thread over devices that misbehave.

use std::time::{Duration, Instant};

use glam::{DQuat, DVec3};
use maulstick_device::fitting::{Fitting, Similarity};
use maulstick_haptics::Switch;
use maulstick_haptics::contact::{Contact, Held};
use maulstick_num::geometry::{Rigid, canonical, rotation};
use maulstick_types::haptics::{ContactModel, ForceLaw};

use super::*;
use crate::driver::{Abilities, Driver, Reading, Wrench};
use crate::pace::OwnClock;
use crate::simulated::Simulated;

#[test]
fn bins_double() {
    assert_eq!(
        (bin(0), bin(49_999), bin(50_000), bin(99_999), bin(100_000)),
        (0, 0, 1, 1, 2)
    );
    assert_eq!(bin(u64::MAX), BINS - 1);
}

/// A device that stands somewhere, with the point that it senses as its ferrule.
fn placed(device: impl Driver + 'static, rigid: Rigid, scale: f64) -> Placed {
    let fitting = Fitting {
        to_desk: Similarity { rigid, scale },
        ferrule_m: DVec3::ZERO,
        corners: None,
    };
    Placed::new(Box::new(device), fitting, 0)
}

/// A servo on our own clock.
fn start(device: Placed, limits: Limits) -> Host {
    Host::start(device, Box::new(OwnClock), limits).expect("started")
}

/// The first tick that `look` accepts.
fn tick(host: &mut Host, mut look: impl FnMut(&Ticked) -> bool) -> Option<Ticked> {
    let give_up = Instant::now() + Duration::from_secs(20);
    while Instant::now() < give_up {
        while let Ok(ticked) = host.ticks.pop() {
            if look(&ticked) {
                return Some(ticked);
            }
        }
        std::thread::yield_now();
    }
    None
}

#[test]
fn the_servo_ticks_and_its_ticks_come_out_in_order() {
    let device = placed(Simulated::at_rest(), Rigid::IDENTITY, 1.0);
    let mut host = start(device, Limits::default());
    let (mut count, mut last_ns) = (0, 0);
    let enough = tick(&mut host, |ticked| {
        assert!(ticked.monotonic_ns > last_ns);
        last_ns = ticked.monotonic_ns;
        count += 1;
        count == 200
    });
    assert!(enough.is_some());
}

#[test]
fn ticks_that_do_not_fit_are_counted() {
    let device = placed(Simulated::at_rest(), Rigid::IDENTITY, 1.0);
    let limits = Limits::default();
    let before = Before {
        kept: Kept::nothing(limits),
        armings: 0,
    };
    let mut host = Host::with_ring(device, Box::new(OwnClock), limits, before, 4).expect("started");
    let give_up = Instant::now() + Duration::from_secs(20);
    while host.dropped() < 3 && Instant::now() < give_up {
        std::thread::yield_now();
    }
    assert!(host.dropped() >= 3);
    assert_eq!(
        std::iter::from_fn(|| host.ticks.pop().ok()).take(4).count(),
        4
    );
}

/// A reading of what is held.
fn at(held: Held) -> Reading {
    Reading {
        held,
        switches: 0,
        in_range: true,
        is_permitted: true,
        motor_temperature: 0.0,
    }
}

/// A device that stands still and remembers the newest force written to it.
struct Still {
    held: Held,
    written: Arc<[AtomicU64; 3]>,
}

impl Driver for Still {
    fn abilities(&self) -> Abilities {
        Simulated::at_rest().abilities()
    }

    fn read(&mut self, _: f64) -> Result<Option<Reading>, Trouble> {
        Ok(Some(at(self.held)))
    }

    fn write(&mut self, wrench: Wrench) -> Result<(), Trouble> {
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

    fn read(&mut self, dt: f64) -> Result<Option<Reading>, Trouble> {
        self.1 += 1;
        assert!(self.1 < 100, "the seeded fault");
        self.0.read(dt)
    }

    fn write(&mut self, wrench: Wrench) -> Result<(), Trouble> {
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
        held: Held {
            position: DVec3::Z,
            orientation: DQuat::IDENTITY,
            velocity: DVec3::ZERO,
        },
        written: Arc::clone(&written),
    };
    let device = placed(Failing(still, 0), Rigid::IDENTITY, 1.0);
    let mut host = start(device, Limits::default());
    tick(&mut host, |_| true).expect("a tick");
    if let Some(thread) = host.thread.take() {
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

    fn read(&mut self, _: f64) -> Result<Option<Reading>, Trouble> {
        Ok(Some(at(Held {
            position: DVec3::NAN,
            orientation: DQuat::IDENTITY,
            velocity: DVec3::ZERO,
        })))
    }

    fn write(&mut self, wrench: Wrench) -> Result<(), Trouble> {
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
    let mut host = start(device, Limits::default());
    let latched = tick(&mut host, |ticked| ticked.tick.fault.is_some());
    assert!(latched.is_some());
    assert!(tick(&mut host, |_| !powered.load(Ordering::SeqCst)).is_some());
    let wish = Wish {
        armings: 1,
        ..Wish::default()
    };
    host.wishes.write(wish);
    let again = |ticked: &Ticked| ticked.armings == 1 && ticked.tick.fault.is_some();
    assert!(tick(&mut host, again).is_some());
    assert!(!powered.load(Ordering::SeqCst));
}

#[test]
fn a_fault_outlasts_the_device_until_it_is_armed_anew() {
    let still = || Still {
        held: Held {
            position: DVec3::Z,
            orientation: DQuat::IDENTITY,
            velocity: DVec3::ZERO,
        },
        written: Arc::default(),
    };
    let limits = Limits::default();
    let before = Before {
        kept: Kept {
            fault: Some(maulstick_haptics::Fault::Shaking),
            ..Kept::nothing(limits)
        },
        armings: 3,
    };
    let device = placed(still(), Rigid::IDENTITY, 1.0);
    let mut host = Host::resume(device, Box::new(OwnClock), limits, before).expect("started");
    let wish = |armings| Wish {
        armings,
        ..Wish::default()
    };
    let in_fault = |host: &mut Host| {
        let mut ticks = 0;
        tick(host, |ticked| {
            assert!(ticked.tick.fault.is_some());
            ticks += 1;
            ticks == 20
        })
        .is_some()
    };
    assert!(in_fault(&mut host), "nobody has wished anything yet");
    // What the daemon wishes of every servo that it starts.
    host.wishes.write(wish(3));
    assert!(in_fault(&mut host));
    host.wishes.write(wish(4));
    assert!(tick(&mut host, |ticked| ticked.tick.fault.is_none()).is_some());
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

#[test]
fn a_turned_shifted_and_scaled_device_feels_the_desk_where_it_is() {
    // What the hand does on the desk: the tip 4 mm below the wall, sliding along x.
    let on_desk = Held {
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
            held: Held {
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
        let mut host = start(placed(still, rigid, scale), limits.scaled(scale));
        host.models.write(Delivery {
            contact: Some(wall()),
            sender: None,
            number: 1,
        });
        // The tick after the first is there once the force of the first is written.
        let (mut seen, expected) = (0, asked / scale);
        let felt = tick(&mut host, |ticked| {
            seen += u32::from((ticked.force - expected).length() < 1e-12);
            seen == 2
        });
        let felt = felt.expect("the force on the hand");
        let off = (felt.reading.held.position - on_desk.position).length()
            + (felt.reading.held.velocity - on_desk.velocity).length()
            + felt
                .reading
                .held
                .orientation
                .angle_between(on_desk.orientation);
        assert!(off < 1e-7, "{:?}", felt.reading.held);
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

    fn read(&mut self, _: f64) -> Result<Option<Reading>, Trouble> {
        let switches = self.switches.load(Ordering::SeqCst) as u32;
        let position = DVec3::Z * f64::from_bits(self.height.load(Ordering::SeqCst));
        Ok(Some(Reading {
            switches,
            ..at(Held {
                position,
                orientation: DQuat::IDENTITY,
                velocity: DVec3::ZERO,
            })
        }))
    }

    fn write(&mut self, _: Wrench) -> Result<(), Trouble> {
        Ok(())
    }
}

#[test]
fn a_clutch_in_mid_stroke_takes_the_force_away_until_the_hand_has_come_up() {
    for (clutch, lets_go) in [(1, true), (0, false)] {
        let device = Moved::default();
        let fitting = Fitting {
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
        let placed = Placed::new(Box::new(device.clone()), fitting, clutch);
        let mut host = start(placed, limits);
        host.models.write(Delivery {
            contact: Some(wall()),
            sender: None,
            number: 1,
        });
        let pressed = |ticked: &Ticked| (ticked.force.z - 0.4).abs() < 1e-9;
        let up = |ticked: &Ticked| !ticked.tick.waiting && ticked.reading.held.position.z > 0.025;
        tick(&mut host, |ticked| up(ticked) && !ticked.tick.resting).expect("begun");
        device.put(0.021, 0);
        tick(&mut host, pressed).expect("the wall");
        device.put(0.021, 1);
        let held = tick(&mut host, |ticked| ticked.reading.switches == 1).expect("a tick");
        if !lets_go {
            assert!(pressed(&held), "the seeded fault: no clutch");
            continue;
        }
        assert!(held.force == DVec3::ZERO && held.tick.resting && !held.reading.in_range);
        device.put(0.06, 1);
        device.put(0.06, 0);
        let released = |ticked: &Ticked| ticked.reading.switches == 0;
        let on = tick(&mut host, released).expect("let go");
        assert!(
            (on.reading.held.position.z - 0.021).abs() < 1e-12,
            "no jump"
        );
        assert!(on.force == DVec3::ZERO && on.tick.waiting && on.reading.in_range);
        // Up by a centimetre, and down again.
        device.put(0.07, 0);
        tick(&mut host, |ticked| up(ticked)).expect("come up");
        device.put(0.06, 0);
        tick(&mut host, pressed).expect("the wall again");
    }
}
