//! Requests to the rig: collected while the window is drawn, sent by the
//! [`dispatcher`](crate::rig::dispatcher).

use maulstick_types::command::{BrushCommand, Command, RIG_NODE};
use maulstick_types::haptics::ForceOrder;

use crate::input::keys::Action;
use crate::rig::device_commands::DeviceOrder;
use crate::sessions::SessionOrder;

pub(crate) use maulstick_types::command::PAINT_NODE as PAINT;

/// The edit that moves a surface.
const PLACE: &str = "place";
/// Edits of a brush, its paint and its use.
const OF_A_BRUSH: [&str; 5] = ["tune", "handle", "load", "load_from", "clean"];
/// Edits that set a value, of which the newest counts, and the field that says whose.
const SETTINGS: [(&str, &str); 5] = [
    (PLACE, "surface"),
    ("tune", "brush"),
    ("handle", "brush"),
    ("wells", "surface"),
    ("relight", ""),
];

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

/// A process that carries out requests.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Peer {
    /// The paint node.
    Paint,
    /// The launcher.
    Rig,
    /// The node of a brush.
    Brush(String),
    /// The daemon of a device.
    Device(String),
}

impl Request {
    /// The process that carries it out.
    pub(crate) fn peer(&self) -> Peer {
        match self {
            Self::Command { node, .. } => match node.as_str() {
                PAINT => Peer::Paint,
                RIG_NODE => Peer::Rig,
                brush => Peer::Brush(brush.to_owned()),
            },
            Self::Force { device, .. } => Peer::Device(device.clone()),
        }
    }

    /// A command to the node that carries it out.
    #[must_use]
    pub fn of(command: impl Into<Command>) -> Self {
        let command = command.into();
        let node = command.node().to_owned();
        Self::Command { node, command }
    }

    /// True if it moves a surface.
    #[must_use]
    pub fn moves_surface(&self) -> bool {
        matches!(self, Self::Command { command: Command::Edit(edit), .. } if edit.name == PLACE)
    }

    /// True if it changes the brush, its paint or how it is used.
    #[must_use]
    pub fn changes_brush(&self) -> bool {
        let Self::Command { command, .. } = self else {
            return false;
        };
        match command {
            Command::Brush(_) => true,
            Command::Edit(edit) => OF_A_BRUSH.contains(&edit.name.as_str()),
            _ => false,
        }
    }

    /// True if strokes that begin after it was asked for are painted when it is done: a change of the brush, and every edit
    /// that has its place among the strokes.
    #[must_use]
    pub fn precedes_strokes(&self) -> bool {
        let is_edit = matches!(
            self,
            Self::Command {
                command: Command::Edit(_),
                ..
            }
        );
        self.changes_brush() || is_edit && self.sets().is_none()
    }

    /// Key of the value it sets, if only the newest of its kind counts.
    #[must_use]
    pub fn sets(&self) -> Option<(&'static str, String)> {
        let command = match self {
            Self::Command { command, .. } => command,
            Self::Force {
                device,
                order: ForceOrder::Strength { .. },
            } => return Some(("strength", device.clone())),
            Self::Force {
                device,
                order: ForceOrder::Guidance { .. },
            } => return Some(("guidance", device.clone())),
            Self::Force { .. } => return None,
        };
        Some(match command {
            Command::Edit(edit) => {
                let (name, of) = SETTINGS.iter().find(|(name, _)| *name == edit.name)?;
                (*name, edit.word(of))
            }
            Command::Brush(BrushCommand::Define { brush, .. }) => ("brush", brush.to_string()),
            _ => return None,
        })
    }
}

/// Requests that wait to be sent.
#[derive(Debug, Default)]
pub struct Requests {
    waiting: Vec<Request>,
    /// Requests that an answer brings about, each with the time at which it was asked for, rig clock, ns.
    follow_ups: Vec<(Request, u64)>,
    acts: Vec<Action>,
    devices: Vec<DeviceOrder>,
    sessions: Vec<SessionOrder>,
}

impl Requests {
    /// Asks the node that carries out a command.
    pub fn send(&mut self, command: impl Into<Command>) {
        self.waiting.push(Request::of(command));
    }

    /// Asks for what was to follow another request, which is done; the painter asked for it at this time.
    pub fn follow_up(&mut self, command: impl Into<Command>, asked_ns: u64) {
        self.follow_ups.push((Request::of(command), asked_ns));
    }

    /// Takes what was to follow other requests, the oldest first, with the times at which it was asked for.
    #[must_use]
    pub fn take_follow_ups(&mut self) -> Vec<(Request, u64)> {
        std::mem::take(&mut self.follow_ups)
    }

    /// Requests a change of the force of a device.
    pub fn force(&mut self, device: &str, order: ForceOrder) {
        self.waiting.push(Request::Force {
            device: device.to_owned(),
            order,
        });
    }

    /// Runs `maulstick device` with these words.
    pub fn device<'a>(&mut self, words: impl IntoIterator<Item = &'a str>) {
        let words = words.into_iter().map(str::to_owned).collect();
        self.devices.push(DeviceOrder::Run(words));
    }

    /// As [`device`](Self::device), for what is no single command.
    pub fn order_device(&mut self, order: DeviceOrder) {
        self.devices.push(order);
    }

    /// Takes the orders of devices, the oldest first.
    #[must_use]
    pub fn take_device_orders(&mut self) -> Vec<DeviceOrder> {
        std::mem::take(&mut self.devices)
    }

    /// Asks recorder or player.
    pub fn session(&mut self, order: SessionOrder) {
        self.sessions.push(order);
    }

    /// Takes the orders to recorder and player, the oldest first.
    #[must_use]
    pub fn take_session_orders(&mut self) -> Vec<SessionOrder> {
        std::mem::take(&mut self.sessions)
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
    pub fn take(&mut self) -> Vec<Request> {
        std::mem::take(&mut self.waiting)
    }
}
