//! Devices of a rig that may run.

use std::time::Duration;

use maulstick_bus::{BusError, RigFolder};
use maulstick_client::connection::Client;
use maulstick_haptic::force_state_file::ForceStateFile;
use maulstick_rig::config::DeviceSection;
use maulstick_rig::{RigConfig, UserError};
use maulstick_types::command::{Detail, RigCommand};
use maulstick_types::values::{DeviceName, DeviceToml};

use crate::error::SetupError;
use crate::user_file::{UserFile, toml_text};

/// Longest wait until the rig has started a device.
const PATIENCE: Duration = Duration::from_secs(10);

/// A rig whose devices come and go.
pub(crate) trait Devices {
    /// Its devices; none of a rig that does not run.
    fn all(&self) -> Result<Vec<DeviceSection>, SetupError>;
    /// Starts a device, in the place of one of its name; the answer of a rig that runs.
    fn put(&mut self, device: &DeviceSection) -> Result<Option<Detail>, SetupError>;
    /// Ends a device; true if the rig had it.
    fn remove(&mut self, name: &str) -> Result<bool, SetupError>;
    /// Gives the force settings and the latched fault of a device to one called `name`: a force that is off stays off.
    fn keep_force(&mut self, from: &DeviceSection, name: &str) -> Result<(), SetupError>;
}

/// A rig by its name, and a connection to it if it runs.
pub(crate) struct Running<'a> {
    rig: &'a str,
    client: Option<Client>,
}

impl<'a> Running<'a> {
    /// Connects to the rig called `rig`, if it runs.
    ///
    /// # Errors
    /// [`SetupError::Connect`].
    pub(crate) fn open(rig: &'a str) -> Result<Self, SetupError> {
        let client = if_running(Client::open(rig))?;
        Ok(Self { rig, client })
    }

    /// Its settings, if it runs.
    pub(crate) fn config(&self) -> Result<Option<RigConfig>, SetupError> {
        Ok(self.client.as_ref().map(Client::config).transpose()?)
    }
}

impl Devices for Running<'_> {
    fn all(&self) -> Result<Vec<DeviceSection>, SetupError> {
        Ok(self.config()?.map_or_else(Vec::new, |config| config.device))
    }

    fn put(&mut self, device: &DeviceSection) -> Result<Option<Detail>, SetupError> {
        let Some(client) = &self.client else {
            return Ok(None);
        };
        let toml = DeviceToml::new(toml_text(device)?).map_err(UserError::from)?;
        let done = client.carry_out(RigCommand::PutDevice { toml }, PATIENCE)?;
        Ok(Some(done.detail))
    }

    fn remove(&mut self, name: &str) -> Result<bool, SetupError> {
        let has = self.all()?.iter().any(|own| own.name == name);
        if let Some(client) = self.client.as_ref().filter(|_| has) {
            let name = DeviceName::new(name).map_err(UserError::from)?;
            client.send(RigCommand::RemoveDevice { name })?;
        }
        Ok(has)
    }

    fn keep_force(&mut self, from: &DeviceSection, name: &str) -> Result<(), SetupError> {
        if from.is_hid() {
            return Ok(());
        }
        let (folder, rig) = RigFolder::join(self.rig).map_err(SetupError::Connect)?;
        let file = |name| ForceStateFile::of(folder.path(), name, rig.clock_offset_ns);
        let written = file(name).write(&file(&from.name).read());
        Ok(written.map_err(|error| UserError::writing(folder.path(), &error))?)
    }
}

/// The connection, or `None` where no rig runs: one that runs and cannot be joined is an error.
fn if_running<T>(opened: Result<T, BusError>) -> Result<Option<T>, SetupError> {
    match opened {
        Ok(client) => Ok(Some(client)),
        Err(BusError::NoRig(_)) => Ok(None),
        Err(error) => Err(SetupError::Connect(error)),
    }
}

/// Puts a device into the rig and into the file, or into neither; the rig's answer.
pub(crate) fn put_in_both(
    rig: &mut impl Devices,
    file: &mut UserFile,
    device: &DeviceSection,
) -> Result<Option<Detail>, SetupError> {
    file.change(device)?;
    let before = rig.all()?.into_iter().find(|own| own.name == device.name);
    let answer = rig.put(device)?;
    let Err(fault) = file.write() else {
        return Ok(answer);
    };
    let undone = match &before {
        Some(before) => rig.put(before).map(drop),
        None => rig.remove(&device.name).map(drop),
    };
    Err(unless_undone(&device.name, fault, undone))
}

