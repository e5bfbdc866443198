//! State of a rig as its messages describe it: plain data, filled by the [listener](crate::listener).

use std::collections::BTreeMap;

use maulstick_bus::typed::Refusal;
use maulstick_types::paint::{Decision, PaintStatus};
use maulstick_types::scene::{CANVAS, PALETTE, Scene, Surface};
use maulstick_types::stylus::{StylusInfo, StylusStatus, axes};

use crate::force_history::{Aging, ForceHistory, size};
use crate::sample_history::SampleHistory;
use crate::thumbnails::Thumbnails;

/// Driver of the mouse as a device.
const POINTER: &str = "pointer";
/// Smallest force that is shown, N.
const LEAST_N: f64 = 0.02;

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
    /// Its newest samples, with their senses.
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

    /// The device that moves a brush: of those near the desk the one of highest priority.
    #[must_use]
    pub fn active_device(&self, brush: &str) -> Option<(&str, &Device)> {
        let near = self.devices.iter().filter_map(|(name, device)| {
            let info = device.info.as_ref()?;
            let aging = if info.driver == POINTER {
                Aging::Never
            } else {
                Aging::Silence
            };
            let moves = info.brush == brush && device.forces.is_near(self.now_ns, aging);
            moves.then_some((info.priority, name.as_str(), device))
        });
        let first = near.max_by_key(|(priority, ..)| *priority)?;
        Some((first.1, first.2))
    }

    /// Point on the desk where the force of the device that moves a brush acts, m, and that force, N; `None` if it is too
    /// small to show.
    #[must_use]
    pub fn force_arrow(&self, brush: &str) -> Option<([f64; 3], [f64; 3])> {
        let (_, device) = self.active_device(brush)?;
        let drives = device.info.as_ref()?.drives & axes::FORCE != 0;
        let force_n = device.forces.force_n(self.now_ns)?;
        let place_m = device.forces.place_m()?;
        (drives && size(force_n) >= LEAST_N).then_some((place_m, force_n))
    }
}

#[cfg(test)]
mod tests {
    use maulstick_types::stylus::StylusSample;

    use super::*;

    fn sample(force_n: [f64; 3]) -> StylusSample {
        StylusSample {
            force_n,
            in_range: true,
            ..StylusSample::away()
        }
    }

    #[test]
    fn of_those_near_the_one_of_highest_priority_paints_and_shows_its_arrow() {
        let mut rig = LiveRig::new("t");
        rig.now_ns = 10_000_000_000;
        for (name, driver, priority, drives) in [
            ("mouse", POINTER, -100, 0),
            ("pen", "pen", 5, 0),
            ("arm", "simulated", 10, axes::FORCE),
        ] {
            let device = rig.devices.entry(name.to_owned()).or_default();
            device.info = Some(StylusInfo {
                device: name.into(),
                driver: driver.into(),
                brush: "main".into(),
                priority,
                senses: 0,
                drives,
                rate_hz: 0.0,
                max_force_n: 0.0,
                max_stiffness_n_m: 0.0,
                workspace_m: [0.0; 6],
            });
            device.forces.add(9_900_000_000, &sample([0.0, 0.0, 0.5]));
        }
        let who = |rig: &LiveRig| rig.active_device("main").map(|(name, _)| name.to_owned());
        assert_eq!(who(&rig).as_deref(), Some("arm"));
        let (_, force_n) = rig.force_arrow("main").expect("an arrow");
        assert_eq!(force_n, [0.0, 0.0, 0.5]);
        let arm = rig.devices.get_mut("arm").expect("an arm");
        arm.forces.add(9_950_000_000, &StylusSample::away());
        assert_eq!(who(&rig).as_deref(), Some("pen"));
        assert_eq!(rig.force_arrow("main"), None, "a pen gives no force");
        rig.now_ns += 500_000_000;
        assert_eq!(who(&rig).as_deref(), Some("mouse"), "it keeps still");
    }
}
