//! The C functions (openxr.h of 1.0), and those by which a test talks to the fake.

#![allow(
    unsafe_code,
    reason = "functions of C that write through their caller's pointers"
)]

use std::ffi::{CStr, CString, c_char, c_void};

use openxr::sys::{self, Handle as _};

use crate::script::Call;
use crate::state::{Suggested, with};

type Code = sys::Result;

fn code(number: i32) -> Code {
    Code::from_raw(number)
}

/// A text of C, as one of ours.
unsafe fn text(at: *const c_char) -> String {
    // SAFETY: the caller's text ends with a zero.
    unsafe { CStr::from_ptr(at) }.to_string_lossy().into_owned()
}

/// A text into a field of C.
fn put(text: &str, field: &mut [c_char]) {
    for (to, byte) in field.iter_mut().zip(text.bytes().chain([0])) {
        *to = byte as c_char;
    }
}

#[unsafe(no_mangle)]
unsafe extern "system" fn xrEnumerateInstanceExtensionProperties(
    _layer: *const c_char,
    room: u32,
    count: *mut u32,
    properties: *mut sys::ExtensionProperties,
) -> Code {
    let names = with(|state| state.script.extensions.clone());
    // SAFETY: the caller has room for the count, and for as many properties as it says.
    unsafe {
        count.write(names.len() as u32);
        for (place, name) in names.iter().take(room as usize).enumerate() {
            let property = &mut *properties.add(place);
            put(name, &mut property.extension_name);
            property.extension_version = 1;
        }
    }
    Code::SUCCESS
}

#[unsafe(no_mangle)]
unsafe extern "system" fn xrCreateInstance(
    _info: *const sys::InstanceCreateInfo,
    instance: *mut sys::Instance,
) -> Code {
    // SAFETY: the caller has room for it.
    unsafe { instance.write(sys::Instance::from_raw(1)) };
    with(|state| {
        state.begin();
        code(state.script.instance_code)
    })
}

unsafe extern "system" fn destroy_instance(_instance: sys::Instance) -> Code {
    with(|state| state.calls.push(Call::DestroyInstance));
    Code::SUCCESS
}

unsafe extern "system" fn get_instance_properties(
    _instance: sys::Instance,
    properties: *mut sys::InstanceProperties,
) -> Code {
    // SAFETY: the caller has room for them.
    put("Scripted", unsafe { &mut (*properties).runtime_name });
    Code::SUCCESS
}

unsafe extern "system" fn get_system(
    _instance: sys::Instance,
    _info: *const sys::SystemGetInfo,
    system: *mut sys::SystemId,
) -> Code {
    // SAFETY: the caller has room for it.
    unsafe { system.write(sys::SystemId::from_raw(1)) };
    with(|state| code(state.script.system_code))
}

unsafe extern "system" fn create_session(
    _instance: sys::Instance,
    _info: *const sys::SessionCreateInfo,
    session: *mut sys::Session,
) -> Code {
    // SAFETY: the caller has room for it.
    unsafe { session.write(sys::Session::from_raw(1)) };
    with(|state| code(state.script.session_code))
}

unsafe extern "system" fn destroy_session(_session: sys::Session) -> Code {
    with(|state| state.calls.push(Call::DestroySession));
    Code::SUCCESS
}

unsafe extern "system" fn begin_session(
    _session: sys::Session,
    _info: *const sys::SessionBeginInfo,
) -> Code {
    with(|state| state.calls.push(Call::Begin));
    Code::SUCCESS
}

unsafe extern "system" fn end_session(_session: sys::Session) -> Code {
    with(|state| state.calls.push(Call::End));
    Code::SUCCESS
}

unsafe extern "system" fn string_to_path(
    _instance: sys::Instance,
    string: *const c_char,
    path: *mut sys::Path,
) -> Code {
    // SAFETY: a text, and room for its path.
    unsafe {
        let text = text(string);
        path.write(sys::Path::from_raw(with(|state| state.path(text))));
    }
    Code::SUCCESS
}

unsafe extern "system" fn create_action_set(
    _instance: sys::Instance,
    _info: *const sys::ActionSetCreateInfo,
    set: *mut sys::ActionSet,
) -> Code {
    // SAFETY: the caller has room for it.
    unsafe { set.write(sys::ActionSet::from_raw(1)) };
    Code::SUCCESS
}

unsafe extern "system" fn create_action(
    _set: sys::ActionSet,
    _info: *const sys::ActionCreateInfo,
    action: *mut sys::Action,
) -> Code {
    // SAFETY: the caller has room for it.
    unsafe { action.write(sys::Action::from_raw(with(|state| state.action()))) };
    Code::SUCCESS
}

