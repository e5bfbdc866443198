//! The devices of this machine, through hidapi.

use std::ffi::CString;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::Duration;

use hidapi::{BusType, HidApi, HidDevice, HidError};
use maulstick_rig::UserError;

use crate::descriptor::LONGEST;
use crate::device_source::{Found, HidSource, Identity, Ports};
use crate::evdev::grab::{Grab, event_nodes};

/// The machine's own ports.
#[derive(Debug, Default)]
pub struct Hidraw;

struct Device {
    device: HidDevice,
    place: PathBuf,
    grab: Grab,
    descriptor: Vec<u8>,
    name: String,
}

fn failed(what: &str, error: &HidError) -> UserError {
    UserError::failure(format!("{what}: {error}")).help("see what the kernel says of it: `dmesg`")
}

impl Ports for Hidraw {
    fn list(&mut self) -> Result<Vec<Found>, UserError> {
        let api = HidApi::new().map_err(|error| failed("the devices cannot be listed", &error))?;
        let mut found: Vec<Found> = Vec::new();
        for info in api.device_list() {
            let place = info.path().to_string_lossy().into_owned();
            let usage = (info.usage_page(), info.usage());
            // A device comes once for each of its collections.
            if let Some(known) = found.iter_mut().find(|found| found.identity.place == place) {
                known.usages.push(usage);
                continue;
            }
            let words = [info.manufacturer_string(), info.product_string()];
            let words: Vec<_> = words
                .into_iter()
                .flatten()
                .filter(|word| !word.is_empty())
                .collect();
            found.push(Found {
                identity: Identity {
                    bus: match info.bus_type() {
                        BusType::Usb => 3,
                        BusType::Bluetooth => 5,
                        BusType::I2c => 0x18,
                        BusType::Spi => 0x1C,
                        BusType::Unknown => 0,
                    },
                    vendor: info.vendor_id(),
                    product: info.product_id(),
                    name: words.join(" "),
                    place,
                },
                usages: vec![usage],
            });
        }
        // hidraw9 before hidraw10.
        found.sort_by(|a, b| {
            let [a, b] = [a, b].map(|found| &found.identity.place);
            (a.len(), a).cmp(&(b.len(), b))
        });
        Ok(found)
    }

    fn dev(&self) -> Option<&Path> {
        Some(Path::new("/dev"))
    }

    fn open(&mut self, found: &Found) -> Result<Box<dyn HidSource>, UserError> {
        let Identity { place, .. } = &found.identity;
        let name = found.identity.to_string();
        // hidapi says in words alone why a device does not open.
        std::fs::OpenOptions::new()
            .read(true)
            .write(true)
            .open(place)
            .map_err(|error| closed(&found.identity, &error))?;
        let api = HidApi::new().map_err(|error| failed("the devices cannot be listed", &error))?;
        let path = CString::new(place.as_bytes())
            .map_err(|_| UserError::usage(format!("'{place}' is no path")))?;
        let what = format!("{name} cannot be opened");
        let device = api
            .open_path(&path)
            .map_err(|error| failed(&what, &error))?;
        let mut descriptor = vec![0; LONGEST];
        let length = device
            .get_report_descriptor(&mut descriptor)
            .map_err(|error| failed(&format!("{name} does not describe itself"), &error))?;
        descriptor.truncate(length);
        Ok(Box::new(Device {
            device,
            place: place.into(),
            grab: Grab::default(),
            descriptor,
            name,
        }))
    }
}

/// The reason why a device does not open, with advice.
#[must_use]
pub fn closed(device: &Identity, error: &std::io::Error) -> UserError {
    let name = device.to_string();
    let (what, help) = match error.kind() {
        ErrorKind::PermissionDenied => (
            format!("you may not read {name}"),
            "`maulstick device allow` installs the rule that permits it",
        ),
        ErrorKind::ResourceBusy => (
            format!("{name} is in use"),
            "end the program that holds it, a vendor's driver perhaps",
        ),
        ErrorKind::NotFound => (format!("{name} is gone"), "plug it in again"),
        _ => (
            format!("{name} cannot be opened: {error}"),
            "plug it in again",
        ),
    };
    UserError::failure(what).at(device.place.clone()).help(help)
}

impl HidSource for Device {
    fn grab(&mut self) -> Result<(), UserError> {
        let nodes = event_nodes(Path::new("/sys"), Path::new("/dev"), &self.place);
        let (grab, fault) = Grab::all(&nodes);
        self.grab = grab;
        fault.map_or(Ok(()), Err)
    }

    fn descriptor(&self) -> &[u8] {
        &self.descriptor
    }

    fn read(&mut self, report: &mut [u8], limit: Duration) -> Result<usize, UserError> {
        let limit = i32::try_from(limit.as_millis()).unwrap_or(i32::MAX);
        match self.device.read_timeout(report, limit) {
            Ok(length) => Ok(length),
            Err(HidError::IoError { error }) if error.kind() == ErrorKind::Interrupted => Ok(0),
            Err(error) => {
                let name = &self.name;
                let what = format!("{name} was unplugged, or does not answer: {error}");
                Err(UserError::failure(what).help("plug it in again"))
            }
        }
    }

    fn write(&mut self, report: &[u8]) -> Result<(), UserError> {
        let what = format!("{} does not take an order", self.name);
        self.device
            .write(report)
            .map(drop)
            .map_err(|error| failed(&what, &error))
    }
}
