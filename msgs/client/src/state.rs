//! State of a rig as its messages describe it: plain data, filled by the [listener](crate::listener).

use std::collections::BTreeMap;

use maulstick_bus::typed::Refusal;
use maulstick_types::paint::{Decision, PaintStatus};
use maulstick_types::scene::{CANVAS, PALETTE, Scene, Surface};
use maulstick_types::stylus::{StylusInfo, StylusStatus};

use crate::force_history::ForceHistory;
use crate::sample_history::SampleHistory;
use crate::thumbnails::Thumbnails;

/// An input device of the rig.
#[derive(Clone, Debug, Default)]
pub struct Device {
    /// Description of the stylus; `None` until it was received.
    pub info: Option<StylusInfo>,
    /// Status of the stylus; `None` until it was received.
    pub status: Option<StylusStatus>,
    /// Time of its last message, rig clock, ns.
    pub heard_ns: u64,
    /// Its newest samples.
    pub forces: ForceHistory,
    /// What they sensed.
    pub samples: SampleHistory,
}

/// Last known state of a paint node.
#[derive(Clone, Debug)]
pub struct PaintNode {
    /// Its status.
    pub status: PaintStatus,
    /// Time of its last message, rig clock, ns.
    pub heard_ns: u64,
}

/// An event that changes nothing in the state of the rig.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RigEvent {
    /// A message that this window does not understand.
    Refused(Refusal),
    /// The paint node has decided something.
    Decided(Decision),
}

/// A brush file that the node of a brush has sent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BrushDefinition {
    /// The brush.
    pub brush: String,
    /// Start of its node: a brush that is started anew has the file of `rig.toml`.
    pub epoch: u32,
    /// The file.
    pub toml: String,
}

/// The rig as its messages describe it.
#[derive(Clone, Debug, Default)]
pub struct LiveRig {
    /// Name of the rig.
    pub name: String,
    /// The time of the rig, ns.
    pub now_ns: u64,
    /// The scene on the desk; `None` until the paint node has sent it.
    pub scene: Option<Scene>,
    /// The paint node; `None` until its status was received.
    pub paint: Option<PaintNode>,
    /// Devices by name.
    pub devices: BTreeMap<String, Device>,
    /// The nodes that are alive, by name.
    pub nodes: Vec<String>,
    /// Number of starts of the paint node: each invalidates what was remembered of its painting.
    pub starts: u64,
    /// Small pictures of the versions.
    pub thumbnails: Thumbnails,
    /// Brush files received and not yet read.
    pub definitions: Vec<BrushDefinition>,
    /// Events received and not yet notified.
    pub events: Vec<RigEvent>,
}

impl LiveRig {
    /// A rig without any message so far.
    #[must_use]
    pub fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            ..Self::default()
        }
    }

    /// A surface of the scene.
    #[must_use]
    pub fn surface(&self, id: u32) -> Option<&Surface> {
        let mut surfaces = self.scene.as_ref()?.surfaces.iter();
        surfaces.find(|surface| surface.id == id)
    }

    /// The canvas.
    #[must_use]
    pub fn canvas(&self) -> Option<&Surface> {
        self.surface(CANVAS)
    }

    /// The palette.
    #[must_use]
    pub fn palette(&self) -> Option<&Surface> {
        self.surface(PALETTE)
    }
}
