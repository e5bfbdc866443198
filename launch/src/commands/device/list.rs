//! `maulstick device list`: attached devices, the drivers that fit, and their missing requirements.

use clap::Args;
use maulstick_device_setup::attached::{Attached, Places, hid, rules};
use maulstick_device_setup::listing::{DeviceListing, RigDevice};
use maulstick_rig::UserError;
use serde_json::json;

use crate::commands::client::Target;
use crate::commands::table::table;
use crate::commands::{print_json, print_text};

/// Options of `maulstick device list`.
#[derive(Args, Clone, Debug)]
pub struct ListOptions {
    /// Print JSON
    #[arg(long)]
    json: bool,
    /// Print a udev rule that lets the user at this machine use its devices
    ///
    /// `maulstick device allow` installs it
    #[arg(long, conflicts_with = "json")]
    udev: bool,
    #[command(flatten)]
    target: Target,
}

/// Lists the attached devices.
///
/// # Errors
/// A [`UserError`] where it cannot be printed.
pub(super) fn run(options: &ListOptions) -> Result<i32, UserError> {
    if options.udev {
        print_text(&rules(&hid::devices(&Places::here())))?;
        return Ok(0);
    }
    let listing = DeviceListing::read(options.target.rig());
    if options.json {
        print_json(&json!(listing))?;
    } else {
        print_text(&in_words(&listing))?;
    }
    Ok(0)
}

/// Row of a device.
type Row = [String; 5];

/// The findings, for people.
fn in_words(findings: &DeviceListing) -> String {
    let mut rows: Vec<Row> = Vec::new();
    let all = || {
        findings
            .hid
            .iter()
            .chain(&findings.events)
            .chain(&findings.serial)
    };
    for fits in [true, false] {
        let these = all().filter(|device| device.driver.is_some() == fits);
        rows.extend(these.map(row));
    }
    let service = &findings.inverse_service;
    for (name, driver, library) in [
        ("OpenHaptics", "openhaptics", &findings.openhaptics),
        (
            "Force Dimension SDK",
            "forcedimension",
            &findings.forcedimension,
        ),
        ("OpenXR controller", "openxr", &findings.openxr),
    ] {
        let path = library.path.as_ref();
        rows.extend(path.map(|path| program(name, driver, &path.display().to_string())));
    }
    if service.listens {
        rows.push(program(
            "Haply Inverse Service",
            "inverse3",
            service.address,
        ));
    }
    // Devices in use come before possible ones.
    let is_used = is_used(findings);
    let in_rig = in_rig(findings.rig.as_deref());
    let mut text = if is_used {
        in_rig.clone() + "\n"
    } else {
        String::new()
    };
    if !rows.is_empty() {
        text += &table(["device", "id", "at", "driver", ""], &rows);
    }
    if !all().any(|device| device.driver.is_some())
        && findings.openhaptics.path.is_none()
        && findings.forcedimension.path.is_none()
        && findings.openxr.path.is_none()
        && !service.listens
    {
        text += &nothing(findings);
    } else {
        // Prefer a painting device to one that moves the canvas.
        let usable = all().filter(|device| is_usable(device));
        let device = usable.min_by_key(|device| device.driver == Some("spacemouse"));
        text += &device.map(advice).unwrap_or_default();
    }
    if is_used { text } else { text + "\n" + &in_rig }
}

/// True if a device of the rig has shown itself.
fn is_used(findings: &DeviceListing) -> bool {
    let mut used = findings.rig.iter().flatten();
    used.any(|used| used.is_there)
}

fn is_usable(device: &Attached) -> bool {
    let known = device.driver.is_some_and(|driver| driver != "openhaptics");
    known && device.missing.is_none()
}

fn row(device: &Attached) -> Row {
    let missing = device.missing.clone();
    let state = match device.driver {
        Some("openhaptics") => missing.unwrap_or_else(|| "through its vendor's library".into()),
        Some(_) => missing.unwrap_or_else(|| "ready".into()),
        None => String::new(),
    };
    [
        device.name.clone(),
        device.id.clone(),
        device.path.display().to_string(),
        device.driver.unwrap_or("-").to_owned(),
        state,
    ]
}

fn program(name: &str, driver: &str, at: &str) -> Row {
    [name, "-", at, driver, "found"].map(str::to_owned)
}

/// Beginning of the list where nothing is attached beside the devices of the rig.
const NOTHING_ELSE: &str = "Nothing else is attached that a driver fits.";
/// Beginning of the list where nothing is attached.
const NOTHING: &str =
    "Nothing attached that a driver fits; the mouse paints, and so does `driver = \"simulated\"`.";

/// Message if there is nothing that a driver fits, but what the rig has in use.
fn nothing(findings: &DeviceListing) -> String {
    let folders: Vec<String> = findings
        .openhaptics
        .looked_in
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    let first = match is_used(findings) {
        true => NOTHING_ELSE,
        false => NOTHING,
    };
    format!(
        "{first}\n\
         Shown would be pens (pen) and 6-DOF mice (spacemouse) at /dev/hidraw*, other tablets (evdev)\n\
         at /dev/input/event*, Polhem and WoodenHaptics (polhem) at serial ports, an Inverse3\n\
         (inverse3) with Haply's service at {}, a Touch (openhaptics) with libHD.so,\n\
         an omega (forcedimension) with libdhd.so and a headset's controller (openxr) with an active\n\
         runtime and libopenxr_loader.so.1 in\n\
         {}.\n",
        findings.inverse_service.address,
        folders.join(", ")
    )
}

/// Advice on the use of a device.
fn advice(device: &Attached) -> String {
    let driver = device.driver.unwrap_or_default();
    let purpose = match driver {
        "spacemouse" => "To move the canvas with it",
        _ => "To paint with it",
    };
    let address = device.address();
    format!("\n{purpose}:\n\n  maulstick device add --address {address}\n")
}

fn in_rig(used: Option<&[RigDevice]>) -> String {
    let Some(used) = used else {
        return "The rig does not run: `maulstick up` starts it.\n".into();
    };
    if used.is_empty() {
        return "The rig that runs has no device.\n".into();
    }
    let row = |used: &RigDevice| -> Row {
        let state = match (used.trouble.as_str(), used.is_there) {
            ("", true) => "in use",
            ("", false) => "does not run: see its messages in the rig's terminal",
            (trouble, _) => trouble,
        };
        let own = &used.section;
        let priority = own.priority.to_string();
        [&own.name, &own.driver, &own.brush, &priority, state].map(Into::into)
    };
    let rows: Vec<Row> = used.iter().map(row).collect();
    let head = ["in the rig", "driver", "brush", "priority", ""];
    table(head, &rows)
}

#[cfg(test)]
mod tests;
