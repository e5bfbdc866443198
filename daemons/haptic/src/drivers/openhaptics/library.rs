//! The vendor's library, opened at run time: its functions, behind ones that cannot be misused.
//!
//! It is never closed: its driver fails if it is loaded a second time in a process (so says CHAI3D).

#![allow(
    unsafe_code,
    reason = "functions of a shared library, of which the vendor's headers say what they are"
)]

use std::ffi::{CStr, CString, c_char, c_int, c_uchar, c_ulong, c_ushort, c_void};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use maulstick_rig::UserError;

use crate::drivers::vendor_library::{Unusable, VendorLibrary, load};

use super::abi::{
    Boolean, Capability, Doubles, ErrorInfo, Float, Handle, Integer, MOST_DOUBLES, Text, error,
};

/// Function that the scheduler calls.
pub type Callback = unsafe extern "C" fn(*mut c_void) -> u32;

/// A callback that has been scheduled.
#[derive(Clone, Copy, Debug)]
pub struct Scheduled(c_ulong);

/// As its vendor calls it.
pub const HD: VendorLibrary = VendorLibrary {
    product: "OpenHaptics",
    kind: "HD library of OpenHaptics",
    names: ["libHD.so", "libHD.so.3.4", "libHD.so.3.0"],
    install: "install OpenHaptics and the driver of the device, or say where libHD.so is by `library` in rig.toml",
    correct: "`library` in rig.toml is to name libHD.so, of OpenHaptics 3.0 or newer",
};

macro_rules! functions {
    ($($field:ident = $name:literal: fn($($argument:ty),*) $(-> $result:ty)?;)*) => {
        struct Functions {
            $($field: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
        }

        impl Functions {
            /// All of them, or the name of the first that is not there.
            fn of(library: &libloading::Library) -> Result<Self, &'static str> {
                Ok(Self {
                    // SAFETY: the vendor's headers declare it so, in 3.0 as in 3.4.
                    $($field: unsafe { *library.get($name).map_err(|_| $name)? },)*
                })
            }
        }
    };
}

functions! {
    init_device = "hdInitDevice": fn(*const c_char) -> Handle;
    disable_device = "hdDisableDevice": fn(Handle);
    make_current = "hdMakeCurrentDevice": fn(Handle);
    begin_frame = "hdBeginFrame": fn(Handle);
    end_frame = "hdEndFrame": fn(Handle);
    get_error = "hdGetError": fn() -> ErrorInfo;
    error_string = "hdGetErrorString": fn(u32) -> *const c_char;
    enable = "hdEnable": fn(u32);
    disable = "hdDisable": fn(u32);
    get_boolean = "hdGetBooleanv": fn(u32, *mut c_uchar);
    get_integer = "hdGetIntegerv": fn(u32, *mut c_int);
    get_float = "hdGetFloatv": fn(u32, *mut f32);
    get_double = "hdGetDoublev": fn(u32, *mut f64);
    set_double = "hdSetDoublev": fn(u32, *const f64);
    get_string = "hdGetString": fn(u32) -> *const c_char;
    check_calibration = "hdCheckCalibration": fn() -> u32;
    update_calibration = "hdUpdateCalibration": fn(u32);
    start_scheduler = "hdStartScheduler": fn();
    stop_scheduler = "hdStopScheduler": fn();
    set_scheduler_rate = "hdSetSchedulerRate": fn(c_ulong);
    schedule = "hdScheduleAsynchronous": fn(Callback, *mut c_void, c_ushort) -> c_ulong;
    unschedule = "hdUnschedule": fn(c_ulong);
}

/// The library.
pub struct Library {
    functions: Functions,
    /// The name by which it was found.
    pub name: PathBuf,
}

impl std::fmt::Debug for Library {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Library").field("name", &self.name).finish()
    }
}

/// Libraries opened so far.
static OPENED: Mutex<Vec<&'static Library>> = Mutex::new(Vec::new());

