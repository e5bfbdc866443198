//! A hand that paints from a thread of its own, whatever happens to the rig, and what it can do amiss.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

use maulstick_bus::typed::Sender;
use maulstick_bus::{Bus as _, Qos, ZenohBus};
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample, axes};
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Flags, Origin, encode};

use crate::support::{Place, join};

/// Time between two samples.
const INTERVAL: Duration = Duration::from_millis(5);
/// Samples of one stroke; the hand is up for a tenth as many.
const STROKE: u64 = 600;

/// A hand at work until it is dropped.
pub(crate) struct Hand {
    run: Arc<AtomicBool>,
    /// Samples that are still to leap across the canvas.
    leaps: Arc<AtomicU32>,
    thread: Option<JoinHandle<()>>,
}

fn pressing(at: [f64; 2]) -> StylusSample {
    StylusSample {
        senses: axes::POSITION | axes::PRESSURE | axes::TILT,
        pose: StylusPose::Contact {
            point_m: [at[0], at[1], 0.0],
            tilt_rad: DEFAULT_TILT_RAD,
            twist_rad: 0.0,
            pressure: 0.5,
        },
        in_range: true,
        ..StylusSample::away()
    }
}

impl Hand {
    pub(crate) fn new(place: &Place) -> Self {
        let run = Arc::new(AtomicBool::new(true));
        let leaps = Arc::new(AtomicU32::new(0));
        let (bus, topics) = join(place);
        let origin = Origin {
            source: 71,
            epoch: 1,
        };
        let mut sender =
            Sender::new(&bus, &topics.sample("hand"), Qos::RealTime, origin).expect("declared");
        let (running, leaping) = (Arc::clone(&run), Arc::clone(&leaps));
        let thread = std::thread::spawn(move || {
            let mut number = 0_u64;
            while running.load(Ordering::Relaxed) {
                // A rhombus, once a second.
                let wave = |number: u64| ((number % 200) as f64 / 100.0 - 1.0).abs() - 0.5;
                let mut at = [0.06 * wave(number), 0.06 * wave(number + 50)];
                let left = leaping.load(Ordering::Relaxed);
                if left > 0 {
                    leaping.store(left - 1, Ordering::Relaxed);
                    at[0] += if left.is_multiple_of(2) { 0.1 } else { -0.1 };
                }
                let mut sample = pressing(at);
                if number % STROKE < STROKE / 10
                    && let StylusPose::Contact {
                        pressure, point_m, ..
                    } = &mut sample.pose
                {
                    (*pressure, point_m[2]) = (0.0, 0.01);
                }
                let now_ns = bus.now_ns();
                sender.send(now_ns, now_ns, &sample).ok();
                number += 1;
                // The hand's own pace, which is what is tested against.
                std::thread::sleep(INTERVAL);
            }
            bus.close();
        });
        Self {
            run,
            leaps,
            thread: Some(thread),
        }
    }

    /// A message as this hand sends it.
    pub(crate) fn encoded(&self) -> Vec<u8> {
        let origin = Origin {
            source: 71,
            epoch: 1,
        };
        encode(&origin, Flags::NONE, 1, 1, 1, &pressing([0.0; 2])).expect("encoded")
    }

    /// The next samples leap to and fro across the canvas.
    pub(crate) fn leap(&self, samples: u32) {
        self.leaps.store(samples / 5, Ordering::Relaxed);
    }

    /// So many samples of another device, as fast as they can be sent, .2 m from one to the next.
    pub(crate) fn flood(&self, bus: &ZenohBus, topics: &Topics, samples: u64) {
        let origin = Origin {
            source: 72,
            epoch: 1,
        };
        let mut sender =
            Sender::new(bus, &topics.sample("flood"), Qos::RealTime, origin).expect("declared");
        for number in 0..samples {
            let now_ns = bus.now_ns();
            let x = if number % 2 == 0 { 0.1 } else { -0.1 };
            sender
                .send(now_ns, now_ns, &pressing([x, 0.0]))
                .expect("sent");
        }
        let now_ns = bus.now_ns();
        sender
            .send(now_ns, now_ns, &StylusSample::away())
            .expect("sent");
    }

    /// Samples of a device that knows no numbers.
    pub(crate) fn not_finite(&self, bus: &ZenohBus, topics: &Topics) {
        let origin = Origin {
            source: 73,
            epoch: 1,
        };
        let publisher = bus
            .publisher(&topics.sample("broken"), Qos::RealTime)
            .expect("declared");
        for (number, x) in [f64::NAN, f64::INFINITY, -1e308, 1e30]
            .into_iter()
            .enumerate()
        {
            let now_ns = bus.now_ns();
            let sample = pressing([x, x]);
            if let Ok(bytes) = encode(&origin, Flags::NONE, number as u64, now_ns, now_ns, &sample)
            {
                publisher.put(bytes).expect("sent");
            }
        }
    }
}

impl Drop for Hand {
    fn drop(&mut self) {
        self.run.store(false, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.join().ok();
        }
    }
}
