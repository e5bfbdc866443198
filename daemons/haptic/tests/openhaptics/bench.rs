//! Shared by the tests: a section of `rig.toml`, a servo with a wall, the log.

use std::io::Write;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use maulstick_device::registration::Registration;
use maulstick_haptic::MountedDevice;
use maulstick_haptic::device::driver::Opened;
use maulstick_haptic::device::open::HapticSettings;
use maulstick_haptic::drivers::vendor_library::allow_library;
use maulstick_haptic::servo::channels::{Delivery, TickRecord};
use maulstick_haptic::servo::servo_thread::ServoThread;
use maulstick_haptics::{Contact, Limits};
use maulstick_libhd::{Call, Control, Script};
use maulstick_rig::config::DeviceSection;
use maulstick_rig::{RigConfig, UserError};
use maulstick_types::haptics::{ContactModel, ForceLaw};

/// Beyond this a test gives up.
const PATIENCE: Duration = Duration::from_secs(60);

/// A library that lies in no folder of the system.
pub(crate) fn trusted(path: PathBuf) -> PathBuf {
    allow_library(&path);
    path
}

/// A device of our libHD, of which nothing else is said.
pub(crate) fn section() -> DeviceSection {
    DeviceSection {
        library: Some(trusted(maulstick_libhd::control::path().expect("a path"))),
        ..DeviceSection::new("phantom", "openhaptics", "main")
    }
}

/// Opens the device of a section, as the daemon does.
pub(crate) fn open(section: &DeviceSection) -> Result<Opened, UserError> {
    let settings = HapticSettings {
        device: section.clone(),
        hand: None,
    };
    maulstick_haptic::device::open::open(&RigConfig::default(), &settings)
}

/// Reason why a device cannot be opened.
pub(crate) fn refusal(section: &DeviceSection) -> UserError {
    open(section).err().expect("a fault")
}

/// Plays a script.
pub(crate) fn play(script: &Script) -> Control {
    Control::play(script).expect("played")
}

/// However late the ticks of a busy machine come, the force comes up.
pub(crate) fn patient() -> Limits {
    Limits {
        engage_n: f64::MAX,
        engage_s: 1e-3,
        longest_tick_s: 1e3,
        ..Limits::default()
    }
}

/// A servo over the opened device, which stands on the desk as it is.
pub(crate) fn start(opened: Opened, limits: Limits) -> ServoThread {
    let placed = MountedDevice::new(opened.driver, Registration::IDENTITY, 0);
    ServoThread::start(placed, opened.clock, limits).expect("started")
}

/// A servo over a device of our libHD.
pub(crate) fn serve() -> ServoThread {
    start(open(&section()).expect("opened"), patient())
}

/// Sends a rigid wall of 100 N/m at the desk's z = 0, for a head of 25 mm.
pub(crate) fn wall(servo: &mut ServoThread) {
    let law = ForceLaw::Rigid {
        stiffness_n_m: 100.0,
    };
    let mut contact = Contact::new(&ContactModel::bare(law, 0.025)).expect("a model");
    // Nobody sends it again.
    contact.time_to_live_s = f64::INFINITY;
    servo.models.write(Delivery {
        model: Some(contact),
        sender: None,
        number: 1,
    });
}

/// Waits until something is so.
pub(crate) fn wait(what: &str, mut is_so: impl FnMut() -> bool) {
    let give_up = Instant::now() + PATIENCE;
    while !is_so() {
        assert!(Instant::now() < give_up, "waited in vain for {what}");
        std::thread::yield_now();
    }
}

/// The first tick that `look` accepts.
pub(crate) fn tick(
    servo: &mut ServoThread,
    mut look: impl FnMut(&TickRecord) -> bool,
) -> TickRecord {
    let mut found = None;
    wait("such a tick", || {
        while found.is_none()
            && let Ok(record) = servo.ticks.pop()
        {
            found = Some(record).filter(&mut look);
        }
        found.is_some()
    });
    found.expect("found")
}

/// All that was called.
pub(crate) fn calls(control: &Control) -> Vec<Call> {
    control.calls(0).expect("a log")
}

/// Fault of a log from opening to closing, if any: its errors, frames that are not one
/// a tick, a force at the end, another order of the end than the vendor asks for.
pub(crate) fn disorder(calls: &[Call]) -> Option<String> {
    let (mut open, mut last_tick, mut force) = (false, 0, [0.0; 3]);
    for (place, call) in calls.iter().enumerate() {
        let wrong = match call {
            Call::Error(_) => true,
            Call::Begin(tick) => {
                let wrong = open || *tick <= last_tick;
                (open, last_tick) = (true, *tick);
                wrong
            }
            Call::End(given) => {
                force = *given;
                !std::mem::replace(&mut open, false)
            }
            Call::Stop => open || force != [0.0; 3],
            _ => false,
        };
        if wrong {
            return Some(format!("{call:?} at {place}"));
        }
    }
    let end: Vec<&Call> = calls
        .iter()
        .filter(|call| {
            matches!(
                call,
                Call::Stop | Call::Unschedule(_) | Call::DisableDevice(_)
            )
        })
        .collect();
    match end[..] {
        [Call::Stop, Call::Unschedule(_), Call::DisableDevice(_)] => None,
        _ => Some(format!("it ends with {end:?}")),
    }
}

/// Where in a log a call is.
pub(crate) fn place(calls: &[Call], what: impl Fn(&Call) -> bool) -> usize {
    calls.iter().position(what).expect("such a call")
}

static TOLD: Mutex<Vec<u8>> = Mutex::new(Vec::new());

struct Ear;

impl Write for Ear {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let mut told = TOLD.lock().unwrap_or_else(PoisonError::into_inner);
        told.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// Listens to what is told from now on; to be called while a [`Control`] is held.
pub(crate) fn listen() {
    let ear = tracing_subscriber::fmt()
        .with_ansi(false)
        .with_writer(|| Ear);
    ear.try_init().ok();
    TOLD.lock().unwrap_or_else(PoisonError::into_inner).clear();
}

/// Lines that were logged since.
pub(crate) fn told() -> String {
    let told = TOLD.lock().unwrap_or_else(PoisonError::into_inner);
    String::from_utf8_lossy(&told).into_owned()
}
