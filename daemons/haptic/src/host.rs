//! The real-time thread: absolute deadlines a millisecond apart, the measured time goes to the law.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::JoinHandle;

use glam::DVec3;
use maulstick_haptics::contact::Contact;
use maulstick_haptics::{Limits, Sender, Servo, Switch, Tick};
use maulstick_types::Origin;
use nix::sys::time::TimeSpec;
use nix::time::{ClockId, ClockNanosleepFlags, clock_gettime, clock_nanosleep};
use thread_priority::unix::{RealtimeThreadSchedulePolicy, ThreadSchedulePolicy};
use thread_priority::{ThreadPriority, ThreadPriorityValue};

use crate::driver::{Placed, Reading};

/// Period of the servo, ns.
pub const PERIOD_NS: u64 = 1_000_000;
/// Bins of the histograms: below 50 µs, doubling, the rest.
pub const BINS: usize = 12;
/// Ticks that fit into the ring to the publisher: two seconds.
const RING: usize = 2048;
/// SCHED_FIFO priority of the servo.
const PRIORITY: u8 = 80;

/// A tick as it goes to the publisher.
#[derive(Clone, Copy, Debug)]
pub struct Ticked {
    /// When the device was read, `CLOCK_MONOTONIC`, ns.
    pub monotonic_ns: u64,
    /// What was read, desk frame.
    pub reading: Reading,
    /// The force applied, N, desk frame.
    pub force: DVec3,
    /// How late the wake-up was, ns.
    pub late_ns: u64,
    /// How long the tick took, ns.
    pub spent_ns: u64,
    /// What the servo did.
    pub tick: Tick,
}

/// A model on its way to the servo.
#[derive(Clone, Copy, Debug, Default)]
pub struct Delivery {
    /// The model.
    pub contact: Option<Contact>,
    /// Who sent it.
    pub sender: Option<Origin>,
    /// Counts deliveries.
    pub number: u64,
}

/// The running servo.
pub struct Host {
    /// Ticks, oldest first.
    pub ticks: rtrb::Consumer<Ticked>,
    /// Where models go in.
    pub models: triple_buffer::Input<Delivery>,
    /// What hindered real-time scheduling, if anything did.
    pub warnings: Vec<String>,
    stop: Arc<AtomicBool>,
    dropped: Arc<AtomicU64>,
    thread: Option<JoinHandle<()>>,
}

fn monotonic_ns() -> u64 {
    clock_gettime(ClockId::CLOCK_MONOTONIC).map_or(0, |time| {
        time.tv_sec() as u64 * 1_000_000_000 + time.tv_nsec() as u64
    })
}

fn sleep_until(deadline_ns: u64) {
    let time = TimeSpec::new(
        (deadline_ns / 1_000_000_000) as i64,
        (deadline_ns % 1_000_000_000) as i64,
    );
    clock_nanosleep(
        ClockId::CLOCK_MONOTONIC,
        ClockNanosleepFlags::TIMER_ABSTIME,
        &time,
    )
    .ok();
}

impl Host {
    /// Starts the servo over `device`.
    ///
    /// # Errors
    /// What the system says where no thread can be started.
    pub fn start(device: Placed, limits: Limits) -> std::io::Result<Self> {
        Self::with_ring(device, limits, RING)
    }

    /// How many ticks did not fit into the ring, as the publisher was late.
    #[must_use]
    pub fn dropped(&self) -> u64 {
        self.dropped.load(Ordering::Relaxed)
    }

