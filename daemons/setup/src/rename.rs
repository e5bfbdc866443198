//! Another name for a device, in the user's file and in the running rig.

use maulstick_rig::config::DeviceSection;

use crate::error::{SetupError, Task};
use crate::running::{Devices, Running, is_same, unless_undone};
use crate::user_file::UserFile;

/// Renames a device.
///
/// # Errors
/// A [`SetupError`] where the user has no such device, the name is taken or invalid, or the rig refuses it; all is as it was then.
pub fn rename(device: &str, name: &str, rig: &str) -> Result<(), SetupError> {
    let mut file = UserFile::read()?;
    let mut rig = Running::open(rig)?;
    let in_rig = rig.all()?;
    let running = in_rig.iter().find(|own| own.name == device);
    let own = file
        .device(device, &in_rig)
        .map_err(|fault| match running {
            Some(_) => SetupError::OfTheRig {
                device: device.to_owned(),
                task: Task::Rename,
            },
            None => fault,
        })?;
    let is_own = is_same(own, running).is_ok();
    file.check_free(name, &in_rig)?;
    file.rename(device, name)?;
    if let Some(running) = running.filter(|_| is_own)
        && let Err(fault) = replace(&mut rig, running, name)
    {
        return Err(unless_undone(device, fault, file.rename(name, device)));
    }
    Ok(())
}

/// Replaces a device by the same one called `name`; where that fails it is put back.
fn replace(rig: &mut impl Devices, before: &DeviceSection, name: &str) -> Result<(), SetupError> {
    let renamed = DeviceSection {
        name: name.to_owned(),
        ..before.clone()
    };
    let moved = rig
        .remove(&before.name)
        .and_then(|_| rig.keep_force(before, name))
        .and_then(|()| rig.put(&renamed));
    let Err(fault) = moved else {
        return Ok(());
    };
    let is_gone = |devices: Vec<DeviceSection>| devices.iter().all(|own| own.name != before.name);
    let back = if rig.all().is_ok_and(is_gone) {
        rig.put(before).map(drop)
    } else {
        Ok(())
    };
    Err(unless_undone(&before.name, fault, back))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::running::tests::{Fake, refusal};

    fn arm(name: &str) -> DeviceSection {
        DeviceSection {
            priority: 7,
            ..DeviceSection::new(name, "polhem", "second")
        }
    }

    /// The devices of the rig after an arm is renamed to `cup`, and the result.
    fn renamed(refused: &'static [&'static str]) -> (Vec<DeviceSection>, Result<(), SetupError>) {
        let mut rig = Fake {
            devices: vec![arm("arm")],
            refused,
            forces: Vec::new(),
        };
        let done = replace(&mut rig, &arm("arm"), "cup");
        let is_kept = done.is_err() || rig.forces == [("arm".to_owned(), "cup".to_owned())];
        assert!(is_kept, "{:?}", rig.forces);
        (rig.devices, done)
    }

    #[test]
    fn a_refusal_of_the_rig_leaves_it_with_the_device_as_it_was() {
        assert_eq!(renamed(&[]), (vec![arm("cup")], Ok(())));
        for refused in [&["cup"], &["remove"]] {
            let failed = Err(refusal(refused[0]));
            assert_eq!(renamed(refused), (vec![arm("arm")], failed));
        }
        let lost = SetupError::NotTakenBack {
            device: "arm".to_owned(),
            what: Box::new(refusal("cup")),
            why: Box::new(refusal("arm")),
        };
        assert_eq!(renamed(&["cup", "arm"]), (vec![], Err(lost)));
    }
}
