//! `maulstick device fit`: the corners of the canvas, as a hand shows them with its device, written into the settings.

use std::io::Write as _;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use clap::Args;
use glam::DVec3;
use maulstick_bus::Wake;
use maulstick_device::corner_calibration::{Corner, CornerCalibration, HandReading, Progress};
use maulstick_device::registration::{by_corners, canvas_m, check_side};
use maulstick_haptic::device::open::{HapticSettings, open};
use maulstick_haptic::device::probe::probe;
use maulstick_hid::open::Kind as DeviceKind;
use maulstick_hid::tablet::Tablet;
use maulstick_rig::config::DeviceSection;
use maulstick_rig::files::{Kind, check_writable, write_whole};
use maulstick_rig::{RigConfig, Stop, UserError, user_devices};
use serde_json::json;
use toml_edit::{Array, DocumentMut, Item, TableLike, Value};

use super::user_file::{in_rig, is_same, put_in_rig, remove_from_rig, unknown};
use crate::EXIT_INTERRUPTED;
use crate::commands::client::{Client, Target};
use crate::commands::{print_json_line, print_line};

/// Options of `maulstick device fit`.
#[derive(Args, Clone, Debug)]
pub struct FitOptions {
    /// The device
    device: String,
    /// Settings of a rig, into which the corners are written [default: your own devices]
    #[arg(long, value_name = "FILE")]
    rig: Option<PathBuf>,
    /// Print a line of JSON for each that is said, with the corner that is to be touched
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    target: Target,
}

/// Prints what is said, for people or for a program.
#[derive(Clone, Copy, Debug)]
struct Teller {
    as_json: bool,
}

impl Teller {
    fn say(self, said: &str) -> Result<(), UserError> {
        self.ask(said, None)
    }

    /// Says something that asks for a corner.
    fn ask(self, said: &str, asks: Option<Corner>) -> Result<(), UserError> {
        if !self.as_json {
            return print_line(said);
        }
        let asks = asks.map(|corner| corner.to_string());
        print_json_line(&json!({"said": said, "asks": asks}))
    }
}

/// Has a hand show the corners and writes them; a rig that runs lets go of the device meanwhile.
///
/// # Errors
/// A [`UserError`] for a device that is not there, corners that do not fit the canvas, or settings that
/// cannot be written.
pub(super) fn run(options: &FitOptions) -> Result<i32, UserError> {
    let teller = Teller {
        as_json: options.json,
    };
    let (path, config, target) = match &options.rig {
        Some(path) => {
            let config = RigConfig::read(path)?;
            let target = Target::named(&config.rig.name);
            (path.clone(), config, target)
        }
        None => own_settings(&options.device, &options.target, teller)?,
    };
    let place = path.display().to_string();
    let device = section(&config, &options.device).ok_or_else(|| {
        let names = config.device.iter().map(|device| device.name.as_str());
        let what = format!("there is no [[device]] called '{}'", options.device);
        UserError::unknown(what, &options.device, names).at(place.clone())
    })?;
    if device.driver == "spacemouse" {
        let what = format!(
            "'{}' moves the canvas itself: there is nothing to fit",
            device.name
        );
        return Err(UserError::usage(what).at(place));
    }
    // From here on a signal ends the fit, which puts the device back.
    let stop = Stop::on_signals(&Wake::new())
        .map_err(|error| UserError::failure(format!("cannot watch for signals: {error}")))?;
    let running = match Client::open(&target) {
        Ok(client) => section(&client.config()?, &device.name),
        Err(_) => None,
    };
    is_same(&device, running.as_ref())?;
    let fitted = remove_from_rig(&target, &device.name)
        .and_then(|_| fit(&path, &config, device.clone(), (&stop, teller)));
    if let Some(running) = running {
        let written = fitted.as_ref().is_ok_and(|code| *code == 0);
        let now = written.then(|| corners(&path, &device.name)).flatten();
        let back = DeviceSection {
            corners_m: now.or(running.corners_m),
            ..running
        };
        if let Err(fault) = put_in_rig(&target, &back) {
            teller.say(&format!(
                "the rig does not take '{}' back: {}",
                back.name, fault.what
            ))?;
        }
    }
    fitted
}

