//! The vendor's library, opened at run time: its functions, behind ones that cannot be misused. It is never closed: other
//! devices of the process may use it.

#![allow(
    unsafe_code,
    reason = "functions of a shared library, of which the vendor's headers say what they are"
)]

use std::ffi::{CStr, c_char, c_int, c_uchar, c_uint, c_ushort};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use glam::{DMat3, DVec3};
use maulstick_rig::UserError;

use crate::device::driver::DeviceError;
use crate::drivers::vendor_library::{Unusable, VendorLibrary, load};

/// Number by which the library knows an open device.
type DhdId = c_char;

/// As its vendor calls it.
pub const DHD: VendorLibrary = VendorLibrary {
    product: "Force Dimension's SDK",
    kind: "libdhd of SDK 3.16",
    names: ["libdhd.so.3", "libdhd.so", "libdrd.so.3"],
    install: "install Force Dimension's SDK (3.16 or newer), or say where libdhd.so is by `library` in rig.toml",
    correct: "`library` in rig.toml is to name libdhd.so, of SDK 3.16 or newer",
};

/// Nothing new was to be read, though no more time was asked for.
const TIME_GUARD: c_int = 1;

/// Advice on a device that does not answer.
const RECONNECT: &str =
    "see that it is switched on and calibrated, and unplug it and plug it in again";

/// The reason why no device is opened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OpenError {
    /// An address that is no serial number.
    Address(String),
    /// No device of this serial number, but of these.
    Serial(c_ushort, Vec<c_ushort>),
    /// No device at all.
    Absent,
    /// Words of the library about a device that it cannot open.
    Closed(String),
}

impl From<OpenError> for UserError {
    fn from(error: OpenError) -> Self {
        match error {
            OpenError::Address(text) => Self::usage(format!("'{text}' is no serial number"))
                .help("`address` is the number on the base of the device, 0 to 65535"),
            OpenError::Serial(wanted, seen) => {
                let seen: Vec<_> = seen.iter().map(ToString::to_string).collect();
                Self::failure(format!("there is no device of the serial number {wanted}"))
                    .help(format!("there are: {}", seen.join(", ")))
            }
            OpenError::Absent => {
                Self::failure("no device of Force Dimension is attached").help(RECONNECT)
            }
            OpenError::Closed(said) => {
                Self::failure(format!("the device cannot be opened: {said}"))
                    .help("close other programs that use it, and see that you may use its USB port")
            }
        }
    }
}

/// The device has not answered.
pub const LOST: DeviceError = DeviceError {
    what: "the device does not answer",
    code: 0,
    help: RECONNECT,
};
/// The device has nothing new to say any more.
pub const SILENT: DeviceError = DeviceError {
    what: "the device is silent",
    code: 0,
    help: RECONNECT,
};
/// It reports values that are not finite.
pub const NOT_FINITE: DeviceError = DeviceError {
    what: "the device reports values that are not finite",
    code: 0,
    help: RECONNECT,
};

macro_rules! functions {
    ($($field:ident = $name:literal: fn($($argument:ty),*) -> $result:ty;)*) => {
        #[derive(Debug)]
        struct Functions {
            $($field: unsafe extern "C" fn($($argument),*) -> $result,)*
        }

        impl Functions {
            /// All of them, or the name of the first that is not there.
            fn of(library: &libloading::Library) -> Result<Self, &'static str> {
                Ok(Self {
                    // SAFETY: the vendor's headers declare it so.
                    $($field: unsafe { *library.get($name).map_err(|_| $name)? },)*
                })
            }
        }
    };
}

