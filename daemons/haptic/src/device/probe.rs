//! Reads a device without a rig and without force, for calibration.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, SyncSender, sync_channel};
use std::time::Duration;

use glam::DVec3;
use maulstick_device::corner_calibration::{HandReading, HandSample, Touch};
use maulstick_device::registration::{Registration, Similarity};
use maulstick_haptics::Switch;
use maulstick_types::stylus::axes;

use crate::device::driver::{DeviceError, Opened, Reading, ServoClock};
use crate::device::mounted_device::MountedDevice;
use crate::servo::clock::monotonic_ns;

/// Readings that may wait: two seconds.
const WAITING: usize = 2048;
/// Time without readings after which `look` is called all the same, so that it can break off.
const SILENCE: Duration = Duration::from_millis(50);
/// Bit of the switch that marks a corner.
const FIRST_SWITCH: u32 = 1;

/// Reads a device whose ferrule is `ferrule_m` from the sensed point and hands the readings to `look`,
/// until `look` breaks off.
///
/// # Errors
/// [`DeviceError`] if the device is lost.
pub fn probe(
    opened: Opened,
    ferrule_m: DVec3,
    mut look: impl FnMut(HandReading) -> ControlFlow<()>,
) -> Result<(), DeviceError> {
    let registration = Registration {
        to_desk: Similarity::IDENTITY,
        ferrule_m,
        corners: None,
    };
    let mut clock = opened.clock;
    let senses = opened.driver.abilities().senses;
    let mut device = MountedDevice::new(opened.driver, registration, 0);
    let (to_caller, readings) = sync_channel(WAITING);
    let stop = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let ending = Ending(&stop);
        let reading = scope.spawn(|| {
            device.switch(Switch::Off);
            read_on(&mut device, &mut *clock, senses, (&stop, to_caller))
        });
        loop {
            let reading = match readings.recv_timeout(SILENCE) {
                Ok(reading) => reading,
                Err(RecvTimeoutError::Timeout) => HandReading::Away,
                Err(RecvTimeoutError::Disconnected) => break,
            };
            if look(reading).is_break() {
                break;
            }
        }
        drop(ending);
        reading.join().unwrap_or(Err(DeviceError {
            what: "the device's driver has failed",
            code: 0,
            help: "its own message above says why",
        }))
    })
}

/// Hands on readings until it is stopped; its end of the channel ends the caller's loop.
fn read_on(
    device: &mut MountedDevice,
    clock: &mut dyn ServoClock,
    senses: u32,
    (stop, to_caller): (&AtomicBool, SyncSender<HandReading>),
) -> Result<(), DeviceError> {
    let (mut last_ns, mut lost) = (monotonic_ns(), None);
    let run = clock.run(&mut |_: u64| {
        if stop.load(Ordering::Relaxed) {
            return ControlFlow::Break(());
        }
        let now_ns = monotonic_ns();
        let dt = now_ns.saturating_sub(last_ns) as f64 * 1e-9;
        let read = device.read(dt).and_then(|reading| match reading {
            Some(reading) => device
                .write(DVec3::ZERO, DVec3::ZERO)
                .map(|()| Some(reading)),
            None => Ok(None),
        });
        match read {
            Ok(Some(reading)) => {
                last_ns = now_ns;
                // A caller that does not keep up sees the older ones.
                to_caller
                    .try_send(hand_reading(&reading, senses, now_ns))
                    .ok();
            }
            Ok(None) => {}
            Err(error) => {
                lost = Some(error);
                return ControlFlow::Break(());
            }
        }
        ControlFlow::Continue(())
    });
    lost.map_or(run, Err)
}

/// Ends the reading also if `look` panics, for the scope waits for its thread.
struct Ending<'a>(&'a AtomicBool);

impl Drop for Ending<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

fn hand_reading(reading: &Reading, senses: u32, now_ns: u64) -> HandReading {
    if !reading.in_range {
        return HandReading::Away;
    }
    let touch = match reading.switches & FIRST_SWITCH {
        0 => Touch::Unknown,
        _ => Touch::Down,
    };
    HandReading::Sample(HandSample {
        point: reading.handle.position,
        handle: (senses & axes::ORIENTATION != 0).then(|| reading.handle.orientation * DVec3::Z),
        touch,
        time_s: now_ns as f64 * 1e-9,
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::atomic::AtomicU32;

    use glam::DQuat;
    use maulstick_haptics::contact::HandleState;

    use super::*;
    use crate::device::driver::{Abilities, Driver, Wrench};
    use crate::drivers::simulated::Simulated;
    use crate::servo::clock::MonotonicClock;

    /// A device that is lost at its hundredth reading; counts what is written to it.
    struct Fleeting {
        read: u32,
        written: Arc<AtomicU32>,
        powered: Arc<AtomicBool>,
    }

    const LOST: DeviceError = DeviceError {
        what: "the plug is out",
        code: 7,
        help: "put it in",
    };

    impl Driver for Fleeting {
        fn abilities(&self) -> Abilities {
            Simulated::at_rest().abilities()
        }

        fn read(&mut self, _: f64) -> Result<Option<Reading>, DeviceError> {
            self.read += 1;
            let handle = HandleState {
                position: DVec3::X * f64::from(self.read),
                orientation: DQuat::IDENTITY,
                velocity: DVec3::ZERO,
            };
            match self.read {
                100 => Err(LOST),
                read if read % 3 == 0 => Ok(None),
                read => Ok(Some(Reading {
                    handle,
                    switches: u32::from(read > 50),
                    in_range: read > 10,
                    is_permitted: true,
                    motor_temperature: 0.0,
                })),
            }
        }

        fn write(&mut self, wrench: Wrench) -> Result<(), DeviceError> {
            assert_eq!(wrench, Wrench::ZERO);
            self.written.fetch_add(1, Ordering::SeqCst);
            Ok(())
        }

        fn switch(&mut self, amplifiers: Switch) {
            self.powered
                .store(amplifiers == Switch::On, Ordering::SeqCst);
        }
    }

    #[test]
    fn a_hand_is_seen_without_force_until_its_device_is_lost() {
        let (written, powered) = (Arc::new(AtomicU32::new(0)), Arc::new(AtomicBool::new(true)));
        let opened = || Opened {
            driver: Box::new(Fleeting {
                read: 0,
                written: Arc::clone(&written),
                powered: Arc::clone(&powered),
            }),
            clock: Box::new(MonotonicClock),
            what: String::new(),
        };
        let (mut seen, mut pressed) = (Vec::new(), 0);
        let lost = probe(opened(), DVec3::Z, |reading| {
            if let HandReading::Sample(hand) = reading {
                assert_eq!(hand.point.z, 1.0, "the ferrule");
                seen.push(hand.point.x);
                pressed += usize::from(hand.touch == Touch::Down);
            }
            ControlFlow::Continue(())
        });
        assert_eq!(lost, Err(LOST));
        let expected: Vec<f64> = (11..100).filter(|i| i % 3 != 0).map(f64::from).collect();
        assert_eq!((seen, pressed), (expected, 32));
        // A writing a reading, and the last as it is dropped.
        assert_eq!(written.load(Ordering::SeqCst), 66 + 1);
        assert!(!powered.load(Ordering::SeqCst));
        assert_eq!(
            probe(opened(), DVec3::Z, |_| ControlFlow::Break(())),
            Ok(())
        );
    }
}
