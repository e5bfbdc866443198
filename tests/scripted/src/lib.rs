//! How a test hands a script in and gets the calls out, through a shared library that the driver under test has opened too
//! in place of the vendor's: the test and the driver share its statics, and nothing of their own.
//!
//! Such a library exports `<name>_script`, which takes a script in JSON, `<name>_log`, which gives the calls since the last
//! question in JSON, and `<name>_free`, which takes that text back.

#![allow(
    unsafe_code,
    reason = "functions of a shared library, of which this crate says what they are"
)]

use std::ffi::{CStr, CString, c_char};
use std::marker::PhantomData;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde::Serialize;
use serde::de::DeserializeOwned;

/// What a device is and senses.
pub trait Script: Serialize {
    /// Name of the shared library, and the beginning of what it exports.
    const LIBRARY: &'static str;
    /// A call that moved something.
    type Call: DeserializeOwned;

    /// Where cargo puts the shared library: beside the tests.
    ///
    /// # Errors
    /// What the system says where a test does not know its own path.
    fn path() -> std::io::Result<PathBuf> {
        let file = format!("lib{}.so", Self::LIBRARY);
        Ok(std::env::current_exe()?.with_file_name(file))
    }
}

/// The shared library's own functions. While one is held no other is given out: a library has one device.
pub struct Control<S> {
    library: libloading::Library,
    _turn: MutexGuard<'static, ()>,
    script: PhantomData<S>,
}

static TURN: Mutex<()> = Mutex::new(());

impl<S: Script> Control<S> {
    /// Begins anew by a script; waits for its turn where another test of the process has it.
    ///
    /// # Errors
    /// What is wrong with the library.
    pub fn play(script: &S) -> Result<Self, String> {
        let turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        let path = S::path().map_err(|error| error.to_string())?;
        // SAFETY: a library of these tests, which does nothing as it is opened.
        let library = unsafe { libloading::Library::new(path) }.map_err(words)?;
        let control = Self {
            library,
            _turn: turn,
            script: PhantomData,
        };
        control.calls()?;
        control.change(script)?;
        Ok(control)
    }

    /// The device is another from now on.
    ///
    /// # Errors
    /// What is wrong with the library.
    pub fn change(&self, script: &S) -> Result<(), String> {
        let json = serde_json::to_string(script).map_err(|error| error.to_string())?;
        let json = CString::new(json).map_err(|error| error.to_string())?;
        let change = self.function::<unsafe extern "C" fn(*const c_char)>("script")?;
        // SAFETY: as the library declares it; the text outlives the call.
        unsafe { change(json.as_ptr()) };
        Ok(())
    }

    /// What was called since the last question.
    ///
    /// # Errors
    /// What is wrong with the library.
    pub fn calls(&self) -> Result<Vec<S::Call>, String> {
        let get = self.function::<unsafe extern "C" fn() -> *mut c_char>("log")?;
        let free = self.function::<unsafe extern "C" fn(*mut c_char)>("free")?;
        // SAFETY: as the library declares them; the text is not used after it is given back.
        let json = unsafe {
            let log = get();
            let json = CStr::from_ptr(log).to_string_lossy().into_owned();
            free(log);
            json
        };
        serde_json::from_str(&json).map_err(|error| error.to_string())
    }

    fn function<F: Copy>(&self, what: &str) -> Result<F, String> {
        let name = format!("{}_{what}", S::LIBRARY);
        // SAFETY: what a library of these tests exports, each by one declaration.
        unsafe { self.library.get::<F>(&name) }
            .map(|function| *function)
            .map_err(words)
    }
}

fn words(error: libloading::Error) -> String {
    format!("{error:?}")
}
