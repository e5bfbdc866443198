//! How a test hands a script in and gets the log out, through the shared library that the driver
//! under test has opened too.

#![allow(
    unsafe_code,
    reason = "functions of a shared library, of which this crate says what they are"
)]

use std::ffi::{CStr, CString, c_char, c_uchar, c_ulong};
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::log::Call;
use crate::script::{Event, Script};

/// The shared library's own functions. While one is held no other is given out: the library has one
/// device and one scheduler.
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
    Ok(std::env::current_exe()?.with_file_name("libmaulstick_libhd.so"))
}

impl Control {
    /// Begins anew by a script; waits for its turn where another test of the process has it.
    ///
    /// # Errors
    /// What is wrong: there is no such library, or a device of it is still in use.
    pub fn play(script: &Script) -> Result<Self, String> {
        let turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        let path = path().map_err(|error| error.to_string())?;
        // SAFETY: this crate's own library, which does nothing as it is opened.
        let library = unsafe { libloading::Library::new(path) }.map_err(|e| format!("{e:?}"))?;
        let control = Self {
            library,
            _turn: turn,
        };
        let json = serde_json::to_string(script).map_err(|error| error.to_string())?;
        match control.hand_in("maulstick_libhd_script", json)? {
            1 => Ok(control),
            _ => Err("a device is still in use, or the script is of another build".into()),
        }
    }

    /// Has something happen now.
    ///
    /// # Errors
    /// What is wrong with the library.
    pub fn happen(&self, event: &Event) -> Result<(), String> {
        let json = serde_json::to_string(event).map_err(|error| error.to_string())?;
        self.hand_in("maulstick_libhd_event", json).map(drop)
    }

    /// What was called, from the call of this number on.
    ///
    /// # Errors
    /// What is wrong with the library.
    pub fn calls(&self, from: usize) -> Result<Vec<Call>, String> {
        type Log = unsafe extern "C" fn(c_ulong) -> *mut c_char;
        type Free = unsafe extern "C" fn(*mut c_char);
        // SAFETY: as `exports` declares them; the text is not used after it is given back.
        let json = unsafe {
            let get = self.library.get::<Log>("maulstick_libhd_log");
            let free = self.library.get::<Free>("maulstick_libhd_free");
            let (get, free) = (get.map_err(words)?, free.map_err(words)?);
            let log = get(from as c_ulong);
            let json = CStr::from_ptr(log).to_string_lossy().into_owned();
            free(log);
            json
        };
        serde_json::from_str(&json).map_err(|error| error.to_string())
    }

    fn hand_in(&self, name: &str, json: String) -> Result<c_uchar, String> {
        type HandIn = unsafe extern "C" fn(*const c_char) -> c_uchar;
        let json = CString::new(json).map_err(|error| error.to_string())?;
        // SAFETY: as `exports` declares both; the text outlives the call.
        unsafe {
            let function = self.library.get::<HandIn>(name).map_err(words)?;
            Ok(function(json.as_ptr()))
        }
    }
}

fn words(error: libloading::Error) -> String {
    format!("{error:?}")
}
