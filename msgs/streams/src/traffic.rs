//! Rates, losses and delays of streams, counted message by message.
//!
//! A stream is what one sender sends on one topic from one start to the next. Its messages are numbered, so what is
//! missing is known exactly, however late some come.

use std::collections::{BTreeMap, BTreeSet};

use maulstick_types::Origin;
use maulstick_types::wire::header::Header;

/// Samples of one measure at most; beyond, each second one is dropped and the rest stand for two.
const MOST_SAMPLES: usize = 1 << 16;

/// Missing numbers of a stream that are remembered, should they still come.
const MOST_MISSING: usize = 4096;

/// A message that arrived.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arrived {
    /// Its header.
    pub header: Header,
    /// Header and body, bytes.
    pub bytes: usize,
    /// When, rig clock, ns.
    pub arrived_ns: u64,
}

/// Distribution of times, ns.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Distribution {
    samples: Vec<u64>,
    /// Interval of the samples that are kept: each `every`th.
    every: u64,
    skipped: u64,
    most: u64,
}

impl Distribution {
    fn add(&mut self, ns: u64) {
        self.most = self.most.max(ns);
        self.every = self.every.max(1);
        self.skipped += 1;
        if self.skipped < self.every {
            return;
        }
        self.skipped = 0;
        self.samples.push(ns);
        if self.samples.len() >= MOST_SAMPLES {
            let mut keep = false;
            self.samples.retain(|_| {
                keep = !keep;
                keep
            });
            self.every *= 2;
        }
    }

    /// The time that a share of them does not exceed, ns; 0 without any.
    #[must_use]
    pub fn quantile(&self, share: f64) -> u64 {
        let mut sorted = self.samples.clone();
        sorted.sort_unstable();
        let last = sorted.len().saturating_sub(1);
        let place = (share * last as f64).round() as usize;
        sorted.get(place.min(last)).copied().unwrap_or(0)
    }

    /// True if there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.samples.is_empty() && self.most == 0
    }

    /// The longest, ns.
    #[must_use]
    pub fn most(&self) -> u64 {
        self.most
    }
}

/// Counts and times of a stream.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Stream {
    /// Hash of its messages' field table.
    pub schema: u32,
    /// Messages.
    pub messages: u64,
    /// Bytes, headers among them.
    pub bytes: u64,
    /// Messages that are missing between the first and the last one heard.
    pub lost: u64,
    /// Messages that came twice, or after one that was sent later.
    pub disordered: u64,
    /// Time between two arrivals.
    pub gaps: Distribution,
    /// From sending to arrival.
    pub transit: Distribution,
    /// From sampling to arrival.
    pub age: Distribution,
    /// When the newest arrived, ns.
    last_ns: u64,
    sent: Sendings,
    /// One more than the highest number.
    next_seq: Option<u64>,
    /// True once one was heard that was sent since the listener came.
    has_begun: bool,
    /// The newest of the missing numbers.
    missing: BTreeSet<u64>,
}

/// Messages whose rate is measured, by their sender's times: what comes late comes in heaps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Sendings {
    messages: u64,
    first_ns: u64,
    last_ns: u64,
}

impl Sendings {
    fn add(&mut self, sent_ns: u64) {
        self.first_ns = match self.messages {
            0 => sent_ns,
            _ => self.first_ns.min(sent_ns),
        };
        self.last_ns = self.last_ns.max(sent_ns);
        self.messages += 1;
    }
}

impl Stream {
    fn add(&mut self, message: &Arrived, since_ns: u64) {
        let Arrived {
            header,
            bytes,
            arrived_ns,
        } = *message;
        if self.messages > 0 {
            self.gaps.add(arrived_ns.saturating_sub(self.last_ns));
        }
        self.schema = header.schema;
        self.messages += 1;
        self.bytes += bytes as u64;
        self.last_ns = arrived_ns;
        let is_since = header.sent_ns >= since_ns;
        if is_since {
            self.transit.add(arrived_ns.saturating_sub(header.sent_ns));
            self.age.add(arrived_ns.saturating_sub(header.event_ns));
        }
        let mut next_seq = self.next_seq.unwrap_or(header.seq);
        if is_since && !self.has_begun && header.seq > next_seq {
            // Messages so far were cached for late joiners; those between them were not sent to this listener.
            next_seq = header.seq;
            self.sent = Sendings::default();
        }
        self.has_begun |= is_since;
        if header.seq < next_seq {
            self.disordered += 1;
            // One that comes twice is counted once.
            if self.missing.remove(&header.seq) {
                self.lost -= 1;
                self.sent.add(header.sent_ns);
            }
            return;
        }
        self.sent.add(header.sent_ns);
        self.lost += header.seq - next_seq;
        self.missing
            .extend((next_seq..header.seq).rev().take(MOST_MISSING));
        while self.missing.len() > MOST_MISSING {
            self.missing.pop_first();
        }
        self.next_seq = Some(header.seq.saturating_add(1));
    }

