//! Phantoms (Omni, Desktop, Premium, Touch, Touch X) through the HD library of OpenHaptics, which the
//! user installs: nothing of it is part of Maulstick, it is opened at run time.
//!
//! Facts of the interface are from the vendor's public headers and reference guide, practice from the
//! drivers of CHAI3D, OpenSurgSim and ROS.
//! Nine tenths of the driver's own limits of speed and of change of the force are kept where they are below ours (1.5 m/s,
//! 400 N/s).
//!
//! | module | holds |
//! | --- | --- |
//! | [`abi`] | types and numbers of the interface |
//! | [`library`] | the library, opened at run time |
//! | [`model`] | limits of a model by its name |
//! | [`session`] | an initiated device |
//! | [`frame`] | values of a frame, and the axes |
//! | [`device`] | the driver |
//! | [`calibration`], [`calibration_state`] | calibration of a device, and its state |
//! | [`faults`] | meaning of the library's errors |
//! | [`callback_slot`] | slot for the scheduler's callback |
//! | [`vendor_clock`] | the scheduler as the servo's clock |

pub mod abi;
pub mod calibration;
pub mod calibration_state;
pub mod callback_slot;
pub mod device;
pub mod faults;
pub mod frame;
pub mod library;
pub mod model;
pub mod session;
pub mod vendor_clock;

use std::ffi::CString;

use maulstick_rig::UserError;
use maulstick_rig::config::DeviceSection;
use maulstick_types::stylus::axes;

use self::calibration::Calibration;
use self::device::Device;
use self::frame::MILLI;
use self::library::Library;
use self::model::Model;
use self::session::{Claim, Drives, Session};
use self::vendor_clock::VendorClock;
use crate::device::driver::{Abilities, Opened};

/// Names of the default device, for libraries that do not find it by a null pointer.
const DEFAULT_NAMES: [&str; 2] = ["Default Device", "Default PHANToM"];
/// Working area of a Touch, mm, for a device that does not report its own.
const WORKSPACE_MM: [f64; 6] = [-80.0, -60.0, -35.0, 80.0, 60.0, 35.0];
/// Least viscous friction that was measured of such arms, N·s/m.
const DAMPING_N_S_M: f64 = 0.1;
/// Share of the driver's own limits that is used of them: at the limit it cuts the motors.
const BELOW_LIMIT: f64 = 0.9;
/// Unit of the library's impulse, N/s.
const N_PER_MS: f64 = 1000.0;
/// Unit of the library's stiffness, N/m.
const STIFFEST_N_M: f64 = 1000.0;

/// A process has one device at a time.
#[must_use]
pub fn already_open() -> UserError {
    UserError::usage("this process already has a device of OpenHaptics")
        .help("give each haptic device its own daemon")
}

/// Opens the device that a section of `rig.toml` asks for.
///
/// # Errors
/// A [`UserError`]: no library, no such device, or another program has it. Nothing is left behind.
pub fn open(section: &DeviceSection) -> Result<Opened, UserError> {
    let claim = Claim::take().ok_or_else(already_open)?;
    let library = Library::find(section.library.as_deref())?;
    let handle = initiate(library, section.address.as_deref())?;
    let session = Session::new(library, handle, claim);
    library.make_current(handle);
    let name = library.text(abi::DEVICE_MODEL_TYPE);
    let model = Model::named(&name);
    let abilities = abilities(library, &model);
    let what = format!(
        "{name}, serial number {}, driver {}, by {}",
        library.text(abi::DEVICE_SERIAL_NUMBER),
        library.text(abi::DEVICE_DRIVER_VERSION),
        library.name.display()
    );
    let styles = library.integer(abi::CALIBRATION_STYLE);
    library.enable(abi::MAX_FORCE_CLAMPING);
    // Questions and settings up to here are optional.
    library.forget_errors();
    library.enable(abi::FORCE_OUTPUT);
    if let Some(error) = library.forget_errors() {
        return Err(faults::fault(error, &library.error_words(error.code)));
    }
    let session = session.driving(match abilities.drives & axes::TORQUE {
        0 => Drives::Force,
        _ => Drives::ForceAndTorque,
    });
    let (calibration, name) = (Calibration::new(styles), section.name.clone());
    Ok(Opened {
        driver: Box::new(Device::new(
            session.clone(),
            abilities,
            model.dead_man,
            calibration,
        )),
        clock: Box::new(VendorClock::new(session, name)),
        what,
    })
}

