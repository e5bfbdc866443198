//! How a test hands a script in and gets the log out, through the shared library that the driver under test has opened too.

#![allow(
    unsafe_code,
    reason = "functions of a shared library, of which this crate says what they are"
)]

use std::ffi::{CStr, CString, c_char};
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::script::{Call, Script};

/// The shared library's own functions. While one is held no other is given out: the library has one device.
pub struct Control {
    library: libloading::Library,
    _turn: MutexGuard<'static, ()>,
}

static TURN: Mutex<()> = Mutex::new(());

/// Where cargo puts the shared library: beside the tests.
///
/// # Errors
/// What the system says where a test does not know its own path.
pub fn path() -> std::io::Result<PathBuf> {
    Ok(std::env::current_exe()?.with_file_name("libmaulstick_libdhd.so"))
}

impl Control {
    /// Begins anew by a script; waits for its turn where another test of the process has it.
    ///
    /// # Errors
    /// What is wrong with the library.
    pub fn play(script: &Script) -> Result<Self, String> {
        let turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        let path = path().map_err(|error| error.to_string())?;
        // SAFETY: this crate's own library, which does nothing as it is opened.
        let library = unsafe { libloading::Library::new(path) }.map_err(|e| format!("{e:?}"))?;
        let control = Self {
            library,
            _turn: turn,
        };
        control.calls()?;
        control.change(script)?;
        Ok(control)
    }

    /// The device is another from now on.
    ///
    /// # Errors
    /// What is wrong with the library.
    pub fn change(&self, script: &Script) -> Result<(), String> {
        type Change = unsafe extern "C" fn(*const c_char);
        let json = serde_json::to_string(script).map_err(|error| error.to_string())?;
        let json = CString::new(json).map_err(|error| error.to_string())?;
        // SAFETY: as `exports` declares it; the text outlives the call.
        unsafe {
            let change = self.library.get::<Change>("maulstick_libdhd_script");
            change.map_err(|error| format!("{error:?}"))?(json.as_ptr());
        }
        Ok(())
    }

    /// What was called since the last question.
    ///
    /// # Errors
    /// What is wrong with the library.
    pub fn calls(&self) -> Result<Vec<Call>, String> {
        type Log = unsafe extern "C" fn() -> *mut c_char;
        type Free = unsafe extern "C" fn(*mut c_char);
        // SAFETY: as `exports` declares them; the text is not used after it is given back.
        let json = unsafe {
            let words = |error: libloading::Error| format!("{error:?}");
            let get = self
                .library
                .get::<Log>("maulstick_libdhd_log")
                .map_err(words)?;
            let free = self
                .library
                .get::<Free>("maulstick_libdhd_free")
                .map_err(words)?;
            let log = get();
            let json = CStr::from_ptr(log).to_string_lossy().into_owned();
            free(log);
            json
        };
        serde_json::from_str(&json).map_err(|error| error.to_string())
    }
}
