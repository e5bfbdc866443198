//! A device that paints no more.

use std::path::PathBuf;

use crate::error::SetupError;
use crate::running::{Devices, Running, unless_undone};
use crate::user_file::UserFile;

/// Where a device was removed from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Removed {
    /// The file of this user's devices, if it was in there.
    pub file: Option<PathBuf>,
    /// True if it was in the rig.
    pub was_in_rig: bool,
}

/// Removes a device from those of this user, and from the rig of this name if it runs.
///
/// # Errors
/// A [`SetupError`] where neither the user nor the rig has it, or where it stays; all is as it was then.
pub fn remove(name: &str, rig: &str) -> Result<Removed, SetupError> {
    remove_from_both(&mut Running::open(rig)?, &mut UserFile::read()?, name)
}

fn remove_from_both(
    rig: &mut impl Devices,
    file: &mut UserFile,
    name: &str,
) -> Result<Removed, SetupError> {
    let in_rig = rig.all()?;
    let running = in_rig.iter().find(|own| own.name == name);
    let own = file.device(name, &in_rig).map(drop);
    let is_own = own.is_ok();
    let was_in_rig = rig.remove(name)?;
    if !was_in_rig {
        own?;
    }
    if is_own && let Err(fault) = file.remove(name) {
        let undone = running.map_or(Ok(()), |running| rig.put(running).map(drop));
        return Err(unless_undone(name, fault, undone));
    }
    Ok(Removed {
        file: is_own.then(|| file.path().to_owned()),
        was_in_rig,
    })
}

#[cfg(test)]
mod tests {
    use maulstick_rig::config::DeviceSection;

    use super::*;
    use crate::running::tests::{Fake, refusal};

    #[test]
    fn a_device_leaves_the_rig_and_the_file_or_neither() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("devices.toml");
        let arm = DeviceSection::new("arm", "polhem", "main");
        let mut file = UserFile::at(path.clone()).expect("none yet");
        file.put(&arm).expect("written");
        let text = std::fs::read(&path).expect("there");
        let rig = |refused| Fake {
            devices: vec![arm.clone()],
            refused,
            ..Fake::default()
        };
        let mut refusing = rig(&["remove"]);
        let failed = remove_from_both(&mut refusing, &mut file, "arm");
        assert_eq!(failed, Err(refusal("remove")));
        assert_eq!(std::fs::read(&path).expect("there"), text);
        // A folder in its place cannot be written.
        std::fs::remove_file(&path).expect("removed");
        std::fs::create_dir(&path).expect("a folder");
        let mut running = rig(&[]);
        assert!(remove_from_both(&mut running, &mut file, "arm").is_err());
        assert_eq!(running.devices, [arm]);
    }
}
