//! Devices that come and go while the rig runs.

use maulstick_rig::UserError;
use maulstick_rig::config::{DeviceSection, RigConfig};
use maulstick_types::command::{Command, Outcome, RigCommand};

use super::Supervisor;
use crate::up::child::{Node, State};
use crate::up::plan::{Role, device};

impl Supervisor {
    /// Starts a device with other settings, or one that was not there.
    pub(super) fn put_device(&mut self, toml: &str) -> Result<Outcome, UserError> {
        if self.conductor.is_some() {
            return Err(UserError::usage("a take is played in the place of devices")
                .help("wait for its end, and ask again"));
        }
        let section = DeviceSection::parse(toml)?;
        self.set_config(self.config.with_device(section.clone())?)?;
        let spec = device(&self.config, &section);
        let name = section.name;
        match self.device_node(&name) {
            None => {
                self.nodes.push(Node::new(spec));
                self.start_node(self.nodes.len() - 1)?;
            }
            Some(place) => {
                let node = &mut self.nodes[place];
                node.spec = spec;
                // One that was about to be started again is started with these settings.
                self.due.retain(|(due, _)| *due != name);
                if !node.renew() {
                    self.start_node(place)?;
                }
            }
        }
        Ok(Outcome::done(format!("device '{name}' is started")))
    }

    /// Ends the device that a command removes; true while its process still runs.
    pub(super) fn lets_go(&mut self, command: &Command) -> bool {
        let Command::Rig(RigCommand::RemoveDevice { name }) = command else {
            return false;
        };
        let name = name.as_str();
        let Some(place) = self.device_node(name) else {
            return false;
        };
        let is_known = self.config.device.iter().any(|own| own.name == name);
        if is_known {
            if let Err(fault) = self.set_config(self.config.without_device(name)) {
                tracing::warn!("{fault}");
            }
            self.due.retain(|(due, _)| due != name);
            if !self.nodes[place].renew() {
                self.nodes[place].state = State::Ended;
            }
        }
        self.nodes[place].pid().is_some()
    }

    /// The answer when a device is gone.
    pub(super) fn removed_device(&self, name: &str) -> Result<Outcome, UserError> {
        match self.device_node(name) {
            Some(_) => Ok(Outcome::done(format!("device '{name}' has left"))),
            None => {
                let names = self.config.device.iter().map(|own| own.name.as_str());
                let what = format!("the rig has no device called '{name}'");
                Err(UserError::unknown(what, name, names))
            }
        }
    }

    /// A device that was asked to end has ended: it is started again, unless it was removed.
    pub(super) fn device_has_left(&mut self, place: usize) -> Result<(), UserError> {
        let node = &mut self.nodes[place];
        node.leaving_since = None;
        let is_there = |own: &DeviceSection| own.name == node.spec.name;
        match self.config.device.iter().any(is_there) {
            true => self.start_node(place),
            false => {
                node.state = State::Ended;
                Ok(())
            }
        }
    }

    fn device_node(&self, name: &str) -> Option<usize> {
        let is_meant = |node: &Node| node.spec.role == Role::Device && node.spec.name == name;
        self.nodes.iter().position(is_meant)
    }

    fn set_config(&mut self, config: RigConfig) -> Result<(), UserError> {
        let before = std::mem::replace(&mut self.config, config);
        let written = self.write_config();
        if written.is_err() {
            self.config = before;
        }
        written
    }
}
