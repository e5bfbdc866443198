//! Processor time of a tick: read, drain, step, write, publish; on the servo's own thread and clock, over the simulated
//! device, a hand that presses and slides, models at 250 Hz with the Hermite law, friction and grain.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use maulstick_brush::BrushFile;
use maulstick_brush::head_stiffness::tuples;
use maulstick_device::registration::Registration;
use maulstick_device::{Take, TakeSample};
use maulstick_haptic::MountedDevice;
use maulstick_haptic::device::driver::{DeviceError, ServoClock};
use maulstick_haptic::drivers::simulated::Simulated;
use maulstick_haptic::servo::channels::Delivery;
use maulstick_haptic::servo::clock::MonotonicClock;
use maulstick_haptic::servo::servo_thread::ServoThread;
use maulstick_haptics::Limits;
use maulstick_haptics::contact::Contact;
use maulstick_num::{cos, sin};
use maulstick_rig::UserError;
use maulstick_types::haptics::{ContactModel, ForceLaw, Grain};
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample, axes};

use super::fault;
use crate::report::{Report, quantile, sorted};
use crate::thread_cpu::thread_cpu;

/// Number of measured ticks, and of those before them, in which the force rises.
const TICKS: usize = 5000;
const WARM_UP: usize = 1000;
/// Time between two models: 250 Hz.
const MODEL_PERIOD: Duration = Duration::from_millis(4);
/// Share of the head that is pressed in.
const DEPTH_SHARE: f64 = 0.5;
/// Least share of the measured ticks in which the hand feels something.
const IN_CONTACT: f64 = 0.9;
/// Silence after which ticks count as stopped.
const PATIENCE: Duration = Duration::from_secs(30);

/// The servo's own clock; notes the processor time of each tick.
struct Timed(rtrb::Producer<Duration>);

impl ServoClock for Timed {
    fn run(
        &mut self,
        tick: &mut (dyn FnMut(u64) -> ControlFlow<()> + Send),
    ) -> Result<(), DeviceError> {
        let spent = &mut self.0;
        MonotonicClock.run(&mut |late_ns| {
            let before = thread_cpu();
            let flow = tick(late_ns);
            // Ticks beyond the capacity come after the measured ones.
            spent.push(thread_cpu().saturating_sub(before)).ok();
            flow
        })
    }
}

/// Measures and reports.
pub(super) fn run(report: &mut Report) -> Result<(), UserError> {
    let brush = BrushFile::library("round").map_err(fault)?;
    let take = sliding();
    let desk = Registration::IDENTITY;
    let device = Simulated::following(&take, brush.length_m(), DEPTH_SHARE, &desk);
    let all = TICKS + WARM_UP;
    let (to_us, mut spent) = rtrb::RingBuffer::new(all);
    let placed = MountedDevice::new(Box::new(device), desk, 0);
    // The hand begins pressed: force comes up all the same.
    let limits = Limits {
        engage_n: f64::MAX,
        max_stiffness_n_m: placed.abilities().max_stiffness_n_m,
        ..Limits::default()
    };
    let mut servo = ServoThread::start(placed, Box::new(Timed(to_us)), limits).map_err(fault)?;
    let contact = Contact::new(&model(&brush)).map_err(fault)?;
    let mut delivery = Delivery {
        model: Some(contact),
        ..Delivery::default()
    };
    let (mut ticks, mut felt, mut heard) = (0, 0, Instant::now());
    while ticks < all {
        delivery.number += 1;
        servo.models.write(delivery);
        // Models come as often as a brush node sends them.
        std::thread::sleep(MODEL_PERIOD);
        while let Ok(record) = servo.ticks.pop() {
            (ticks, heard) = (ticks + 1, Instant::now());
            let counts = (WARM_UP..all).contains(&ticks) && record.force.length() > 0.0;
            felt += usize::from(counts);
        }
        if heard.elapsed() > PATIENCE {
            return Err(fault("the servo stands still"));
        }
    }
    drop(servo);
    if (felt as f64) < IN_CONTACT * TICKS as f64 {
        return Err(fault(format!("{felt} of {TICKS} ticks give a force")));
    }
    let spent = std::iter::from_fn(|| spent.pop().ok()).skip(WARM_UP);
    let spent = sorted(spent.map(|it| it.as_secs_f64() * 1e6).collect());
    for (name, share) in [("tick.p50", 0.5), ("tick.p99", 0.99)] {
        report.row(name, quantile(&spent, share), "µs");
    }
    Ok(())
}

/// A hand that circles, pressed in, for twice the measured time.
fn sliding() -> Take {
    let samples = (0..3 * (TICKS + WARM_UP) as u64).map(|number| {
        let turn = 1e-3 * number as f64 * std::f64::consts::TAU;
        TakeSample {
            time_ns: number * 1_000_000,
            sample: StylusSample {
                senses: axes::POSITION | axes::PRESSURE | axes::TILT,
                pose: StylusPose::Contact {
                    point_m: [0.03 * cos(turn), 0.03 * sin(turn), 0.0],
                    tilt_rad: DEFAULT_TILT_RAD,
                    twist_rad: 0.0,
                    pressure: 0.5,
                },
                in_range: true,
                ..StylusSample::away()
            },
        }
    });
    Take {
        setup: None,
        device: "hand".into(),
        samples: samples.collect(),
    }
}

/// The model that the brush node would send for this brush on a canvas.
fn model(brush: &BrushFile) -> ContactModel {
    let law = ForceLaw::Hermite {
        knots: tuples(brush),
    };
    ContactModel {
        friction_static: 0.3,
        friction_kinetic: 0.2,
        viscous_n_s_m: 0.5,
        grain: Grain {
            amplitude: 0.05,
            wavelength_m: 1e-3,
            seed: 1,
        },
        time_to_live_ns: 100_000_000,
        recovery_ns: 10_000_000,
        ..ContactModel::bare(law, brush.length_m())
    }
}
