//! What is attached and what the rig has of it, as `maulstick device list --json` says.

use std::path::PathBuf;

use maulstick_rig::config::DeviceSection;
use serde::Deserialize;

/// All that was found.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct DeviceListing {
    hid: Vec<AttachedDevice>,
    events: Vec<AttachedDevice>,
    serial: Vec<AttachedDevice>,
    openhaptics: Library,
    #[serde(default)]
    forcedimension: Library,
    #[serde(default)]
    openxr: Library,
    inverse_service: Service,
    rig: Option<Vec<RigDevice>>,
}

/// A device at a node below `/dev`, or one behind a program of its vendor's.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct AttachedDevice {
    /// Name that it reports.
    pub name: String,
    /// As `address` of `[[device]]`; empty for the only one of its driver.
    pub address: String,
    /// The driver that fits, if one does.
    pub driver: Option<String>,
    /// `granted`, `denied` or `absent`.
    pub permission: String,
    /// Missing requirement of the driver, with advice.
    pub missing: Option<String>,
}

/// A device of the rig.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct RigDevice {
    /// Its settings.
    #[serde(flatten)]
    pub section: DeviceSection,
    /// True if it is in the rig's settings.
    pub is_in_rig: bool,
    /// True if it is kept for this user.
    pub is_own: bool,
}

#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
struct Library {
    path: Option<PathBuf>,
}

#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
struct Service {
    listens: bool,
}

impl DeviceListing {
    /// Reads the JSON.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    pub fn parse(json: &[u8]) -> Result<Self, String> {
        serde_json::from_slice(json).map_err(|error| error.to_string())
    }

    /// Settings of a device of the rig.
    #[must_use]
    pub fn device(&self, name: &str) -> Option<&RigDevice> {
        let mut devices = self.rig.iter().flatten();
        devices.find(|device| device.section.name == name)
    }

    /// True if a device may not be used yet.
    #[must_use]
    pub fn lacks_permission(&self) -> bool {
        let unused = self.unused();
        unused.iter().any(|device| device.permission == "denied")
    }

    /// The attached devices that a driver fits and that the rig does not have: each once, however many interfaces it
    /// shows.
    #[must_use]
    pub fn unused(&self) -> Vec<AttachedDevice> {
        let behind = |name: &str, driver: &str| AttachedDevice {
            name: name.to_owned(),
            address: String::new(),
            driver: Some(driver.to_owned()),
            permission: "granted".to_owned(),
            missing: None,
        };
        let libraries = [
            (&self.openhaptics, "OpenHaptics", "openhaptics"),
            (&self.forcedimension, "Force Dimension", "forcedimension"),
            (&self.openxr, "OpenXR controller", "openxr"),
        ];
        let libraries = libraries
            .into_iter()
            .filter(|(library, ..)| library.path.is_some());
        let libraries = libraries.map(|(_, name, driver)| behind(name, driver));
        let service = self.inverse_service.listens;
        let service = service.then(|| behind("Haply Inverse Service", "inverse3"));
        let nodes = self.hid.iter().chain(&self.events).chain(&self.serial);
        let of_nodes = nodes.filter(|device| device.driver.as_deref() != Some("openhaptics"));
        let all = of_nodes.cloned().chain(libraries).chain(service);
        let mut found: Vec<AttachedDevice> = Vec::new();
        for device in all.filter(|device| device.driver.is_some() && !self.has(device)) {
            let is_same = |other: &AttachedDevice| {
                (&other.driver, &other.address) == (&device.driver, &device.address)
            };
            if !found.iter().any(is_same) {
                found.push(device);
            }
        }
        found
    }

    /// Whether the rig has it: a device without an address takes the first of its driver.
    fn has(&self, device: &AttachedDevice) -> bool {
        let mut devices = self.rig.iter().flatten().map(|device| &device.section);
        devices.any(|own| {
            Some(&own.driver) == device.driver.as_ref()
                && own.address.as_ref().is_none_or(|own| {
                    own.eq_ignore_ascii_case(&device.address) || device.address.is_empty()
                })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SAID: &str = r#"{
        "hid": [
            {"name": "Intuos", "id": "056a:0357", "path": "/dev/hidraw0", "driver": "pen",
             "permission": "granted", "missing": null, "address": "056a:0357"},
            {"name": "Intuos", "id": "056a:0357", "path": "/dev/hidraw1", "driver": "pen",
             "permission": "granted", "missing": null, "address": "056a:0357"},
            {"name": "Deco", "id": "28bd:0935", "path": "/dev/hidraw2", "driver": "pen",
             "permission": "denied", "missing": "no permission", "address": "28bd:0935"},
            {"name": "Keys", "id": "046d:c31c", "path": "/dev/hidraw3", "driver": null,
             "permission": "granted", "missing": null, "address": "046d:c31c"}
        ],
        "events": [], "serial": [],
        "openhaptics": {"path": null, "looked_in": []},
        "openxr": {"path": "/usr/lib/libopenxr_loader.so.1", "looked_in": []},
        "forcedimension": {"path": "/usr/lib/libdhd.so.3", "looked_in": []},
        "inverse_service": {"address": "localhost:10001", "listens": true},
        "rig": [
            {"name": "tablet", "driver": "pen", "brush": "main", "address": "28BD:0935", "priority": 1,
             "is_in_rig": true, "is_own": true, "is_there": true, "trouble": ""}
        ]
    }"#;

    #[test]
    fn what_the_rig_has_is_not_offered_again() {
        let listing = DeviceListing::parse(SAID.as_bytes()).expect("read");
        let offered: Vec<String> = listing.unused().into_iter().map(|it| it.name).collect();
        assert_eq!(
            offered,
            [
                "Intuos",
                "Force Dimension",
                "OpenXR controller",
                "Haply Inverse Service"
            ]
        );
        let tablet = listing.device("tablet").expect("a tablet");
        assert!(tablet.is_own && tablet.section.priority == 1);
        let any = SAID.replace("\"address\": \"28BD:0935\", ", "");
        let listing = DeviceListing::parse(any.as_bytes()).expect("read");
        assert_eq!(listing.unused().len(), 3);
        assert!(DeviceListing::parse(b"{").is_err());
    }
}
