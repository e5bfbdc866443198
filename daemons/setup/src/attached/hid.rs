//! HID devices. Their report descriptors and names are in sysfs, where everybody may read them: so a pen is known by
//! its own description, and is listed too if its node may not be opened.

use std::path::{Path, PathBuf};

use maulstick_device::hid_collections::{Collection, collections};

use super::{Attached, Places, printable};

/// The drivers of HID devices.
pub(super) const DRIVERS: [&str; 2] = ["pen", "spacemouse"];
/// Vendors of 6-DOF mice: 3Dconnexion, and Logitech before it.
const MICE: [u16; 2] = [0x256f, 0x046d];
/// Vendor of the Touch, which OpenHaptics drives.
const TOUCH: u16 = 0x2988;

/// All HID devices, in the order of their nodes.
#[must_use]
pub fn devices(places: &Places<'_>) -> Vec<Attached> {
    let device = |(node, entry): (String, PathBuf)| {
        let path = places.dev.join(node);
        let told = Told::read(&entry.join("device"))?;
        let driver = told.driver();
        let permission = (places.permission)(&path);
        Some(Attached {
            missing: driver
                .filter(|driver| DRIVERS.contains(driver))
                .and_then(|_| permission.missing()),
            name: told.name,
            id: format!("{:04x}:{:04x}", told.vendor, told.product),
            path,
            driver,
            permission,
        })
    };
    let nodes = places.class("hidraw").into_iter();
    nodes.filter_map(device).collect()
}

/// Entry of the kernel for a HID device.
struct Told {
    name: String,
    vendor: u16,
    product: u16,
    collections: Vec<Collection>,
}

impl Told {
    /// Entry of the device's folder; `None` if it does not identify the device.
    fn read(folder: &Path) -> Option<Self> {
        let text = std::fs::read(folder.join("uevent")).ok()?;
        let text = String::from_utf8_lossy(&text);
        let of = |key: &str| text.lines().find_map(|line| line.strip_prefix(key));
        // Bus, vendor and product, each in hexadecimal.
        let mut id = of("HID_ID=")?.split(':').skip(1);
        let mut number = || u32::from_str_radix(id.next()?.trim(), 16).ok();
        let (vendor, product) = (number()? as u16, number()? as u16);
        let descriptor = std::fs::read(folder.join("report_descriptor")).unwrap_or_default();
        Some(Self {
            name: printable(of("HID_NAME=").unwrap_or("a HID device")),
            vendor,
            product,
            collections: collections(&descriptor),
        })
    }

    fn driver(&self) -> Option<&'static str> {
        let has = |is: fn(&Collection) -> bool| self.collections.iter().any(is);
        if has(Collection::is_pen) {
            Some("pen")
        } else if MICE.contains(&self.vendor) && has(Collection::has_six_axes) {
            Some("spacemouse")
        } else {
            (self.vendor == TOUCH).then_some("openhaptics")
        }
    }
}
