//! Where the journal of a recording breaks off: what comes then can be painted again only from another beginning.

use std::collections::{BTreeMap, BTreeSet};

use maulstick_streams::topic_pattern::matches;
use maulstick_types::paint::{Entry, JournalEntry, PaintConsumed};
use maulstick_types::{Header, decode, name_hash};

use super::on_the_way::{Brush, CREDIT};
use crate::listener::ReceivedMessage;
use crate::session_file::{JOURNAL, STATES};

/// Brushes that are remembered.
const BRUSHES: usize = 64;
/// Missing states of a brush that are remembered, and entries that name states which have not come yet.
const REMEMBERED: usize = 4096;

/// A break of the journal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Break {
    /// Something that the painting accepted did not reach this recorder.
    Gap,
    /// Another paint node goes on: after a crash at the newest place that was written, or in another painting.
    Restart,
}

/// The states of a brush.
#[derive(Debug, Default)]
struct States {
    /// One more than the newest number.
    next: u64,
    /// The newest of the missing numbers.
    missing: BTreeSet<u64>,
    /// Numbers that entries of the journal name and that have not come yet.
    named: Vec<[u64; 2]>,
    /// All below this number are painted.
    painted: u64,
}

/// Known part of the journal.
#[derive(Debug, Default)]
pub(super) struct JournalWatch {
    /// Epoch of the paint node.
    epoch: Option<u32>,
    /// Index of the next entry.
    next: Option<u64>,
    brushes: BTreeMap<Brush, States>,
}

impl JournalWatch {
    /// Adds a message: the break before it, if there is one.
    pub(super) fn note(&mut self, received: &ReceivedMessage) -> Option<Break> {
        let header = &received.message.header;
        let topic = received.topic.as_str();
        if matches(STATES, topic) {
            return self.state((header.source, header.epoch), header.seq);
        }
        if topic == CREDIT
            && let Ok((_, credit)) = decode::<PaintConsumed>(&received.bytes)
        {
            for own in credit.brushes {
                let states = self.brushes.get_mut(&(own.brush, own.epoch));
                states
                    .into_iter()
                    .for_each(|states| states.painted = own.next);
            }
        }
        if topic == JOURNAL
            && let Ok((header, entry)) = decode::<JournalEntry>(&received.bytes)
        {
            return self.entry(&header, &entry);
        }
        None
    }

    fn state(&mut self, brush: Brush, number: u64) -> Option<Break> {
        if !self.brushes.contains_key(&brush) && self.brushes.len() == BRUSHES {
            self.brushes.pop_first();
        }
        let states = self.brushes.entry(brush).or_insert_with(|| States {
            next: number,
            ..States::default()
        });
        if number < states.next {
            states.missing.remove(&number);
            return None;
        }
        let lost = states.next..number;
        let is_named = |[from, to]: &[u64; 2]| *from < lost.end && *to >= lost.start;
        let breaks = !lost.is_empty() && states.named.iter().any(is_named);
        states.missing.extend(lost.rev().take(REMEMBERED));
        while states.missing.len() > REMEMBERED {
            states.missing.pop_first();
        }
        states.next = number.saturating_add(1);
        states.named.retain(|[_, to]| *to > number);
        breaks.then_some(Break::Gap)
    }

    fn entry(&mut self, header: &Header, entry: &JournalEntry) -> Option<Break> {
        let known = self.epoch.replace(header.epoch);
        let after = entry.index.saturating_add(1);
        if known.is_some_and(|known| known != header.epoch) {
            self.next = Some(after);
            return Some(Break::Restart);
        }
        let expected = *self.next.get_or_insert(entry.index);
        self.next = Some(after.max(expected));
        let is_missing = entry.index > expected;
        let lacks_states = match &entry.entry {
            Entry::States {
                brush,
                epoch,
                from,
                to,
            } => self.names((name_hash(brush), *epoch), [*from, *to]),
            _ => false,
        };
        (is_missing || lacks_states).then_some(Break::Gap)
    }

