//! The file of a user's devices, changed without touching what else is written in it, and the running rig told of it.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use maulstick_rig::config::DeviceSection;
use maulstick_rig::files::{Kind, write_whole};
use maulstick_rig::{RigConfig, UserError, user_devices};
use maulstick_types::command::RigCommand;
use maulstick_types::values::{DeviceName, DeviceToml};
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table};

use crate::commands::session::{Session, Target};

/// The user's devices, read for a change.
#[derive(Debug)]
pub(super) struct UserFile {
    path: PathBuf,
    text: DocumentMut,
    /// The devices in it.
    pub(super) devices: Vec<DeviceSection>,
}

impl UserFile {
    /// Reads it; it need not be there.
    ///
    /// # Errors
    /// A [`UserError`] where it cannot be read, with the line.
    pub(super) fn read() -> Result<Self, UserError> {
        let path = user_devices::path()?;
        let devices = user_devices::read(&path)?;
        let text = match path.exists() {
            true => {
                std::fs::read_to_string(&path).map_err(|error| UserError::reading(&path, &error))?
            }
            false => String::new(),
        };
        let text = text
            .parse()
            .map_err(|error| UserError::usage(format!("{error}")).at(path.display().to_string()))?;
        Ok(Self {
            path,
            text,
            devices,
        })
    }

    /// Its path.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// The device called `name`.
    ///
    /// # Errors
    /// A [`UserError`] with the nearest name where there is none.
    pub(super) fn device(&self, name: &str) -> Result<&DeviceSection, UserError> {
        let found = self.devices.iter().find(|device| device.name == name);
        found.ok_or_else(|| {
            let names = self.devices.iter().map(|device| device.name.as_str());
            let what = format!("you have no device called '{name}'");
            UserError::unknown(what, name, names).at(self.path.display().to_string())
        })
    }

    /// Puts a device into the file: what it had and has still, comments among it, stays as it was.
    ///
    /// # Errors
    /// A [`UserError`] where the device is wrong, or the file cannot be written.
    pub(super) fn put(&mut self, device: &DeviceSection) -> Result<(), UserError> {
        let (wanted, usual) = (
            table(device)?,
            table(&DeviceSection::new(
                &device.name,
                &device.driver,
                &device.brush,
            ))?,
        );
        let tables = self.tables()?;
        let is_meant = |table: &Table| named(table) == Some(&device.name);
        let known = tables.iter().position(is_meant);
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
        for (key, value) in &wanted {
            let text = |item: &Item| item.to_string().trim().to_owned();
            let is_usual = usual.get(key).map(text) == Some(text(value));
            let is_named = ["name", "driver", "brush"].contains(&key);
            match own.get(key) {
                Some(before) if text(before) == text(value) => {}
                None if is_usual && !is_named => {}
                _ => {
                    own.insert(key, value.clone());
                }
            }
        }
        own.retain(|key, _| wanted.contains_key(key));
        self.write()
    }

    /// Takes a device out of the file.
    ///
    /// # Errors
    /// A [`UserError`] where the file cannot be written.
    pub(super) fn remove(&mut self, name: &str) -> Result<(), UserError> {
        self.tables()?.retain(|table| named(table) != Some(name));
        self.write()
    }

    fn tables(&mut self) -> Result<&mut ArrayOfTables, UserError> {
        let place = self.path.display().to_string();
        let item = self
            .text
            .entry("device")
            .or_insert_with(|| Item::ArrayOfTables(ArrayOfTables::new()));
        item.as_array_of_tables_mut().ok_or_else(|| {
            UserError::usage("the devices are not sections [[device]]")
                .at(place)
                .help("write each as a section of its own")
        })
    }

    fn write(&mut self) -> Result<(), UserError> {
        let text = self.text.to_string();
        let place = self.path.display().to_string();
        self.devices = RigConfig::parse(&text, &place)?.device;
        let failed = |error| UserError::writing(&self.path, &error);
        if let Some(folder) = self.path.parent() {
            std::fs::create_dir_all(folder).map_err(failed)?;
        }
        write_whole(&self.path, Kind::Own, |file| {
            file.write_all(text.as_bytes())
        })
        .map_err(failed)
    }
}

fn named(table: &Table) -> Option<&str> {
    table.get("name").and_then(Item::as_str)
}

/// A section as TOML.
fn table(device: &DeviceSection) -> Result<Table, UserError> {
    let written: DocumentMut = toml_text(device)?
        .parse()
        .map_err(|error| UserError::failure(format!("{error}")))?;
    Ok(written.as_table().clone())
}

fn toml_text(device: &DeviceSection) -> Result<String, UserError> {
    toml::to_string(device).map_err(|error| UserError::failure(error.to_string()))
}

/// Starts a device in the rig of `target`, if that runs; what the rig says.
///
/// # Errors
/// A [`UserError`] with the rig's refusal.
pub(super) fn put_in_rig(
    target: &Target,
    device: &DeviceSection,
) -> Result<Option<String>, UserError> {
    let Ok(session) = Session::open(target) else {
        return Ok(None);
    };
    let toml = DeviceToml::new(toml_text(device)?)?;
    session.send(RigCommand::PutDevice { toml }).map(Some)
}

/// Ends a device in the rig of `target`, if that runs and has it; true if so.
///
/// # Errors
/// A [`UserError`] with the rig's refusal.
pub(super) fn remove_from_rig(target: &Target, name: &str) -> Result<bool, UserError> {
    let Ok(session) = Session::open(target) else {
        return Ok(false);
    };
    let has = session.config()?.device.iter().any(|own| own.name == name);
    if has {
        let name = DeviceName::new(name)?;
        session.send(RigCommand::RemoveDevice { name })?;
    }
    Ok(has)
}