/// The corners of a device in settings, whichever they are.
fn corners(path: &Path, name: &str) -> Option<[[f64; 3]; 3]> {
    let own = user_devices::read(path).ok();
    let devices = own.or_else(|| Some(RigConfig::read(path).ok()?.device))?;
    devices.iter().find(|device| device.name == name)?.corners_m
}

fn section(config: &RigConfig, name: &str) -> Option<DeviceSection> {
    let mut devices = config.device.iter();
    devices.find(|device| device.name == name).cloned()
}

/// The user's own devices, `name` among them, to be fitted to the canvas of the rig that runs.
fn own_settings(
    name: &str,
    target: &Target,
    teller: Teller,
) -> Result<(PathBuf, RigConfig, Target), UserError> {
    let path = user_devices::path()?;
    let device = match path.exists() {
        true => user_devices::read(&path)?,
        false => Vec::new(),
    };
    if !device.iter().any(|own| own.name == name) {
        return Err(not_own(name, &device, target));
    }
    let config = match Client::open(target) {
        Ok(client) => client.config()?,
        Err(_) => {
            let config = RigConfig::default();
            let canvas = &config.canvas;
            teller.say(&format!(
                "no rig runs: this is for a canvas of {} x {} mm",
                canvas.width_mm, canvas.height_mm
            ))?;
            config
        }
    };
    Ok((path, RigConfig { device, ..config }, target.clone()))
}

/// The error that a device is none of the user's own, which are `own`.
fn not_own(name: &str, own: &[DeviceSection], target: &Target) -> UserError {
    let in_rig = in_rig(target).unwrap_or_default();
    match in_rig.iter().any(|device| device.name == name) {
        true => UserError::usage(format!("'{name}' is a device of the rig's own settings")).help(
            format!(
                "name the file that the rig was started with: `maulstick device fit {name} --rig rig.toml`"
            ),
        ),
        false => unknown(name, own, &in_rig),
    }
}

/// Fits a device that nobody else has open.
fn fit(
    path: &Path,
    config: &RigConfig,
    device: DeviceSection,
    (stop, teller): (&Stop, Teller),
) -> Result<i32, UserError> {
    check_writable(path, Kind::Own).map_err(|error| UserError::writing(path, &error))?;
    let mut showing = Showing::of(&device, teller);
    let mut broken = None;
    let look = |reading| {
        if stop.requested() {
            return ControlFlow::Break(());
        }
        match showing.see(reading) {
            Ok(flow) => flow,
            Err(fault) => {
                broken = Some(fault);
                ControlFlow::Break(())
            }
        }
    };
    match device.is_hid() {
        true => watch_pen(&device, teller, look)?,
        false => watch_ferrule(config, &device, teller, look)?,
    }
    if let Some(fault) = broken {
        return Err(fault);
    }
    let Some(corners) = showing.corners.all() else {
        teller.say("nothing is written")?;
        return Ok(EXIT_INTERRUPTED);
    };
    check_side(&corners, showing.corners.handle())?;
    let name = device.name.clone();
    match device.is_hid() {
        true => fit_tablet(config, device, &corners, teller)?,
        false => fit_ferrule(config, &corners, teller)?,
    }
    write(path, &name, &corners)?;
    teller.say(&format!("written into {}", path.display()))?;
    Ok(0)
}

/// Checks that the daemon of a tablet takes the corners, and says how it fits: it may be stretched
/// over a canvas of another shape.
fn fit_tablet(
    config: &RigConfig,
    mut device: DeviceSection,
    corners: &[DVec3; 3],
    teller: Teller,
) -> Result<(), UserError> {
    device.corners_m = Some(corners.map(|corner| corner.to_array()));
    // With corners, neither the tablet's area nor its senses matter.
    Tablet::fit([1.0; 2], 0, &device, &config.canvas)?;
    let size = canvas_m(&config.canvas);
    let [width, height] = [1, 2].map(|to| corners[to].distance(corners[0]));
    teller.say(&format!(
        "the canvas is {:.2} times as wide and {:.2} times as high",
        size.x / width,
        size.y / height
    ))?;
    Ok(())
}

