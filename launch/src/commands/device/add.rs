//! `maulstick device add`: an attached device paints from now on.

use clap::Args;
use maulstick_rig::UserError;
use maulstick_rig::config::{DeviceSection, PEN_DRIVERS};
use maulstick_types::plain;

use super::user_file::{UserFile, in_rig, put_in_rig};
use crate::attached::{Attached, Places, events, hid, serial};
use crate::commands::client::Target;
use crate::commands::say;

/// Options of `maulstick device add`.
#[derive(Args, Clone, Debug)]
pub struct AddOptions {
    /// Name for the device [default: by what it is]
    device: Option<String>,
    /// Its driver [default: the one that fits what is attached]
    #[arg(long)]
    driver: Option<String>,
    /// Which of several: vendor:product or a path, as `maulstick device list` shows them
    #[arg(long)]
    address: Option<String>,
    /// Brush that it moves
    #[arg(long, default_value = "main")]
    brush: String,
    /// Of devices in range the one with the highest priority paints
    #[arg(long, default_value_t = 0, allow_negative_numbers = true)]
    priority: i32,
    #[command(flatten)]
    target: Target,
}

/// Adds a device.
///
/// # Errors
/// A [`UserError`] where none or several fit, where it is wrong, or where it cannot be kept.
pub(super) fn run(options: &AddOptions) -> Result<i32, UserError> {
    let mut file = UserFile::read()?;
    let (driver, address) = match &options.driver {
        Some(driver) => (driver.clone(), options.address.clone()),
        None => {
            let found = attached(&Places::here());
            let (driver, address) = chosen(&found, options.address.as_deref(), &file.devices)?;
            (driver, Some(address))
        }
    };
    let name = match &options.device {
        Some(name) => name.clone(),
        None => free_name(&driver, &file.devices),
    };
    file.check_free(&name, &in_rig(&options.target)?)?;
    let device = DeviceSection {
        address,
        priority: options.priority,
        ..DeviceSection::new(&name, &driver, &options.brush)
    };
    file.put(&device)?;
    say!("'{name}' ({driver}) is kept in {}", file.path().display());
    match put_in_rig(&options.target, &device)? {
        Some(said) => say!("{said}; `maulstick device list` shows how it fares"),
        None => say!("it paints when the rig is started: `maulstick up`"),
    }
    Ok(0)
}

fn attached(places: &Places<'_>) -> Vec<Attached> {
    let hid = hid::devices(places);
    let events = events::devices(places, &hid);
    let all = hid.into_iter().chain(events).chain(serial::ports(places));
    all.filter(|device| device.driver.is_some_and(|driver| driver != "openhaptics"))
        .collect()
}

/// Driver and address of the attached device that is meant.
fn chosen(
    found: &[Attached],
    address: Option<&str>,
    known: &[DeviceSection],
) -> Result<(String, String), UserError> {
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
        [one] => {
            if let Some(missing) = &one.missing {
                say!("{}: {missing}", one.name);
            }
            let driver = one.driver.unwrap_or_default().to_owned();
            Ok((driver, address.map_or_else(|| one.address(), str::to_owned)))
        }
        [] if address.is_none() && found.iter().any(is_known) => {
            Err(UserError::usage("what is attached is yours already")
                .help("`maulstick device use` has it paint"))
        }
        [] => Err(UserError::usage("no device is attached that a driver fits")
            .help("`maulstick device list` shows what is; `--driver` names one that shows nowhere, as `openhaptics`, `forcedimension`, `openxr` or `inverse3`")),
        several => {
            let of = |device: &&Attached| format!("{} {}", device.address(), plain(&device.name));
            let all: Vec<String> = several.iter().map(of).collect();
            Err(UserError::usage(format!("several devices are attached: {}", all.join(", ")))
                .help("say which: --address"))
        }
    }
}

/// A name that no device has.
fn free_name(driver: &str, known: &[DeviceSection]) -> String {
    let name = match PEN_DRIVERS.contains(&driver) {
        true => "tablet",
        false => driver,
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
        let told = |address, known: &[DeviceSection]| {
            chosen(&found, address, known).map_err(|fault| fault.to_string())
        };
        let of = |address: &str| Ok(("pen".to_owned(), address.to_owned()));
        assert_eq!(told(Some("28bd:0935"), &[]), of("28bd:0935"));
        assert_eq!(told(Some("/dev/hidraw1"), &[]), of("/dev/hidraw1"));
        let fault = told(None, &[]).expect_err("two");
        assert!(
            fault.contains("056a:0357") && fault.contains("28bd:0935"),
            "{fault}"
        );
        let known = DeviceSection {
            address: Some("056a:0357".into()),
            ..DeviceSection::new("tablet", "pen", "main")
        };
        assert_eq!(told(None, std::slice::from_ref(&known)), of("28bd:0935"));
        assert!(
            told(Some("1:2"), &[])
                .expect_err("none")
                .contains("no device is attached")
        );
        let both = [
            known.clone(),
            DeviceSection {
                address: Some("28bd:0935".into()),
                ..known.clone()
            },
        ];
        assert!(
            told(None, &both)
                .expect_err("known")
                .contains("yours already")
        );
        assert_eq!(told(Some("28BD:0935"), &[]), of("28BD:0935"));
        assert_eq!(free_name("pen", &[known]), "tablet-2");
        assert_eq!(free_name("polhem", &[]), "polhem");
    }
}
