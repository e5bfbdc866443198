//! The C functions (hd.h of OpenHaptics 3.4), and those by which a test talks to the fake.

#![allow(
    unsafe_code,
    reason = "functions of C that write through their caller's pointers"
)]

use std::ffi::{CStr, CString, c_char, c_int, c_long, c_uchar, c_ulong, c_ushort, c_void};

use crate::codes;
use crate::library::{Callback, Capability, with};
use crate::phantom::Phantom;
use crate::scheduler;

/// An error with the device that it came from.
#[repr(C)]
pub(crate) struct ErrorInfo {
    code: u32,
    internal: c_int,
    device: u32,
}

/// A text of C, as one of ours; a null pointer is empty.
unsafe fn text(at: *const c_char) -> String {
    if at.is_null() {
        return String::new();
    }
    // SAFETY: the caller's text ends with a zero.
    unsafe { CStr::from_ptr(at) }.to_string_lossy().into_owned()
}

/// Writes values of a parameter to the caller.
unsafe fn write<T: Copy>(values: Option<Vec<T>>, to: *mut T) {
    for (place, value) in values.into_iter().flatten().enumerate() {
        // SAFETY: the caller has room for as many values as the parameter has.
        unsafe { to.add(place).write(value) };
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn hdInitDevice(name: *const c_char) -> u32 {
    // SAFETY: a null pointer or a text.
    let name = unsafe { text(name) };
    with(|state| state.init(name))
}

#[unsafe(no_mangle)]
extern "C" fn hdDisableDevice(handle: u32) {
    with(|state| state.disable_device(handle));
}

#[unsafe(no_mangle)]
extern "C" fn hdMakeCurrentDevice(handle: u32) {
    with(|state| state.make_current(handle));
}

#[unsafe(no_mangle)]
extern "C" fn hdGetCurrentDevice() -> u32 {
    with(|state| state.current())
}

#[unsafe(no_mangle)]
extern "C" fn hdBeginFrame(handle: u32) {
    with(|state| state.begin(handle));
}

#[unsafe(no_mangle)]
extern "C" fn hdEndFrame(handle: u32) {
    with(|state| state.end(handle));
}

#[unsafe(no_mangle)]
extern "C" fn hdGetError() -> ErrorInfo {
    with(|state| {
        let (code, internal) = state.pop_from(scheduler::whose());
        ErrorInfo {
            code,
            internal,
            device: state.current(),
        }
    })
}

#[unsafe(no_mangle)]
extern "C" fn hdGetErrorString(code: u32) -> *const c_char {
    codes::words(code).as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn hdEnable(capability: u32) {
    with(|state| state.switch(capability, Capability::On));
}

#[unsafe(no_mangle)]
extern "C" fn hdDisable(capability: u32) {
    with(|state| state.switch(capability, Capability::Off));
}

#[unsafe(no_mangle)]
extern "C" fn hdIsEnabled(capability: u32) -> c_uchar {
    with(|state| u8::from(state.is_enabled(capability)))
}

#[unsafe(no_mangle)]
unsafe extern "C" fn hdGetBooleanv(parameter: u32, to: *mut c_uchar) {
    let value = with(|state| state.value(parameter, Phantom::boolean));
    // SAFETY: as the caller promises.
    unsafe { write(value.map(|value| vec![value]), to) };
}

#[unsafe(no_mangle)]
unsafe extern "C" fn hdGetIntegerv(parameter: u32, to: *mut c_int) {
    let value = with(|state| state.value(parameter, Phantom::integer));
    // SAFETY: as the caller promises.
    unsafe { write(value.map(|value| vec![value]), to) };
}

#[unsafe(no_mangle)]
unsafe extern "C" fn hdGetFloatv(parameter: u32, to: *mut f32) {
    let values = with(|state| state.value(parameter, Phantom::floats));
    let narrow = |values: Vec<f64>| values.iter().map(|value| *value as f32).collect();
    // SAFETY: as the caller promises.
    unsafe { write(values.map(narrow), to) };
}

#[unsafe(no_mangle)]
unsafe extern "C" fn hdGetDoublev(parameter: u32, to: *mut f64) {
    let values = with(|state| state.value(parameter, Phantom::doubles));
    // SAFETY: as the caller promises.
    unsafe { write(values, to) };
}

#[unsafe(no_mangle)]
unsafe extern "C" fn hdGetLongv(_parameter: u32, _to: *mut c_long) {
    // This Phantom hides its encoders.
    with(|state| state.report(codes::INVALID_ENUM, 0));
}

#[unsafe(no_mangle)]
unsafe extern "C" fn hdSetDoublev(parameter: u32, from: *const f64) {
    // SAFETY: what can be set of a Phantom are three values.
    let values = [0, 1, 2].map(|place| unsafe { from.add(place).read() });
    with(|state| state.set(parameter, values));
}

#[unsafe(no_mangle)]
unsafe extern "C" fn hdSetFloatv(parameter: u32, from: *const f32) {
    // SAFETY: what can be set of a Phantom are three values.
    let values = [0, 1, 2].map(|place| f64::from(unsafe { from.add(place).read() }));
    with(|state| state.set(parameter, values));
}

#[unsafe(no_mangle)]
unsafe extern "C" fn hdGetString(parameter: u32) -> *const c_char {
    let fixed = match parameter {
        codes::MODEL => None,
        codes::VERSION => Some(c"3.40.0"),
        codes::DRIVER => Some(c"4.3"),
        codes::VENDOR => Some(c"Maulstick"),
        codes::SERIAL => Some(c"00000815"),
        _ => {
            with(|state| state.report(codes::INVALID_ENUM, 0));
            return std::ptr::null();
        }
    };
    let model = with(|state| CString::new(state.model()).unwrap_or_default());
    // The library's texts live for ever.
    fixed.map_or_else(|| model.into_raw().cast_const(), CStr::as_ptr)
}

#[unsafe(no_mangle)]
extern "C" fn hdCheckCalibration() -> u32 {
    with(|state| state.check())
}

#[unsafe(no_mangle)]
extern "C" fn hdUpdateCalibration(style: u32) {
    with(|state| state.update(style));
}

#[unsafe(no_mangle)]
extern "C" fn hdStartScheduler() {
    if with(|state| state.start()) {
        scheduler::start();
    }
}

#[unsafe(no_mangle)]
extern "C" fn hdStopScheduler() {
    scheduler::stop();
}

#[unsafe(no_mangle)]
extern "C" fn hdSetSchedulerRate(rate: c_ulong) {
    with(|state| {
        state.log.push(crate::Call::Rate(rate));
        if ![500, 1000, 2000].contains(&rate) {
            state.report(codes::INVALID_VALUE, 0);
        }
    });
}

#[unsafe(no_mangle)]
extern "C" fn hdScheduleAsynchronous(
    callback: Callback,
    data: *mut c_void,
    priority: c_ushort,
) -> c_ulong {
    with(|state| state.schedule(callback, data as usize, priority))
}

#[unsafe(no_mangle)]
extern "C" fn hdUnschedule(handle: c_ulong) {
    with(|state| state.unschedule(handle));
}

/// Begins anew by a script in JSON: 1 where it does.
#[unsafe(no_mangle)]
unsafe extern "C" fn maulstick_libhd_script(json: *const c_char) -> c_uchar {
    // SAFETY: a text.
    let json = unsafe { text(json) };
    let played = serde_json::from_str(&json).is_ok_and(|script| with(|state| state.play(script)));
    u8::from(played)
}

/// Has an event in JSON happen now: 1 where it does.
#[unsafe(no_mangle)]
unsafe extern "C" fn maulstick_libhd_event(json: *const c_char) -> c_uchar {
    // SAFETY: a text.
    let json = unsafe { text(json) };
    let event = serde_json::from_str(&json);
    u8::from(event.is_ok_and(|event| {
        with(|state| state.happen(&event));
        true
    }))
}

/// The log since the call of this number, in JSON; to be given back to [`maulstick_libhd_free`].
#[unsafe(no_mangle)]
extern "C" fn maulstick_libhd_log(from: c_ulong) -> *mut c_char {
    let calls = with(|state| state.log.get(from as usize..).unwrap_or_default().to_vec());
    let json = serde_json::to_string(&calls).unwrap_or_default();
    CString::new(json).unwrap_or_default().into_raw()
}

/// Gives a log back.
#[unsafe(no_mangle)]
unsafe extern "C" fn maulstick_libhd_free(log: *mut c_char) {
    // SAFETY: `maulstick_libhd_log` made it.
    drop(unsafe { CString::from_raw(log) });
}