unsafe extern "system" fn suggest_bindings(
    _instance: sys::Instance,
    suggested: *const sys::InteractionProfileSuggestedBinding,
) -> Code {
    // SAFETY: the caller has as many bindings as it says.
    let (profile, bindings) = unsafe {
        let suggested = &*suggested;
        let count = suggested.count_suggested_bindings as usize;
        let bindings = std::slice::from_raw_parts(suggested.suggested_bindings, count);
        (suggested.interaction_profile, bindings)
    };
    let bindings: Vec<(u64, u64)> = bindings
        .iter()
        .map(|binding| (binding.action.into_raw(), binding.binding.into_raw()))
        .collect();
    match with(|state| state.suggest(profile.into_raw(), &bindings)) {
        Suggested::Taken => Code::SUCCESS,
        Suggested::Unsupported => Code::ERROR_PATH_UNSUPPORTED,
        Suggested::Invalid => Code::ERROR_VALIDATION_FAILURE,
    }
}

unsafe extern "system" fn attach(
    _session: sys::Session,
    _info: *const sys::SessionActionSetsAttachInfo,
) -> Code {
    with(|state| state.attach());
    Code::SUCCESS
}

unsafe extern "system" fn sync(_session: sys::Session, _info: *const sys::ActionsSyncInfo) -> Code {
    with(|state| state.sync());
    Code::SUCCESS
}

unsafe extern "system" fn action_space(
    _session: sys::Session,
    _info: *const sys::ActionSpaceCreateInfo,
    space: *mut sys::Space,
) -> Code {
    // SAFETY: the caller has room for it.
    unsafe { space.write(sys::Space::from_raw(1)) };
    Code::SUCCESS
}

unsafe extern "system" fn reference_space(
    _session: sys::Session,
    _info: *const sys::ReferenceSpaceCreateInfo,
    space: *mut sys::Space,
) -> Code {
    // SAFETY: the caller has room for it.
    unsafe { space.write(sys::Space::from_raw(2)) };
    Code::SUCCESS
}

unsafe extern "system" fn locate_space(
    _space: sys::Space,
    _base: sys::Space,
    _time: sys::Time,
    location: *mut sys::SpaceLocation,
) -> Code {
    let script = with(|state| state.script.clone());
    let [x, y, z] = script.position;
    let position = sys::Vector3f { x, y, z };
    let [x, y, z, w] = script.orientation;
    // SAFETY: the caller has room for it.
    unsafe {
        (*location).location_flags = sys::SpaceLocationFlags::from_raw(script.known);
        (*location).pose = sys::Posef {
            orientation: sys::Quaternionf { x, y, z, w },
            position,
        };
    }
    code(script.place_code)
}

unsafe extern "system" fn state_float(
    _session: sys::Session,
    info: *const sys::ActionStateGetInfo,
    to: *mut sys::ActionStateFloat,
) -> Code {
    // SAFETY: the caller says which action, and has room for its state.
    unsafe {
        let pressed = with(|state| state.pressed((*info).action.into_raw()));
        (*to).current_state = pressed.unwrap_or_default();
        (*to).is_active = pressed.is_some().into();
    }
    Code::SUCCESS
}

unsafe extern "system" fn state_boolean(
    _session: sys::Session,
    info: *const sys::ActionStateGetInfo,
    to: *mut sys::ActionStateBoolean,
) -> Code {
    // SAFETY: the caller says which action, and has room for its state.
    unsafe {
        let pressed = with(|state| state.pressed((*info).action.into_raw()));
        (*to).current_state = (pressed.unwrap_or_default() > 0.5).into();
        (*to).is_active = pressed.is_some().into();
    }
    Code::SUCCESS
}

/// The part of the controller that an action drives.
fn driven(action: sys::Action) -> String {
    with(|state| state.part(action.into_raw()).cloned()).unwrap_or_default()
}

unsafe extern "system" fn apply_feedback(
    _session: sys::Session,
    info: *const sys::HapticActionInfo,
    feedback: *const sys::HapticBaseHeader,
) -> Code {
    // SAFETY: the only feedback of OpenXR 1.0 without extensions is a vibration.
    let (action, vibration) = unsafe { ((*info).action, *feedback.cast::<sys::HapticVibration>()) };
    let path = driven(action);
    let (amplitude, ns) = (vibration.amplitude, vibration.duration.as_nanos());
    with(|state| state.calls.push(Call::Vibrate(path, amplitude, ns)));
    Code::SUCCESS
}

