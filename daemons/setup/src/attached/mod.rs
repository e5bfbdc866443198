//! Devices attached to this machine: HID devices and serial ports as Linux lists them in sysfs,
//! whoever may read them, and programs that drive devices.
//!
//! | module | holds |
//! | --- | --- |
//! | [`hid`] | HID devices, `/sys/class/hidraw` |
//! | [`events`] | tablets that only an event device makes a pen of, `/sys/class/input` |
//! | [`serial`] | serial ports of USB devices, `/sys/class/tty` |
//! | [`vendors`] | OpenHaptics' library, Haply's service |

pub mod events;
pub mod hid;
pub mod serial;
pub mod vendors;

use std::path::{Path, PathBuf};

use nix::errno::Errno;
use nix::unistd::{AccessFlags, access};
use serde::Serialize;

/// The rule by which udev lets a person at the machine use its devices.
pub const UDEV_RULES: &str = include_str!("../../../../tools/udev/70-maulstick.rules");

/// File in which udev reads the rule.
pub const RULE: &str = "/etc/udev/rules.d/70-maulstick.rules";

/// A device at a node below `/dev`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Attached {
    /// Name that it reports.
    pub name: String,
    /// Vendor and product, in hexadecimal: as `address` of `[[device]]`.
    pub id: String,
    /// Its node.
    pub path: PathBuf,
    /// The driver that fits, if one does.
    pub driver: Option<&'static str>,
    /// Permission of this user for the node.
    pub permission: Permission,
    /// Missing requirement of the driver, with advice; `None` if it is complete.
    pub missing: Option<String>,
}

impl Attached {
    /// Its address in `[[device]]`: of a serial port its node, of any other what it is, wherever it is plugged in.
    #[must_use]
    pub fn address(&self) -> String {
        match self.driver {
            Some("polhem") => self.path.display().to_string(),
            _ => self.id.clone(),
        }
    }
}

/// Permission for a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Permission {
    /// It may be read and written.
    Granted,
    /// It may not.
    Denied,
    /// The node is not there.
    Absent,
}

impl Permission {
    /// Missing requirement of a driver that reads the node, with advice.
    fn missing(self) -> Option<String> {
        let what = match self {
            Self::Granted => return None,
            Self::Denied => "no permission: `maulstick device allow` gives it",
            Self::Absent => "its node is not there: is /dev that of the machine?",
        };
        Some(what.to_owned())
    }
}

/// Permission of this user for a node.
#[must_use]
pub fn permission(node: &Path) -> Permission {
    match access(node, AccessFlags::R_OK | AccessFlags::W_OK) {
        Ok(()) => Permission::Granted,
        Err(Errno::ENOENT) => Permission::Absent,
        Err(_) => Permission::Denied,
    }
}

/// Places where devices are looked for, and the check of permissions.
pub struct Places<'a> {
    /// `/sys`, or what stands for it.
    pub sys: &'a Path,
    /// `/dev`, or what stands for it.
    pub dev: &'a Path,
    /// Permission of the user for a node.
    pub permission: &'a dyn Fn(&Path) -> Permission,
}

impl Places<'static> {
    /// Those of this machine.
    #[must_use]
    pub fn here() -> Self {
        Self {
            sys: Path::new("/sys"),
            dev: Path::new("/dev"),
            permission: &permission,
        }
    }
}

impl Places<'_> {
    /// The entries of a class of devices, by name; empty if there is no such class.
    fn class(&self, class: &str) -> Vec<(String, PathBuf)> {
        let entries = std::fs::read_dir(self.sys.join("class").join(class));
        let named = |entry: std::fs::DirEntry| {
            let name = entry.file_name().into_string().ok()?;
            Some((name, entry.path()))
        };
        let entries = entries.into_iter().flatten().flatten();
        let mut found: Vec<_> = entries.filter_map(named).collect();
        // hidraw2 comes before hidraw10.
        found.sort_by(|(a, _), (b, _)| (a.len(), a).cmp(&(b.len(), b)));
        found
    }
}

/// True if the rule is about a HID device of these numbers, as `VVVV:PPPP`.
fn is_ruled(id: &str) -> bool {
    let mut beginnings = UDEV_RULES.lines().filter_map(|line| {
        let (_, after) = line.split_once("KERNELS==\"*:")?;
        Some(after.split_once("*\"")?.0)
    });
    let id = id.to_uppercase();
    beginnings.any(|beginning| id.starts_with(beginning))
}

/// The rule, and a line for each HID device that a driver fits and that it does not know.
#[must_use]
pub fn rules(devices: &[Attached]) -> String {
    let mut text = UDEV_RULES.to_owned();
    let mut ids: Vec<&str> = devices
        .iter()
        .filter(|device| {
            device
                .driver
                .is_some_and(|driver| hid::DRIVERS.contains(&driver))
        })
        .map(|device| device.id.as_str())
        .filter(|id| !is_ruled(id))
        .collect();
    ids.sort_unstable();
    ids.dedup();
    if !ids.is_empty() {
        text += "\n# Attached to this machine.\n";
    }
    for id in ids {
        let id = id.to_uppercase();
        text += &format!("SUBSYSTEM==\"hidraw\", KERNELS==\"*:{id}.*\", TAG+=\"uaccess\"\n");
    }
    text
}

/// A name as a terminal may show it: a device may call itself anything.
fn printable(name: &str) -> String {
    const LONGEST: usize = 80;
    let shown = |c: char| if c.is_control() { '?' } else { c };
    name.trim().chars().take(LONGEST).map(shown).collect()
}

#[cfg(test)]
mod tests;
