//! Keys of a `[[device]]` that its driver would ignore.

use super::device::{DeviceSection, LIBRARY_DRIVERS, PEN_DRIVERS};
use super::wrong::Wrong;

/// Rejects keys that the driver of a device would ignore.
pub(super) fn check_driver(device: &DeviceSection) -> Result<(), Wrong> {
    for (key, is_ignored, help) in keys(device) {
        if is_ignored {
            return Err(Wrong {
                what: format!(
                    "{key} of '{}' does nothing: its driver is {}",
                    device.name, device.driver
                ),
                key,
                value: String::new(),
                help: help.into(),
            });
        }
    }
    check_library(device)?;
    check_clutch(device)
}

/// Keys that some drivers ignore: true where the device has one in vain, and advice.
fn keys(device: &DeviceSection) -> [(&'static str, bool, &'static str); 10] {
    let driver = device.driver.as_str();
    let usual = DeviceSection::new(&device.name, driver, &device.brush);
    [
        (
            "hand",
            device.hand.is_some() && driver != "simulated",
            "take it out: only a simulated device follows a take",
        ),
        (
            "library",
            device.library.is_some() && !LIBRARY_DRIVERS.contains(&driver),
            "take it out: it is the library of openhaptics, forcedimension or openxr",
        ),
        (
            "replay",
            device.replay.is_some() && !device.is_hid(),
            "take it out: it is played in the place of a tablet or a spacemouse; \
             a take is the `hand` of a simulated device",
        ),
        (
            "address",
            device.address.is_some() && driver == "simulated",
            "take it out: a simulated device is attached to nothing",
        ),
        (
            "pressure_curve",
            device.pressure_curve != usual.pressure_curve && !PEN_DRIVERS.contains(&driver),
            "take it out: only a pen senses pressure",
        ),
        (
            "force",
            device.force != usual.force && device.is_hid(),
            "take it out: this device gives no force",
        ),
        (
            "max_force_n",
            device.max_force_n != usual.max_force_n && device.is_hid(),
            "take it out: this device gives no force",
        ),
        (
            "paint_drag",
            device.paint_drag != usual.paint_drag && device.is_hid(),
            "take it out: this device gives no force",
        ),
        (
            "driven_by",
            !device.driven_by.is_empty() && device.is_hid(),
            "take it out: this device gives no force",
        ),
        (
            "relief",
            device.relief != usual.relief && device.is_hid(),
            "take it out: this device gives no force",
        ),
    ]
}

/// Rejects the relative path of a library: the system would look for it elsewhere.
fn check_library(device: &DeviceSection) -> Result<(), Wrong> {
    if let Some(library) = &device.library
        && !library.is_absolute()
        && library.file_name() != Some(library.as_os_str())
    {
        return Err(Wrong {
            what: format!("the path of the library of '{}' is relative", device.name),
            key: "library",
            value: String::new(),
            help: "give the whole path from the root, or the name alone, which the system finds"
                .into(),
        });
    }
    Ok(())
}

/// Rejects a clutch of a device that lets go of the desk by itself.
fn check_clutch(device: &DeviceSection) -> Result<(), Wrong> {
    let mut actions = device.switches.iter().flatten();
    if device.is_hid() && actions.any(|action| action == "clutch") {
        let help = "choose another action: lifting a pen, or letting go of a 6-DOF mouse, is a clutch already";
        return Err(Wrong {
            what: format!(
                "the switch 'clutch' of '{}' does nothing: its driver is {}",
                device.name, device.driver
            ),
            key: "switches",
            value: "clutch".into(),
            help: help.into(),
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::config::{DEFAULT, RigConfig};

    #[test]
    fn what_the_driver_would_ignore_is_refused_with_what_to_do() {
        let section = |driver: &str, line: &str| {
            let text = DEFAULT.replace("driver = \"simulated\"", &format!("driver = \"{driver}\""));
            text.replace("max_force_n = 3.0", &format!("{line}\nmax_force_n = 3.0"))
        };
        for (line, fits, others) in [
            ("hand = \"a.mcap\"", "simulated", ["pen", "polhem"]),
            (
                "library = \"libHD.so\"",
                "openhaptics",
                ["simulated", "inverse3"],
            ),
            ("replay = \"a.hid\"", "spacemouse", ["simulated", "polhem"]),
            (
                "pressure_curve = [[0, 0], [0.5, 0.3], [1, 1]]",
                "pen",
                ["polhem", "spacemouse"],
            ),
            (
                "switches = [\"undo\", \"clutch\"]",
                "polhem",
                ["pen", "spacemouse"],
            ),
        ] {
            RigConfig::parse(&section(fits, line), "rig.toml").expect("it has an effect");
            for driver in others {
                let refused = RigConfig::parse(&section(driver, line), "rig.toml").expect_err(line);
                let text = refused.to_string();
                assert!(
                    text.contains(driver) && text.contains("rig.toml:37"),
                    "{text}"
                );
                assert!(refused.help.is_some(), "{text}");
            }
        }
    }

    #[test]
    fn a_library_has_a_whole_path_or_a_name_alone() {
        let section = |library: &str| {
            let text = DEFAULT.replace("driver = \"simulated\"", "driver = \"openhaptics\"");
            let line = format!("library = \"{library}\"\nmax_force_n = 3.0");
            RigConfig::parse(&text.replace("max_force_n = 3.0", &line), "rig.toml")
        };
        for library in ["libHD.so.3.4", "/opt/OpenHaptics/lib/libHD.so"] {
            section(library).expect(library);
        }
        for library in ["vendor/libHD.so", "./libHD.so", "../libHD.so", "libHD.so/"] {
            let refused = section(library).expect_err(library).to_string();
            assert!(refused.contains("rig.toml:37"), "{refused}");
        }
    }

    #[test]
    fn an_address_and_forces_are_refused_where_there_are_none() {
        for (driver, from, to, line) in [
            (
                "simulated",
                "max_force_n = 3.0",
                "max_force_n = 3.0\naddress = \"1:2\"",
                38,
            ),
            ("pen", "max_force_n = 3.0", "max_force_n = 2.0", 37),
            ("pen", "max_force_n = 3.0", "paint_drag = 2.0", 37),
            ("pen", "max_force_n = 3.0", "relief = 0.5", 37),
            ("spacemouse", "force = \"linear\"", "force = \"local\"", 38),
        ] {
            let text = DEFAULT.replace("driver = \"simulated\"", &format!("driver = \"{driver}\""));
            let wrong = text.replace(from, to);
            let refused = RigConfig::parse(&wrong, "rig.toml")
                .expect_err(to)
                .to_string();
            assert!(refused.contains(&format!("rig.toml:{line}")), "{refused}");
        }
    }
}
