//! Brush states that are on their way to the paint when a file begins: they belong to the painting that it begins with.

use std::collections::BTreeMap;

use maulstick_streams::topic_pattern::matches;
use maulstick_types::decode;
use maulstick_types::paint::PaintConsumed;

use crate::listener::ReceivedMessage;
use crate::session_file::STATES;

/// Topic of the paint's credit.
pub(super) const CREDIT: &str = "paint/consumed";

/// A brush: the source and the epoch of its states.
pub(super) type Brush = (u32, u32);

/// Known states of each brush.
#[derive(Debug, Default)]
pub(super) struct OnTheWay {
    /// Number of the first state of each brush in the file.
    first: BTreeMap<Brush, u64>,
    /// All states of a brush below this number are painted.
    painted: BTreeMap<Brush, u64>,
}

/// Progress of the states before the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Painted {
    /// Not yet.
    No,
    /// Of some brush nothing is known.
    Unknown,
    /// All of them.
    Yes,
}

impl OnTheWay {
    /// State at the beginning of a file: brushes of whose states some were not painted then, with the number of the
    /// next one.
    pub(super) fn after(unpainted: BTreeMap<Brush, u64>) -> Self {
        Self {
            first: unpainted,
            ..Self::default()
        }
    }

    /// Adds a message of the file.
    pub(super) fn note(&mut self, received: &ReceivedMessage) {
        let header = &received.message.header;
        if matches(STATES, &received.topic) {
            self.state((header.source, header.epoch), header.seq);
        } else if received.topic == CREDIT
            && let Ok((_, credit)) = decode::<PaintConsumed>(&received.bytes)
        {
            let brushes = credit.brushes.iter();
            self.painted
                .extend(brushes.map(|own| ((own.brush, own.epoch), own.next)));
        }
    }

    fn state(&mut self, brush: Brush, number: u64) {
        self.first.entry(brush).or_insert(number);
    }

    /// Progress of all that was sent before the file.
    pub(super) fn painted(&self) -> Painted {
        let mut states = self.first.iter();
        let lacks = |(brush, first): (&Brush, &u64)| {
            self.painted.get(brush).is_none_or(|next| next < first)
        };
        let idle = |brush: &Brush| !self.first.contains_key(brush);
        match (states.any(lacks), self.painted.keys().any(idle)) {
            (true, _) => Painted::No,
            (false, true) => Painted::Unknown,
            (false, false) if self.first.is_empty() => Painted::Unknown,
            (false, false) => Painted::Yes,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_sent_before_the_file_is_painted_once_the_credit_covers_it() {
        let (main, flat) = ((1, 7), (2, 9));
        let mut states = OnTheWay::default();
        assert_eq!(states.painted(), Painted::Unknown);
        states.state(main, 40);
        states.state(main, 41);
        assert_eq!(states.painted(), Painted::No, "no credit yet");
        states.painted.insert(main, 39);
        assert_eq!(states.painted(), Painted::No, "39 is not painted");
        states.painted.insert(main, 40);
        assert_eq!(states.painted(), Painted::Yes);
        states.painted.insert(flat, 3);
        assert_eq!(states.painted(), Painted::Unknown, "another brush rests");
        states.state((2, 10), 0);
        assert_eq!(states.painted(), Painted::No, "another epoch of it");
    }
}
