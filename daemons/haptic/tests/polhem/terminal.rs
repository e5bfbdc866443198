//! The driver as a rig opens it, at a pseudo-terminal with the firmware behind it.

use std::io::{ErrorKind, Read, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use glam::DVec3;
use maulstick_haptic::device::driver::{DeviceError, Driver, Reading, Wrench};
use maulstick_haptic::drivers::polhem::handshake::HandshakeError;
use maulstick_haptic::drivers::polhem::{self, port};
use maulstick_rig::UserError;
use maulstick_rig::config::DeviceSection;
use serialport::{SerialPort, TTYPort};

use super::counting::allocations;
use super::firmware::{Firmware, Reads, Style};
use super::wall;

/// A stylus at a pseudo-terminal, until it is pulled out.
struct Plugged {
    path: String,
    firmware: Arc<Mutex<Firmware>>,
    pulled: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
    /// Keeps the terminal there while nobody has opened it.
    _open: TTYPort,
}

impl Plugged {
    /// A stylus that answers in pieces of so many bytes.
    fn new(firmware: Firmware, piece: usize) -> Self {
        let (mut master, open) = TTYPort::pair().expect("a pair of terminals");
        master
            .set_timeout(Duration::from_millis(2))
            .expect("a timeout");
        let firmware = Arc::new(Mutex::new(firmware));
        let pulled = Arc::new(AtomicBool::new(false));
        let (shared, pull) = (Arc::clone(&firmware), Arc::clone(&pulled));
        let thread = std::thread::spawn(move || {
            let start = Instant::now();
            let mut bytes = [0; 64];
            while !pull.load(Ordering::Relaxed) {
                let count = match master.read(&mut bytes) {
                    Ok(count) => count,
                    Err(error) if error.kind() == ErrorKind::TimedOut => 0,
                    // Nobody has the other end open.
                    Err(_) => 0,
                };
                let now_s = start.elapsed().as_secs_f64();
                let mut firmware = shared.lock().expect("firmware");
                firmware.watch(now_s);
                let answer = firmware.hear(&bytes[..count], now_s);
                drop(firmware);
                for part in answer.chunks(piece) {
                    master.write_all(part).ok();
                }
            }
        });
        Self {
            path: open.name().expect("a name"),
            firmware,
            pulled,
            thread: Some(thread),
            _open: open,
        }
    }

    fn firmware(&self) -> MutexGuard<'_, Firmware> {
        self.firmware.lock().expect("firmware")
    }

    fn pull(&mut self) {
        self.pulled.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.join().expect("the firmware ends");
        }
    }
}

impl Drop for Plugged {
    fn drop(&mut self) {
        self.pull();
    }
}

fn at(path: &str) -> DeviceSection {
    DeviceSection {
        address: Some(path.to_owned()),
        ..DeviceSection::new("stylus", "polhem", "round")
    }
}

fn opened(path: &str) -> Box<dyn Driver> {
    let opened = polhem::open(&at(path)).expect("a stylus");
    assert!(opened.what.contains(path), "{}", opened.what);
    opened.driver
}

/// Ticks over the driver with a force until `look` has seen enough of its readings; None where that does
/// not happen.
fn run_ticks<T>(
    driver: &mut dyn Driver,
    force: DVec3,
    mut look: impl FnMut(&Reading) -> Option<T>,
) -> Result<Option<T>, DeviceError> {
    let give_up = Instant::now() + Duration::from_secs(20);
    let mut last = Instant::now();
    while Instant::now() < give_up {
        if let Some(reading) = driver.read(last.elapsed().as_secs_f64())? {
            last = Instant::now();
            driver.write(Wrench {
                force,
                torque: DVec3::ZERO,
            })?;
            if let Some(seen) = look(&reading) {
                return Ok(Some(seen));
            }
        }
        std::thread::yield_now();
    }
    Ok(None)
}

#[test]
fn a_stylus_at_a_terminal_is_opened_read_and_pushes() {
    for (style, reads, piece) in [
        (Style::Single, Reads::Lines, 64),
        (Style::Double, Reads::Lines, 7),
        (Style::Double, Reads::Only64, 1),
    ] {
        let plugged = Plugged::new(Firmware::new(style, reads), piece);
        let mut driver = opened(&plugged.path);
        let force = DVec3::new(0.0, 2.0, 1.0);
        let seen = run_ticks(&mut *driver, force, |reading| {
            // Device z is toward the user, which is the device's own x.
            let z = reading.handle.position.z;
            assert!((z + 59.276e-3).abs() < 1e-9, "{z}");
            let felt = plugged.firmware().force();
            (felt == [1.0, 0.0, 2.0]).then_some(())
        });
        assert_eq!(seen, Ok(Some(())), "{style:?} {reads:?}");
        drop(driver);
        assert!(comes_to(&plugged, [0.0; 3]));
    }
}

