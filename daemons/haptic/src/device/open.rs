//! Opens the device of a section of `rig.toml`.

use std::path::PathBuf;

use maulstick_device::registration::Registration;
use maulstick_device::{Take, brush_file};
use maulstick_rig::config::DeviceSection;
use maulstick_rig::{RigConfig, UserError};

use crate::device::driver::Opened;
use crate::drivers::simulated::Simulated;
use crate::drivers::{force_dimension, inverse3, openhaptics, openxr, polhem};
use crate::servo::clock::MonotonicClock;

/// Settings of a haptic daemon.
#[derive(Clone, Debug)]
pub struct HapticSettings {
    /// The device's section of `rig.toml`.
    pub device: DeviceSection,
    /// Take that a simulated hand follows.
    pub hand: Option<PathBuf>,
}

/// Opens the device.
///
/// # Errors
/// [`UserError`] that names what is missing; a later attempt may find it.
pub fn open(config: &RigConfig, settings: &HapticSettings) -> Result<Opened, UserError> {
    let device = &settings.device;
    match device.driver.as_str() {
        "simulated" => simulated(config, settings),
        "openhaptics" => openhaptics::open(device),
        "polhem" => polhem::open(device),
        "inverse3" => inverse3::open(device),
        "forcedimension" => force_dimension::open(device),
        "openxr" => openxr::open(device),
        other => Err(UserError::usage(format!(
            "this daemon has no driver '{other}'"
        ))),
    }
}

fn simulated(config: &RigConfig, settings: &HapticSettings) -> Result<Opened, UserError> {
    let opened = |driver: Simulated, what: &str| Opened {
        driver: Box::new(driver),
        clock: Box::new(MonotonicClock),
        what: what.to_owned(),
    };
    let Some(path) = settings.hand.as_ref().or(settings.device.hand.as_ref()) else {
        return Ok(opened(Simulated::at_rest(), "a simulated hand at rest"));
    };
    let take = Take::read(path)?;
    let section = config
        .brush_named(&settings.device.brush)
        .ok_or_else(|| UserError::usage(format!("no brush '{}'", settings.device.brush)))?;
    let file = brush_file(section)?;
    let (length_m, share) = (file.length_m(), section.depth_share);
    let registration = Registration::of(&settings.device, &config.canvas)?;
    let driver = Simulated::following(&take, length_m, share, &registration);
    Ok(opened(driver, "a simulated hand that follows a take"))
}
