//! Solved states that wait for credit, cut into messages that fit.

use std::collections::VecDeque;

use maulstick_types::Flags;
use maulstick_types::brush::BrushState;

/// States in order of sending.
#[derive(Clone, Debug, Default)]
pub struct Outbox {
    waiting: VecDeque<(Flags, BrushState)>,
}

impl Outbox {
    /// Adds a state of any length; returns how many messages it takes. `first` and `last` are flags
    /// that its first and its last message have beside `flags`.
    pub fn push(&mut self, flags: Flags, first: Flags, last: Flags, state: BrushState) -> usize {
        let messages = state.messages(flags, first, last);
        let count = messages.len();
        self.waiting.extend(messages);
        count
    }

    /// The next message.
    pub fn pop(&mut self) -> Option<(Flags, BrushState)> {
        self.waiting.pop_front()
    }

    /// True if it is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }

    /// Messages that wait.
    #[must_use]
    pub fn len(&self) -> usize {
        self.waiting.len()
    }
}

#[cfg(test)]
mod tests {
    use maulstick_types::brush::{Contact, Solve};
    use maulstick_types::{Origin, Pose, encode};
    use proptest::prelude::*;

    use super::*;

    fn solve(number: u64, joints: usize, contacts: usize) -> Solve {
        let contact = Contact {
            spine: 0,
            joint: 1,
            force_n: 0.1,
        };
        Solve {
            event_ns: number,
            stroke: 1,
            surface: 0,
            flags: 0,
            pose: Pose::IDENTITY,
            zoom: 1.0,
            angles_rad: vec![[0.0; 2]; joints],
            contacts: vec![contact; contacts],
        }
    }

    proptest! {
        #[test]
        fn every_part_fits_and_none_is_lost(
            sizes in prop::collection::vec((0usize..60, 0usize..60), 0..400),
        ) {
            let solves: Vec<Solve> = sizes
                .iter()
                .enumerate()
                .map(|(i, (joints, contacts))| solve(i as u64, *joints, *contacts))
                .collect();
            let state = BrushState { device: 1, device_epoch: 2, device_seq: 3, solves };
            let mut outbox = Outbox::default();
            let count = outbox.push(Flags::REPLAY, Flags::FIRST, Flags::NONE, state);
            prop_assert_eq!(count, outbox.len());
            let origin = Origin { source: 1, epoch: 1 };
            let mut times = Vec::new();
            for place in 0..count {
                let (flags, part) = outbox.pop().expect("as counted");
                prop_assert!(encode(&origin, flags, 0, 0, 0, &part).is_ok());
                prop_assert_eq!(flags.has(Flags::FIRST), place == 0);
                prop_assert_eq!(flags.has(Flags::CONTINUES), place + 1 < count);
                times.extend(part.solves.iter().map(|solve| solve.event_ns));
            }
            prop_assert!(outbox.is_empty());
            prop_assert_eq!(times, (0..sizes.len() as u64).collect::<Vec<_>>());
        }
    }
}
