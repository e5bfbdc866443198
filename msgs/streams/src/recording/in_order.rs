//! Messages in order of time, wherever they stand in a file.

use std::collections::BTreeMap;

use super::RecordedMessage;

/// Most bytes of messages that wait for earlier ones. A recorder's file has none that wait for long; of one whose stretches
/// all overlap, or whose index states no true times, the earliest that are known come first.
const MOST_WAITING: usize = 64 << 20;

/// Messages that wait for earlier ones.
#[derive(Debug, Default)]
pub(super) struct InOrder {
    /// By time, place of the stretch, and place in it.
    waiting: BTreeMap<(u64, u64, u64), RecordedMessage>,
    bytes: usize,
    added: u64,
}

impl InOrder {
    /// Adds a message of the stretch at a place of the file.
    pub(super) fn add(&mut self, at: u64, message: RecordedMessage) {
        self.bytes += message.bytes.len();
        self.added += 1;
        let key = (message.arrived_ns, at, self.added);
        self.waiting.insert(key, message);
    }

    /// Has `each` see those that come before a stretch that begins at a time and place; false once it says so.
    pub(super) fn take_before(
        &mut self,
        (first_ns, at): (u64, u64),
        each: &mut dyn FnMut(RecordedMessage) -> bool,
    ) -> bool {
        while let Some(next) = self.waiting.first_entry() {
            if *next.key() > (first_ns, at, 0) && self.bytes <= MOST_WAITING {
                return true;
            }
            let message = next.remove();
            self.bytes -= message.bytes.len();
            if !each(message) {
                return false;
            }
        }
        true
    }

    /// Has `each` see all others, until it says false.
    pub(super) fn take_rest(self, each: &mut dyn FnMut(RecordedMessage) -> bool) {
        self.waiting.into_values().all(each);
    }
}
