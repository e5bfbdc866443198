//! Fit of a device to the canvas: the corners, as a hand shows them with the device, written into the settings.

mod corners_file;

use std::fmt;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use glam::DVec3;
use maulstick_device::corner_calibration::{
    Corner, CornerCalibration, HandReading, Progress, TouchRejection,
};
use maulstick_device::registration::{CornerFit, by_corners, canvas_m, check_side};
use maulstick_haptic::device::open::{HapticSettings, open};
use maulstick_haptic::device::probe::probe;
use maulstick_hid::open::Kind as DeviceKind;
use maulstick_hid::tablet::Tablet;
use maulstick_rig::config::DeviceSection;
use maulstick_rig::files::{Kind, check_writable};
use maulstick_rig::{RigConfig, Stop, UserError, user_devices};

use crate::error::{SetupError, Task};
use crate::running::{Devices as _, Running, is_same};
use crate::user_file::unknown;

/// A step of a fit.
#[derive(Clone, Debug, PartialEq)]
pub enum FitEvent {
    /// No rig runs: the canvas is the default one, mm.
    DefaultCanvas {
        /// Width and height, mm.
        size_mm: [f64; 2],
    },
    /// The device is open.
    Opened {
        /// Its name.
        device: String,
        /// Description by its driver.
        what: String,
    },
    /// A corner is to be touched.
    Touch {
        /// The corner.
        corner: Corner,
        /// Gesture that marks it.
        gesture: Gesture,
    },
    /// A corner was touched.
    Found {
        /// The corner.
        corner: Corner,
        /// Its place in the frame of the device, m.
        place_m: DVec3,
    },
    /// A touch does not count.
    Rejected(TouchRejection),
    /// The canvas by what was shown on a tablet: width and height.
    Stretched([f64; 2]),
    /// Fit of the corners to those of the canvas.
    Fitted(CornerFit),
    /// Size of the canvas by what was shown, and how far at worst a corner comes to lie off.
    Scaled {
        /// The canvas by what was shown.
        scale: f64,
        /// Farthest distance of a corner, m.
        off_m: f64,
    },
    /// The corners are written into this file.
    Written(PathBuf),
    /// The fit was stopped: nothing is written.
    Unwritten,
    /// The rig does not take the device back.
    NotTakenBack {
        /// The device.
        device: String,
        /// The reason.
        what: String,
    },
}

/// Gesture that marks a corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gesture {
    /// A touch of the pen on its tablet.
    Pen,
    /// A touch of the ferrule that keeps still, or a switch.
    Ferrule,
}

impl fmt::Display for FitEvent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::DefaultCanvas {
                size_mm: [width, height],
            } => write!(
                f,
                "no rig runs: this is for a canvas of {width} x {height} mm"
            ),
            Self::Opened { device, what } => write!(f, "{device}: {what}"),
            Self::Touch { corner, gesture } => {
                let how = match gesture {
                    Gesture::Pen => "with the pen on its tablet",
                    Gesture::Ferrule => {
                        "with the ferrule, and keep still for a second or press the first switch"
                    }
                };
                write!(f, "touch the {corner} corner of the canvas {how}")
            }
            Self::Found { corner, place_m } => {
                let [x, y, z] = (*place_m * 1e3).to_array();
                write!(f, "{corner}: {x:.1}, {y:.1}, {z:.1} mm")
            }
            Self::Rejected(why) => why.fmt(f),
            Self::Stretched([width, height]) => write!(
                f,
                "the canvas is {width:.2} times as wide and {height:.2} times as high"
            ),
            Self::Fitted(fit) => fit.fmt(f),
            Self::Scaled { scale, off_m } => write!(
                f,
                "the canvas is {scale:.2} times as large; at worst a corner comes to lie {:.1} mm off",
                off_m * 1e3
            ),
            Self::Written(path) => write!(f, "written into {}", path.display()),
            Self::Unwritten => f.write_str("nothing is written"),
            Self::NotTakenBack { device, what } => {
                write!(f, "the rig does not take '{device}' back: {what}")
            }
        }
    }
}

/// End of a fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FitEnd {
    /// The corners are written.
    Written,
    /// It was stopped.
    Stopped,
}

/// Receiver of the steps of a fit; an error ends it.
pub type Report<'a> = &'a mut dyn FnMut(FitEvent) -> Result<(), UserError>;