/// Checks that the corners are those of the canvas, and says how they fit: a hand in the air may not
/// be stretched.
fn fit_ferrule(config: &RigConfig, corners: &[DVec3; 3], teller: Teller) -> Result<(), UserError> {
    let (to_desk, fit) = by_corners(corners, canvas_m(&config.canvas))?;
    teller.say(&fit.to_string())?;
    if !fit.is_good() {
        return Err(UserError::failure("the three places are no corners of the canvas; nothing is written")
            .help("its width by height has to fit within 10 %, and its corner to be a right one; begin again"));
    }
    teller.say(&format!(
        "the canvas is {:.2} times as large; at worst a corner comes to lie {:.1} mm off",
        to_desk.scale,
        fit.off_m * 1e3
    ))?;
    Ok(())
}

fn watch_pen(
    device: &DeviceSection,
    teller: Teller,
    look: impl FnMut(HandReading) -> ControlFlow<()>,
) -> Result<(), UserError> {
    let shown = maulstick_hid::probe::open(&mut *DeviceKind::of_section(device)?.ports(), device)?;
    teller.say(&format!("{}: {}", device.name, shown.what))?;
    Showing::of(device, teller).ask()?;
    shown.probe(look)
}

fn watch_ferrule(
    config: &RigConfig,
    device: &DeviceSection,
    teller: Teller,
    look: impl FnMut(HandReading) -> ControlFlow<()>,
) -> Result<(), UserError> {
    let settings = HapticSettings {
        device: device.clone(),
        hand: None,
    };
    let opened = open(config, &settings)?;
    teller.say(&format!("{}: {}", device.name, opened.what))?;
    Showing::of(device, teller).ask()?;
    probe(opened, DVec3::from(device.ferrule_m), look)
        .map_err(|error| UserError::failure(error.to_string()).help(error.help))
}

/// A calibration in progress, corner by corner.
struct Showing {
    corners: CornerCalibration,
    /// Gesture that marks a corner.
    how: &'static str,
    teller: Teller,
}

impl Showing {
    fn of(device: &DeviceSection, teller: Teller) -> Self {
        Self {
            corners: CornerCalibration::new(),
            teller,
            how: match device.is_hid() {
                true => "with the pen on its tablet",
                false => "with the ferrule, and keep still for a second or press the first switch",
            },
        }
    }

    fn ask(&self) -> Result<(), UserError> {
        if let Some(corner) = self.corners.wanted() {
            let said = format!("touch the {corner} corner of the canvas {}", self.how);
            self.teller.ask(&said, Some(corner))?;
        }
        Ok(())
    }

    fn see(&mut self, reading: HandReading) -> Result<ControlFlow<()>, UserError> {
        let progress = match reading {
            HandReading::Sample(seen) => self.corners.see(&seen),
            HandReading::Away => {
                self.corners.lose();
                Progress::Going
            }
        };
        match progress {
            Progress::Going => {}
            Progress::Found(corner, place) => {
                let [x, y, z] = (place * 1e3).to_array();
                self.teller
                    .say(&format!("{corner}: {x:.1}, {y:.1}, {z:.1} mm"))?;
                self.ask()?;
            }
            Progress::Rejected(why) => self.teller.say(&why.to_string())?,
        }
        Ok(match self.corners.wanted() {
            Some(_) => ControlFlow::Continue(()),
            None => ControlFlow::Break(()),
        })
    }
}

/// Writes the corners of a device into the settings, and nothing else of them.
fn write(path: &Path, device: &str, corners: &[DVec3; 3]) -> Result<(), UserError> {
    // Changes made to the file meanwhile stay.
    let text = std::fs::read_to_string(path).map_err(|error| UserError::reading(path, &error))?;
    let place = path.display().to_string();
    let text = with_corners(&text, device, corners).map_err(|what| {
        UserError::failure(what)
            .at(place.clone())
            .help("see what was changed in the file")
    })?;
    if user_devices::parse(&text, path).is_err() {
        RigConfig::parse(&text, &place)?;
    }
    write_whole(path, Kind::Own, |file| file.write_all(text.as_bytes()))
        .map_err(|error| UserError::writing(path, &error))
}

