//! Samples of takes, which have the brush to themselves.

use maulstick_bus::BusError;
use maulstick_bus::typed::Received;
use maulstick_types::Flags;
use maulstick_types::brush::BrushState;
use maulstick_types::stylus::StylusSample;

use super::BrushNode;
use super::devices::TakeClaim;

impl BrushNode {
    /// Follows a sample of a take; false where another take has the brush. The last one passes on
    /// the end, whatever else is in it.
    pub(super) fn replay(
        &mut self,
        device: &str,
        received: &Received<StylusSample>,
        now_ns: u64,
    ) -> Result<bool, BusError> {
        let header = &received.header;
        let first = match self.devices.claim(device, header) {
            TakeClaim::Rejected => return Ok(false),
            TakeClaim::Begins => {
                self.solver.begin_take();
                Flags::FIRST
            }
            TakeClaim::Continues => Flags::NONE,
        };
        let state = self.solver.replay(received);
        if header.flags.has(Flags::LAST) {
            self.devices.end_take();
            let origin = header.origin();
            let state = state.unwrap_or(BrushState {
                device: origin.source,
                device_epoch: origin.epoch,
                device_seq: header.seq,
                solves: Vec::new(),
            });
            self.output.post(Flags::REPLAY, first, Flags::LAST, state);
        } else if let Some(state) = state {
            self.output.post(Flags::REPLAY, first, Flags::NONE, state);
        }
        self.output.send(now_ns)?;
        Ok(true)
    }
}