functions! {
    version = "dhdGetSDKVersion": fn(*mut c_int, *mut c_int, *mut c_int, *mut c_int) -> ();
    device_count = "dhdGetDeviceCount": fn() -> c_int;
    open_id = "dhdOpenID": fn(c_char) -> c_int;
    close = "dhdClose": fn(c_char) -> c_int;
    error_words = "dhdErrorGetLastStr": fn() -> *const c_char;
    serial = "dhdGetSerialNumber": fn(*mut c_ushort, c_char) -> c_int;
    system_type = "dhdGetSystemType": fn(c_char) -> c_int;
    system_name = "dhdGetSystemName": fn(c_char) -> *const c_char;
    has_wrist = "dhdHasWrist": fn(c_char) -> bool;
    enable_force = "dhdEnableForce": fn(c_uchar, c_char) -> c_int;
    pose = "dhdGetPositionAndOrientationFrame": fn(*mut f64, *mut f64, *mut f64, *mut f64, c_char) -> c_int;
    velocity = "dhdGetLinearVelocity": fn(*mut f64, *mut f64, *mut f64, c_char) -> c_int;
    buttons = "dhdGetButtonMask": fn(c_char) -> c_uint;
    set_force = "dhdSetForceAndTorqueAndGripperForce": fn(f64, f64, f64, f64, f64, f64, f64, c_char) -> c_int;
}

/// The library.
#[derive(Debug)]
pub struct Library {
    functions: Functions,
    /// The name by which it was found.
    name: PathBuf,
}

/// Libraries opened so far.
static OPENED: Mutex<Vec<&'static Library>> = Mutex::new(Vec::new());

/// Position and frame of a handle, in the vendor's axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DhdPose {
    /// Position, m.
    pub position: DVec3,
    /// The handle's axes as columns.
    pub frame: DMat3,
}

impl DhdPose {
    /// True if all of its values are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.position.is_finite() && self.frame.is_finite()
    }
}

impl Library {
    /// The library in the file `asked`, or by its usual names where the system looks for libraries.
    ///
    /// # Errors
    /// A [`UserError`]: it is missing, it cannot be loaded, or it is not the vendor's.
    pub fn find(asked: Option<&Path>) -> Result<&'static Self, UserError> {
        DHD.find(asked, Self::open_file)
    }

    fn open_file(name: &Path) -> Result<&'static Self, Unusable> {
        let mut opened = OPENED.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(library) = opened.iter().find(|library| library.name == name) {
            return Ok(library);
        }
        let loaded = load(name)?;
        let functions = Functions::of(&loaded).map_err(Unusable::Lacks)?;
        std::mem::forget(loaded);
        let library = Box::leak(Box::new(Self {
            functions,
            name: name.to_owned(),
        }));
        opened.push(library);
        Ok(library)
    }

    /// Its version.
    #[must_use]
    pub fn version(&self) -> String {
        let mut version: [c_int; 4] = [0; 4];
        let [major, minor, release, revision] = &mut version;
        // SAFETY: room for four numbers.
        unsafe { (self.functions.version)(major, minor, release, revision) };
        version.map(|number| number.to_string()).join(".")
    }

    /// Opens the device of a serial number, or the first.
    ///
    /// # Errors
    /// [`OpenError`].
    pub fn open(&'static self, serial: Option<&str>) -> Result<Dhd, OpenError> {
        let wanted = serial.map(|text| {
            let number = text.parse::<c_ushort>();
            number.map_err(|_| OpenError::Address(text.to_owned()))
        });
        let wanted = wanted.transpose()?;
        // SAFETY: it has no arguments.
        let count = unsafe { (self.functions.device_count)() }.clamp(0, c_int::from(i8::MAX));
        let mut seen = Vec::new();
        for index in 0..count {
            // SAFETY: a number.
            let id = unsafe { (self.functions.open_id)(index as c_char) };
            let Ok(id) = DhdId::try_from(id) else {
                continue;
            };
            if id < 0 {
                continue;
            }
            let dhd = Dhd { library: self, id };
            let own = dhd.serial();
            if wanted.is_none() || wanted == own {
                return Ok(dhd);
            }
            seen.extend(own);
        }
        // SAFETY: it has no arguments and returns a text of its own.
        let said = words(unsafe { (self.functions.error_words)() });
        Err(match (wanted, seen.is_empty()) {
            (Some(wanted), false) => OpenError::Serial(wanted, seen),
            _ if count == 0 => OpenError::Absent,
            _ => OpenError::Closed(said),
        })
    }
}

