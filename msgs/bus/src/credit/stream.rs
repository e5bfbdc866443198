//! Reordering of one sender's messages.

use std::collections::{BTreeMap, VecDeque};

use maulstick_types::{Flags, Header};

use super::losses::Losses;
use super::{RING, WINDOW};
use crate::bus::Pending;
use crate::sender_arbiter::{SenderArbiter, Verdict};
use crate::typed::Received;

/// Messages that a stream keeps at most until they are taken; its sender's ring has the rest.
const KEPT: usize = 2 * RING;

/// Messages from the first up to, but not with, the second number are missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Gap {
    pub from: u64,
    pub seen: u64,
}

/// Result for a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Taken {
    /// New message.
    New,
    /// Repetition of the newest one in order.
    Again,
    /// Message that was there already, or for which there is no room.
    Known,
    /// Message of another sender.
    SetAside,
}

/// One sender since its start.
pub(super) struct Stream<M> {
    pub arbiter: SenderArbiter,
    pub epoch: u32,
    /// Number of the next message to hand on; `None` while the beginning of a replay is sought.
    next: Option<u64>,
    /// Time at which the newest message in order was sent, by its header, ns.
    sent_ns: u64,
    held: BTreeMap<u64, Received<M>>,
    /// In order, each with its place among those of all senders.
    pub ready: VecDeque<(u64, Received<M>)>,
    /// The newest questions for the gap; an answer to any of them will do.
    pub asked: VecDeque<Pending>,
    pub asked_ns: u64,
    /// Questions for the gap that begins at `next`.
    pub askings: u32,
    /// True if the newest message in order is played from a take.
    replay: bool,
    /// Messages given up as another sender was followed.
    pub lost: u64,
    /// Messages that did not come.
    pub losses: Losses,
}

impl<M> Stream<M> {
    pub(super) fn new(header: &Header, arrived_ns: u64) -> Self {
        Self::of(header, SenderArbiter::new(header, arrived_ns))
    }

    fn of(header: &Header, arbiter: SenderArbiter) -> Self {
        let replay = header.flags.has(Flags::REPLAY);
        let first = header.flags.has(Flags::FIRST);
        Self {
            arbiter,
            epoch: header.epoch,
            next: (first || !replay).then_some(header.seq),
            sent_ns: header.sent_ns,
            held: BTreeMap::new(),
            ready: VecDeque::new(),
            asked: VecDeque::new(),
            asked_ns: 0,
            askings: 0,
            replay,
            lost: 0,
            losses: Losses::default(),
        }
    }

    /// Adds a message as it was sent.
    pub(super) fn take(&mut self, received: Received<M>, ordered: &mut u64) -> Taken {
        let (header, arrived_ns) = (received.header, received.arrived_ns);
        let fits = self.fits(&header);
        let handed_on = self.ready.front().map(|(_, head)| head.header.seq);
        let verdict = self
            .arbiter
            .judge(&header, arrived_ns, fits, handed_on.or(self.next));
        match verdict {
            Verdict::Followed => {}
            Verdict::SetAside => return Taken::SetAside,
            Verdict::TakesOver(before) => self.take_over(&header, before),
        }
        if self.next == Some(header.seq.wrapping_add(1)) {
            return Taken::Again;
        }
        self.put(received, ordered)
    }

    /// Adds a message that was requested again.
    pub(super) fn fill(&mut self, received: Received<M>, ordered: &mut u64) -> Taken {
        if received.header.epoch != self.epoch || !self.fits(&received.header) {
            return Taken::SetAside;
        }
        self.put(received, ordered)
    }

    fn put(&mut self, received: Received<M>, ordered: &mut u64) -> Taken {
        let (seq, flags) = (received.header.seq, received.header.flags);
        if self.next.is_none() && flags.has(Flags::FIRST) {
            self.next = Some(seq);
            self.held = self.held.split_off(&seq);
        }
        let known = self.next.is_some_and(|next| seq < next);
        let full = self.held.len() + self.ready.len() >= KEPT && self.next != Some(seq);
        if known || full {
            return Taken::Known;
        }
        let taken = match self.held.insert(seq, received) {
            None => Taken::New,
            Some(_) => Taken::Known,
        };
        self.release(ordered);
        taken
    }

    /// True if a message may be of the sender that is followed: its number is no leap, and one that was numbered before
    /// the newest in order was sent before it.
    fn fits(&self, header: &Header) -> bool {
        match self.next {
            None => true,
            Some(next) if header.seq >= next => header.seq - next <= RING as u64,
            Some(_) => header.sent_ns <= self.sent_ns,
        }
    }

    /// Follows another sender. The rest of the previous stream is dropped; a take that was followed before continues
    /// where it was.
    fn take_over(&mut self, header: &Header, before: Option<u64>) {
        let from = if header.epoch == self.epoch {
            before.or(self.next)
        } else {
            before
        };
        let (lost, losses) = (self.lost, self.losses);
        *self = Self::of(header, self.arbiter.clone());
        (self.lost, self.losses) = (lost, losses);
        if self.replay {
            self.next = before.or(self.next);
        } else if let Some(from) = from {
            self.lost += header.seq.saturating_sub(from);
        }
    }

    /// Moves what is in order to `ready`.
    fn release(&mut self, ordered: &mut u64) {
        while let Some(next) = self.next {
            let Some(received) = self.held.remove(&next) else {
                return;
            };
            self.replay = received.header.flags.has(Flags::REPLAY);
            self.sent_ns = received.header.sent_ns;
            self.askings = 0;
            self.ready.push_back((*ordered, received));
            *ordered += 1;
            self.next = Some(next.wrapping_add(1));
        }
    }

    /// True if a take is played on either side of the gap: live and played messages of a brush are one stream.
    pub(super) fn is_replayed(&self) -> bool {
        let behind = self.held.first_key_value();
        self.replay || behind.is_some_and(|(_, held)| held.header.flags.has(Flags::REPLAY))
    }

    /// Messages missing before the first one in the buffer.
    pub(super) fn gap(&mut self, ordered: &mut u64) -> Option<Gap> {
        let (&seen, _) = self.held.first_key_value()?;
        let from = self.next.unwrap_or(seen.saturating_sub(WINDOW));
        if from == seen {
            self.next = Some(seen);
            self.release(ordered);
            return None;
        }
        Some(Gap { from, seen })
    }

    /// Goes on behind a gap; returns how many messages are lost in it.
    pub(super) fn give_up(&mut self, gap: Gap, ordered: &mut u64) -> u64 {
        self.next = Some(gap.seen);
        self.askings = 0;
        self.asked.clear();
        self.release(ordered);
        gap.seen - gap.from
    }

    /// True if nothing is lost by forgetting it: it is empty, and it is no take that pauses.
    pub(super) fn is_idle(&self) -> bool {
        self.ready.is_empty() && self.held.is_empty() && !self.replay
    }
}