/// The settings with other corners of a device, to a thousandth of a millimetre; comments and all else
/// are as they were.
fn with_corners(text: &str, device: &str, corners: &[DVec3; 3]) -> Result<String, String> {
    let mut settings: DocumentMut = text.parse().map_err(|error| format!("{error}"))?;
    let missing = || format!("there is no [[device]] called '{device}' any more");
    let is_meant = |table: &dyn TableLike| table.get("name").and_then(Item::as_str) == Some(device);
    match settings.get_mut("device").ok_or_else(missing)? {
        Item::ArrayOfTables(tables) => {
            let mut tables = tables.iter_mut();
            let table = tables.find(|table| is_meant(*table)).ok_or_else(missing)?;
            set(table, corners);
        }
        Item::Value(Value::Array(tables)) => {
            let mut tables = tables.iter_mut().filter_map(Value::as_inline_table_mut);
            let table = tables.find(|table| is_meant(*table)).ok_or_else(missing)?;
            set(table, corners);
        }
        _ => return Err(missing()),
    }
    Ok(settings.to_string())
}

fn set(table: &mut dyn TableLike, corners: &[DVec3; 3]) {
    const KEY: &str = "corners_m";
    let round = |metres: f64| (metres * 1e6).round() * 1e-6;
    let corner = |corner: &DVec3| {
        let metres = corner.to_array().map(round);
        // A multiple of a power of ten is not always the nearest number to its digits.
        Value::from_iter(metres.map(|metres| format!("{metres:.6}").parse().unwrap_or(metres)))
    };
    let mut value = Value::Array(Array::from_iter(corners.iter().map(corner)));
    match table.get_mut(KEY).and_then(Item::as_value_mut) {
        Some(before) => {
            *value.decor_mut() = before.decor().clone();
            *before = value;
        }
        None => {
            table.insert(KEY, Item::Value(value));
        }
    }
}

#[cfg(test)]
mod tests {
    use maulstick_rig::config::DEFAULT;

    use super::*;

    const CORNERS: [DVec3; 3] = [
        DVec3::new(-0.064_000_4, -0.048, 0.0),
        DVec3::new(0.064, -0.048, 1e-9),
        DVec3::new(-0.064, 0.048, 0.02),
    ];
    const LINE: &str =
        "corners_m = [[-0.064, -0.048, 0.0], [0.064, -0.048, 0.0], [-0.064, 0.048, 0.02]]";

    #[test]
    fn only_the_corners_change() {
        let written = with_corners(DEFAULT, "phantom", &CORNERS).expect("written");
        let added: Vec<&str> = written
            .lines()
            .filter(|line| !DEFAULT.contains(line))
            .collect();
        assert_eq!(added, [LINE]);
        let without = written.replace(&format!("{LINE}\n"), "");
        assert_eq!(without, DEFAULT);
        let config = RigConfig::parse(&written, "rig.toml").expect("valid");
        assert_eq!(config.device[0].corners_m.map(|c| c[2][2]), Some(0.02));
        // And again, with what was written beside it.
        let before = written.replace(LINE, &format!("{LINE} # by hand"));
        let moved = CORNERS.map(|corner| corner + DVec3::Z * 0.1);
        let again = with_corners(&before, "phantom", &moved).expect("written");
        assert_eq!(again.matches("\ncorners_m").count(), 1);
        assert!(again.contains("0.12]] # by hand\n"), "{again}");
    }

    #[test]
    fn of_several_devices_the_meant_one_is_fitted_in_whatever_way_they_are_written() {
        let inline = "device = [ # two\n  {name = 'a', driver = 'polhem', brush = 'main'},\n  \
                      {name = 'b', driver = 'polhem', brush = 'main'}, # the second\n]\n";
        let written = with_corners(inline, "b", &CORNERS).expect("written");
        let config = RigConfig::parse(&written, "rig.toml").expect("valid");
        assert!(config.device[0].corners_m.is_none() && config.device[1].corners_m.is_some());
        assert!(written.contains("# two") && written.contains("# the second"));
        for (text, name) in [(inline, "c"), ("", "a"), ("device = 3", "a")] {
            let wrong = with_corners(text, name, &CORNERS).expect_err(text);
            assert!(wrong.contains(&format!("'{name}'")), "{wrong}");
        }
    }
}