/// Waits until the firmware pushes so, its own axes.
fn comes_to(plugged: &Plugged, force: [f64; 3]) -> bool {
    let give_up = Instant::now() + Duration::from_secs(20);
    while plugged.firmware().force() != force && Instant::now() < give_up {
        std::thread::yield_now();
    }
    plugged.firmware().force() == force
}

#[test]
fn a_servo_pushes_a_stylus_out_of_a_wall_and_leaves_no_force() {
    let mut firmware = Firmware::new(Style::Double, Reads::Lines);
    // Straight, 21 mm toward the user: a head of 25 mm is 4 mm deep in a wall of 100 N/m.
    firmware.pose = [21.0, 5.0, -3.0, 0.0, 0.0, 0.0, 0.0];
    let plugged = Plugged::new(firmware, 64);
    let felt = || {
        let [x, y, z] = plugged.firmware().force();
        (x - 0.4).abs() < 2e-3 && y == 0.0 && z == 0.0
    };
    assert!(wall::push(&at(&plugged.path), felt));
    assert!(comes_to(&plugged, [0.0; 3]));
}

#[test]
fn a_stylus_pulled_out_in_mid_run_is_unplugged_and_can_be_opened_again() {
    let mut plugged = Plugged::new(Firmware::new(Style::Double, Reads::Lines), 64);
    let mut driver = opened(&plugged.path);
    let mut count = 0;
    run_ticks(&mut *driver, DVec3::X, |_| {
        count += 1;
        (count == 50).then_some(())
    })
    .expect("there");
    assert_eq!(count, 50);
    plugged.pull();
    let lost = run_ticks(&mut *driver, DVec3::X, |_| None::<()>).expect_err("lost");
    assert_eq!(lost.what, "the stylus is unplugged");
    assert!(lost.code != 0 && !lost.help.is_empty());
    drop(driver);
    let again = Plugged::new(Firmware::new(Style::Double, Reads::Lines), 64);
    let mut driver = opened(&again.path);
    assert_eq!(
        run_ticks(&mut *driver, DVec3::X, |_| Some(())),
        Ok(Some(()))
    );
}

#[test]
fn reading_and_writing_a_terminal_allocate_nothing() {
    let plugged = Plugged::new(Firmware::new(Style::Double, Reads::Lines), 5);
    let mut driver = opened(&plugged.path);
    let (mut ticks, mut nothing) = (0, 0);
    let mut counted = 0;
    let give_up = Instant::now() + Duration::from_secs(20);
    let mut last = Instant::now();
    while ticks < 300 && Instant::now() < give_up {
        let dt = last.elapsed().as_secs_f64();
        let mut came = false;
        counted += allocations(|| {
            came = driver.read(dt).is_ok_and(|reading| reading.is_some());
            if came {
                driver
                    .write(Wrench {
                        force: DVec3::splat(-1.2345),
                        torque: DVec3::ZERO,
                    })
                    .ok();
            }
        });
        if came {
            (ticks, last) = (ticks + 1, Instant::now())
        } else {
            nothing += 1
        }
        std::thread::yield_now();
    }
    assert_eq!((ticks, counted), (300, 0));
    // Both with and without an answer.
    assert!(nothing > 0);
    assert!(allocations(|| drop(std::hint::black_box(Box::new(1)))) > 0);
}

fn fault(path: &str) -> UserError {
    polhem::open(&at(path)).map(|_| ()).expect_err(path)
}

#[test]
fn each_port_that_cannot_be_opened_says_why() {
    let missing = fault("/dev/ttyACM987");
    let refused = |path: &str, kind| {
        let error = serialport::Error::new(kind, "");
        port::refused(path, &error)
    };
    let absent = serialport::ErrorKind::Io(ErrorKind::NotFound);
    assert_eq!(missing, refused("/dev/ttyACM987", absent));
    let folder = std::env::temp_dir().display().to_string();
    for path in ["/dev/null", &folder] {
        let no_port = refused(path, serialport::ErrorKind::Unknown);
        assert_eq!(fault(path).help, no_port.help);
    }
    let plugged = Plugged::new(Firmware::new(Style::Double, Reads::Lines), 64);
    let driver = opened(&plugged.path);
    let busy = fault(&plugged.path);
    let in_use = serialport::ErrorKind::NoDevice;
    assert_eq!(busy, refused(&plugged.path, in_use));
    drop(driver);
    drop(opened(&plugged.path));
}

#[test]
fn refuses_what_is_no_stylus() {
    let mut firmware = Firmware::new(Style::Double, Reads::NoForces);
    let plugged = Plugged::new(firmware.clone(), 64);
    let refused = |plugged: &Plugged, error| {
        let refused = polhem::refused(&plugged.path, error);
        assert_eq!(fault(&plugged.path), refused);
    };
    refused(&plugged, HandshakeError::NoPoses);
    firmware.reads = Reads::Nothing;
    let plugged = Plugged::new(firmware.clone(), 64);
    refused(&plugged, HandshakeError::Silent);
    firmware.reads = Reads::Modem;
    let plugged = Plugged::new(firmware, 64);
    refused(&plugged, HandshakeError::Foreign("ERROR".to_owned()));
}