unsafe extern "system" fn stop_feedback(
    _session: sys::Session,
    info: *const sys::HapticActionInfo,
) -> Code {
    // SAFETY: the caller says which action.
    let path = driven(unsafe { (*info).action });
    with(|state| state.calls.push(Call::Stop(path)));
    Code::SUCCESS
}

unsafe extern "system" fn poll_event(
    _instance: sys::Instance,
    event: *mut sys::EventDataBuffer,
) -> Code {
    let Some(state) = with(|state| state.states.pop_front()) else {
        return Code::EVENT_UNAVAILABLE;
    };
    let change = sys::EventDataSessionStateChanged {
        ty: sys::EventDataSessionStateChanged::TYPE,
        next: std::ptr::null(),
        session: sys::Session::from_raw(1),
        state: sys::SessionState::from_raw(state),
        time: sys::Time::from_nanos(0),
    };
    // SAFETY: a buffer has room for any event.
    unsafe {
        event
            .cast::<sys::EventDataSessionStateChanged>()
            .write(change)
    };
    Code::SUCCESS
}

unsafe extern "system" fn convert_time(
    _instance: sys::Instance,
    _from: *const c_void,
    time: *mut sys::Time,
) -> Code {
    // SAFETY: the caller has room for it.
    unsafe { time.write(sys::Time::from_nanos(1)) };
    Code::SUCCESS
}

/// What the driver needs no more than to be there.
unsafe extern "system" fn done() -> Code {
    Code::SUCCESS
}

#[unsafe(no_mangle)]
unsafe extern "system" fn xrGetInstanceProcAddr(
    _instance: sys::Instance,
    name: *const c_char,
    function: *mut Option<sys::pfn::VoidFunction>,
) -> Code {
    // SAFETY: a text.
    let name = unsafe { text(name) };
    let own = match name.as_str() {
        "xrDestroyInstance" => destroy_instance as *const c_void,
        "xrGetInstanceProperties" => get_instance_properties as *const c_void,
        "xrGetSystem" => get_system as *const c_void,
        "xrCreateSession" => create_session as *const c_void,
        "xrDestroySession" => destroy_session as *const c_void,
        "xrBeginSession" => begin_session as *const c_void,
        "xrEndSession" => end_session as *const c_void,
        "xrStringToPath" => string_to_path as *const c_void,
        "xrCreateActionSet" => create_action_set as *const c_void,
        "xrCreateAction" => create_action as *const c_void,
        "xrSuggestInteractionProfileBindings" => suggest_bindings as *const c_void,
        "xrAttachSessionActionSets" => attach as *const c_void,
        "xrSyncActions" => sync as *const c_void,
        "xrCreateActionSpace" => action_space as *const c_void,
        "xrCreateReferenceSpace" => reference_space as *const c_void,
        "xrLocateSpace" => locate_space as *const c_void,
        "xrGetActionStateFloat" => state_float as *const c_void,
        "xrGetActionStateBoolean" => state_boolean as *const c_void,
        "xrApplyHapticFeedback" => apply_feedback as *const c_void,
        "xrStopHapticFeedback" => stop_feedback as *const c_void,
        "xrPollEvent" => poll_event as *const c_void,
        "xrConvertTimespecTimeToTimeKHR" => convert_time as *const c_void,
        _ => done as *const c_void,
    };
    // SAFETY: each is a function as the registry declares it, and the caller has room for one.
    unsafe {
        let own = std::mem::transmute::<*const c_void, sys::pfn::VoidFunction>(own);
        function.write(Some(own));
    }
    Code::SUCCESS
}

#[unsafe(no_mangle)]
unsafe extern "C" fn maulstick_libopenxr_script(json: *const c_char) {
    // SAFETY: the caller's text ends with a zero.
    let json = unsafe { text(json) };
    if let Ok(script) = serde_json::from_str(&json) {
        with(|state| state.change(script));
    }
}

#[unsafe(no_mangle)]
extern "C" fn maulstick_libopenxr_log() -> *mut c_char {
    let calls = with(|state| std::mem::take(&mut state.calls));
    let json = serde_json::to_string(&calls).unwrap_or_default();
    CString::new(json).unwrap_or_default().into_raw()
}

#[unsafe(no_mangle)]
unsafe extern "C" fn maulstick_libopenxr_free(text: *mut c_char) {
    // SAFETY: a text of `maulstick_libopenxr_log`, given back once.
    drop(unsafe { CString::from_raw(text) });
}