/// An open device.
#[derive(Debug)]
pub struct Dhd {
    library: &'static Library,
    id: DhdId,
}

impl Dhd {
    fn serial(&self) -> Option<c_ushort> {
        let mut serial = 0;
        // SAFETY: room for the number.
        let done = unsafe { (self.library.functions.serial)(&raw mut serial, self.id) };
        (done >= 0).then_some(serial)
    }

    /// The vendor's number of its type.
    #[must_use]
    pub fn system_type(&self) -> i32 {
        // SAFETY: a number.
        unsafe { (self.library.functions.system_type)(self.id) }
    }

    /// Its name.
    #[must_use]
    pub fn name(&self) -> String {
        // SAFETY: it returns a text of its own, or null.
        words(unsafe { (self.library.functions.system_name)(self.id) })
    }

    /// True if it senses how its handle is turned.
    #[must_use]
    pub fn has_wrist(&self) -> bool {
        // SAFETY: a number.
        unsafe { (self.library.functions.has_wrist)(self.id) }
    }

    /// Switches its amplifiers.
    pub fn enable_force(&self, on: bool) {
        // SAFETY: numbers.
        unsafe { (self.library.functions.enable_force)(c_uchar::from(on), self.id) };
    }

    /// Its handle; none if nothing is new.
    ///
    /// # Errors
    /// [`LOST`].
    pub fn pose(&self) -> Result<Option<DhdPose>, DeviceError> {
        let mut place = [0.0; 3];
        // Rows.
        let mut frame = [0.0; 9];
        let [x, y, z] = &mut place;
        // SAFETY: room for three numbers and for a matrix of three by three.
        let done = unsafe { (self.library.functions.pose)(x, y, z, frame.as_mut_ptr(), self.id) };
        match done {
            TIME_GUARD => Ok(None),
            done if done < 0 => Err(LOST),
            _ => Ok(Some(DhdPose {
                position: DVec3::from_array(place),
                frame: DMat3::from_cols_array(&frame).transpose(),
            })),
        }
    }

    /// Velocity of its handle, m/s.
    ///
    /// # Errors
    /// [`LOST`].
    pub fn velocity(&self) -> Result<DVec3, DeviceError> {
        let mut velocity = [0.0; 3];
        let [x, y, z] = &mut velocity;
        // SAFETY: room for three numbers.
        let done = unsafe { (self.library.functions.velocity)(x, y, z, self.id) };
        if done < 0 {
            Err(LOST)
        } else {
            Ok(DVec3::from_array(velocity))
        }
    }

    /// Its buttons, one bit each.
    #[must_use]
    pub fn buttons(&self) -> u32 {
        // SAFETY: a number.
        unsafe { (self.library.functions.buttons)(self.id) }
    }

    /// Sets the force on its handle, N; that its motors give no more is no error.
    ///
    /// # Errors
    /// [`LOST`].
    pub fn set_force(&self, force: DVec3) -> Result<(), DeviceError> {
        let [x, y, z] = force.to_array();
        // SAFETY: numbers.
        let done =
            unsafe { (self.library.functions.set_force)(x, y, z, 0.0, 0.0, 0.0, 0.0, self.id) };
        if done < 0 { Err(LOST) } else { Ok(()) }
    }
}

impl Drop for Dhd {
    fn drop(&mut self) {
        // SAFETY: a number, which is used no more.
        unsafe { (self.library.functions.close)(self.id) };
    }
}

/// A text of the library's; a question mark where it has none.
fn words(text: *const c_char) -> String {
    if text.is_null() {
        return "?".to_owned();
    }
    // SAFETY: the library's texts end with a zero, and stay until its next call of this thread.
    unsafe { CStr::from_ptr(text) }
        .to_string_lossy()
        .into_owned()
}