/// The failure of a change, with that of taking it back.
pub(crate) fn unless_undone(
    device: &str,
    what: SetupError,
    undone: Result<(), SetupError>,
) -> SetupError {
    match undone {
        Ok(()) => what,
        Err(why) => SetupError::NotTakenBack {
            device: device.to_owned(),
            what: Box::new(what),
            why: Box::new(why),
        },
    }
}

/// Checks that the device of that name in the rig is the same as the user's.
///
/// # Errors
/// [`SetupError::Other`].
pub(crate) fn is_same(
    own: &DeviceSection,
    running: Option<&DeviceSection>,
) -> Result<(), SetupError> {
    match running {
        Some(other) if (&other.driver, &other.address) != (&own.driver, &own.address) => {
            Err(SetupError::Other(own.name.clone()))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A rig in memory that refuses some devices by their names, or "remove" for all.
    #[derive(Default)]
    pub(crate) struct Fake {
        pub devices: Vec<DeviceSection>,
        pub refused: &'static [&'static str],
        pub forces: Vec<(String, String)>,
    }

    impl Devices for Fake {
        fn all(&self) -> Result<Vec<DeviceSection>, SetupError> {
            Ok(self.devices.clone())
        }

        fn put(&mut self, device: &DeviceSection) -> Result<Option<Detail>, SetupError> {
            if self.refused.contains(&device.name.as_str()) {
                return Err(refusal(&device.name));
            }
            self.devices.retain(|own| own.name != device.name);
            self.devices.push(device.clone());
            Ok(None)
        }

        fn remove(&mut self, name: &str) -> Result<bool, SetupError> {
            if self.refused.contains(&"remove") {
                return Err(refusal("remove"));
            }
            let before = self.devices.len();
            self.devices.retain(|own| own.name != name);
            Ok(self.devices.len() < before)
        }

        fn keep_force(&mut self, from: &DeviceSection, name: &str) -> Result<(), SetupError> {
            self.forces.push((from.name.clone(), name.to_owned()));
            Ok(())
        }
    }

    pub(crate) fn refusal(name: &str) -> SetupError {
        UserError::usage(format!("no room for {name}")).into()
    }

    #[test]
    fn only_a_rig_that_does_not_run_is_none() {
        let opened = |opened| if_running::<()>(opened);
        assert_eq!(opened(Ok(())), Ok(Some(())));
        assert_eq!(opened(Err(BusError::NoRig("studio".into()))), Ok(None));
        let silent = BusError::Silent {
            at: "unix/x".into(),
            limit_s: 5,
        };
        let failed = opened(Err(silent.clone()));
        assert_eq!(failed, Err(SetupError::Connect(silent)));
    }

    #[test]
    fn a_device_is_in_the_rig_and_in_the_file_or_in_neither() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("devices.toml");
        let arm = DeviceSection::new("arm", "polhem", "main");
        let mut rig = Fake {
            refused: &["arm"],
            ..Fake::default()
        };
        let mut file = UserFile::at(path.clone()).expect("none yet");
        assert_eq!(put_in_both(&mut rig, &mut file, &arm), Err(refusal("arm")));
        assert!(!path.exists(), "the rig has refused it");
        // A folder in its place cannot be written.
        std::fs::create_dir(&path).expect("a folder");
        let higher = DeviceSection {
            priority: 3,
            ..arm.clone()
        };
        for before in [vec![], vec![arm.clone()]] {
            let mut rig = Fake {
                devices: before.clone(),
                ..Fake::default()
            };
            let failed = put_in_both(&mut rig, &mut file, &higher);
            assert!(matches!(failed, Err(SetupError::Fault(_))), "{failed:?}");
            assert_eq!(rig.devices, before);
        }
        std::fs::remove_dir(&path).expect("removed");
        let mut rig = Fake::default();
        put_in_both(&mut rig, &mut file, &higher).expect("both take it");
        let kept = UserFile::at(path).expect("written");
        assert_eq!(
            (kept.devices, rig.devices),
            (vec![higher.clone()], vec![higher])
        );
    }
}
