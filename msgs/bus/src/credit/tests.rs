//! A stream arrives whole and in order, whatever the network loses and reorders.

use maulstick_types::stylus::StylusSample;
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Flags, Message as _, Origin, decode, encode};
use proptest::prelude::*;

use super::{CreditReceiver, CreditSender, Stamp};
use crate::bus::{Bus, Qos};
use crate::inbox::Wake;
use crate::memory::{Faults, MemoryBus, MemoryNet};
use crate::typed::Received;

const STEP_NS: u64 = 1_000_000;

/// Sends `total` samples under credit; the receiver consumes each. Returns the numbers received.
fn run(seed: u64, faults: Faults, total: u64, flags: Flags) -> Vec<u64> {
    let net = MemoryNet::new(seed, 1_000_000_000, faults);
    let (bus, topics, wake) = (net.bus(), Topics::new("t"), Wake::new());
    let topic = topics.sample("d");
    let origin = Origin {
        source: 1,
        epoch: 7,
    };
    let mut sender =
        CreditSender::<StylusSample>::new(&bus, &topics, &topic, origin, &wake).expect("a sender");
    let mut receiver =
        CreditReceiver::<StylusSample>::new(&bus, &topics, &topic, origin, &wake).expect("one");
    let mut got = Vec::new();
    for _ in 0..200_000 {
        let now_ns = bus.now_ns();
        while sender.next_seq() < total && sender.has_credit() {
            let stamp = Stamp {
                now_ns,
                event_ns: now_ns,
            };
            sender
                .send(flags, stamp, &StylusSample::away())
                .expect("sent");
        }
        receiver.poll(&bus).expect("polled");
        while let Some(received) = receiver.pop() {
            got.push(received.header.seq);
        }
        // Credit travels over the same bad network: lost with the same chance, sent again when
        // the sender repeats itself.
        if !receiver.unheard().is_empty() || now_ns % (5 * STEP_NS) == 0 {
            sender.consumed(7, got.last().map_or(0, |last| last + 1), now_ns);
        }
        sender.serve(now_ns).expect("served");
        if got.len() as u64 == total && sender.outstanding() == 0 {
            break;
        }
        net.advance(STEP_NS);
    }
    assert_eq!(receiver.counts().lost, 0);
    got
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn arrives_whole_and_in_order(
        seed in any::<u64>(),
        loss in 0.0..0.4f64,
        delay_ms in 0u64..30,
        total in 1u64..600,
    ) {
        let faults = Faults { loss, delay_ns: delay_ms * 1_000_000 };
        prop_assert_eq!(run(seed, faults, total, Flags::REPLAY), (0..total).collect::<Vec<_>>());
    }
}

/// A device's stream on a network that loses everything until it is set otherwise.
struct Stream {
    net: MemoryNet,
    bus: MemoryBus,
    sender: CreditSender<StylusSample>,
    receiver: CreditReceiver<StylusSample>,
}

const ORIGIN: Origin = Origin {
    source: 1,
    epoch: 7,
};
const STAMP: Stamp = Stamp {
    now_ns: 0,
    event_ns: 0,
};

fn stream() -> Stream {
    let lost = Faults {
        loss: 1.0,
        delay_ns: 0,
    };
    let net = MemoryNet::new(3, 0, lost);
    let (bus, topics, wake) = (net.bus(), Topics::new("t"), Wake::new());
    let topic = topics.sample("d");
    let sender = CreditSender::new(&bus, &topics, &topic, ORIGIN, &wake).expect("a sender");
    let receiver = CreditReceiver::new(&bus, &topics, &topics.sample("*"), ORIGIN, &wake);
    Stream {
        receiver: receiver.expect("a receiver"),
        net,
        bus,
        sender,
    }
}

impl Stream {
    fn got(&mut self) -> Vec<u64> {
        std::iter::from_fn(|| self.receiver.pop())
            .map(|received| received.header.seq)
            .collect()
    }

