//! Another name for a device, in the user's file and in the running rig.

use maulstick_bus::RigFolder;
use maulstick_haptic::force_state_file::ForceStateFile;
use maulstick_rig::UserError;
use maulstick_rig::config::DeviceSection;

use crate::running::{in_rig, is_same, put_in_rig, remove_from_rig};
use crate::user_file::UserFile;

/// Renames a device.
///
/// # Errors
/// A [`UserError`] where the user has no such device, the name is taken or invalid, or the rig refuses it; all is as it was then.
pub fn rename(device: &str, name: &str, rig: &str) -> Result<(), UserError> {
    let mut file = UserFile::read()?;
    let in_rig = in_rig(rig)?;
    let running = in_rig.iter().find(|own| own.name == device);
    let own = file
        .device(device, &in_rig)
        .map_err(|fault| match running {
            Some(_) => UserError::usage(format!(
                "'{device}' is a device of the rig's own settings"
            ))
            .help(
                "change its name in the rig.toml that the rig was started with, and start it again",
            ),
            None => fault,
        })?;
    let is_own = is_same(own, running).is_ok();
    file.check_free(name, &in_rig)?;
    file.rename(device, name)?;
    if let Some(running) = running.filter(|_| is_own)
        && let Err(fault) = replace(&mut Running(rig), running, name)
    {
        file.rename(name, device)?;
        return Err(fault);
    }
    Ok(())
}

/// A rig whose devices come and go.
trait Devices {
    fn has(&self, name: &str) -> Result<bool, UserError>;
    fn remove(&mut self, name: &str) -> Result<(), UserError>;
    /// Gives the force settings and the latched fault of a device to one called `name`: a force that is off stays off.
    fn keep_force(&mut self, from: &DeviceSection, name: &str) -> Result<(), UserError>;
    fn put(&mut self, device: &DeviceSection) -> Result<(), UserError>;
}

/// The running rig.
struct Running<'a>(&'a str);

impl Devices for Running<'_> {
    fn has(&self, name: &str) -> Result<bool, UserError> {
        Ok(in_rig(self.0)?.iter().any(|own| own.name == name))
    }

    fn remove(&mut self, name: &str) -> Result<(), UserError> {
        remove_from_rig(self.0, name).map(drop)
    }

    fn keep_force(&mut self, from: &DeviceSection, name: &str) -> Result<(), UserError> {
        if from.is_hid() {
            return Ok(());
        }
        let (folder, rig) = RigFolder::join(self.0)?;
        let file = |name| ForceStateFile::of(folder.path(), name, rig.clock_offset_ns);
        let written = file(name).write(&file(&from.name).read());
        written.map_err(|error| UserError::writing(folder.path(), &error))
    }

    fn put(&mut self, device: &DeviceSection) -> Result<(), UserError> {
        put_in_rig(self.0, device).map(drop)
    }
}

/// Replaces a device by the same one called `name`; where that fails it is put back.
fn replace(rig: &mut impl Devices, before: &DeviceSection, name: &str) -> Result<(), UserError> {
    let renamed = DeviceSection {
        name: name.to_owned(),
        ..before.clone()
    };
    let moved = rig
        .remove(&before.name)
        .and_then(|()| rig.keep_force(before, name))
        .and_then(|()| rig.put(&renamed));
    let Err(fault) = moved else {
        return Ok(());
    };
    if matches!(rig.has(&before.name), Ok(false))
        && let Err(lost) = rig.put(before)
    {
        let (own, what, why) = (&before.name, fault.what, lost.what);
        return Err(UserError::failure(format!(
            "{what}; the rig does not take '{own}' back: {why}"
        ))
        .help(format!(
            "it is kept: `maulstick device use {own}` puts it back"
        )));
    }
    Err(fault)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rig in memory that refuses devices of some names.
    struct Fake {
        devices: Vec<DeviceSection>,
        refused: &'static [&'static str],
        forces: Vec<(String, String)>,
    }

    impl Devices for Fake {
        fn has(&self, name: &str) -> Result<bool, UserError> {
            Ok(self.devices.iter().any(|own| own.name == name))
        }

        fn remove(&mut self, name: &str) -> Result<(), UserError> {
            if self.refused.contains(&"remove") {
                return Err(UserError::usage("a take is played"));
            }
            self.devices.retain(|own| own.name != name);
            Ok(())
        }

        fn keep_force(&mut self, from: &DeviceSection, name: &str) -> Result<(), UserError> {
            self.forces.push((from.name.clone(), name.to_owned()));
            Ok(())
        }

        fn put(&mut self, device: &DeviceSection) -> Result<(), UserError> {
            if self.refused.contains(&device.name.as_str()) {
                return Err(UserError::usage(format!("no room for {}", device.name)));
            }
            self.devices.push(device.clone());
            Ok(())
        }
    }

    /// The devices of the rig after an arm is renamed to `cup`, and what is said.
    fn renamed(refused: &'static [&'static str]) -> (Vec<DeviceSection>, Result<(), String>) {
        let arm = DeviceSection {
            priority: 7,
            ..DeviceSection::new("arm", "polhem", "second")
        };
        let mut rig = Fake {
            devices: vec![arm.clone()],
            refused,
            forces: Vec::new(),
        };
        let said = replace(&mut rig, &arm, "cup").map_err(|fault| fault.to_string());
        let is_kept = said.is_err() || rig.forces == [("arm".to_owned(), "cup".to_owned())];
        assert!(is_kept, "{:?}", rig.forces);
        (rig.devices, said)
    }

    #[test]
    fn what_the_rig_refuses_leaves_it_with_the_device_as_it_was() {
        let arm = |name: &str| DeviceSection {
            priority: 7,
            ..DeviceSection::new(name, "polhem", "second")
        };
        assert_eq!(renamed(&[]), (vec![arm("cup")], Ok(())));
        for (refused, what) in [
            (&["cup"], "no room for cup"),
            (&["remove"], "a take is played"),
        ] {
            let (devices, said) = renamed(refused);
            assert_eq!(devices, [arm("arm")]);
            let said = said.expect_err(what);
            assert!(said.contains(what) && !said.contains("back"), "{said}");
        }
        let (devices, said) = renamed(&["cup", "arm"]);
        assert!(devices.is_empty());
        let said = said.expect_err("both are refused");
        for word in ["no room for cup", "no room for arm", "device use arm"] {
            assert!(said.contains(word), "{said}");
        }
    }
}
