//! Attached devices, the drivers that fit and what they lack; devices of a running rig.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use maulstick_bus::Qos;
use maulstick_client::connection::{Client, Feed};
use maulstick_haptic::drivers::force_dimension::library::DHD;
use maulstick_haptic::drivers::openhaptics::library::HD;
use maulstick_rig::config::DeviceSection;
use maulstick_rig::user_devices;
use maulstick_types::stylus::{StylusInfo, StylusStatus};
use serde::{Serialize, Serializer};

use crate::attached::vendors::{INVERSE_SERVICE, library, library_folders, listens, openxr_loader};
use crate::attached::{Attached, Permission, Places, events, hid, serial};

/// Longest wait for the devices of a rig to show themselves.
const PATIENCE: Duration = Duration::from_secs(1);
/// After the first, others come this soon; a status comes each tenth of a second.
const TOGETHER: Duration = Duration::from_millis(300);

/// Devices attached to a machine, and those of a rig.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct DeviceListing {
    /// At HID nodes.
    #[serde(serialize_with = "with_addresses")]
    pub hid: Vec<Attached>,
    /// At event nodes.
    #[serde(serialize_with = "with_addresses")]
    pub events: Vec<Attached>,
    /// At serial ports.
    #[serde(serialize_with = "with_addresses")]
    pub serial: Vec<Attached>,
    /// OpenHaptics' library.
    pub openhaptics: VendorSoftware,
    /// Force Dimension's library.
    pub forcedimension: VendorSoftware,
    /// The OpenXR loader.
    pub openxr: VendorSoftware,
    /// Haply's service.
    pub inverse_service: InverseService,
    /// The devices of the rig; `None` if it does not run.
    pub rig: Option<Vec<RigDevice>>,
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
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct VendorSoftware {
    /// Where it is, if it is there.
    pub path: Option<PathBuf>,
    /// The folders in which it was looked for.
    pub looked_in: Vec<PathBuf>,
}

/// Haply's service.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct InverseService {
    /// Its address.
    pub address: &'static str,
    /// True if it answers.
    pub listens: bool,
}

/// A device of a running rig.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RigDevice {
    /// Its settings.
    #[serde(flatten)]
    pub section: DeviceSection,
    /// True if it is in the rig's settings; other programs show themselves by their messages alone.
    pub is_in_rig: bool,
    /// True if it is kept for this user.
    pub is_own: bool,
    /// True if it has shown itself.
    pub is_there: bool,
    /// The reason why it gives nothing now; empty if it does.
    pub trouble: String,
}

/// An attached device that the rig does not have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnusedDevice {
    /// Name that it reports.
    pub name: String,
    /// As `address` of `[[device]]`; empty for the only one of its driver.
    pub address: String,
    /// The driver that fits.
    pub driver: &'static str,
    /// Permission of this user for its node.
    pub permission: Permission,
    /// Missing requirement of the driver, with advice.
    pub missing: Option<String>,
}

impl DeviceListing {
    /// Devices attached to this machine, and those of the rig of this name.
    #[must_use]
    pub fn read(rig: &str) -> Self {
        let places = Places::here();
        let looked_in = library_folders();
        let hid = hid::devices(&places);
        let vendor = |path| VendorSoftware {
            path,
            looked_in: looked_in.clone(),
        };
        Self {
            events: events::devices(&places, &hid),
            hid,
            serial: serial::ports(&places),
            openhaptics: vendor(library(&HD, &looked_in)),
            forcedimension: vendor(library(&DHD, &looked_in)),
            openxr: vendor(openxr_loader(&looked_in)),
            inverse_service: InverseService {
                address: INVERSE_SERVICE,
                listens: listens(INVERSE_SERVICE),
            },
            rig: in_use(rig),
        }
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
        unused
            .iter()
            .any(|device| device.permission == Permission::Denied)
    }

