//! Event devices of tablets, beside those whose HID device describes its pen: tablets in a format of their maker's own, which
//! the kernel's or a vendor's driver reads.

use std::path::Path;

use maulstick_hid::device_source::Ports as _;
use maulstick_hid::evdev::ports::EventDevices;

use super::{Attached, Places, printable};

/// The pens among the event devices that are not among `hid`, in the order of their nodes.
#[must_use]
pub fn devices(places: &Places<'_>, hid: &[Attached]) -> Vec<Attached> {
    let mut ports = EventDevices {
        sys: places.sys.to_owned(),
        dev: places.dev.to_owned(),
    };
    let found = ports.list().unwrap_or_default().into_iter();
    let device = |found: maulstick_hid::device_source::Found| {
        let identity = found.identity;
        let id = format!("{:04x}:{:04x}", identity.vendor, identity.product);
        let is_pen = |other: &&Attached| other.driver == Some("pen") && other.id == id;
        if found.usages.is_empty() || hid.iter().any(|other| is_pen(&other)) {
            return None;
        }
        let permission = (places.permission)(Path::new(&identity.place));
        Some(Attached {
            name: printable(&identity.name),
            id,
            path: identity.place.into(),
            driver: Some("evdev"),
            missing: permission.missing(),
            permission,
        })
    };
    found.filter_map(device).collect()
}
