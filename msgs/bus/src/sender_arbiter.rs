//! Choice among several senders on one stream.
//!
//! A stream is one sender's, but nothing keeps a second one away: another copy of a program, a stray message, a program
//! that counts wrongly. Of senders that differ in their epoch the one that started last is followed; any other is set
//! aside, and followed again once the newer one is silent. Within one epoch, where numbers leap, the stream that is
//! followed stays until it is silent.

use std::collections::BTreeSet;

use maulstick_types::{Flags, Header};

/// Time without a message after which a sender is silent, and time of messages without a pause after which it is no
/// stray, ns.
pub const SILENCE_NS: u64 = 500_000_000;
/// Largest number of senders set aside that are remembered for each stream.
const REMEMBERED: usize = 8;

/// One sender.
#[derive(Clone, Copy, Debug)]
struct Sender {
    epoch: u32,
    /// Time at which its first message was sent, rig clock, ns.
    began_ns: u64,
    /// Time at which its newest message was sent, ns.
    sent_ns: u64,
    /// Start of its messages without a pause, ns.
    since_ns: u64,
    /// Time of its last message, ns.
    heard_ns: u64,
    /// Number of its next message, if it was followed.
    next: Option<u64>,
}

/// Decision about a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Its sender is followed.
    Followed,
    /// Its sender is followed from now on: the number that it had come to, if it was followed before.
    TakesOver(Option<u64>),
    /// Its sender is not followed.
    SetAside,
}

/// The senders of one stream.
#[derive(Clone, Debug)]
pub struct SenderArbiter {
    followed: Sender,
    others: Vec<Sender>,
}

/// Time at which a message was sent, ns; at the latest that of its arrival.
fn sent_ns(header: &Header, arrived_ns: u64) -> u64 {
    header.sent_ns.min(arrived_ns)
}

impl Sender {
    fn of(header: &Header, arrived_ns: u64) -> Self {
        let sent_ns = sent_ns(header, arrived_ns);
        Self {
            epoch: header.epoch,
            began_ns: sent_ns,
            sent_ns,
            since_ns: arrived_ns,
            heard_ns: arrived_ns,
            next: None,
        }
    }

    fn note(&mut self, header: &Header, arrived_ns: u64) {
        if self.is_silent(arrived_ns) {
            self.since_ns = arrived_ns;
        }
        self.heard_ns = self.heard_ns.max(arrived_ns);
        self.sent_ns = self.sent_ns.max(sent_ns(header, arrived_ns));
    }

    fn is_silent(&self, now_ns: u64) -> bool {
        now_ns >= self.heard_ns.saturating_add(SILENCE_NS)
    }

    /// True if it was heard for long enough to be no stray message.
    fn lasts(&self) -> bool {
        self.heard_ns >= self.since_ns.saturating_add(SILENCE_NS)
    }
}

impl SenderArbiter {
    /// Follows the sender of the first message.
    #[must_use]
    pub fn new(first: &Header, arrived_ns: u64) -> Self {
        Self {
            followed: Sender::of(first, arrived_ns),
            others: Vec::new(),
        }
    }

    /// Time of the last message of the followed sender, ns.
    #[must_use]
    pub fn heard_ns(&self) -> u64 {
        self.followed.heard_ns
    }

    /// Judges a message. `fits` says whether its number goes with the stream that is followed, `next` is the
    /// number that this one has come to.
    pub fn judge(
        &mut self,
        header: &Header,
        arrived_ns: u64,
        fits: bool,
        next: Option<u64>,
    ) -> Verdict {
        let same = header.epoch == self.followed.epoch;
        if same && fits {
            self.followed.note(header, arrived_ns);
            return Verdict::Followed;
        }
        let place = self.place(header, arrived_ns);
        let (followed, other) = (&self.followed, &self.others[place]);
        let silent = followed.is_silent(arrived_ns);
        let takes_over = if !same && other.began_ns > followed.began_ns {
            silent || other.lasts() || header.flags.has(Flags::FIRST)
        } else {
            // A message sent before the newest one of the followed stream is merely late.
            silent && (sent_ns(header, arrived_ns) >= followed.sent_ns || other.lasts())
        };
        if !takes_over {
            return Verdict::SetAside;
        }
        let before = other.next;
        std::mem::swap(&mut self.followed, &mut self.others[place]);
        self.others[place].next = next;
        Verdict::TakesOver(before)
    }

    /// Index of a message's sender among the others; the one that was silent for longest makes room.
    fn place(&mut self, header: &Header, arrived_ns: u64) -> usize {
        let known = |other: &Sender| other.epoch == header.epoch;
        if let Some(place) = self.others.iter().position(known) {
            self.others[place].note(header, arrived_ns);
            return place;
        }
        if self.others.len() == REMEMBERED {
            let oldest = (0..REMEMBERED).min_by_key(|place| self.others[*place].heard_ns);
            self.others.swap_remove(oldest.unwrap_or_default());
        }
        self.others.push(Sender::of(header, arrived_ns));
        self.others.len() - 1
    }

    /// True if a message shows that there are two senders: a late one of a sender that has ended does not.
    #[must_use]
    pub fn is_rival(&self, header: &Header, arrived_ns: u64) -> bool {
        sent_ns(header, arrived_ns) >= self.followed.began_ns
    }
}

/// Remarks already reported; each is reported once, and no more than 256 in all.
#[derive(Clone, Debug, Default)]
pub struct Once(BTreeSet<String>);

impl Once {
    /// True if this is to be reported: it was not yet.
    pub fn say(&mut self, what: &str) -> bool {
        self.0.len() < 256 && self.0.insert(what.to_owned())
    }
}

#[cfg(test)]
mod tests;
