//! Requests to the rig: collected while the window is drawn, sent by the
//! [dispatcher](maulstick_client::dispatcher).

use maulstick_client::request::Request;
use maulstick_types::command::Command;
use maulstick_types::haptics::ForceOrder;

use crate::input::keys::Action;
use crate::rig::device_order::{DeviceOrder, SetupChange};
use crate::sessions::SessionOrder;

/// Requests that wait to be sent.
#[derive(Debug, Default)]
pub(crate) struct Requests {
    waiting: Vec<Request>,
    /// Requests that an answer brings about, each with the time at which it was asked for, rig clock, ns.
    follow_ups: Vec<(Request, u64)>,
    acts: Vec<Action>,
    devices: Vec<DeviceOrder>,
    sessions: Vec<SessionOrder>,
    environment: bool,
}

impl Requests {
    /// Asks the node that carries out a command.
    pub(crate) fn send(&mut self, command: impl Into<Command>) {
        self.waiting.push(Request::of(command));
    }

    /// Asks for what was to follow another request, which is done; the painter asked for it at this time.
    pub(crate) fn follow_up(&mut self, command: impl Into<Command>, asked_ns: u64) {
        self.follow_ups.push((Request::of(command), asked_ns));
    }

    /// Takes what was to follow other requests, the oldest first, with the times at which it was asked for.
    #[must_use]
    pub(crate) fn take_follow_ups(&mut self) -> Vec<(Request, u64)> {
        std::mem::take(&mut self.follow_ups)
    }

    /// Requests a change of the force of a device.
    pub(crate) fn force(&mut self, device: &str, order: ForceOrder) {
        self.waiting.push(Request::Force {
            device: device.to_owned(),
            order,
        });
    }

    /// Asks for a change of the devices.
    pub(crate) fn change_device(&mut self, change: SetupChange) {
        self.devices.push(DeviceOrder::Change(change));
    }

    /// Asks for a fit, or its end.
    pub(crate) fn order_device(&mut self, order: DeviceOrder) {
        self.devices.push(order);
    }

    /// Takes the orders of devices, the oldest first.
    #[must_use]
    pub(crate) fn take_device_orders(&mut self) -> Vec<DeviceOrder> {
        std::mem::take(&mut self.devices)
    }

    /// Asks recorder or player.
    pub(crate) fn session(&mut self, order: SessionOrder) {
        self.sessions.push(order);
    }

    /// Takes the orders to recorder and player, the oldest first.
    #[must_use]
    pub(crate) fn take_session_orders(&mut self) -> Vec<SessionOrder> {
        std::mem::take(&mut self.sessions)
    }

    /// Asks for a picture of surroundings to be chosen.
    pub(crate) fn choose_environment(&mut self) {
        self.environment = true;
    }

    /// True once after a picture of surroundings was asked for.
    #[must_use]
    pub(crate) fn takes_environment(&mut self) -> bool {
        std::mem::take(&mut self.environment)
    }

    /// Does what a key would do.
    pub(crate) fn act(&mut self, act: Action) {
        self.acts.push(act);
    }

    /// Takes what is to be done as if by keys, the oldest first.
    #[must_use]
    pub(crate) fn take_acts(&mut self) -> Vec<Action> {
        std::mem::take(&mut self.acts)
    }

    /// Takes what waits and what follows, as if it had been asked for at once.
    #[cfg(test)]
    pub(crate) fn take_all(&mut self) -> Vec<Request> {
        let follow_ups = self.take_follow_ups().into_iter();
        let mut all = self.take();
        all.extend(follow_ups.map(|(request, _)| request));
        all
    }

    /// Takes what waits, the oldest first.
    #[must_use]
    pub(crate) fn take(&mut self) -> Vec<Request> {
        std::mem::take(&mut self.waiting)
    }
}