    fn with_ring(mut device: Placed, limits: Limits, ring: usize) -> std::io::Result<Self> {
        let (mut to_publisher, ticks) = rtrb::RingBuffer::new(ring);
        let (models, mut from_rig) = triple_buffer::triple_buffer(&Delivery::default());
        let (tell, told) = std::sync::mpsc::channel();
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stop);
        let dropped = Arc::new(AtomicU64::new(0));
        let drops = Arc::clone(&dropped);
        let thread = std::thread::Builder::new()
            .name("servo".into())
            .spawn(move || {
                tell.send(become_real_time()).ok();
                let mut servo = Servo::new(limits);
                let (mut seen, mut sender) = (0, None);
                let mut amplifiers = Switch::On;
                let mut last_ns = monotonic_ns();
                let mut deadline_ns = last_ns + PERIOD_NS;
                while !stopped.load(Ordering::Relaxed) {
                    sleep_until(deadline_ns);
                    let now_ns = monotonic_ns();
                    let dt = (now_ns - last_ns) as f64 * 1e-9;
                    last_ns = now_ns;
                    let delivery = *from_rig.read();
                    if delivery.number != seen
                        && let Some(contact) = delivery.contact
                    {
                        let whose = if delivery.sender == sender {
                            Sender::Same
                        } else {
                            Sender::Another
                        };
                        servo.receive(contact, whose);
                        (seen, sender) = (delivery.number, delivery.sender);
                    }
                    let reading = device.read(dt);
                    servo.measure(reading.motor_temperature);
                    let (force, tick) = servo.step(&reading.held, dt);
                    device.write(force);
                    let wanted = if tick.resting {
                        Switch::Off
                    } else {
                        Switch::On
                    };
                    if wanted != amplifiers {
                        amplifiers = wanted;
                        device.switch(amplifiers);
                    }
                    let ticked = Ticked {
                        monotonic_ns: now_ns,
                        reading,
                        force,
                        late_ns: now_ns.saturating_sub(deadline_ns),
                        spent_ns: monotonic_ns() - now_ns,
                        tick,
                    };
                    if to_publisher.push(ticked).is_err() {
                        drops.fetch_add(1, Ordering::Relaxed);
                    }
                    // After an overrun the next deadline is the next grid point: no burst to catch up.
                    deadline_ns += PERIOD_NS;
                    let now_ns = monotonic_ns();
                    if deadline_ns <= now_ns {
                        deadline_ns += (now_ns - deadline_ns).div_ceil(PERIOD_NS) * PERIOD_NS;
                    }
                }
                // Leaves no force: see what drops a device.
                drop(device);
            })?;
        let warnings = told.recv().unwrap_or_default();
        Ok(Self {
            ticks,
            models,
            warnings,
            stop,
            dropped,
            thread: Some(thread),
        })
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.join().ok();
        }
    }
}

impl std::fmt::Debug for Host {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Host")
            .field("warnings", &self.warnings)
            .finish_non_exhaustive()
    }
}

/// Locks memory and asks for real-time scheduling; returns what was not permitted, with the fix.
fn become_real_time() -> Vec<String> {
    let mut warnings = Vec::new();
    let all =
        nix::sys::mman::MlockAllFlags::MCL_CURRENT | nix::sys::mman::MlockAllFlags::MCL_FUTURE;
    if let Err(error) = nix::sys::mman::mlockall(all) {
        warnings.push(format!(
            "memory is not locked ({error}): add 'memlock unlimited' for your user to /etc/security/limits.conf"
        ));
    }
    let policy = ThreadSchedulePolicy::Realtime(RealtimeThreadSchedulePolicy::Fifo);
    let priority = ThreadPriorityValue::try_from(PRIORITY).map(ThreadPriority::Crossplatform);
    let set = priority
        .map_err(|error| error.to_string())
        .and_then(|priority| {
            thread_priority::set_thread_priority_and_policy(
                thread_priority::thread_native_id(),
                priority,
                policy,
            )
            .map_err(|error| format!("{error:?}"))
        });
    if let Err(error) = set {
        warnings.push(format!(
            "the servo has no real-time priority ({error}): add 'rtprio 99' for your user to /etc/security/limits.conf"
        ));
    }
    warnings
}