    /// One that was missing, and came after the end: how late it is says nothing, for nobody looked.
    fn add_late(&mut self, message: &Arrived) {
        if self.missing.remove(&message.header.seq) {
            self.lost -= 1;
            self.messages += 1;
            self.bytes += message.bytes as u64;
            self.disordered += 1;
            self.sent.add(message.header.sent_ns);
        }
    }

    /// True while some are missing that may still come.
    #[must_use]
    pub fn lacks_some(&self) -> bool {
        !self.missing.is_empty()
    }

    /// Messages a second that arrived, between the first and the last by their sender's times; 0 of fewer than two.
    #[must_use]
    pub fn rate_hz(&self) -> f64 {
        let Sendings {
            messages,
            first_ns,
            last_ns,
        } = self.sent;
        let passed_s = last_ns.saturating_sub(first_ns) as f64 * 1e-9;
        if messages >= 2 && passed_s > 0.0 {
            (messages - 1) as f64 / passed_s
        } else {
            0.0
        }
    }
}

/// Streams by topic and sender.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Traffic {
    streams: BTreeMap<(String, Origin), Stream>,
    since_ns: u64,
}

impl Traffic {
    /// Of a listener who begins at this time, rig clock, ns: what was sent before was kept for late joiners, and its delay
    /// says nothing.
    #[must_use]
    pub fn since(since_ns: u64) -> Self {
        Self {
            since_ns,
            ..Self::default()
        }
    }

    /// Adds a message of a topic.
    pub fn add(&mut self, topic: &str, message: &Arrived) {
        let key = (topic.to_owned(), message.header.origin());
        let stream = self.streams.entry(key).or_default();
        stream.add(message, self.since_ns);
    }

    /// Takes in what waited when the time was over: it fills what is missing, and is not measured otherwise.
    pub fn add_late(&mut self, topic: &str, message: &Arrived) {
        let key = (topic.to_owned(), message.header.origin());
        let late = self.streams.get_mut(&key);
        let late = late.filter(|stream| stream.missing.contains(&message.header.seq));
        if let Some(stream) = late {
            stream.add_late(message);
        }
    }

    /// True while messages of some stream are missing that may still come.
    #[must_use]
    pub fn lacks_some(&self) -> bool {
        self.streams.values().any(Stream::lacks_some)
    }

    /// The streams, by topic.
    pub fn streams(&self) -> impl Iterator<Item = (&str, Origin, &Stream)> {
        let streams = self.streams.iter();
        streams.map(|((topic, origin), stream)| (topic.as_str(), *origin, stream))
    }
}

#[cfg(test)]
mod tests {
    use maulstick_types::Flags;

    use super::*;

    /// A message that was sampled, sent and heard at these times, ms.
    fn message(seq: u64, [event, sent, arrived]: [u64; 3]) -> Arrived {
        Arrived {
            header: Header {
                version: 1,
                schema: 9,
                source: 7,
                epoch: 1,
                flags: Flags::NONE,
                length: 52,
                seq,
                event_ns: event * 1_000_000,
                sent_ns: sent * 1_000_000,
            },
            bytes: 100,
            arrived_ns: arrived * 1_000_000,
        }
    }

    fn heard(messages: impl IntoIterator<Item = Arrived>) -> Stream {
        let mut traffic = Traffic::default();
        for message in messages {
            traffic.add("a", &message);
        }
        let (topic, _, stream) = traffic.streams().next().expect("one");
        assert_eq!(topic, "a");
        stream.clone()
    }

    /// A sender of 1000 messages 4 ms apart that drops each tenth, and delays each fiftieth by 30 ms.
    #[test]
    fn drops_and_delays_by_plan_are_counted_exactly() {
        let sent = (0..1000u64).filter(|seq| seq % 10 != 5);
        let mut plan: Vec<Arrived> = sent
            .map(|seq| {
                let delay = if seq % 50 == 0 { 30 } else { 1 };
                message(seq, [4 * seq, 4 * seq + 1, 4 * seq + 1 + delay])
            })
            .collect();
        plan.sort_by_key(|message| message.arrived_ns);
        let stream = heard(plan);
        assert_eq!((stream.messages, stream.lost), (900, 100));
        // Seven messages overtake each delayed one, of which one was dropped before.
        assert_eq!(stream.disordered, 20);
        assert_eq!(stream.transit.quantile(0.5), 1_000_000);
        assert_eq!(stream.transit.most(), 30_000_000);
        assert_eq!(stream.age.quantile(0.5), 2_000_000);
        assert_eq!(stream.gaps.most(), 8_000_000);
        assert_eq!(stream.bytes, 90_000);
    }

