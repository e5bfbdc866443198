//! A device that paints from now on: kept for this user, and started in the running rig.

use std::path::PathBuf;

use maulstick_rig::config::{DeviceSection, PEN_DRIVERS};
use maulstick_types::command::Detail;
use maulstick_types::plain;

use crate::attached::{Attached, Places, events, hid, serial};
use crate::error::{ChoiceError, SetupError};
use crate::running::{Devices as _, Running, put_in_both};
use crate::user_file::UserFile;

/// A device to be added.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NewDevice {
    /// Its name; by what it is if absent.
    pub name: Option<String>,
    /// Its driver; the one that fits what is attached if absent.
    pub driver: Option<String>,
    /// Which of several: vendor:product or a path.
    pub address: Option<String>,
    /// Brush that it moves; "main" if absent.
    pub brush: Option<String>,
    /// Of devices in range the one with the highest priority paints.
    pub priority: i32,
}

/// A device that was added.
#[derive(Clone, Debug, PartialEq)]
pub struct Added {
    /// Its name.
    pub name: String,
    /// Its driver.
    pub driver: String,
    /// The file in which it is kept.
    pub file: PathBuf,
    /// Name that the device reports, and the missing requirement of its driver.
    pub missing: Option<(String, String)>,
    /// The rig's answer; `None` if it does not run.
    pub started: Option<Detail>,
}

/// Adds a device to those of this user, and to the rig of this name if it runs.
///
/// # Errors
/// A [`SetupError`] where none or several fit, where it is wrong, where the rig refuses it, or where it cannot be kept; all
/// is as it was then.
pub fn add(new: &NewDevice, rig: &str) -> Result<Added, SetupError> {
    let mut file = UserFile::read()?;
    let mut rig = Running::open(rig)?;
    let mut missing = None;
    let (driver, address) = match &new.driver {
        Some(driver) => (driver.clone(), new.address.clone()),
        None => {
            let found = attached(&Places::here());
            let (one, address) = chosen(&found, new.address.as_deref(), &file.devices)?;
            missing = one
                .missing
                .clone()
                .map(|missing| (one.name.clone(), missing));
            (one.driver.unwrap_or_default().to_owned(), Some(address))
        }
    };
    let name = match &new.name {
        Some(name) => name.clone(),
        None => free_name(&driver, &file.devices),
    };
    file.check_free(&name, &rig.all()?)?;
    let brush = new.brush.as_deref().unwrap_or("main");
    let device = DeviceSection {
        address,
        priority: new.priority,
        ..DeviceSection::new(&name, &driver, brush)
    };
    Ok(Added {
        started: put_in_both(&mut rig, &mut file, &device)?,
        file: file.path().to_owned(),
        name,
        driver,
        missing,
    })
}

fn attached(places: &Places<'_>) -> Vec<Attached> {
    let hid = hid::devices(places);
    let events = events::devices(places, &hid);
    let all = hid.into_iter().chain(events).chain(serial::ports(places));
    all.filter(|device| device.driver.is_some_and(|driver| driver != "openhaptics"))
        .collect()
}

/// The attached device that is meant, and its address.
fn chosen<'a>(
    found: &'a [Attached],
    address: Option<&str>,
    known: &[DeviceSection],
) -> Result<(&'a Attached, String), ChoiceError> {
    let is_known = |device: &Attached| {
        let mut addresses = known.iter().filter_map(|own| own.address.as_ref());
        addresses.any(|own| *own == device.address())
    };
    let is_meant = |device: &&Attached| match address {
        Some(address) => {
            device.id.eq_ignore_ascii_case(address) || device.path.as_os_str() == address
        }
        None => !is_known(device),
    };
    let mut meant: Vec<&Attached> = found.iter().filter(is_meant).collect();
    // A tablet may have several interfaces.
    meant.dedup_by_key(|device| (device.driver, device.address()));
    match meant.as_slice() {
        [one] => Ok((*one, address.map_or_else(|| one.address(), str::to_owned))),
        [] if address.is_none() && found.iter().any(is_known) => Err(ChoiceError::Yours),
        [] => Err(ChoiceError::Nothing),
        several => {
            let of = |device: &&Attached| format!("{} {}", device.address(), plain(&device.name));
            Err(ChoiceError::Several(several.iter().map(of).collect()))
        }
    }
}

/// A name that no device has.
fn free_name(driver: &str, known: &[DeviceSection]) -> String {
    let name = if PEN_DRIVERS.contains(&driver) {
        "tablet"
    } else {
        driver
    };
    let is_free = |name: &String| known.iter().all(|device| device.name != *name);
    let numbered = (2..).map(|number| format!("{name}-{number}"));
    let mut names = std::iter::once(name.to_owned()).chain(numbered);
    names.find(is_free).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attached::Permission;

    fn pen(id: &str, path: &str) -> Attached {
        Attached {
            name: format!("Pen {id}"),
            id: id.into(),
            path: path.into(),
            driver: Some("pen"),
            permission: Permission::Granted,
            missing: None,
        }
    }

    #[test]
    fn the_only_device_is_meant_and_of_several_one_is_named() {
        let found = [
            pen("056a:0357", "/dev/hidraw1"),
            pen("28bd:0935", "/dev/hidraw2"),
        ];
        let meant = |address, known: &[DeviceSection]| {
            let chosen = chosen(&found, address, known);
            chosen.map(|(one, address)| (one.id.clone(), address))
        };
        let of = |id: &str, address: &str| Ok((id.to_owned(), address.to_owned()));
        let deco = "28bd:0935";
        assert_eq!(meant(Some(deco), &[]), of(deco, deco));
        let path = "/dev/hidraw1";
        assert_eq!(meant(Some(path), &[]), of("056a:0357", path));
        let all = found.iter().map(|pen| format!("{} {}", pen.id, pen.name));
        assert_eq!(meant(None, &[]), Err(ChoiceError::Several(all.collect())));
        let known = DeviceSection {
            address: Some("056a:0357".into()),
            ..DeviceSection::new("tablet", "pen", "main")
        };
        assert_eq!(meant(None, std::slice::from_ref(&known)), of(deco, deco));
        assert_eq!(meant(Some("1:2"), &[]), Err(ChoiceError::Nothing));
        let both = [
            known.clone(),
            DeviceSection {
                address: Some(deco.into()),
                ..known.clone()
            },
        ];
        assert_eq!(meant(None, &both), Err(ChoiceError::Yours));
        assert_eq!(meant(Some("28BD:0935"), &[]), of(deco, "28BD:0935"));
        assert_eq!(free_name("pen", &[known]), "tablet-2");
        assert_eq!(free_name("polhem", &[]), "polhem");
    }
}
