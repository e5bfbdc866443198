//! The file of a user's devices, changed without touching what else is written in it.

use std::collections::BTreeSet;
use std::fs::DirBuilder;
use std::io::{ErrorKind, Write as _};
use std::os::unix::fs::DirBuilderExt as _;
use std::path::{Path, PathBuf};

use maulstick_rig::config::{BrushSection, DeviceSection};
use maulstick_rig::files::{Kind, write_whole};
use maulstick_rig::{RigConfig, UserError, user_devices};
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, TomlError, Value};

use crate::error::SetupError;

/// The user's devices, read for a change.
#[derive(Debug)]
pub struct UserFile {
    path: PathBuf,
    text: DocumentMut,
    /// The devices in it.
    pub devices: Vec<DeviceSection>,
}

impl UserFile {
    /// Reads it; it need not be there.
    ///
    /// # Errors
    /// A [`SetupError`] where it cannot be read, with the line.
    pub fn read() -> Result<Self, SetupError> {
        Self::at(user_devices::path()?)
    }

    pub(crate) fn at(path: PathBuf) -> Result<Self, SetupError> {
        let text = match std::fs::read_to_string(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => String::new(),
            Err(error) => return Err(UserError::reading(&path, &error).into()),
        };
        Self::parse(path, &text)
    }