    #[test]
    fn a_rate_is_that_of_the_sender_however_late_and_in_heaps_it_comes() {
        // 490 a second, which arrive within .75 s after a pause of the machine.
        let at = |seq: u64| seq * 1000 / 490;
        let stream =
            heard((0..490).map(|seq| message(seq, [at(seq), at(seq), 1000 + 3 * seq / 2])));
        assert!(
            (stream.rate_hz() - 490.0).abs() < 1.0,
            "{}",
            stream.rate_hz()
        );
        // Half of them are lost.
        let half = (0..490).step_by(2).map(|seq| message(seq, [at(seq); 3]));
        let stream = heard(half);
        assert!(
            (stream.rate_hz() - 245.0).abs() < 1.0,
            "{}",
            stream.rate_hz()
        );
        // Each comes twice.
        let twice = (0..490).flat_map(|seq| [message(seq, [at(seq); 3]); 2]);
        let stream = heard(twice);
        assert!(
            (stream.rate_hz() - 490.0).abs() < 1.0,
            "{}",
            stream.rate_hz()
        );
    }

    #[test]
    fn what_was_sent_before_a_listener_came_is_not_lost() {
        let mut traffic = Traffic::since(50_000_000);
        // The newest value of before, then what is sent to this listener too.
        traffic.add("a", &message(100, [1, 2, 60]));
        for seq in 157..160 {
            traffic.add("a", &message(seq, [seq; 3]));
        }
        traffic.add("a", &message(161, [161; 3]));
        let (_, _, stream) = traffic.streams().next().expect("one");
        assert_eq!((stream.messages, stream.lost), (5, 1));
    }

    #[test]
    fn what_waits_at_the_end_is_late_and_not_lost() {
        let mut traffic = Traffic::default();
        for seq in [0, 1, 58] {
            traffic.add("a", &message(seq, [seq; 3]));
        }
        assert!(traffic.lacks_some());
        for seq in (2..58).chain(59..200) {
            traffic.add_late("a", &message(seq, [seq, seq, 300]));
        }
        let (_, _, stream) = traffic.streams().next().expect("one");
        assert_eq!((stream.messages, stream.lost), (59, 0));
        assert!(!traffic.lacks_some());
    }

    #[test]
    fn a_rate_is_that_of_what_arrives() {
        let stream = heard((0..101).map(|seq| message(seq, [10 * seq; 3])));
        assert!((stream.rate_hz() - 100.0).abs() < 1e-9);
        assert_eq!(heard([message(3, [0; 3])]).rate_hz(), 0.0);
        assert_eq!(
            heard([message(3, [0; 3])]).lost,
            0,
            "nobody heard it from its start"
        );
    }

    #[test]
    fn what_was_kept_for_late_joiners_has_no_delay() {
        let mut traffic = Traffic::since(50_000_000);
        traffic.add("a", &message(0, [1, 2, 60]));
        let delays = |traffic: &Traffic| {
            let (_, _, stream) = traffic.streams().next().expect("one");
            (
                stream.messages,
                stream.transit.quantile(0.5),
                stream.age.is_empty(),
            )
        };
        assert_eq!(delays(&traffic), (1, 0, true));
        traffic.add("a", &message(1, [61, 62, 64]));
        assert_eq!(delays(&traffic), (2, 2_000_000, false));
    }

    #[test]
    fn what_comes_twice_is_not_found_again() {
        let stream = heard([0, 1, 5, 5, 3, 3].map(|seq| message(seq, [0; 3])));
        assert_eq!(
            (stream.lost, stream.disordered),
            (2, 3),
            "2 and 4 are missing"
        );
        let far = heard([0, u64::MAX].map(|seq| message(seq, [0; 3])));
        assert_eq!(far.lost, u64::MAX - 1);
        assert_eq!(far.missing.len(), MOST_MISSING);
    }

    #[test]
    fn a_sender_that_starts_anew_is_another_stream() {
        let mut traffic = Traffic::default();
        let first = message(99, [0; 3]);
        let mut second = message(0, [1; 3]);
        second.header.epoch = 2;
        traffic.add("a", &first);
        traffic.add("a", &second);
        assert_eq!(traffic.streams().count(), 2);
        assert!(traffic.streams().all(|(_, _, stream)| stream.lost == 0));
    }

    #[test]
    fn a_long_measurement_keeps_its_quantiles_in_bounded_memory() {
        let mut times = Distribution::default();
        (0..1_000_000).for_each(|ns| times.add(ns));
        assert!(times.samples.len() < MOST_SAMPLES);
        for share in [0.1, 0.5, 0.99] {
            let off = times.quantile(share) as f64 - share * 1e6;
            assert!(off.abs() < 100.0, "{share}: {off}");
        }
        assert_eq!(times.most(), 999_999);
    }
}
