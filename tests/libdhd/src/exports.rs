//! The C functions (dhdc.h of SDK 3.16), and those by which a test talks to the fake.

#![allow(
    unsafe_code,
    reason = "functions of C that write through their caller's pointers"
)]

use std::ffi::{CStr, CString, c_char, c_int, c_uchar, c_uint, c_ushort};
use std::sync::{Mutex, PoisonError};

use crate::script::{Call, Script};

/// The device and what was called.
#[derive(Default)]
struct State {
    script: Script,
    calls: Vec<Call>,
}

static STATE: Mutex<Option<State>> = Mutex::new(None);

fn with<T>(work: impl FnOnce(&mut State) -> T) -> T {
    let mut state = STATE.lock().unwrap_or_else(PoisonError::into_inner);
    work(state.get_or_insert_default())
}

#[unsafe(no_mangle)]
unsafe extern "C" fn dhdGetSDKVersion(
    major: *mut c_int,
    minor: *mut c_int,
    release: *mut c_int,
    revision: *mut c_int,
) {
    for (to, number) in [(major, 3), (minor, 16), (release, 1), (revision, 0)] {
        // SAFETY: the caller has room for each number.
        unsafe { to.write(number) };
    }
}

#[unsafe(no_mangle)]
extern "C" fn dhdGetDeviceCount() -> c_int {
    with(|state| state.script.serials.len() as c_int)
}

#[unsafe(no_mangle)]
extern "C" fn dhdOpenID(index: c_char) -> c_int {
    with(|state| {
        if state.script.is_held {
            return -1;
        }
        state.calls.push(Call::Open(index));
        c_int::from(index)
    })
}

#[unsafe(no_mangle)]
extern "C" fn dhdClose(id: c_char) -> c_int {
    with(|state| state.calls.push(Call::Close(id)));
    0
}

#[unsafe(no_mangle)]
extern "C" fn dhdErrorGetLastStr() -> *const c_char {
    c"device is in use".as_ptr()
}

#[unsafe(no_mangle)]
unsafe extern "C" fn dhdGetSerialNumber(serial: *mut c_ushort, id: c_char) -> c_int {
    let own = with(|state| state.script.serials.get(id as usize).copied());
    match own {
        Some(own) => {
            // SAFETY: the caller has room for the number.
            unsafe { serial.write(own) };
            0
        }
        None => -1,
    }
}

#[unsafe(no_mangle)]
extern "C" fn dhdGetSystemType(_id: c_char) -> c_int {
    with(|state| state.script.system_type)
}

#[unsafe(no_mangle)]
extern "C" fn dhdGetSystemName(_id: c_char) -> *const c_char {
    c"omega.6".as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn dhdHasWrist(_id: c_char) -> bool {
    with(|state| state.script.has_wrist)
}

#[unsafe(no_mangle)]
extern "C" fn dhdEnableForce(on: c_uchar, _id: c_char) -> c_int {
    with(|state| state.calls.push(Call::Enable(on == 1)));
    0
}

/// Writes three numbers to the caller.
unsafe fn write(values: [f64; 3], to: [*mut f64; 3]) {
    for (value, to) in values.into_iter().zip(to) {
        // SAFETY: the caller has room for each number.
        unsafe { to.write(value) };
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn dhdGetPositionAndOrientationFrame(
    x: *mut f64,
    y: *mut f64,
    z: *mut f64,
    frame: *mut f64,
    _id: c_char,
) -> c_int {
    let (position, rows, code) = with(|state| {
        let script = &state.script;
        (script.position, script.frame, script.pose_code)
    });
    // SAFETY: the caller has room for three numbers and for nine.
    unsafe {
        write(position, [x, y, z]);
        for (place, value) in rows.into_iter().flatten().enumerate() {
            frame.add(place).write(value);
        }
    }
    code
}

#[unsafe(no_mangle)]
unsafe extern "C" fn dhdGetLinearVelocity(
    x: *mut f64,
    y: *mut f64,
    z: *mut f64,
    _id: c_char,
) -> c_int {
    let velocity = with(|state| state.script.velocity);
    // SAFETY: the caller has room for three numbers.
    unsafe { write(velocity, [x, y, z]) };
    0
}

#[unsafe(no_mangle)]
extern "C" fn dhdGetButtonMask(_id: c_char) -> c_uint {
    with(|state| state.script.buttons)
}

#[unsafe(no_mangle)]
extern "C" fn dhdSetForceAndTorqueAndGripperForce(
    x: f64,
    y: f64,
    z: f64,
    _about_x: f64,
    _about_y: f64,
    _about_z: f64,
    _gripper: f64,
    _id: c_char,
) -> c_int {
    with(|state| {
        state.calls.push(Call::Force([x, y, z]));
        state.script.force_code
    })
}

#[unsafe(no_mangle)]
unsafe extern "C" fn maulstick_libdhd_script(json: *const c_char) {
    // SAFETY: the caller's text ends with a zero.
    let json = unsafe { CStr::from_ptr(json) }.to_string_lossy();
    if let Ok(script) = serde_json::from_str(&json) {
        with(|state| state.script = script);
    }
}

#[unsafe(no_mangle)]
extern "C" fn maulstick_libdhd_log() -> *mut c_char {
    let calls = with(|state| std::mem::take(&mut state.calls));
    let json = serde_json::to_string(&calls).unwrap_or_default();
    CString::new(json).unwrap_or_default().into_raw()
}

#[unsafe(no_mangle)]
unsafe extern "C" fn maulstick_libdhd_free(text: *mut c_char) {
    // SAFETY: a text of `maulstick_libdhd_log`, given back once.
    drop(unsafe { CString::from_raw(text) });
}
