//! The runtime and its controller, and what was called.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// A runtime with a controller.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Script {
    /// Names of the extensions that it has.
    pub extensions: Vec<String>,
    /// What creating an instance returns.
    pub instance_code: i32,
    /// What asking for a headset returns.
    pub system_code: i32,
    /// What creating a session returns.
    pub session_code: i32,
    /// Interaction profiles that it knows.
    pub profiles: Vec<String>,
    /// That of the controller in hand.
    pub profile: String,
    /// States through which the session goes from now on.
    pub states: Vec<i32>,
    /// Paths of what is pressed or pulled, and how far.
    pub inputs: BTreeMap<String, f32>,
    /// Bits of what is known of its place.
    pub known: u64,
    /// Its place, m.
    pub position: [f32; 3],
    /// How it is turned, x, y, z, w.
    pub orientation: [f32; 4],
    /// What every question about the place returns.
    pub place_code: i32,
}

impl maulstick_scripted::Script for Script {
    const LIBRARY: &'static str = "maulstick_libopenxr";
    type Call = Call;
}

/// An Oculus Touch that lies where the headset was, in a session that goes as far as one without a window can.
impl Default for Script {
    fn default() -> Self {
        Self {
            extensions: ["XR_MND_headless", "XR_KHR_convert_timespec_time"]
                .map(str::to_owned)
                .to_vec(),
            instance_code: 0,
            system_code: 0,
            session_code: 0,
            profiles: ["khr/simple_controller", "oculus/touch_controller"]
                .map(|kind| format!("/interaction_profiles/{kind}"))
                .to_vec(),
            profile: "/interaction_profiles/oculus/touch_controller".into(),
            // Idle, ready, synchronized, visible, focused.
            states: vec![1, 2, 3, 4, 5],
            inputs: BTreeMap::new(),
            known: 0b1111,
            position: [0.0; 3],
            orientation: [0.0, 0.0, 0.0, 1.0],
            place_code: 0,
        }
    }
}

/// A call that changes something.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Call {
    /// `xrBeginSession`.
    Begin,
    /// `xrEndSession`.
    End,
    /// `xrApplyHapticFeedback` on a path, by an amplitude, for a time, ns.
    Vibrate(String, f32, i64),
    /// `xrStopHapticFeedback` on a path.
    Stop(String),
    /// `xrDestroySession`.
    DestroySession,
    /// `xrDestroyInstance`.
    DestroyInstance,
}
