//! Actions of the supervisor's parts, carried out.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use maulstick_rig::UserError;

use super::Supervisor;
use super::crew::{Action, Exit};
use super::node::State;
use super::sketch::Leave;
use super::switch::{SwitchAction, SwitchEvent};
use crate::up::plan::Role;
use crate::up::processes::Ended;

/// Pause before a node is started whose process of before has not ended yet.
const STILL_THERE: Duration = Duration::from_millis(20);

impl Supervisor {
    /// Carries out actions on processes.
    pub(super) fn carry_out(
        &mut self,
        actions: Vec<Action>,
        now: Instant,
    ) -> Result<(), UserError> {
        for action in actions {
            match action {
                Action::Start(name) => {
                    let node = self.crew.find(&name);
                    let is_paint = node.is_some_and(|node| node.spec.role == Role::Paint);
                    // A painting in a document restores the loads of its brushes.
                    self.loads.are_due |= is_paint && self.settings.config.paint.document.is_none();
                    self.start_node(&name, now)?;
                }
                Action::Terminate(name) => self.processes.terminate(&name),
                Action::Kill(name) => self.processes.kill(&name),
            }
        }
        Ok(())
    }

    /// Starts a node, now or when the system allows it.
    pub(super) fn start_node(&mut self, name: &str, now: Instant) -> Result<(), UserError> {
        self.try_start(name, now)
            .or_else(|fault| self.crew.put_off(name, fault, now))
    }

    pub(super) fn try_start(&mut self, name: &str, now: Instant) -> Result<(), UserError> {
        // It dials the sockets of the others once.
        self.folder_watch.hasten();
        let folder = &self.settings.folder;
        let without_sockets = self.folder_watch.watch(folder, &self.crew.nodes, now);
        for renewed in without_sockets {
            let asked = self.crew.renew(&renewed, now);
            if asked.is_some() {
                self.processes.terminate(&renewed);
            }
        }
        let Some(node) = self.crew.find(name) else {
            return Ok(());
        };
        if self.processes.runs(name) {
            node.due = Some(now + STILL_THERE);
            return Ok(());
        }
        let pid = self
            .processes
            .start(&node.spec, self.settings.folder.path())?;
        node.has_started(pid, now);
        Ok(())
    }

    /// A process has ended; an exit code where the rig is to end.
    pub(super) fn process_ended(
        &mut self,
        name: &str,
        ended: Ended,
    ) -> Result<Option<i32>, UserError> {
        let (now, hands) = (Instant::now(), self.hands());
        let Some(node) = self.crew.find(name) else {
            return Ok(None);
        };
        node.pid = None;
        let role = node.spec.role;
        if node.leaving_since.is_some() || self.switch.opened() == Some(role) {
            self.has_left(name, ended, now)?;
            return Ok(None);
        }
        if role == Role::Paint {
            self.switch_on(SwitchEvent::PaintGone, now)?;
        }
        match self.crew.ended(name, ended, hands, now) {
            Exit::Rests => Ok(None),
            Exit::EndsRig(code) => Ok(Some(code)),
            Exit::Fails(fault) => Err(fault.at(self.link.topics.node(name))),
            Exit::Restarts => {
                self.play_again(role, now)?;
                Ok(None)
            }
        }
    }

    /// Plays a take again from its start after a crash of its brush or paint; its paint is undone.
    fn play_again(&mut self, role: Role, now: Instant) -> Result<(), UserError> {
        if role == Role::Window || role.is_spare() {
            return Ok(());
        }
        if let Some(conductor) = &mut self.conductor {
            conductor.begin_again();
            self.switch_on(SwitchEvent::PaintGone, now)?;
            let actions = self.crew.play_again(now);
            self.carry_out(actions, now)?;
        }
        Ok(())
    }

    /// Handles the requested end of a node, or the end of the paint node while it opened another painting.
    fn has_left(&mut self, name: &str, ended: Ended, now: Instant) -> Result<(), UserError> {
        let Some(node) = self.crew.find(name) else {
            return Ok(());
        };
        node.leaving_since = None;
        match node.spec.role {
            Role::Paint if self.switch.is_busy() => {
                self.switch_on(SwitchEvent::PaintLeft(ended), now)
            }
            Role::Paint => self.start_paint(now),
            Role::Device => {
                let mut devices = self.settings.config.device.iter();
                if devices.any(|own| own.name == name) {
                    self.start_node(name, now)
                } else {
                    node.state = State::Ended;
                    Ok(())
                }
            }
            Role::Brush | Role::Window | Role::Player | Role::Recorder => {
                self.start_node(name, now)
            }
        }
    }

