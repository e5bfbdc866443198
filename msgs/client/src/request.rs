//! Requests to the processes of a rig.

use maulstick_types::command::{BrushCommand, Command, PAINT_NODE, RIG_NODE};
use maulstick_types::haptics::ForceOrder;

/// The edit that moves a surface.
const PLACE: &str = "place";
/// Edits of a brush, its paint and its use.
const OF_A_BRUSH: [&str; 6] = ["tune", "handle", "load", "load_from", "clean", "reshape"];
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
pub enum Peer {
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
    #[must_use]
    pub fn peer(&self) -> Peer {
        match self {
            Self::Command { node, .. } => match node.as_str() {
                PAINT_NODE => Peer::Paint,
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