    fn parse(path: PathBuf, text: &str) -> Result<Self, SetupError> {
        let devices = user_devices::parse(text, &path)?;
        let text = text.parse().map_err(|error: TomlError| {
            UserError::usage(error.to_string()).at(path.display().to_string())
        })?;
        Ok(Self {
            path,
            text,
            devices,
        })
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The user's device called `name`; `in_rig` are those of the rig, which may have been meant.
    ///
    /// # Errors
    /// [`SetupError::NoDevice`].
    pub fn device(
        &self,
        name: &str,
        in_rig: &[DeviceSection],
    ) -> Result<&DeviceSection, SetupError> {
        let found = self.devices.iter().find(|device| device.name == name);
        found.ok_or_else(|| unknown(name, &self.devices, in_rig))
    }

    /// Checks that neither the user nor the rig, whose devices are `in_rig`, has a device called `name`.
    ///
    /// # Errors
    /// [`SetupError::Taken`], [`SetupError::TakenInRig`].
    pub fn check_free(&self, name: &str, in_rig: &[DeviceSection]) -> Result<(), SetupError> {
        let is_it = |device: &DeviceSection| device.name == name;
        if self.devices.iter().any(is_it) {
            return Err(SetupError::Taken {
                name: name.to_owned(),
                file: self.path.clone(),
            });
        }
        if in_rig.iter().any(is_it) {
            return Err(SetupError::TakenInRig(name.to_owned()));
        }
        Ok(())
    }

    /// Puts a device into the file: what it had and has still, comments among it, stays as it was.
    ///
    /// # Errors
    /// A [`SetupError`] where the device is wrong, or the file cannot be written.
    pub fn put(&mut self, device: &DeviceSection) -> Result<(), SetupError> {
        self.change(device)?;
        self.write()
    }

    /// As [`Self::put`], without writing the file.
    pub(crate) fn change(&mut self, device: &DeviceSection) -> Result<(), SetupError> {
        check(device)?;
        let usual = DeviceSection::new(&device.name, &device.driver, &device.brush);
        let (wanted, usual) = (table(device)?, table(&usual)?);
        let tables = self.tables()?;
        let known = tables
            .iter()
            .position(|table| name_of(table) == Some(&device.name));
        let place = match known {
            Some(place) => place,
            None => {
                tables.push(Table::new());
                tables.len() - 1
            }
        };
        let Some(own) = tables.get_mut(place) else {
            return Ok(());
        };
        for (key, item) in &wanted {
            let Some(value) = item.as_value() else {
                continue;
            };
            let is_usual = usual.get(key).and_then(Item::as_value).map(bare) == Some(bare(value));
            match own.get_mut(key).and_then(Item::as_value_mut) {
                Some(before) if bare(before) == bare(value) => {}
                Some(before) => set(before, value.clone()),
                None if is_usual && !["name", "driver", "brush"].contains(&key) => {}
                None => {
                    own.insert(key, item.clone());
                }
            }
        }
        own.retain(|key, _| wanted.contains_key(key));
        Ok(())
    }

    /// Gives a device another name; all else stays as it was.
    ///
    /// # Errors
    /// A [`SetupError`] where there is no such device, the name is invalid, or the file cannot be written.
    pub fn rename(&mut self, device: &str, name: &str) -> Result<(), SetupError> {
        self.change_name(device, name)?;
        self.write()
    }

    fn change_name(&mut self, device: &str, name: &str) -> Result<(), SetupError> {
        check(&DeviceSection {
            name: name.to_owned(),
            ..self.device(device, &[])?.clone()
        })?;
        let mut tables = self.tables()?.iter_mut();
        let own = tables.find(|table| name_of(table) == Some(device));
        let before = own.and_then(|own| own.get_mut("name")?.as_value_mut());
        if let Some(before) = before {
            set(before, name.into());
        }
        Ok(())
    }

    /// Takes a device out of the file.
    ///
    /// # Errors
    /// A [`SetupError`] where the file cannot be written.
    pub fn remove(&mut self, name: &str) -> Result<(), SetupError> {
        self.tables()?.retain(|table| name_of(table) != Some(name));
        self.write()
    }

    fn tables(&mut self) -> Result<&mut ArrayOfTables, SetupError> {
        let item = self
            .text
            .entry("device")
            .or_insert_with(|| Item::ArrayOfTables(ArrayOfTables::new()));
        let tables = item.as_array_of_tables_mut();
        tables.ok_or_else(|| SetupError::NoSections(self.path.clone()))
    }

    pub(crate) fn write(&mut self) -> Result<(), SetupError> {
        let text = self.text.to_string();
        self.devices = user_devices::parse(&text, &self.path)?;
        let failed = |error| UserError::writing(&self.path, &error);
        if let Some(folder) = self.path.parent() {
            let mut folders = DirBuilder::new();
            folders.recursive(true).mode(0o700);
            folders.create(folder).map_err(failed)?;
        }
        write_whole(&self.path, Kind::Own, |file| {
            file.write_all(text.as_bytes())
        })
        .map_err(failed)?;
        Ok(())
    }
}

/// Checks a device in a rig that has its brush.
fn check(device: &DeviceSection) -> Result<(), UserError> {
    let usual = RigConfig::default();
    let brush = usual.brush.iter().map(|brush| BrushSection {
        name: device.brush.clone(),
        ..brush.clone()
    });
    let rig = RigConfig {
        brush: brush.collect(),
        device: Vec::new(),
        ..usual.clone()
    };
    rig.with_device(device.clone()).map(drop)
}

/// A value without the blanks and comments beside it, and whichever quotes it has.
fn bare(value: &Value) -> String {
    match value.as_str() {
        Some(text) => text.to_owned(),
        None => value.clone().decorated("", "").to_string(),
    }
}

/// Sets a value; blanks and comments beside it stay.
fn set(before: &mut Value, value: Value) {
    let decor = before.decor().clone();
    *before = value;
    *before.decor_mut() = decor;
}

fn name_of(table: &Table) -> Option<&str> {
    table.get("name").and_then(Item::as_str)
}

/// A section as TOML.
fn table(device: &DeviceSection) -> Result<Table, SetupError> {
    let written = toml_text(device)?.parse::<DocumentMut>();
    let written = written.map_err(|error| UserError::failure(error.to_string()))?;
    Ok(written.as_table().clone())
}

pub(crate) fn toml_text(device: &DeviceSection) -> Result<String, UserError> {
    toml::to_string(device).map_err(|error| UserError::failure(error.to_string()))
}

/// The error that neither the user nor the rig has a device called `name`.
pub(crate) fn unknown(name: &str, own: &[DeviceSection], in_rig: &[DeviceSection]) -> SetupError {
    let all = own.iter().chain(in_rig);
    let known: BTreeSet<String> = all.map(|device| device.name.clone()).collect();
    SetupError::NoDevice {
        name: name.to_owned(),
        known: known.into_iter().collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
# mine
[[device]]
# the old one
name = 'arm' # left
driver = \"polhem\"
brush = \"second\"
priority = 3 # for now

[[device]]
name = \"puck\"
driver = \"simulated\"
brush = \"main\"
";

    #[test]
    fn a_change_leaves_comments_and_all_else_as_they_were() {
        let mut file = UserFile::parse("/x/devices.toml".into(), TEXT).expect("valid");
        let arm = file.devices[0].clone();
        file.change(&arm).expect("it fits");
        assert_eq!(file.text.to_string(), TEXT, "nothing has changed");
        let used = DeviceSection {
            priority: 7,
            force: "rigid".into(),
            ..arm
        };
        file.change(&used).expect("it fits");
        let changed = TEXT.replace(
            "priority = 3 # for now\n",
            "priority = 7 # for now\nforce = \"rigid\"\n",
        );
        assert_eq!(file.text.to_string(), changed);
        let wrong = DeviceSection {
            driver: "simulted".into(),
            ..used
        };
        assert!(file.change(&wrong).is_err());
        assert_eq!(file.text.to_string(), changed, "it is as it was");
    }

    #[test]
    fn a_new_name_leaves_comments_and_order_as_they_were_and_may_be_taken_back() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("devices.toml");
        let mut file = UserFile::parse(path.clone(), TEXT).expect("valid");
        file.rename("arm", "left-arm").expect("it fits");
        let written = std::fs::read_to_string(&path).expect("written");
        let renamed = TEXT.replace("name = 'arm' # left", "name = \"left-arm\" # left");
        assert_eq!(written, renamed);
        let names: Vec<&str> = file.devices.iter().map(|own| own.name.as_str()).collect();
        assert_eq!(names, ["left-arm", "puck"]);
        file.rename("left-arm", "arm").expect("it fits");
        assert_eq!(file.text.to_string(), TEXT.replace("'arm'", "\"arm\""));
    }

    #[test]
    fn an_unknown_name_is_refused_with_the_users_and_the_rigs() {
        let own = UserFile::parse("/x/devices.toml".into(), TEXT).expect("valid");
        let in_rig = [DeviceSection::new("phantom", "simulated", "main")];
        let known = |names: &[&str]| SetupError::NoDevice {
            name: "phantm".to_owned(),
            known: names.iter().map(|name| (*name).to_owned()).collect(),
        };
        assert_eq!(
            unknown("phantm", &own.devices, &in_rig),
            known(&["arm", "phantom", "puck"])
        );
        assert_eq!(unknown("phantm", &[], &[]), known(&[]));
    }

    #[test]
    fn names_that_are_taken_or_invalid_are_refused() {
        let mut file = UserFile::parse("/x/devices.toml".into(), TEXT).expect("valid");
        let mut change = |device: &str, name: &str| {
            let fault = file.change_name(device, name).expect_err(name);
            assert_eq!(file.text.to_string(), TEXT);
            fault
        };
        assert!(matches!(change("arn", "cup"), SetupError::NoDevice { .. }));
        for name in ["my arm", "", "paint"] {
            assert!(
                matches!(change("arm", name), SetupError::Fault(_)),
                "{name}"
            );
        }
        let rigs = [DeviceSection::new("phantom", "openhaptics", "main")];
        assert_eq!(file.check_free("cup", &rigs), Ok(()));
        let taken = file.check_free("puck", &rigs);
        assert!(matches!(taken, Err(SetupError::Taken { .. })));
        let in_rig = SetupError::TakenInRig("phantom".to_owned());
        assert_eq!(file.check_free("phantom", &rigs), Err(in_rig));
    }
}