/// Initiates the device of a name, or the default one by the names that it may have.
fn initiate(library: &Library, name: Option<&str>) -> Result<abi::Handle, UserError> {
    let names = match name {
        Some(name) => vec![Some(name)],
        None => [None].into_iter().chain(DEFAULT_NAMES.map(Some)).collect(),
    };
    let mut first = None;
    for name in &names {
        let text = name.map(CString::new).transpose().map_err(|_| {
            UserError::usage("a device's name has a zero in it").help("correct `address`")
        })?;
        match library.init_device(text.as_deref()) {
            Ok(handle) => return Ok(handle),
            Err(error) => {
                let error = *first.get_or_insert(error);
                if error.code == abi::error::DEVICE_ALREADY_INITIATED {
                    break;
                }
            }
        }
    }
    let error = first.unwrap_or(abi::ErrorInfo {
        code: abi::error::BAD_HANDLE,
        internal: 0,
        device: abi::INVALID_HANDLE,
    });
    let fault = faults::fault(error, &library.error_words(error.code));
    Err(match name {
        Some(name) => {
            let known = "`address` in rig.toml is its name in the vendor's setup program";
            let help = fault.help.clone().unwrap_or_default();
            fault
                .at(format!("'{name}'"))
                .help(format!("{help}; {known}"))
        }
        None => fault.at("the default device"),
    })
}

/// Abilities of the current device: the library's values, within the limits of the model.
fn abilities(library: &Library, model: &Model) -> Abilities {
    let known = |value: f64, unit: f64, otherwise: f64| {
        if value.is_finite() && value > 0.0 {
            value * unit
        } else {
            otherwise
        }
    };
    let nominal = |parameter: abi::Doubles<1>, unit: f64, otherwise: f64| {
        let [value] = library.doubles(parameter, f64::NAN);
        known(value, unit, otherwise)
    };
    let impulse = library.float(abi::SOFTWARE_FORCE_IMPULSE_LIMIT);
    let speed = abi::SOFTWARE_VELOCITY_LIMIT;
    let max_force_n = nominal(abi::NOMINAL_MAX_FORCE, 1.0, model.force_n).min(model.force_n);
    let stiffness = nominal(
        abi::NOMINAL_MAX_STIFFNESS,
        STIFFEST_N_M,
        model.stiffness_n_m,
    );
    let torque = nominal(abi::NOMINAL_MAX_TORQUE, MILLI, model.torque_nm).min(model.torque_nm);
    let max_torque_nm = match library.integer(abi::OUTPUT_DOF) {
        6 => torque,
        _ => 0.0,
    };
    let turns = match library.integer(abi::INPUT_DOF) {
        6 => axes::ORIENTATION,
        _ => 0,
    };
    let twists = if max_torque_nm > 0.0 { axes::TORQUE } else { 0 };
    let continuous = abi::NOMINAL_MAX_CONTINUOUS_FORCE;
    let workspace: [f64; 6] = library.doubles(abi::USABLE_WORKSPACE_DIMENSIONS, f64::NAN);
    let is_box = (0..3).all(|axis| workspace[axis] < workspace[axis + 3])
        && workspace.iter().all(|edge| edge.is_finite());
    Abilities {
        senses: axes::POSITION | axes::VELOCITY | axes::SWITCHES | turns,
        drives: axes::FORCE | twists,
        max_force_n,
        continuous_force_n: nominal(continuous, 1.0, model.continuous_n).min(max_force_n),
        max_torque_nm,
        max_stiffness_n_m: stiffness.min(model.stiffness_n_m),
        max_slew_n_s: known(impulse, BELOW_LIMIT * N_PER_MS, f64::INFINITY),
        max_speed_m_s: nominal(speed, BELOW_LIMIT * MILLI, f64::INFINITY),
        damping_n_s_m: DAMPING_N_S_M,
        workspace_m: if is_box { workspace } else { WORKSPACE_MM }.map(|edge| edge * MILLI),
    }
}
