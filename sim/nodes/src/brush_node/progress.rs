//! How far a brush has consumed its devices, and what they were told of it.

use std::collections::BTreeMap;

use maulstick_bus::BusError;
use maulstick_bus::typed::Sender;
use maulstick_types::Origin;
use maulstick_types::brush::BrushConsumed;

/// What is consumed of each device, by name.
#[derive(Debug, Default)]
pub(super) struct Progress {
    devices: BTreeMap<String, BrushConsumed>,
    /// What each was told last.
    told: BTreeMap<String, u64>,
}

impl Progress {
    /// A sample is consumed by a brush of this epoch whose next state has the number `next_state`.
    pub(super) fn note(
        &mut self,
        device: &str,
        origin: Origin,
        seq: u64,
        brush_epoch: u32,
        next_state: u64,
    ) {
        let fresh = BrushConsumed {
            device: origin.source,
            device_epoch: origin.epoch,
            next: 0,
            brush_epoch,
            state: next_state,
        };
        let devices = &mut self.devices;
        let progress = devices
            .entry(device.to_owned())
            .or_insert_with(|| fresh.clone());
        if (progress.device, progress.device_epoch) != (origin.source, origin.epoch) {
            *progress = fresh;
            self.told.remove(device);
        }
        progress.next = seq.wrapping_add(1);
    }

    /// The newest state of a device will have this number.
    pub(super) fn posted(&mut self, device: Origin, number: u64) {
        for progress in self.devices.values_mut() {
            if (progress.device, progress.device_epoch) == (device.source, device.epoch) {
                progress.state = number;
            }
        }
    }

    /// Whether it has followed a device.
    pub(super) fn follows(&self, device: &str) -> bool {
        self.devices.contains_key(device)
    }

    /// A device may not have heard what it was told.
    pub(super) fn forget_told(&mut self, device: &str) {
        self.told.remove(device);
    }

    /// Tells devices what is consumed; those whose samples wait to be solved are told then.
    pub(super) fn tell(
        &mut self,
        now_ns: u64,
        to: &mut Sender<BrushConsumed>,
        waits: impl Fn(Origin) -> bool,
    ) -> Result<(), BusError> {
        for (device, progress) in &self.devices {
            let origin = Origin {
                source: progress.device,
                epoch: progress.device_epoch,
            };
            if self.told.get(device) != Some(&progress.next) && !waits(origin) {
                self.told.insert(device.clone(), progress.next);
                to.send(now_ns, now_ns, progress)?;
            }
        }
        Ok(())
    }
}
