//! Serial ports of USB devices; a port of the machine itself does not identify the device on it.

use std::path::{Path, PathBuf};

use maulstick_haptic::drivers::polhem::find::is_board;

use super::{Attached, Permission, Places, printable};

/// Vendor of the Touch, which OpenHaptics drives.
const TOUCH: u16 = 0x2988;
/// A port's USB device is so many folders above its interface, at most.
const ABOVE: usize = 4;

/// The serial ports of USB devices, in the order of their names.
#[must_use]
pub fn ports(places: &Places<'_>) -> Vec<Attached> {
    let port = |(node, entry): (String, PathBuf)| {
        let interface = entry.join("device").canonicalize().ok()?;
        let device = interface
            .ancestors()
            .take(ABOVE)
            .find(|folder| folder.join("idVendor").exists())?;
        let (vendor, product) = (number(device, "idVendor")?, number(device, "idProduct")?);
        let driver = match vendor {
            _ if is_board(vendor, product) => Some("polhem"),
            TOUCH => Some("openhaptics"),
            _ => None,
        };
        let path = places.dev.join(node);
        let permission = (places.permission)(&path);
        let words = ["manufacturer", "product"].map(|file| word(device, file));
        let name = words.into_iter().flatten().collect::<Vec<_>>().join(" ");
        Some(Attached {
            name: printable(if name.is_empty() {
                "a serial port"
            } else {
                &name
            }),
            id: format!("{vendor:04x}:{product:04x}"),
            path,
            driver,
            permission,
            missing: driver.and_then(|driver| missing(driver, permission)),
        })
    };
    let entries = places.class("tty").into_iter();
    entries.filter_map(port).collect()
}

fn missing(driver: &str, permission: Permission) -> Option<String> {
    let what = match (permission, driver) {
        (Permission::Granted, _) => return None,
        (Permission::Denied, "polhem") => {
            "no permission: `maulstick device allow` gives it, or join the \
             group of serial ports: sudo usermod -aG dialout $USER, then log in again"
        }
        (Permission::Denied, _) => {
            "no permission: join the group of serial ports: sudo usermod -aG dialout $USER, then \
             log in again"
        }
        (Permission::Absent, _) => "its node is not there: is /dev that of the machine?",
    };
    Some(what.to_owned())
}

fn word(device: &Path, file: &str) -> Option<String> {
    let bytes = std::fs::read(device.join(file)).ok()?;
    let text = String::from_utf8_lossy(&bytes).trim().to_owned();
    (!text.is_empty()).then_some(text)
}

fn number(device: &Path, file: &str) -> Option<u16> {
    u16::from_str_radix(&word(device, file)?, 16).ok()
}