    /// Sends one message of any device as it would come over the bus.
    fn put(&self, device: &str, origin: Origin, flags: Flags, seq: u64, sent_ns: u64) {
        self.net.set_faults(Faults::default());
        let away = StylusSample::away();
        let bytes = encode(&origin, flags, seq, sent_ns, sent_ns, &away).expect("encoded");
        let topic = Topics::new("t").sample(device);
        let publisher = self.bus.publisher(&topic, Qos::RealTime);
        publisher.expect("declared").put(bytes).expect("sent");
        self.net.advance(STEP_NS);
    }
}

#[test]
fn a_replay_that_is_joined_late_is_sought_from_its_first_message() {
    let mut stream = stream();
    for _ in 0..40 {
        stream
            .sender
            .send(Flags::REPLAY, STAMP, &StylusSample::away())
            .expect("sent");
    }
    stream.net.set_faults(Faults::default());
    for step in 0..300 {
        stream.sender.serve(step * STEP_NS).expect("served");
        stream.net.advance(STEP_NS);
        stream.receiver.poll(&stream.bus).expect("polled");
    }
    assert_eq!(stream.got(), (0..40).collect::<Vec<_>>());
}

#[test]
fn a_live_gap_that_nobody_can_fill_is_given_up_and_counted() {
    let mut stream = stream();
    for seq in [0, 2] {
        stream.put("d", ORIGIN, Flags::NONE, seq, 0);
    }
    for _ in 0..3000 {
        stream.receiver.poll(&stream.bus).expect("polled");
        stream.net.advance(STEP_NS);
    }
    assert_eq!(stream.got(), vec![0, 2]);
    assert_eq!(stream.receiver.counts().lost, 1);
}

/// A live stream continues within three looks; one that is replayed waits, for a painting with a hole is another.
#[test]
fn a_device_that_answers_for_no_gap_is_not_waited_for() {
    for (flags, expected) in [(Flags::NONE, vec![0, 2]), (Flags::REPLAY, vec![0])] {
        let mut stream = stream();
        for seq in [0, 2] {
            stream.put("foreign", ORIGIN, flags, seq, 0);
        }
        for _ in 0..3 {
            stream.receiver.poll(&stream.bus).expect("polled");
            stream.net.advance(STEP_NS);
        }
        assert_eq!(stream.got(), expected, "{flags:?}");
        assert_eq!(stream.receiver.counts().lost, expected.len() as u64 - 1);
    }
}

#[test]
fn two_devices_of_one_source_do_not_disturb_each_other() {
    let mut stream = stream();
    let other = Origin { epoch: 8, ..ORIGIN };
    for seq in 0..4 {
        stream.put("d", ORIGIN, Flags::NONE, seq, 1);
        stream.put("e", other, Flags::NONE, seq, 1);
    }
    stream.receiver.poll(&stream.bus).expect("polled");
    assert_eq!(stream.got(), vec![0, 0, 1, 1, 2, 2, 3, 3]);
}

#[test]
fn a_late_message_of_an_earlier_epoch_ends_nothing() {
    let mut stream = stream();
    let again = Origin { epoch: 8, ..ORIGIN };
    stream.put("d", ORIGIN, Flags::FIRST, 0, 1);
    stream.put("d", again, Flags::FIRST, 0, 10);
    stream.put("d", again, Flags::NONE, 1, 11);
    stream.put("d", ORIGIN, Flags::NONE, 1, 2);
    stream.put("d", again, Flags::NONE, 2, 12);
    stream.receiver.poll(&stream.bus).expect("polled");
    let got: Vec<(u32, u64)> = std::iter::from_fn(|| stream.receiver.pop())
        .map(|received| (received.header.epoch, received.header.seq))
        .collect();
    assert_eq!(got, vec![(8, 0), (8, 1), (8, 2)]);
}