    /// Starts the paint node; a painting in memory is lost, and its brushes are loaded again.
    fn start_paint(&mut self, now: Instant) -> Result<(), UserError> {
        self.loads.are_due |= self.settings.config.paint.document.is_none();
        match self.paint_name() {
            Some(name) => self.start_node(&name, now),
            None => Ok(()),
        }
    }

    fn paint_name(&self) -> Option<String> {
        let paint = self.crew.of_role(Role::Paint);
        paint.map(|paint| paint.spec.name.clone())
    }

    /// Continues a switch to another painting as far as possible now.
    pub(super) fn follow_switch(&mut self, now: Instant) -> Result<(), UserError> {
        while let Some((asker, outcome)) = self.checks.next() {
            // A request that was given up has no client.
            if asker == self.switch.asker() {
                let outcome = self.checked(outcome);
                self.switch_on(outcome, now)?;
            }
        }
        if !self.switch.is_busy() {
            return Ok(());
        }
        if self.crew.paint_runs() {
            self.switch_on(SwitchEvent::PaintRuns, now)?;
        }
        let paint = self.crew.of_role(Role::Paint);
        let limit = paint.map(|paint| paint.start_time(&self.settings.config));
        self.switch_on(SwitchEvent::Time(limit.unwrap_or_default()), now)
    }

    /// Much may have been painted while another painting was checked.
    fn checked(&self, outcome: SwitchEvent) -> SwitchEvent {
        let forget = self.switch.forgets();
        let (SwitchEvent::Checked(Ok(plan)), Some(forget)) = (&outcome, forget) else {
            return outcome;
        };
        let config = &self.settings.config;
        let may = self.orders.may_leave(config, self.hands(), forget);
        SwitchEvent::Checked(may.map(|()| plan.clone()))
    }

    /// Passes an event to the switch, and carries out its actions.
    pub(super) fn switch_on(&mut self, event: SwitchEvent, now: Instant) -> Result<(), UserError> {
        let config = &self.settings.config;
        let mut actions = VecDeque::from(self.switch.on(event, config, now));
        while let Some(action) = actions.pop_front() {
            if let Some(event) = self.switch_action(action, now)? {
                let config = &self.settings.config;
                actions.extend(self.switch.on(event, config, now));
            }
        }
        Ok(())
    }

    /// Carries out an action of the switch; returns the resulting event.
    fn switch_action(
        &mut self,
        action: SwitchAction,
        now: Instant,
    ) -> Result<Option<SwitchEvent>, UserError> {
        match action {
            SwitchAction::RenewPaint => {
                let paint = self.paint_name();
                let asked = paint.and_then(|paint| self.crew.renew(&paint, now));
                if asked.is_none() {
                    return Ok(Some(SwitchEvent::PaintAway));
                }
                self.carry_out(Vec::from_iter(asked), now)?;
            }
            SwitchAction::KillPaint => {
                if let Some(paint) = self.paint_name() {
                    self.processes.kill(&paint);
                }
            }
            SwitchAction::Use(config) => {
                self.orders.forget_status();
                if let Err(fault) = self.settings.set_painting(*config) {
                    return Ok(Some(SwitchEvent::NotWritten(fault)));
                }
                if let Some(paint) = self.paint_name() {
                    self.start_node(&paint, now)?;
                }
            }
            SwitchAction::PutBack(before) => {
                let written = self.settings.put_back(*before);
                return Ok(written.err().map(SwitchEvent::NotWritten));
            }
            SwitchAction::StartPaint => self.start_paint(now)?,
            SwitchAction::Leave(path) => self.settings.leave_sketch(&path, Leave::Left),
            SwitchAction::Load(load) => {
                (self.loads.first, self.loads.are_due) = (Some(load), true);
            }
            SwitchAction::RenewDevices => {
                let actions = self.crew.renew_all(Role::Device, now);
                self.carry_out(actions, now)?;
            }
            SwitchAction::SavedAs(path) => self.settings.is_saved_as(&path),
            SwitchAction::Reply(asker, outcome) => self.orders.commands.keep(asker, outcome),
        }
        Ok(None)
    }
}
