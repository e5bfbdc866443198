//! Settings of a running rig: where its nodes read them, and the file of its painting.

use std::path::{Path, PathBuf};

use maulstick_bus::RigFolder;
use maulstick_rig::files::{Kind, is_same, write_whole};
use maulstick_rig::node_handle::CONFIG_FILE;
use maulstick_rig::{RigConfig, Sketches, UserError};

use super::sketch::{self, Leave};

/// Settings of a rig.
pub(super) struct Settings {
    pub(super) folder: RigFolder,
    pub(super) config: RigConfig,
    /// The sketches, where paintings without a file of their own are such.
    pub(super) sketches: Option<Sketches>,
}

impl Settings {
    /// The settings that the nodes read, and those before.
    fn files(&self) -> [PathBuf; 2] {
        let path = self.folder.path().join(CONFIG_FILE);
        let former = path.with_extension("before");
        [path, former]
    }

    /// Writes the settings where the nodes read them.
    pub(super) fn write(&self) -> Result<(), UserError> {
        let [path, _] = self.files();
        let text = self.config.to_toml()?;
        write_whole(&path, Kind::Own, |file| {
            std::io::Write::write_all(file, text.as_bytes())
        })
        .map_err(|error| UserError::writing(&path, &error))
    }

    /// Writes other settings; where that fails, the ones before hold.
    pub(super) fn set(&mut self, config: RigConfig) -> Result<(), UserError> {
        let before = std::mem::replace(&mut self.config, config);
        let written = self.write();
        if written.is_err() {
            self.config = before;
        }
        written
    }

    /// Writes the settings of another painting, and keeps the old file for [`Self::put_back`].
    pub(super) fn set_painting(&mut self, config: RigConfig) -> Result<(), UserError> {
        let [path, former] = self.files();
        std::fs::remove_file(&former).ok();
        if let Err(error) = std::fs::hard_link(&path, &former) {
            tracing::debug!("{}: {error}", former.display());
        }
        self.set(config)
    }

    /// Restores the settings of the previous painting. They hold for the launcher even if they cannot be written.
    pub(super) fn put_back(&mut self, before: RigConfig) -> Result<(), UserError> {
        self.config = before;
        // Renaming needs no disk space.
        let [path, former] = self.files();
        std::fs::rename(&former, &path).or_else(|_| {
            let written = self.write();
            written.inspect_err(|fault| tracing::warn!("{}: {}", path.display(), fault.what))
        })
    }

    /// Writes the settings; a fault is only reported.
    pub(super) fn write_or_warn(&self) -> bool {
        let written = self.write();
        let warn = |fault: &UserError| {
            let place = fault.place.as_deref().unwrap_or_default();
            tracing::warn!("{place}: {}", fault.what);
        };
        written.inspect_err(warn).is_ok()
    }

    /// The file of the sketch that the painting is, if it is one.
    pub(super) fn sketch(&self) -> Option<&Path> {
        let path = self.config.paint.document.as_deref()?;
        let sketches = self.sketches.as_ref()?;
        sketches.has(path).then_some(path)
    }

    /// Removes the sketch of a painting that was saved under a name, or left, if nothing is lost with it.
    pub(super) fn leave_sketch(&self, path: &Path, why: Leave) {
        if let Some(sketches) = self.sketches.as_ref().filter(|sketches| sketches.has(path)) {
            sketch::leave(sketches, path, why);
        }
    }

    /// Records the painting's new file. Its sketch is removed once restarting nodes know that, and only if it is
    /// another file.
    pub(super) fn is_saved_as(&mut self, to: &Path) {
        let before = self.config.paint.document.replace(to.to_owned());
        let is_written = self.write_or_warn();
        if let Some(before) = before.filter(|before| is_written && !is_same(before, to)) {
            self.leave_sketch(&before, Leave::Named);
        }
    }

    /// Reports at the end of the rig where the sketch is stored, and removes a blank one.
    pub(super) fn end_sketch(&self) {
        let Some(path) = self.sketch() else {
            return;
        };
        self.leave_sketch(path, Leave::Left);
        if path.exists() {
            maulstick_rig::log::say(&format!(
                "the sketch is kept in {}: `maulstick up` offers it, and `maulstick up FILE` opens it\n",
                path.display()
            ));
        }
    }
}