#[test]
fn a_late_message_of_an_epoch_never_seen_ends_nothing_either() {
    let mut stream = stream();
    let again = Origin { epoch: 8, ..ORIGIN };
    stream.put("d", again, Flags::NONE, 5, 10);
    stream.put("d", ORIGIN, Flags::NONE, 9, 2);
    stream.put("d", again, Flags::NONE, 6, 11);
    stream.receiver.poll(&stream.bus).expect("polled");
    assert_eq!(stream.got(), vec![5, 6]);
}

#[test]
fn a_message_that_may_not_go_holds_up_its_own_sender_alone() {
    let mut stream = stream();
    for seq in 0..3 {
        stream.put("d", ORIGIN, Flags::NONE, seq, 1);
        stream.put("e", ORIGIN, Flags::NONE, seq + 10, 1);
    }
    stream.receiver.poll(&stream.bus).expect("polled");
    let others = |received: &Received<StylusSample>| received.key.ends_with("e/sample");
    let got: Vec<u64> = std::iter::from_fn(|| stream.receiver.pop_where(others))
        .map(|received| received.header.seq)
        .collect();
    assert_eq!(got, vec![10, 11, 12]);
    assert_eq!(stream.got(), vec![0, 1, 2]);
}

#[test]
fn a_take_in_a_stream_that_began_live_has_no_hole() {
    let mut stream = stream();
    stream.put("d", ORIGIN, Flags::NONE, 0, 0);
    stream.put("d", ORIGIN, Flags::REPLAY, 2, 0);
    for _ in 0..3000 {
        stream.receiver.poll(&stream.bus).expect("polled");
        stream.net.advance(STEP_NS);
    }
    assert_eq!((stream.got(), stream.receiver.counts().lost), (vec![0], 0));
    stream.put("d", ORIGIN, Flags::REPLAY, 1, 0);
    stream.receiver.poll(&stream.bus).expect("polled");
    assert_eq!(stream.got(), vec![1, 2]);
}

#[test]
fn a_gap_that_is_being_filled_is_not_given_up() {
    let mut stream = stream();
    stream.put("d", ORIGIN, Flags::NONE, 0, 0);
    stream.put("d", ORIGIN, Flags::NONE, 50, 0);
    // One of the missing messages comes each half of the patience.
    for seq in 1..50 {
        for _ in 0..500 {
            stream.receiver.poll(&stream.bus).expect("polled");
            stream.net.advance(STEP_NS);
        }
        stream.put("d", ORIGIN, Flags::NONE, seq, 0);
    }
    stream.receiver.poll(&stream.bus).expect("polled");
    assert_eq!(stream.got(), (0..51).collect::<Vec<_>>());
    assert_eq!(stream.receiver.counts().lost, 0);
}

#[test]
fn a_message_that_is_too_long_is_dropped_and_the_next_one_has_its_number() {
    use maulstick_types::brush::BrushDef;
    let net = MemoryNet::new(1, 0, Faults::default());
    let (bus, wake) = (net.bus(), Wake::new());
    let topic = "t/brush/main/def";
    let mut sender =
        crate::typed::Sender::new(&bus, topic, Qos::Control, ORIGIN).expect("a sender");
    let queue = crate::Queue::Ring(8);
    let heard = bus
        .subscribe(topic, Qos::Control, queue, &wake)
        .expect("subscribed");
    let long = BrushDef {
        brush: "main".to_owned(),
        toml: "x".repeat(BrushDef::MAX_BYTES),
        hash: 0,
        head_length_m: 0.03,
    };
    let short = BrushDef {
        toml: String::new(),
        ..long.clone()
    };
    for def in [&long, &short, &long, &short] {
        sender.send(0, 0, def).expect("no message ends its sender");
    }
    net.advance(1);
    let numbers = std::iter::from_fn(|| heard.try_recv())
        .map(|arrival| decode::<BrushDef>(&arrival.bytes).expect("whole").0.seq);
    assert_eq!(numbers.collect::<Vec<_>>(), [0, 1]);
}
