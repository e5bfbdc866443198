//! A session without a window (`XR_MND_headless`) in the user's OpenXR runtime, found by Khronos's loader.

#![allow(
    unsafe_code,
    reason = "a shared library runs its initialisers, and a session without graphics asks for nothing more"
)]

use std::path::Path;

use glam::{DQuat, DVec3};
use maulstick_rig::UserError;
use openxr as xr;

use super::bindings::{Hand, MOTOR, POSE, PROFILES};
use crate::device::driver::DeviceError;
use crate::drivers::vendor_library::{Unusable, VendorLibrary, load};

/// Khronos's loader.
pub const LOADER: VendorLibrary = VendorLibrary {
    product: "the OpenXR loader",
    kind: "loader of OpenXR",
    names: [
        "libopenxr_loader.so.1",
        "libopenxr_loader.so",
        "libopenxr_loader.so.1.0",
    ],
    install: "install libopenxr-loader1 (Debian, Ubuntu) or openxr (Arch, Fedora), and a runtime: SteamVR, Monado or WiVRn",
    correct: "`library` in rig.toml is to name libopenxr_loader.so.1",
};

/// The runtime is gone.
pub const LOST: DeviceError = DeviceError {
    what: "the OpenXR runtime has ended the session",
    code: 0,
    help: "start the runtime again",
};

/// The runtime does not do what it is asked.
pub const REFUSED: DeviceError = DeviceError {
    what: "the OpenXR runtime refused a call",
    code: 0,
    help: "see the runtime's own log",
};

/// Length of an order to vibrate: two orders, so that a late one leaves no gap.
const LASTS_NS: i64 = 32_000_000;

/// Inputs of a controller.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ControllerInputs {
    /// True if it is switched on, and the session is ours.
    pub is_there: bool,
    /// Pull of the trigger, 0 to 1.
    pub trigger: f64,
    /// A bit a pressed switch.
    pub switches: u32,
}

/// Pose of a controller, in the axes of the session: x right, y up, z toward the user.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControllerPose {
    /// Position, m.
    pub position: DVec3,
    /// It points along −z.
    pub orientation: DQuat,
}

/// A session of the runtime.
pub struct Runtime {
    instance: xr::Instance,
    name: String,
    session: xr::Session<xr::Headless>,
    set: xr::ActionSet,
    trigger: xr::Action<f32>,
    switches: [xr::Action<bool>; 2],
    motor: xr::Action<xr::Haptic>,
    /// Where the controller points, and from where that is measured.
    spaces: [xr::Space; 2],
    is_running: bool,
}

impl Runtime {
    /// Starts a session by the loader in the file `library`, or by that of the system.
    ///
    /// # Errors
    /// A [`UserError`] that says what is missing.
    pub fn start(library: Option<&Path>, hand: Hand) -> Result<Self, UserError> {
        let entry = LOADER.find(library, |name| {
            let loaded = load(name)?;
            // SAFETY: the library is Khronos's loader, or it lacks its functions.
            let entry = unsafe { xr::Entry::load_from(name, &()) };
            // Runtimes leave threads behind that outlive a session.
            std::mem::forget(loaded);
            entry.map_err(|_| Unusable::Lacks("xrCreateInstance"))
        })?;
        let instance = instance(&entry)?;
        let name = instance.properties().map_err(refused)?.runtime_name;
        Self::begin(instance, name, hand).map_err(refused)
    }

