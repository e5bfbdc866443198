//! Requests to the rig: collected while the window is drawn, sent by the
//! [`dispatcher`](crate::rig::dispatcher).

use maulstick_types::command::Command;
use maulstick_types::haptics::ForceOrder;

use crate::input::keys::Action;

/// The node of the painting.
pub(crate) const PAINT: &str = "paint";

/// A request to a process of the rig.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// A command to a node.
    Command {
        /// The node.
        node: String,
        /// The command.
        command: Command,
    },
    /// A request to the force of a device.
    Force {
        /// The device.
        device: String,
        /// The request.
        order: ForceOrder,
    },
}

impl Request {
    /// Key of the value it sets, if only the newest of its kind counts.
    #[must_use]
    pub fn sets(&self) -> Option<(&'static str, String)> {
        let command = match self {
            Self::Command { command, .. } => command,
            Self::Force {
                device,
                order: ForceOrder::Strength { .. },
            } => return Some(("strength", device.clone())),
            Self::Force { .. } => return None,
        };
        Some(match command {
            Command::Place { surface, .. } => ("place", surface.to_string()),
            Command::Tune { tuning } => ("tuning", tuning.brush.clone()),
            Command::Handle { handling } => ("handling", handling.brush.clone()),
            Command::Define { brush, .. } => ("brush", brush.clone()),
            Command::Wells { surface, .. } => ("wells", surface.to_string()),
            Command::Relight { .. } => ("light", String::new()),
            _ => return None,
        })
    }
}

/// Requests that wait to be sent.
#[derive(Debug, Default)]
pub struct Requests {
    waiting: Vec<Request>,
    acts: Vec<Action>,
}

impl Requests {
    /// Asks the paint node.
    pub fn paint(&mut self, command: Command) {
        self.node(PAINT, command);
    }

    /// Asks the node of a brush.
    pub fn brush(&mut self, brush: &str, command: Command) {
        self.node(brush, command);
    }

    /// Asks a node.
    pub fn node(&mut self, node: &str, command: Command) {
        self.waiting.push(Request::Command {
            node: node.to_owned(),
            command,
        });
    }

    /// Requests a change of the force of a device.
    pub fn force(&mut self, device: &str, order: ForceOrder) {
        self.waiting.push(Request::Force {
            device: device.to_owned(),
            order,
        });
    }

    /// Does what a key would do.
    pub fn act(&mut self, act: Action) {
        self.acts.push(act);
    }

    /// Takes what is to be done as if by keys, the oldest first.
    #[must_use]
    pub fn take_acts(&mut self) -> Vec<Action> {
        std::mem::take(&mut self.acts)
    }

    /// Takes what waits, the oldest first.
    #[must_use]
    pub fn take(&mut self) -> Vec<Request> {
        std::mem::take(&mut self.waiting)
    }
}
