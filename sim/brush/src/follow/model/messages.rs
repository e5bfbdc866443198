//! Solves of a sample as one message.

use maulstick_types::brush::{BrushState, Solve};
use maulstick_types::stylus::StylusSample;
use maulstick_types::{Flags, Origin};

use super::BrushModel;

impl BrushModel {
    /// The solves of [`follow`](Self::follow) as one message.
    pub fn state(
        &mut self,
        origin: Origin,
        device_seq: u64,
        event_ns: u64,
        sample: &StylusSample,
    ) -> Option<BrushState> {
        let solves = self.follow(origin, event_ns, sample);
        message(origin, device_seq, solves)
    }

    /// [`state`](Self::state) for a sample of a take with the flags of its header: a faulty sample is skipped, and a
    /// pen still waiting at the [last](Flags::LAST) sample is set down.
    pub fn state_in_take(
        &mut self,
        origin: Origin,
        device_seq: u64,
        event_ns: u64,
        sample: &StylusSample,
        flags: Flags,
    ) -> Option<BrushState> {
        let mut solves = match sample.fault() {
            None => self.follow(origin, event_ns, sample),
            Some(_) => Vec::new(),
        };
        if flags.has(Flags::LAST) {
            solves.extend(self.finish());
        }
        message(origin, device_seq, solves)
    }

    /// The solves of [`finish`](Self::finish) as one message of the take's last sample.
    pub fn finish_take(&mut self, origin: Origin, device_seq: u64) -> Option<BrushState> {
        let solves = self.finish();
        message(origin, device_seq, solves)
    }
}

/// The message of solves; absent where there are none.
fn message(origin: Origin, device_seq: u64, solves: Vec<Solve>) -> Option<BrushState> {
    (!solves.is_empty()).then_some(BrushState {
        device: origin.source,
        device_epoch: origin.epoch,
        device_seq,
        solves,
    })
}