    fn begin(instance: xr::Instance, name: String, hand: Hand) -> xr::Result<Self> {
        let system = instance.system(xr::FormFactor::HEAD_MOUNTED_DISPLAY)?;
        // SAFETY: there is no graphics to be used rightly.
        let (session, ..) = unsafe {
            instance.create_session::<xr::Headless>(system, &xr::headless::SessionCreateInfo {})?
        };
        let set = instance.create_action_set("stylus", "Stylus", 0)?;
        let aim = set.create_action::<xr::Posef>("aim", "Brush", &[])?;
        let trigger = set.create_action::<f32>("press", "Press the brush", &[])?;
        let switches = [
            set.create_action::<bool>("first", "First switch", &[])?,
            set.create_action::<bool>("second", "Second switch", &[])?,
        ];
        let motor = set.create_action::<xr::Haptic>("felt", "What the brush feels", &[])?;
        for profile in &PROFILES {
            let part = |part: &str| instance.string_to_path(&format!("{}/{part}", hand.path()));
            let mut bindings = vec![
                xr::Binding::new(&aim, part(POSE)?),
                xr::Binding::new(&trigger, part(profile.trigger)?),
                xr::Binding::new(&switches[0], part(profile.first)?),
                xr::Binding::new(&motor, part(MOTOR)?),
            ];
            if let Some([left, right]) = profile.second {
                let second = match hand {
                    Hand::Left => left,
                    Hand::Right => right,
                };
                bindings.push(xr::Binding::new(&switches[1], part(second)?));
            }
            let path = instance.string_to_path(profile.path)?;
            match instance.suggest_interaction_profile_bindings(path, &bindings) {
                // A runtime need not know every kind.
                Ok(()) | Err(xr::sys::Result::ERROR_PATH_UNSUPPORTED) => {}
                Err(error) => return Err(error),
            }
        }
        session.attach_action_sets(&[&set])?;
        let here = xr::Posef::IDENTITY;
        let spaces = [
            aim.create_space(&session, xr::Path::NULL, here)?,
            session.create_reference_space(xr::ReferenceSpaceType::LOCAL, here)?,
        ];
        Ok(Self {
            instance,
            name,
            session,
            set,
            trigger,
            switches,
            motor,
            spaces,
            is_running: false,
        })
    }

    /// The runtime's own name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The inputs now.
    ///
    /// # Errors
    /// [`DeviceError`] once the session is over.
    pub fn inputs(&mut self) -> Result<ControllerInputs, DeviceError> {
        self.follow_events()?;
        if !self.is_running {
            return Ok(ControllerInputs::default());
        }
        let read = || -> xr::Result<ControllerInputs> {
            self.session
                .sync_actions(&[xr::ActiveActionSet::new(&self.set)])?;
            let trigger = self.trigger.state(&self.session, xr::Path::NULL)?;
            let mut switches = 0;
            for (bit, switch) in self.switches.iter().enumerate() {
                let state = switch.state(&self.session, xr::Path::NULL)?;
                switches |= u32::from(state.current_state) << bit;
            }
            let pulled = f64::from(trigger.current_state);
            Ok(ControllerInputs {
                is_there: trigger.is_active,
                trigger: if pulled.is_finite() {
                    pulled.clamp(0.0, 1.0)
                } else {
                    0.0
                },
                switches,
            })
        };
        read().map_err(lost)
    }

    /// The pose now, if it is known.
    ///
    /// # Errors
    /// [`DeviceError`] once the session is over.
    pub fn pose(&self) -> Result<Option<ControllerPose>, DeviceError> {
        let [aim, base] = &self.spaces;
        let read = || aim.locate(base, self.instance.now()?);
        let found = read().map_err(lost)?;
        let known = xr::SpaceLocationFlags::POSITION_VALID
            | xr::SpaceLocationFlags::ORIENTATION_VALID
            | xr::SpaceLocationFlags::POSITION_TRACKED;
        let xr::Posef {
            position: p,
            orientation: q,
        } = found.pose;
        let place = ControllerPose {
            position: DVec3::new(p.x.into(), p.y.into(), p.z.into()),
            orientation: DQuat::from_xyzw(q.x.into(), q.y.into(), q.z.into(), q.w.into()),
        };
        let is_sane = place.position.is_finite() && (place.orientation.length() - 1.0).abs() < 0.01;
        Ok((found.location_flags.contains(known) && is_sane).then_some(place))
    }