impl Library {
    /// The library in the file `asked`, or by its usual names where the system looks for libraries.
    ///
    /// # Errors
    /// A [`UserError`]: it is missing, it cannot be loaded, or it is not OpenHaptics'.
    pub fn find(asked: Option<&Path>) -> Result<&'static Self, UserError> {
        HD.find(asked, Self::open)
    }

    fn open(name: &Path) -> Result<&'static Self, Unusable> {
        let mut opened = OPENED.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(library) = opened.iter().find(|library| library.name == name) {
            return Ok(library);
        }
        let loaded = load(name)?;
        let functions = Functions::of(&loaded);
        std::mem::forget(loaded);
        let library = Box::leak(Box::new(Self {
            functions: functions.map_err(Unusable::Lacks)?,
            name: name.to_owned(),
        }));
        opened.push(library);
        Ok(library)
    }

    /// Initiates a device; without a name the default one.
    ///
    /// # Errors
    /// The library's error; nothing is left behind.
    pub fn init_device(&self, name: Option<&CStr>) -> Result<Handle, ErrorInfo> {
        self.forget_errors();
        let name = name.map_or(std::ptr::null(), CStr::as_ptr);
        // SAFETY: a null pointer or a text, which the library copies.
        let handle = unsafe { (self.functions.init_device)(name) };
        match self.forget_errors() {
            // The handle alone does not tell.
            None if handle != super::abi::INVALID_HANDLE => Ok(handle),
            None => Err(ErrorInfo {
                code: error::BAD_HANDLE,
                internal: 0,
                device: handle,
            }),
            Some(error) => {
                if handle != super::abi::INVALID_HANDLE {
                    self.disable_device(handle);
                }
                Err(error)
            }
        }
    }

    /// Lets a device go.
    pub fn disable_device(&self, device: Handle) {
        // SAFETY: a number.
        unsafe { (self.functions.disable_device)(device) };
        self.forget_errors();
    }

    /// Makes this the device of the following calls.
    pub fn make_current(&self, device: Handle) {
        // SAFETY: a number.
        unsafe { (self.functions.make_current)(device) };
    }

    /// Begins a device's frame.
    pub fn begin_frame(&self, device: Handle) {
        // SAFETY: a number.
        unsafe { (self.functions.begin_frame)(device) };
    }

    /// Ends a device's frame.
    pub fn end_frame(&self, device: Handle) {
        // SAFETY: a number.
        unsafe { (self.functions.end_frame)(device) };
    }

    /// The newest error, which is forgotten then.
    #[must_use]
    pub fn next_error(&self) -> Option<ErrorInfo> {
        // SAFETY: it has no arguments.
        let error = unsafe { (self.functions.get_error)() };
        (error.code != error::SUCCESS).then_some(error)
    }

    /// Forgets what went wrong so far; returns the oldest, for the others may come of it.
    pub fn forget_errors(&self) -> Option<ErrorInfo> {
        // A library that never runs out of errors must not hang its user.
        (0..MOST_ERRORS).map_while(|_| self.next_error()).last()
    }

    /// The library's text for a code.
    #[must_use]
    pub fn error_words(&self, code: u32) -> String {
        // SAFETY: it takes any number and returns a text of its own.
        words(unsafe { (self.functions.error_string)(code) })
    }

    /// Switches a capability on.
    pub fn enable(&self, capability: Capability) {
        // SAFETY: a number.
        unsafe { (self.functions.enable)(capability.0) };
    }

    /// Switches a capability off.
    pub fn disable(&self, capability: Capability) {
        // SAFETY: a number.
        unsafe { (self.functions.disable)(capability.0) };
    }

    /// A boolean of the current device; `absent` where it gives none.
    #[must_use]
    pub fn boolean(&self, parameter: Boolean, absent: u8) -> u8 {
        let mut value = absent;
        // SAFETY: room for the one value that the parameter has.
        unsafe { (self.functions.get_boolean)(parameter.0, &raw mut value) };
        value
    }

    /// An integer of the current device; 0 where it gives none.
    #[must_use]
    pub fn integer(&self, parameter: Integer) -> i32 {
        let mut value = 0;
        // SAFETY: room for the one value that the parameter has.
        unsafe { (self.functions.get_integer)(parameter.0, &raw mut value) };
        value
    }

    /// A float of the current device; not a number where it gives none.
    #[must_use]
    pub fn float(&self, parameter: Float) -> f64 {
        let mut values = [f32::NAN; MOST_DOUBLES];
        // SAFETY: room for more values than the one that the parameter has.
        unsafe { (self.functions.get_float)(parameter.0, values.as_mut_ptr()) };
        f64::from(values[0])
    }

    /// Doubles of the current device; those are `absent` that it does not give.
    #[must_use]
    pub fn doubles<const N: usize>(&self, parameter: Doubles<N>, absent: f64) -> [f64; N] {
        // Room for the longest: a driver that gives more than its manual says does no harm.
        let mut values = [absent; MOST_DOUBLES];
        // SAFETY: room for more values than any parameter of doubles has.
        unsafe { (self.functions.get_double)(parameter.0, values.as_mut_ptr()) };
        std::array::from_fn(|place| values[place])
    }

    /// Sets doubles of the current device.
    pub fn set_doubles<const N: usize>(&self, parameter: Doubles<N>, values: &[f64; N]) {
        // SAFETY: as many values as the parameter has; they are only read.
        unsafe { (self.functions.set_double)(parameter.0, values.as_ptr()) };
    }

    /// A text of the current device; a question mark where it has none.
    #[must_use]
    pub fn text(&self, parameter: Text) -> String {
        // SAFETY: it takes any number and returns a text of its own, or null.
        words(unsafe { (self.functions.get_string)(parameter.0) })
    }

    /// The state of calibration of the current device.
    #[must_use]
    pub fn check_calibration(&self) -> u32 {
        // SAFETY: it has no arguments.
        unsafe { (self.functions.check_calibration)() }
    }

    /// Calibrates the current device.
    pub fn update_calibration(&self, style: u32) {
        // SAFETY: a number.
        unsafe { (self.functions.update_calibration)(style) };
    }

    /// Starts the scheduler.
    pub fn start_scheduler(&self) {
        // SAFETY: it has no arguments.
        unsafe { (self.functions.start_scheduler)() };
    }

    /// Stops the scheduler.
    pub fn stop_scheduler(&self) {
        // SAFETY: it has no arguments.
        unsafe { (self.functions.stop_scheduler)() };
    }

    /// Sets the scheduler's rate, Hz.
    pub fn set_rate(&self, rate_hz: u64) {
        // SAFETY: a number.
        unsafe { (self.functions.set_scheduler_rate)(rate_hz as c_ulong) };
    }

    /// Has a function called in each tick of the scheduler.
    pub fn schedule(&self, callback: SafeCallback, priority: u16) -> Scheduled {
        // SAFETY: a safe function that takes no pointer.
        let callback = unsafe { std::mem::transmute::<SafeCallback, Callback>(callback) };
        // SAFETY: the function lives for ever and does not look at its pointer.
        Scheduled(unsafe { (self.functions.schedule)(callback, std::ptr::null_mut(), priority) })
    }

    /// Has it called no more.
    pub fn unschedule(&self, scheduled: Scheduled) {
        // SAFETY: a number that the library gave out.
        unsafe { (self.functions.unschedule)(scheduled.0) };
    }
}

/// A function that may be called by anyone, at any time.
pub type SafeCallback = extern "C" fn(*mut c_void) -> u32;

/// Errors that are looked at at a time.
pub const MOST_ERRORS: usize = 64;

/// A text of the library's.
fn words(at: *const c_char) -> String {
    if at.is_null() {
        return "?".into();
    }
    // SAFETY: the library's texts end with a zero and live as long as it does, which is for ever.
    let text: CString = unsafe { CStr::from_ptr(at) }.to_owned();
    text.to_string_lossy().into_owned()
}