/// The histogram bin of a time.
#[must_use]
pub fn bin(ns: u64) -> usize {
    let mut edge = 50_000;
    for place in 0..BINS - 1 {
        if ns < edge {
            return place;
        }
        edge *= 2;
    }
    BINS - 1
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use glam::DQuat;
    use maulstick_haptics::contact::Held;
    use maulstick_num::geometry::{Rigid, canonical, rotation};
    use maulstick_types::haptics::{ContactModel, ForceLaw, Grain};

    use super::*;
    use crate::driver::{Abilities, Driver};
    use crate::simulated::Simulated;

    #[test]
    fn bins_double() {
        assert_eq!(
            (bin(0), bin(49_999), bin(50_000), bin(99_999), bin(100_000)),
            (0, 0, 1, 1, 2)
        );
        assert_eq!(bin(u64::MAX), BINS - 1);
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
        let device = Placed::new(Box::new(Simulated::at_rest()), Rigid::IDENTITY);
        let mut host = Host::start(device, Limits::default()).expect("started");
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
        let device = Placed::new(Box::new(Simulated::at_rest()), Rigid::IDENTITY);
        let mut host = Host::with_ring(device, Limits::default(), 4).expect("started");
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

    /// A device that stands still and remembers the newest force written to it.
    struct Still {
        held: Held,
        written: Arc<[AtomicU64; 3]>,
    }

    impl Driver for Still {
        fn abilities(&self) -> Abilities {
            Simulated::at_rest().abilities()
        }

        fn read(&mut self, _: f64) -> Reading {
            Reading {
                held: self.held,
                switches: 0,
                in_range: true,
                motor_temperature: 0.0,
            }
        }

        fn write(&mut self, force: DVec3) {
            for (cell, part) in self.written.iter().zip(force.to_array()) {
                cell.store(part.to_bits(), Ordering::Relaxed);
            }
        }
    }

    /// A device whose reading fails after a while.
    struct Failing(Still, u32);

    impl Driver for Failing {
        fn abilities(&self) -> Abilities {
            self.0.abilities()
        }

        fn read(&mut self, dt: f64) -> Reading {
            self.1 += 1;
            assert!(self.1 < 100, "the seeded fault");
            self.0.read(dt)
        }

        fn write(&mut self, force: DVec3) {
            // A force that nobody asked for, so that its end shows.
            self.0.write(if self.1 < 100 { DVec3::X } else { force });
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
        let device = Placed::new(Box::new(Failing(still, 0)), Rigid::IDENTITY);
        let mut host = Host::start(device, Limits::default()).expect("started");
        tick(&mut host, |_| true).expect("a tick");
        if let Some(thread) = host.thread.take() {
            assert!(thread.join().is_err(), "the servo fails");
        }
        assert_eq!(f64::from_bits(written[0].load(Ordering::Relaxed)), 0.0);
    }

    /// A rigid wall of 100 N/m at the desk's z = 0, for a head of 25 mm.
    fn wall() -> Contact {
        Contact::new(&ContactModel {
            device: 1,
            device_epoch: 1,
            brush: "main".into(),
            plane_point_m: [0.0; 3],
            plane_normal: [0.0, 0.0, 1.0],
            friction_static: 0.0,
            friction_kinetic: 0.0,
            viscous_n_s_m: 2.0,
            grain: Grain {
                amplitude: 0.0,
                wavelength_m: 1e-3,
                seed: 1,
            },
            law: ForceLaw::Rigid {
                stiffness_n_m: 100.0,
            },
            head_length_m: 0.025,
            time_to_live_ns: u64::MAX,
            recovery_ns: 0,
        })
        .expect("a model")
    }

    #[test]
    fn a_turned_and_shifted_device_feels_the_desk_where_it_is() {
        // What the hand does on the desk: the tip 4 mm below the wall, sliding along x.
        let on_desk = Held {
            position: DVec3::new(0.01, -0.02, 0.021),
            orientation: DQuat::IDENTITY,
            velocity: DVec3::new(0.1, 0.0, 0.0),
        };
        let expected = DVec3::new(-0.2, 0.0, 0.4);
        let turn = rotation(DVec3::new(0.6, 0.0, 0.8), 2.0);
        for to_desk in [
            Rigid::IDENTITY,
            Rigid {
                rotation: turn,
                translation: DVec3::new(0.3, -0.1, 0.2),
            },
        ] {
            let to_device = to_desk.inverse();
            let written = Arc::new([const { AtomicU64::new(0) }; 3]);
            let still = Still {
                held: Held {
                    position: to_device.point(on_desk.position),
                    orientation: canonical(to_device.rotation * on_desk.orientation),
                    velocity: to_device.vector(on_desk.velocity),
                },
                written: Arc::clone(&written),
            };
            // However late the ticks of a busy machine come, the force comes up.
            let limits = Limits {
                engage_s: 1e-3,
                longest_tick_s: 1e3,
                ..Limits::default()
            };
            let mut host =
                Host::start(Placed::new(Box::new(still), to_desk), limits).expect("started");
            host.models.write(Delivery {
                contact: Some(wall()),
                sender: None,
                number: 1,
            });
            // The tick after the first is there once the force of the first is written.
            let mut seen = 0;
            let felt = tick(&mut host, |ticked| {
                seen += u32::from((ticked.force - expected).length() < 1e-12);
                seen == 2
            });
            let felt = felt.expect("the force in the desk frame");
            let off = (felt.reading.held.position - on_desk.position).length()
                + (felt.reading.held.velocity - on_desk.velocity).length()
                + felt
                    .reading
                    .held
                    .orientation
                    .angle_between(on_desk.orientation);
            assert!(off < 1e-7, "{:?}", felt.reading.held);
            let written = DVec3::from_array(
                [0, 1, 2].map(|i| f64::from_bits(written[i].load(Ordering::Relaxed))),
            );
            assert!(
                (written - to_device.vector(expected)).length() < 1e-12,
                "{written} in the device frame"
            );
        }
    }
}