/// Settings of a fit.
#[derive(Clone, Copy, Debug)]
pub struct FitSettings<'a> {
    /// The device.
    pub device: &'a str,
    /// Settings of a rig, into which the corners are written; this user's devices if absent.
    pub file: Option<&'a Path>,
    /// Name of the rig, unless `file` names another.
    pub rig: &'a str,
}

/// Has a hand show the corners and writes them; a rig that runs lets go of the device meanwhile. `stop` ends the fit, which
/// puts the device back.
///
/// # Errors
/// A [`SetupError`] for a device that is not there, corners that do not fit the canvas, or settings that
/// cannot be written.
pub fn fit(
    settings: &FitSettings<'_>,
    stop: &Stop,
    report: Report<'_>,
) -> Result<FitEnd, SetupError> {
    let (path, config, rig) = match settings.file {
        Some(path) => {
            let config = RigConfig::read(path)?;
            let rig = config.rig.name.clone();
            (path.to_owned(), config, rig)
        }
        None => {
            let (path, config) = own_settings(settings, report)?;
            (path, config, settings.rig.to_owned())
        }
    };
    let device = section(&config.device, settings.device).ok_or_else(|| {
        let known = config.device.iter().map(|device| device.name.clone());
        SetupError::NoSection {
            name: settings.device.to_owned(),
            known: known.collect(),
            file: path.clone(),
        }
    })?;
    if device.driver == "spacemouse" {
        return Err(SetupError::MovesCanvas {
            device: device.name,
            file: path,
        });
    }
    let mut in_rig = Running::open(&rig)?;
    let running = section(&in_rig.all()?, &device.name);
    is_same(&device, running.as_ref())?;
    let fitted = in_rig
        .remove(&device.name)
        .and_then(|_| fit_free(&path, &config, device.clone(), (stop, &mut *report)));
    if let Some(running) = running {
        let is_written = matches!(fitted, Ok(FitEnd::Written));
        let now = is_written.then(|| corners_file::read(&path, &device.name));
        let back = DeviceSection {
            corners_m: now.flatten().or(running.corners_m),
            ..running
        };
        // The rig may have gone meanwhile.
        let taken = Running::open(&rig).and_then(|mut rig| rig.put(&back));
        if let Err(fault) = taken {
            report(FitEvent::NotTakenBack {
                device: back.name,
                what: fault.to_string(),
            })?;
        }
    }
    fitted
}

fn section(devices: &[DeviceSection], name: &str) -> Option<DeviceSection> {
    let mut devices = devices.iter();
    devices.find(|device| device.name == name).cloned()
}

/// The file of the user's own devices, and settings with them and the canvas of the rig that runs.
fn own_settings(
    settings: &FitSettings<'_>,
    report: Report<'_>,
) -> Result<(PathBuf, RigConfig), SetupError> {
    let path = user_devices::path()?;
    let device = if path.exists() {
        user_devices::read(&path)?
    } else {
        Vec::new()
    };
    let running = Running::open(settings.rig)?.config()?;
    if !device.iter().any(|own| own.name == settings.device) {
        let in_rig = running.map_or_else(Vec::new, |config| config.device);
        return Err(not_own(settings.device, &device, &in_rig));
    }
    let config = match running {
        Some(config) => config,
        None => {
            let config = RigConfig::default();
            report(FitEvent::DefaultCanvas {
                size_mm: [config.canvas.width_mm, config.canvas.height_mm],
            })?;
            config
        }
    };
    Ok((path, RigConfig { device, ..config }))
}

/// The error that a device is none of the user's own, which are `own`.
fn not_own(name: &str, own: &[DeviceSection], in_rig: &[DeviceSection]) -> SetupError {
    if !in_rig.iter().any(|device| device.name == name) {
        return unknown(name, own, in_rig);
    }
    SetupError::OfTheRig {
        device: name.to_owned(),
        task: Task::Fit,
    }
}

