//! Takes that move the brush.

use maulstick_bus::BusError;
use maulstick_bus::typed::Received;
use maulstick_types::brush::BrushState;
use maulstick_types::stylus::StylusSample;
use maulstick_types::{Flags, Origin};

use super::BrushNode;
use super::pace::Pace;

/// A take that plays, from its first sample to its last: no other device moves the brush meanwhile,
/// however long it is silent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Take {
    device: String,
    origin: Origin,
}

impl BrushNode {
    /// True if a take has exclusive use of this brush.
    pub(super) fn is_held(&self) -> bool {
        let there = |take: &Take| !self.gone.has(&take.device);
        self.take.as_ref().is_some_and(there)
    }

    /// Follows a sample of a take; false where another take has the brush. The last one passes on
    /// the end, whatever else is in it.
    pub(super) fn replay(
        &mut self,
        device: &str,
        received: &Received<StylusSample>,
        now_ns: u64,
    ) -> Result<bool, BusError> {
        let header = &received.header;
        let take = Take {
            device: device.to_owned(),
            origin: header.origin(),
        };
        let mut first = Flags::NONE;
        if self.take.as_ref() != Some(&take) {
            if self.is_held() && !header.flags.has(Flags::FIRST) {
                return Ok(false);
            }
            self.gone.remove(device);
            self.backlog.clear();
            // A hand that waits to be set down goes with its backlog: its mark would be a stroke of the take.
            drop(self.model.finish());
            (self.pace, self.holds) = (Pace::default(), false);
            self.take = Some(take);
            first = Flags::FIRST;
        }
        let (origin, sample) = (header.origin(), &received.message);
        let (seq, event_ns) = (header.seq, header.event_ns);
        let state = self
            .model
            .state_in_take(origin, seq, event_ns, sample, header.flags);
        self.tell_haste();
        if header.flags.has(Flags::LAST) {
            self.take = None;
            let state = state.unwrap_or(BrushState {
                device: origin.source,
                device_epoch: origin.epoch,
                device_seq: header.seq,
                solves: Vec::new(),
            });
            self.post(Flags::REPLAY, first, Flags::LAST, state);
        } else if let Some(state) = state {
            self.post(Flags::REPLAY, first, Flags::NONE, state);
        }
        self.send(now_ns)?;
        Ok(true)
    }
}
