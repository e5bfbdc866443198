//! A stylus without hardware: draws an arch on the canvas of a rig that runs on this machine.
//!
//! ```text
//! maulstick up &
//! cargo run --release -p maulstick-bus --example arch -- studio
//! ```

use std::error::Error;
use std::time::Duration;

use maulstick_bus::credit::Stamp;
use maulstick_bus::typed::random_epoch;
use maulstick_bus::{Bus, CreditSender, Dial, RigClock, RigFolder, Wake, ZenohBus};
use maulstick_types::stylus::{DEFAULT_TILT_RAD, StylusPose, StylusSample, axes};
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Flags, Origin, name_hash};

/// Name of the device on the bus.
const DEVICE: &str = "arch";
/// Interval of the samples.
const INTERVAL: Duration = Duration::from_millis(4);
/// Samples of the stroke, and of the pen in the air after it.
const SAMPLES: [u32; 2] = [500, 20];
/// Width and height of the arch, m.
const ARCH_M: [f64; 2] = [0.16, 0.08];

/// The pen after a share of the stroke; it hovers where the pressure is 0.
fn pen(share: f64, pressure: f64) -> StylusSample {
    let [width, height] = ARCH_M;
    let x = width * (share - 0.5);
    let y = height * (4.0 * share * (1.0 - share) - 0.5);
    StylusSample {
        senses: axes::POSITION | axes::PRESSURE,
        pose: StylusPose::Contact {
            point_m: [x, y, 0.0],
            tilt_rad: DEFAULT_TILT_RAD,
            twist_rad: 0.0,
            pressure,
        },
        in_range: true,
        ..StylusSample::away()
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let rig = std::env::args()
        .nth(1)
        .unwrap_or_else(|| "studio".to_owned());
    let (_, info) = RigFolder::join(&rig)?;
    let dial = Dial {
        name: DEVICE.to_owned(),
        listen: None,
        connect: vec![info.endpoint.clone()],
    };
    let bus = ZenohBus::open(&dial, RigClock::with_offset(info.clock_offset_ns))?;
    let topics = Topics::new(&info.rig);
    let me = Origin {
        source: name_hash(DEVICE),
        epoch: random_epoch(),
    };
    let topic = topics.sample(DEVICE);
    let mut samples = CreditSender::new(&bus, &topics, &topic, me, &Wake::new())?;
    let [touching, hovering] = SAMPLES;
    for number in 0..=touching + hovering {
        let now_ns = bus.now_ns();
        let stamp = Stamp {
            now_ns,
            event_ns: now_ns,
        };
        let share = (f64::from(number) / f64::from(touching)).min(1.0);
        let sample = match number {
            number if number < touching => pen(share, 0.6),
            number if number < touching + hovering => pen(share, 0.0),
            _ => StylusSample::away(),
        };
        samples.send(Flags::NONE, stamp, &sample)?;
        samples.serve(now_ns)?;
        // A device's daemon waits here for its hardware, which keeps the time.
        std::thread::sleep(INTERVAL);
    }
    bus.close();
    Ok(())
}
