//! Connection to the device: opened as soon as it is there, again and again, with a servo while it is.

use maulstick_device::actions::{Action, Actions};
use maulstick_device::registration::Registration;
use maulstick_haptics::{Limits, ServoMemory};
use maulstick_rig::{RigConfig, UserError};
use maulstick_types::stylus::StylusInfo;

use super::force_settings::ForceSettings;
use crate::device::mounted_device::MountedDevice;
use crate::device::open::{HapticSettings, open};
use crate::servo::channels::TickRecord;
use crate::servo::force_control::ForceControl;
use crate::servo::servo_loop::PreviousServo;
use crate::servo::servo_thread::{Ended, ServoThread};

/// Time between two attempts to open a device that is not there, ns.
const ATTEMPT_PERIOD_NS: u64 = 1_000_000_000;

/// Result of an attempt to open the device.
pub(super) enum Attempt {
    /// Its servo runs.
    Opened(StylusInfo),
    /// It is not there.
    Missing(UserError),
}

/// The device of a section of `rig.toml`.
pub(super) struct Connection {
    config: RigConfig,
    settings: HapticSettings,
    /// Registration of the device to the canvas.
    registration: Registration,
    /// The servo, while the device is open.
    servo: Option<ServoThread>,
    /// State of the previous servo, and the time of its end, ns.
    previous: Option<(PreviousServo, u64)>,
    /// Description of the device that was logged last.
    description: String,
    /// Time of the next attempt, ns.
    attempt_ns: u64,
    /// Axes that the open device senses.
    senses: u32,
    /// Tick records dropped with earlier servos.
    dropped_before: u64,
}

impl Connection {
    /// A connection that is not open.
    pub(super) fn new(
        config: RigConfig,
        settings: HapticSettings,
        registration: Registration,
    ) -> Self {
        Self {
            config,
            settings,
            registration,
            servo: None,
            previous: None,
            description: String::new(),
            attempt_ns: 0,
            senses: 0,
            dropped_before: 0,
        }
    }

    /// Name of the device.
    pub(super) fn name(&self) -> &str {
        &self.settings.device.name
    }

    /// Axes that the open device senses.
    pub(super) fn senses(&self) -> u32 {
        self.senses
    }

    /// Tick records dropped so far.
    pub(super) fn dropped(&self) -> u64 {
        self.dropped_before + self.servo.as_ref().map_or(0, ServoThread::dropped)
    }

    /// The servo, while the device is open.
    pub(super) fn servo_mut(&mut self) -> Option<&mut ServoThread> {
        self.servo.as_mut()
    }

    /// The oldest tick that was not read.
    pub(super) fn next_tick(&mut self) -> Option<TickRecord> {
        self.servo.as_mut()?.ticks.pop().ok()
    }

    /// Hands force settings to the servo.
    pub(super) fn set_control(&mut self, control: ForceControl) {
        if let Some(servo) = &mut self.servo {
            servo.controls.write(control);
        }
    }

    /// True if the device is closed and the next attempt is due.
    pub(super) fn is_due(&self, now_ns: u64) -> bool {
        self.servo.is_none() && now_ns >= self.attempt_ns
    }

    /// Tries to open the device.
    ///
    /// # Errors
    /// [`UserError`] if the servo cannot start.
    pub(super) fn open(
        &mut self,
        force: &ForceSettings,
        now_ns: u64,
    ) -> Result<Attempt, UserError> {
        self.attempt_ns = now_ns + ATTEMPT_PERIOD_NS;
        let opened = match open(&self.config, &self.settings) {
            Ok(opened) => opened,
            Err(fault) => return Ok(Attempt::Missing(fault)),
        };
        let device = &self.settings.device;
        if self.description != opened.what {
            tracing::info!("{}: {}", device.name, opened.what);
            self.description = opened.what;
        }
        let clutch = Actions::of(device).bits(Action::Clutch);
        let mounted = MountedDevice::new(opened.driver, self.registration, clutch);
        let abilities = mounted.abilities();
        let unscaled = abilities.limits(device.max_force_n);
        let limits = unscaled.scaled(mounted.scale());
        let previous = self.previous_for(limits, force, now_ns);
        let mut servo = ServoThread::resume(mounted, opened.clock, limits, previous)
            .map_err(|error| UserError::failure(format!("the servo cannot start: {error}")))?;
        for warning in &servo.warnings {
            tracing::warn!("{}: {warning}", device.name);
        }
        servo.controls.write(force.control());
        let info = StylusInfo {
            device: device.name.clone(),
            driver: device.driver.clone(),
            brush: device.brush.clone(),
            priority: device.priority,
            senses: abilities.senses,
            drives: abilities.drives,
            rate_hz: 1000.0,
            max_force_n: unscaled.max_force_n,
            max_stiffness_n_m: unscaled.max_stiffness_n_m,
            workspace_m: abilities.workspace_m,
        };
        self.senses = abilities.senses;
        self.servo = Some(servo);
        Ok(Attempt::Opened(info))
    }

    /// State for a new servo: a device that is lost and found again is still without force after a fault,
    /// and its motors have cooled only while it was away.
    fn previous_for(&self, limits: Limits, force: &ForceSettings, now_ns: u64) -> PreviousServo {
        let rearms = force.control().rearms;
        let fresh = || PreviousServo {
            memory: ServoMemory {
                fault: force.fault(),
                ..ServoMemory::fresh(limits)
            },
            rearms,
        };
        let (mut previous, since_ns) = self.previous.unwrap_or_else(|| (fresh(), now_ns));
        if previous.rearms != rearms {
            previous.memory.fault = None;
            previous.rearms = rearms;
        }
        let away_s = now_ns.saturating_sub(since_ns) as f64 * 1e-9;
        previous.memory = previous.memory.cooled(away_s);
        previous
    }

    /// Closes a device that its servo has lost; `None` while the servo runs.
    ///
    /// # Errors
    /// [`UserError`] if the servo ended by a fault of its own.
    pub(super) fn poll_end(&mut self, now_ns: u64) -> Result<Option<Ended>, UserError> {
        if !self.servo.as_ref().is_some_and(ServoThread::has_ended) {
            return Ok(None);
        }
        self.dropped_before = self.dropped();
        let Some(ended) = self.servo.take().and_then(|servo| servo.ended()) else {
            return Err(
                UserError::failure("the servo has ended by a fault of its own")
                    .help("its own message above says why"),
            );
        };
        self.previous = Some((ended.previous, now_ns));
        self.attempt_ns = now_ns + ATTEMPT_PERIOD_NS;
        Ok(Some(ended))
    }
}
