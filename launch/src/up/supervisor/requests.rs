//! Requests to the rig as a whole: another painting, another file, a device.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use maulstick_rig::UserError;
use maulstick_rig::command_client::CommandClient;
use maulstick_rig::config::DeviceSection;
use maulstick_rig::files::is_same;
use maulstick_types::command::{Command, CommandReply, CommandRequest, Outcome, RigCommand};

use super::Supervisor;
use super::node::State;
use super::orders::{refusal, starts_again};
use crate::up::plan::{Hands, Role, device};

impl Supervisor {
    /// Answers requests to the rig.
    pub(super) fn take_requests(&mut self, now: Instant) {
        if let Some(file) = self.orders.follow_paint() {
            self.follow_painting(file);
        }
        let bus = Arc::clone(&self.link.bus);
        while let Some((request, asked)) = self.orders.next(&*bus) {
            let is_held = self.switch.is_busy() || !self.orders.has_heard(&asked, bus.now_ns());
            // It is repeated, and done in its turn.
            let outcome = if is_held {
                Outcome::Waiting
            } else {
                self.orders.begin();
                let outcome = self.order(&asked, now).unwrap_or_else(refusal);
                // The rig itself reports the end of a switch; a removal is checked each time.
                if self.switch.is_busy() || outcome != Outcome::Waiting {
                    let asker = (asked.client, asked.number);
                    self.orders.commands.keep(asker, outcome.clone());
                }
                outcome
            };
            let number = asked.number;
            self.orders
                .commands
                .answer(&*bus, request, &CommandReply { number, outcome });
        }
    }

    /// Stores the new file of a painting whose file was gone: there it is found after a crash.
    fn follow_painting(&mut self, file: PathBuf) {
        let document = &mut self.settings.config.paint.document;
        if self.switch.is_busy() || document.as_ref().is_none_or(|own| *own == file) {
            return;
        }
        tracing::info!("painting in {}", file.display());
        *document = Some(file);
        self.settings.write_or_warn();
    }

    fn order(&mut self, asked: &CommandRequest, now: Instant) -> Result<Outcome, UserError> {
        if asked.after.is_some() {
            return Err(UserError::usage("the rig has no journal in which to wait")
                .help("send the command without a position in the journal"));
        }
        let command = match &asked.command {
            Command::Rig(command) => command,
            command @ (Command::Edit(_)
            | Command::Take(_)
            | Command::File(_)
            | Command::Brush(_)
            | Command::Session(_)) => return Ok(command.misaddressed()),
        };
        let asker = (asked.client, asked.number);
        let config = self.settings.config.clone();
        let may_leave = |forget: bool| self.orders.may_leave(&config, self.hands(), forget);
        match command {
            RigCommand::Open { path, forget } => {
                let path = PathBuf::from(path.as_str());
                let here = config.paint.document.as_ref();
                if here.is_some_and(|here| is_same(here, &path)) {
                    return Ok(Outcome::done(format!("{} is open already", path.display())));
                }
                may_leave(*forget)?;
                self.switch.check(asker, *forget);
                self.checks.open(asker, config, path);
            }
            RigCommand::New {
                path,
                canvas,
                forget,
            } => {
                may_leave(*forget)?;
                let path = path.as_ref().map(|path| PathBuf::from(path.as_str()));
                let sketches = self.settings.sketches.clone();
                self.switch.check(asker, *forget);
                self.checks
                    .begin(asker, config, (path, canvas.clone()), sketches);
            }
            RigCommand::PutDevice { toml } => return self.put_device(toml.as_str(), now),
            RigCommand::RemoveDevice { name } => return self.remove_device(name.as_str(), now),
            RigCommand::SaveAs(save_as) => {
                if !self.crew.paint_runs() {
                    return Ok(starts_again());
                }
                let to = PathBuf::from(save_as.path.as_str());
                tracing::info!("saving in {}", to.display());
                let gone = self.switch.save(asker, &to);
                let (bus, stop) = (Arc::clone(&self.link.bus), self.link.stop.clone());
                let client = CommandClient::new(bus, &self.link.topics);
                self.checks
                    .save(asker, client, save_as.clone(), (gone, stop));
            }
        }
        Ok(Outcome::Waiting)
    }

    /// Starts a device with other settings, or a new one.
    fn put_device(&mut self, toml: &str, now: Instant) -> Result<Outcome, UserError> {
        self.has_devices()?;
        let section = DeviceSection::parse(toml)?;
        let before = self.settings.config.clone();
        self.settings.set(before.with_device(section.clone())?)?;
        let name = section.name.clone();
        self.crew.put(device(&self.settings.config, &section));
        if let Some(asked) = self.crew.renew(&name, now) {
            self.carry_out(vec![asked], now)?;
        } else if let Err(fault) = self.try_start(&name, now) {
            if let Some(node) = self.crew.find(&name) {
                (node.state, node.due) = (State::Failed, None);
            }
            self.settings.set(before)?;
            return Err(fault);
        }
        Ok(Outcome::done(format!("device '{name}' starts")))
    }

    /// Ends a device. While its process still runs the answer is [`Outcome::Waiting`], and the order is given again.
    fn remove_device(&mut self, name: &str, now: Instant) -> Result<Outcome, UserError> {
        self.has_devices()?;
        let config = &self.settings.config;
        let names = config.device.iter().map(|own| own.name.as_str());
        let is_known = names.clone().any(|own| own == name);
        let node = self.crew.find(name);
        if node.is_none_or(|node| node.spec.role != Role::Device) {
            let what = format!("the rig has no device called '{name}'");
            return Err(UserError::unknown(what, name, names));
        }
        if is_known {
            self.settings.set(config.without_device(name))?;
            let asked = self.crew.renew(name, now);
            if let (None, Some(node)) = (&asked, self.crew.find(name)) {
                (node.state, node.due) = (State::Ended, None);
            }
            self.carry_out(Vec::from_iter(asked), now)?;
        }
        Ok(if self.processes.runs(name) {
            Outcome::Waiting
        } else {
            Outcome::done(format!("device '{name}' has left"))
        })
    }

    /// Checks that devices move the brushes.
    fn has_devices(&self) -> Result<(), UserError> {
        match self.hands() {
            Hands::Take => Err(UserError::usage("a take is played in the place of devices")
                .help("wait for its end, and ask again")),
            Hands::Devices => Ok(()),
        }
    }
}
