//! Samples that a brush has consumed of its devices, and the last report of them.

use maulstick_bus::typed::Sender;
use maulstick_bus::{BusError, Recent};
use maulstick_types::Origin;
use maulstick_types::brush::BrushConsumed;

/// Consumed samples of each device, by name.
#[derive(Debug, Default)]
pub(super) struct Progress {
    devices: Recent<Consumed>,
}

/// Consumed samples of a device.
#[derive(Debug)]
struct Consumed {
    newest: BrushConsumed,
    /// The last number reported to it.
    reported: Option<u64>,
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
        let known = self.devices.get(device).map(|known| &known.newest);
        if known
            .is_none_or(|known| (known.device, known.device_epoch) != (origin.source, origin.epoch))
        {
            let (newest, reported) = (fresh, None);
            self.devices.set(device, Consumed { newest, reported });
        }
        if let Some(known) = self.devices.get_mut(device) {
            known.newest.next = seq.wrapping_add(1);
        }
    }

    /// The newest state of a device will have this number.
    pub(super) fn posted(&mut self, device: Origin, number: u64) {
        for Consumed { newest, .. } in self.devices.values_mut() {
            if (newest.device, newest.device_epoch) == (device.source, device.epoch) {
                newest.state = number;
            }
        }
    }

    /// True if it has followed a device.
    pub(super) fn follows(&self, device: &str) -> bool {
        self.devices.has(device)
    }

    /// The last report may not have reached a device: forgets it.
    pub(super) fn forget_report(&mut self, device: &str) {
        if let Some(known) = self.devices.get_mut(device) {
            known.reported = None;
        }
    }

    /// Reports the consumed samples to devices; `first` is the first sample of a device that waits to be solved.
    pub(super) fn publish(
        &mut self,
        now_ns: u64,
        to: &mut Sender<BrushConsumed>,
        first: impl Fn(Origin) -> Option<u64>,
    ) -> Result<(), BusError> {
        for Consumed { newest, reported } in self.devices.values_mut() {
            let origin = Origin {
                source: newest.device,
                epoch: newest.device_epoch,
            };
            let waits = first(origin);
            let next = waits.map_or(newest.next, |first| first.min(newest.next));
            // Of one that has only begun there is nothing to report.
            if *reported != Some(next) && (waits.is_none() || reported.is_some()) {
                *reported = Some(next);
                let report = BrushConsumed {
                    next,
                    ..newest.clone()
                };
                to.send(now_ns, now_ns, &report)?;
            }
        }
        Ok(())
    }
}