/// Fits a device that nobody else has open.
fn fit_free(
    path: &Path,
    config: &RigConfig,
    device: DeviceSection,
    (stop, report): (&Stop, Report<'_>),
) -> Result<FitEnd, SetupError> {
    check_writable(path, Kind::Own).map_err(|error| UserError::writing(path, &error))?;
    let mut hand = Hand {
        corners: CornerCalibration::new(),
        gesture: if device.is_hid() {
            Gesture::Pen
        } else {
            Gesture::Ferrule
        },
        stop,
        report,
        fault: None,
    };
    if device.is_hid() {
        hand.watch_pen(&device)?;
    } else {
        hand.watch_ferrule(config, &device)?;
    }
    let Hand {
        corners: calibration,
        report,
        fault,
        ..
    } = hand;
    if let Some(fault) = fault {
        return Err(fault.into());
    }
    let Some(corners) = calibration.all() else {
        report(FitEvent::Unwritten)?;
        return Ok(FitEnd::Stopped);
    };
    check_side(&corners, calibration.handle())?;
    let name = device.name.clone();
    if device.is_hid() {
        report(fit_tablet(config, device, &corners)?)?;
    } else {
        fit_ferrule(config, &corners, report)?;
    }
    corners_file::write(path, &name, &corners)?;
    report(FitEvent::Written(path.to_owned()))?;
    Ok(FitEnd::Written)
}

/// Checks that the daemon of a tablet takes the corners; it may be stretched over a canvas of another shape.
fn fit_tablet(
    config: &RigConfig,
    mut device: DeviceSection,
    corners: &[DVec3; 3],
) -> Result<FitEvent, UserError> {
    device.corners_m = Some(corners.map(|corner| corner.to_array()));
    // With corners, neither the tablet's area nor its senses matter.
    Tablet::fit([1.0; 2], 0, &device, &config.canvas)?;
    let size = canvas_m(&config.canvas);
    let [width, height] = [1, 2].map(|to| corners[to].distance(corners[0]));
    Ok(FitEvent::Stretched([size.x / width, size.y / height]))
}

/// Checks that the corners are those of the canvas: a hand in the air may not be stretched.
fn fit_ferrule(
    config: &RigConfig,
    corners: &[DVec3; 3],
    report: Report<'_>,
) -> Result<(), SetupError> {
    let (to_desk, fit) = by_corners(corners, canvas_m(&config.canvas))?;
    let (is_good, off_m) = (fit.is_good(), fit.off_m);
    report(FitEvent::Fitted(fit))?;
    if !is_good {
        return Err(SetupError::NoCorners);
    }
    Ok(report(FitEvent::Scaled {
        scale: to_desk.scale,
        off_m,
    })?)
}

/// A hand that shows the corners, one after the other.
struct Hand<'a> {
    corners: CornerCalibration,
    gesture: Gesture,
    stop: &'a Stop,
    report: Report<'a>,
    /// The error that ended it.
    fault: Option<UserError>,
}

impl Hand<'_> {
    fn watch_pen(&mut self, device: &DeviceSection) -> Result<(), UserError> {
        let kind = DeviceKind::of_section(device)?;
        let shown = maulstick_hid::probe::open(&mut *kind.ports(), device)?;
        self.begin(&device.name, &shown.what)?;
        shown.probe(|reading| self.look(reading))
    }

    fn watch_ferrule(
        &mut self,
        config: &RigConfig,
        device: &DeviceSection,
    ) -> Result<(), UserError> {
        let settings = HapticSettings {
            device: device.clone(),
            hand: None,
        };
        let opened = open(config, &settings)?;
        self.begin(&device.name, &opened.what)?;
        probe(opened, DVec3::from(device.ferrule_m), |reading| {
            self.look(reading)
        })
        .map_err(|error| UserError::failure(error.to_string()).help(error.help))
    }

    fn begin(&mut self, device: &str, what: &str) -> Result<(), UserError> {
        (self.report)(FitEvent::Opened {
            device: device.to_owned(),
            what: what.to_owned(),
        })?;
        self.ask()
    }

    fn ask(&mut self) -> Result<(), UserError> {
        let Some(corner) = self.corners.wanted() else {
            return Ok(());
        };
        (self.report)(FitEvent::Touch {
            corner,
            gesture: self.gesture,
        })
    }

    fn look(&mut self, reading: HandReading) -> ControlFlow<()> {
        if self.stop.requested() {
            return ControlFlow::Break(());
        }
        if let Err(fault) = self.see(reading) {
            self.fault = Some(fault);
            return ControlFlow::Break(());
        }
        match self.corners.wanted() {
            Some(_) => ControlFlow::Continue(()),
            None => ControlFlow::Break(()),
        }
    }

    fn see(&mut self, reading: HandReading) -> Result<(), UserError> {
        let HandReading::Sample(seen) = reading else {
            self.corners.lose();
            return Ok(());
        };
        match self.corners.see(&seen) {
            Progress::Going => Ok(()),
            Progress::Found(corner, place_m) => {
                (self.report)(FitEvent::Found { corner, place_m })?;
                self.ask()
            }
            Progress::Rejected(why) => (self.report)(FitEvent::Rejected(why)),
        }
    }
}