    /// The attached devices that a driver fits and that the rig does not have: each once, however many interfaces it
    /// shows.
    #[must_use]
    pub fn unused(&self) -> Vec<UnusedDevice> {
        let behind = |name: &str, driver: &'static str| UnusedDevice {
            name: name.to_owned(),
            address: String::new(),
            driver,
            permission: Permission::Granted,
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
        let of_nodes = nodes.filter_map(|device| {
            Some(UnusedDevice {
                name: device.name.clone(),
                address: device.address(),
                driver: device.driver.filter(|driver| *driver != "openhaptics")?,
                permission: device.permission,
                missing: device.missing.clone(),
            })
        });
        let all = of_nodes.chain(libraries).chain(service);
        let mut found: Vec<UnusedDevice> = Vec::new();
        for device in all.filter(|device| !self.has(device)) {
            let is_same = |other: &UnusedDevice| {
                (other.driver, &other.address) == (device.driver, &device.address)
            };
            if !found.iter().any(is_same) {
                found.push(device);
            }
        }
        found
    }

    /// True if the rig has it: a device without an address takes the first of its driver.
    fn has(&self, device: &UnusedDevice) -> bool {
        let mut devices = self.rig.iter().flatten().map(|device| &device.section);
        devices.any(|own| {
            own.driver == device.driver
                && own.address.as_ref().is_none_or(|own| {
                    own.eq_ignore_ascii_case(&device.address) || device.address.is_empty()
                })
        })
    }
}

/// The devices of a rig, if it runs.
fn in_use(rig: &str) -> Option<Vec<RigDevice>> {
    let client = Client::open(rig).ok()?;
    let own = user_devices::path().and_then(|path| user_devices::read(&path));
    let own = own.unwrap_or_default();
    let row = |section: DeviceSection, is_there: bool| RigDevice {
        is_in_rig: !is_there,
        is_own: own.iter().any(|own| own.name == section.name),
        section,
        is_there,
        trouble: String::new(),
    };
    let sections = client.config().ok()?.device.into_iter();
    let mut found: Vec<RigDevice> = sections.map(|section| row(section, false)).collect();
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

#[cfg(test)]
mod tests {
    use super::*;

    fn attached(name: &str, id: &str, driver: Option<&'static str>) -> Attached {
        Attached {
            name: name.into(),
            id: id.into(),
            path: "/dev/hidraw0".into(),
            driver,
            permission: Permission::Granted,
            missing: None,
        }
    }

    fn listing() -> DeviceListing {
        let found = || VendorSoftware {
            path: Some("/usr/lib/libx.so".into()),
            looked_in: Vec::new(),
        };
        let tablet = DeviceSection {
            address: Some("28BD:0935".into()),
            priority: 1,
            ..DeviceSection::new("tablet", "pen", "main")
        };
        DeviceListing {
            hid: vec![
                attached("Intuos", "056a:0357", Some("pen")),
                attached("Intuos", "056a:0357", Some("pen")),
                attached("Deco", "28bd:0935", Some("pen")),
                attached("Keys", "046d:c31c", None),
            ],
            openxr: found(),
            forcedimension: found(),
            inverse_service: InverseService {
                address: INVERSE_SERVICE,
                listens: true,
            },
            rig: Some(vec![RigDevice {
                section: tablet,
                is_in_rig: true,
                is_own: true,
                is_there: true,
                trouble: String::new(),
            }]),
            ..DeviceListing::default()
        }
    }

    #[test]
    fn a_device_that_the_rig_has_is_not_offered_again() {
        let mut listing = listing();
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
        assert!(listing.device("tablet").is_some_and(|tablet| tablet.is_own));
        let tablet = listing.rig.iter_mut().flatten().next().expect("a tablet");
        tablet.section.address = None;
        assert_eq!(listing.unused().len(), 3, "it takes any pen");
    }

    #[test]
    fn json_has_addresses_and_what_is_not_there() {
        let value = serde_json::json!(listing());
        let pen = &value["hid"][0];
        let parts = [&pen["driver"], &pen["permission"], &pen["address"]];
        assert_eq!(parts, ["pen", "granted", "056a:0357"]);
        assert!(pen["missing"].is_null() && value["openhaptics"]["path"].is_null());
        assert_eq!(value["rig"][0]["name"], "tablet");
    }
}
