//! Settings of a brush node at its start.

use std::collections::BTreeMap;

use maulstick_brush::BrushFile;

use crate::contact_model::ForceKind;

/// Settings of a brush node at its start.
#[derive(Clone, Debug)]
pub struct BrushSettings {
    /// Name of the brush.
    pub name: String,
    /// Its file, at its size.
    pub file: BrushFile,
    /// Share of the head's length that full pressure presses in.
    pub depth_share: f64,
    /// The devices.
    pub devices: BrushDevices,
    /// Epoch of this start.
    pub epoch: u32,
}

/// The devices of a rig, as a brush sees them.
#[derive(Clone, Debug, Default)]
pub struct BrushDevices {
    /// Priority of those that move it, by name.
    pub priorities: BTreeMap<String, i32>,
    /// Force law of each device, by name; two straight pieces by default.
    pub laws: BTreeMap<String, ForceKind>,
    /// Devices that move other brushes.
    pub others: Vec<String>,
    /// Priority of a device that is in neither list, if it may move this brush.
    pub foreign_priority: Option<i32>,
}

impl BrushDevices {
    /// Priority of a device, if it moves the brush called `brush`: rig.toml and the device itself (`moves`: the
    /// brush that it says it moves, or nothing) may say that it moves another one.
    pub(super) fn priority(&self, brush: &str, device: &str, moves: &str) -> Option<i32> {
        let elsewhere = !moves.is_empty() && moves != brush;
        if elsewhere || self.others.iter().any(|other| other == device) {
            return None;
        }
        self.priorities
            .get(device)
            .copied()
            .or(self.foreign_priority)
    }
}