    /// Vibrates by an amplitude of 0 to 1 until the next order.
    ///
    /// # Errors
    /// [`DeviceError`] once the session is over.
    pub fn vibrate(&self, amplitude: f64) -> Result<(), DeviceError> {
        if !self.is_running {
            return Ok(());
        }
        let order = if amplitude > 0.0 {
            let vibration = xr::HapticVibration::new()
                .amplitude(amplitude as f32)
                .frequency(xr::FREQUENCY_UNSPECIFIED)
                .duration(xr::Duration::from_nanos(LASTS_NS));
            self.motor
                .apply_feedback(&self.session, xr::Path::NULL, &vibration)
        } else {
            self.motor.stop_feedback(&self.session, xr::Path::NULL)
        };
        order.map_err(lost)
    }

    fn follow_events(&mut self) -> Result<(), DeviceError> {
        let mut events = xr::EventDataBuffer::new();
        while let Some(event) = self.instance.poll_event(&mut events).map_err(lost)? {
            match event {
                xr::Event::SessionStateChanged(change) => match change.state() {
                    xr::SessionState::READY => {
                        let stereo = xr::ViewConfigurationType::PRIMARY_STEREO;
                        self.session.begin(stereo).map_err(lost)?;
                        self.is_running = true;
                    }
                    xr::SessionState::STOPPING => {
                        self.is_running = false;
                        self.session.end().map_err(lost)?;
                    }
                    xr::SessionState::EXITING | xr::SessionState::LOSS_PENDING => return Err(LOST),
                    _ => {}
                },
                xr::Event::InstanceLossPending(_) => return Err(LOST),
                _ => {}
            }
        }
        Ok(())
    }
}

/// An instance with what a session without a window needs.
fn instance(entry: &xr::Entry) -> Result<xr::Instance, UserError> {
    let known = entry.enumerate_extensions().map_err(refused)?;
    for (is_known, name) in [
        (known.mnd_headless, "XR_MND_headless"),
        (
            known.khr_convert_timespec_time,
            "XR_KHR_convert_timespec_time",
        ),
    ] {
        if !is_known {
            let what = format!("the OpenXR runtime lacks {name}");
            return Err(UserError::failure(what).help(
                "choose another: XR_RUNTIME_JSON, or active_runtime.json in ~/.config/openxr/1, names Monado's or WiVRn's file",
            ));
        }
    }
    let mut needed = xr::ExtensionSet::default();
    (needed.mnd_headless, needed.khr_convert_timespec_time) = (true, true);
    let us = xr::ApplicationInfo {
        application_name: "Maulstick",
        application_version: 0,
        engine_name: "",
        engine_version: 0,
        api_version: xr::Version::new(1, 0, 0),
    };
    entry
        .create_instance(&us, &needed, &[], &())
        .map_err(refused)
}

/// The error of a session that does not begin, with advice.
#[must_use]
pub fn refused(error: xr::sys::Result) -> UserError {
    use xr::sys::Result as Code;
    let (what, help) = match error {
        Code::ERROR_RUNTIME_UNAVAILABLE | Code::ERROR_RUNTIME_FAILURE => (
            "no OpenXR runtime answers",
            "start one: SteamVR, Monado (monado-service) or WiVRn",
        ),
        Code::ERROR_FORM_FACTOR_UNAVAILABLE | Code::ERROR_FORM_FACTOR_UNSUPPORTED => (
            "the OpenXR runtime has no headset",
            "connect it and switch it on",
        ),
        Code::ERROR_LIMIT_REACHED => (
            "the OpenXR runtime takes no further session",
            "end the other program that uses the headset",
        ),
        _ => {
            return UserError::failure(format!("the OpenXR runtime refuses a session: {error}"))
                .help("see the runtime's own log");
        }
    };
    UserError::failure(what).help(help)
}

/// The error of a call in a session.
fn lost(error: xr::sys::Result) -> DeviceError {
    use xr::sys::Result as Code;
    let ended = [
        Code::ERROR_SESSION_LOST,
        Code::ERROR_INSTANCE_LOST,
        Code::ERROR_RUNTIME_FAILURE,
    ];
    let told = if ended.contains(&error) {
        LOST
    } else {
        REFUSED
    };
    DeviceError {
        code: i64::from(error.into_raw()).abs(),
        ..told
    }
}