    /// Notes the states that an entry names; true where some of them are known to be missing.
    fn names(&mut self, brush: Brush, [from, to]: [u64; 2]) -> bool {
        let Some(states) = self.brushes.get_mut(&brush).filter(|_| from <= to) else {
            return false;
        };
        let is_missing = states.missing.range(from..=to).next().is_some();
        states.missing = states.missing.split_off(&from);
        if to >= states.next && states.named.len() < REMEMBERED {
            states.named.push([from, to]);
        }
        is_missing
    }

    /// Brushes of whose states some are not painted, with the number of the next state.
    pub(super) fn unpainted(&self) -> BTreeMap<Brush, u64> {
        let brushes = self.brushes.iter();
        let waiting = brushes.filter(|(_, states)| states.painted < states.next);
        waiting
            .map(|(brush, states)| (*brush, states.next))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use maulstick_types::Flags;

    use super::*;

    const BRUSH: &str = "main";

    fn journal(epoch: u32) -> Header {
        Header {
            version: 1,
            schema: 0,
            source: 1,
            epoch,
            flags: Flags::NONE,
            length: 0,
            seq: 0,
            event_ns: 0,
            sent_ns: 0,
        }
    }

    fn tick(index: u64) -> JournalEntry {
        JournalEntry {
            index,
            entry: Entry::Tick { count: 1 },
        }
    }

    fn states(index: u64, from: u64, to: u64) -> JournalEntry {
        JournalEntry {
            index,
            entry: Entry::States {
                brush: BRUSH.into(),
                epoch: 7,
                from,
                to,
            },
        }
    }

    fn brush() -> Brush {
        (name_hash(BRUSH), 7)
    }

    #[test]
    fn a_paint_node_that_starts_anew_breaks_the_journal_wherever_it_goes_on() {
        for index in [3, 11, 40] {
            let mut watch = JournalWatch::default();
            assert_eq!(watch.entry(&journal(1), &tick(9)), None, "it begins here");
            assert_eq!(watch.entry(&journal(1), &tick(10)), None);
            let found = watch.entry(&journal(2), &tick(index));
            assert_eq!(found, Some(Break::Restart), "{index}");
            assert_eq!(watch.entry(&journal(2), &tick(index + 1)), None);
        }
    }

    #[test]
    fn an_entry_that_did_not_come_is_a_break_and_one_that_comes_twice_is_none() {
        let mut watch = JournalWatch::default();
        for index in [4, 5, 5, 4, 6] {
            assert_eq!(watch.entry(&journal(1), &tick(index)), None, "{index}");
        }
        assert_eq!(watch.entry(&journal(1), &tick(8)), Some(Break::Gap));
        assert_eq!(watch.entry(&journal(1), &tick(9)), None);
    }

    #[test]
    fn a_lost_state_is_a_break_if_the_painting_has_it() {
        let mut watch = JournalWatch::default();
        for number in [20, 21, 23, 26] {
            assert_eq!(watch.state(brush(), number), None);
        }
        let entry = |watch: &mut JournalWatch, entry| watch.entry(&journal(1), &entry);
        assert_eq!(entry(&mut watch, states(0, 12, 21)), None, "before it");
        assert_eq!(entry(&mut watch, states(1, 23, 23)), None, "22 is nowhere");
        assert_eq!(entry(&mut watch, states(2, 24, 26)), Some(Break::Gap));
        // The journal may be faster than the states.
        assert_eq!(entry(&mut watch, states(3, 27, 30)), None);
        assert_eq!(watch.state(brush(), 27), None);
        assert_eq!(watch.state(brush(), 29), Some(Break::Gap));
        assert_eq!(watch.state(brush(), 30), None);
    }

    #[test]
    fn states_that_wait_for_the_paint_are_known() {
        let mut watch = JournalWatch::default();
        watch.state(brush(), 5);
        assert_eq!(watch.unpainted(), BTreeMap::from([(brush(), 6)]));
        if let Some(states) = watch.brushes.get_mut(&brush()) {
            states.painted = 6;
        }
        assert_eq!(watch.unpainted(), BTreeMap::new());
    }
}
