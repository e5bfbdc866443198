//! Devices that come and go while the rig runs.

use maulstick_rig::UserError;
use maulstick_rig::config::{DeviceSection, RigConfig};
use maulstick_types::command::Outcome;

use super::Supervisor;
use crate::up::child::{Node, State};
use crate::up::plan::{Role, device};

impl Supervisor {
    /// Starts a device with other settings, or one that was not there.
    pub(super) fn put_device(&mut self, toml: &str) -> Result<Outcome, UserError> {
        self.has_devices()?;
        let section = DeviceSection::parse(toml)?;
        let before = self.config.clone();
        self.set_config(self.config.with_device(section.clone())?)?;
        let spec = device(&self.config, &section);
        let place = match self.device_node(&section.name) {
            Some(place) => {
                self.nodes[place].spec = spec;
                place
            }
            None => {
                self.nodes.push(Node::new(spec));
                self.nodes.len() - 1
            }
        };
        // One that was about to be started again is started with these settings.
        self.due.retain(|(due, _)| *due != section.name);
        if !self.nodes[place].renew()
            && let Err(fault) = self.try_start(place)
        {
            self.nodes[place].state = State::Failed;
            self.set_config(before)?;
            return Err(fault);
        }
        Ok(Outcome::done(format!("device '{}' starts", section.name)))
    }

    /// Ends a device. While its process still runs the answer is [`Outcome::Waiting`], and the order is given again.
    pub(super) fn remove_device(&mut self, name: &str) -> Result<Outcome, UserError> {
        self.has_devices()?;
        let names = self.config.device.iter().map(|own| own.name.as_str());
        let is_known = names.clone().any(|own| own == name);
        let Some(place) = self.device_node(name) else {
            let what = format!("the rig has no device called '{name}'");
            return Err(UserError::unknown(what, name, names));
        };
        if is_known {
            self.set_config(self.config.without_device(name))?;
            self.due.retain(|(due, _)| due != name);
            if !self.nodes[place].renew() {
                self.nodes[place].state = State::Ended;
            }
        }
        Ok(match self.nodes[place].pid() {
            Some(_) => Outcome::Waiting,
            None => Outcome::done(format!("device '{name}' has left")),
        })
    }

    /// Checks that devices move the brushes.
    fn has_devices(&self) -> Result<(), UserError> {
        match self.conductor {
            Some(_) => Err(UserError::usage("a take is played in the place of devices")
                .help("wait for its end, and ask again")),
            None => Ok(()),
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
