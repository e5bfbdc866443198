//! `maulstick device list`: attached devices, the drivers that fit, and their missing requirements.

use std::time::{Duration, Instant};

use clap::Args;
use maulstick_bus::Qos;
use maulstick_haptic::drivers::force_dimension::library::DHD;
use maulstick_haptic::drivers::openhaptics::library::HD;
use maulstick_rig::config::DeviceSection;
use maulstick_rig::{UserError, user_devices};
use maulstick_types::stylus::{StylusInfo, StylusStatus};
use serde::{Serialize, Serializer};
use serde_json::json;

use crate::attached::vendors::{INVERSE_SERVICE, library, library_folders, listens, openxr_loader};
use crate::attached::{Attached, Places, events, hid, rules, serial};
use crate::commands::client::{Client, Feed, Target};
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

/// Longest wait for the devices of a rig to show themselves.
const PATIENCE: Duration = Duration::from_secs(1);
/// After the first, others come this soon; a status comes each tenth of a second.
const TOGETHER: Duration = Duration::from_millis(300);

/// All that is found.
#[derive(Clone, Debug, Serialize)]
struct Findings {
    #[serde(serialize_with = "with_addresses")]
    hid: Vec<Attached>,
    #[serde(serialize_with = "with_addresses")]
    events: Vec<Attached>,
    #[serde(serialize_with = "with_addresses")]
    serial: Vec<Attached>,
    openhaptics: Library,
    forcedimension: Library,
    openxr: Library,
    inverse_service: Service,
    /// The devices of the rig; `None` if it does not run.
    rig: Option<Vec<Used>>,
}

/// Devices with their addresses in `[[device]]`.
fn with_addresses<S: Serializer>(devices: &[Attached], to: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Addressed<'a> {
        #[serde(flatten)]
        device: &'a Attached,
        address: String,
    }
    to.collect_seq(devices.iter().map(|device| Addressed {
        device,
        address: device.address(),
    }))
}

/// A vendor's library.
#[derive(Clone, Debug, Serialize)]
struct Library {
    path: Option<std::path::PathBuf>,
    looked_in: Vec<std::path::PathBuf>,
}

/// Haply's service.
#[derive(Clone, Debug, Serialize)]
struct Service {
    address: &'static str,
    listens: bool,
}

/// A device of a running rig.
#[derive(Clone, Debug, Serialize)]
struct Used {
    /// Its settings.
    #[serde(flatten)]
    section: DeviceSection,
    /// True if it is in the rig's settings; other programs show themselves by their messages alone.
    is_in_rig: bool,
    /// True if it is kept for this user.
    is_own: bool,
    /// True if it has shown itself.
    is_there: bool,
    /// The reason why it gives nothing now; empty if it does.
    trouble: String,
}

/// Lists what is attached.
///
/// # Errors
/// A [`UserError`] where it cannot be printed.
pub(super) fn run(options: &ListOptions) -> Result<i32, UserError> {
    let places = Places::here();
    if options.udev {
        print_text(&rules(&hid::devices(&places)))?;
        return Ok(0);
    }
    let looked_in = library_folders();
    let hid = hid::devices(&places);
    let findings = Findings {
        events: events::devices(&places, &hid),
        hid,
        serial: serial::ports(&places),
        openhaptics: Library {
            path: library(&HD, &looked_in),
            looked_in: looked_in.clone(),
        },
        forcedimension: Library {
            path: library(&DHD, &looked_in),
            looked_in: looked_in.clone(),
        },
        openxr: Library {
            path: openxr_loader(&looked_in),
            looked_in,
        },
        inverse_service: Service {
            address: INVERSE_SERVICE,
            listens: listens(INVERSE_SERVICE),
        },
        rig: used(&options.target),
    };
    match options.json {
        true => print_json(&json!(findings))?,
        false => print_text(&in_words(&findings))?,
    }
    Ok(0)
}

/// The devices of a rig, if it runs.
fn used(target: &Target) -> Option<Vec<Used>> {
    let client = Client::open(target).ok()?;
    let own = user_devices::path().and_then(|path| user_devices::read(&path));
    let own = own.unwrap_or_default();
    let row = |section: DeviceSection, is_there: bool| Used {
        is_in_rig: !is_there,
        is_own: own.iter().any(|own| own.name == section.name),
        section,
        is_there,
        trouble: String::new(),
    };
    let sections = client.config().ok()?.device.into_iter();
    let mut found: Vec<Used> = sections.map(|section| row(section, false)).collect();
    let topics = client.topics();
    let mut infos: Feed<StylusInfo> = client.follow(&topics.stylus_info("*"), Qos::Cached).ok()?;
    let mut statuses: Feed<StylusStatus> = client
        .follow(&topics.stylus_status("*"), Qos::Background)
        .ok()?;
    let mut until = Instant::now() + PATIENCE;
    while let Some(info) = infos.next_before(until) {
        until = until.min(Instant::now() + TOGETHER);
        match found
            .iter_mut()
            .find(|used| used.section.name == info.device)
        {
            Some(used) => used.is_there = true,
            None => {
                let section = DeviceSection {
                    priority: info.priority,
                    ..DeviceSection::new(&info.device, &info.driver, &info.brush)
                };
                found.push(row(section, true));
            }
        }
    }
    // Heard while the devices showed themselves; one that has never been there has nothing else.
    while let Some(received) = statuses.received_before(Instant::now()) {
        let device = received.key.rsplit('/').nth(1).unwrap_or_default();
        let status = received.message;
        let trouble = match status.trouble() {
            Some(trouble) if status.faults.is_empty() => trouble.to_string(),
            _ => status.faults.join("; "),
        };
        if let Some(used) = found.iter_mut().find(|used| used.section.name == device) {
            used.trouble = trouble;
        }
    }
    // The highest priority first.
    found.sort_by(|a, b| {
        let (a, b) = (&a.section, &b.section);
        b.priority.cmp(&a.priority).then(a.name.cmp(&b.name))
    });
    Some(found)
}

/// Row of a device.
type Row = [String; 5];

/// The findings, for people.
fn in_words(findings: &Findings) -> String {
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
    // What paints already comes before what might.
    let is_used = is_used(findings);
    let mut text = match is_used {
        true => in_rig(findings.rig.as_deref()) + "\n",
        false => String::new(),
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
        // Rather what paints than what moves the canvas.
        let usable = all().filter(|device| is_usable(device));
        let device = usable.min_by_key(|device| device.driver == Some("spacemouse"));
        text += &device.map(advice).unwrap_or_default();
    }
    match is_used {
        true => text,
        false => text + "\n" + &in_rig(findings.rig.as_deref()),
    }
}

/// True if a device of the rig has shown itself.
fn is_used(findings: &Findings) -> bool {
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

/// Message if there is nothing that a driver fits, but what the rig has in use.
fn nothing(findings: &Findings) -> String {
    let folders: Vec<String> = findings
        .openhaptics
        .looked_in
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    let first = match is_used(findings) {
        true => "Nothing else is attached that a driver fits.",
        false => {
            "Nothing attached that a driver fits; the mouse paints, and so does `driver = \"simulated\"`."
        }
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

fn in_rig(used: Option<&[Used]>) -> String {
    let Some(used) = used else {
        return "The rig does not run: `maulstick up` starts it.\n".into();
    };
    if used.is_empty() {
        return "The rig that runs has no device.\n".into();
    }
    let row = |used: &Used| -> Row {
        let state = match (used.trouble.as_str(), used.is_there) {
            ("", true) => "in use",
            ("", false) => "does not run: the rig's terminal says why",
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
