//! A stream arrives whole and in order, whatever the network loses and reorders.

use maulstick_types::stylus::StylusSample;
use maulstick_types::topics::Topics;
use maulstick_types::{Flags, Origin};
use proptest::prelude::*;

use super::{CreditReceiver, CreditSender, Stamp};
use crate::bus::Bus;
use crate::inbox::Wake;
use crate::memory::{Faults, MemoryNet};

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
        // Credit travels over the same bad network: lost with the same chance, told again when
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

#[test]
fn a_replay_that_is_joined_late_is_sought_from_its_first_message() {
    let net = MemoryNet::new(
        3,
        0,
        Faults {
            loss: 1.0,
            delay_ns: 0,
        },
    );
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
    for _ in 0..40 {
        let stamp = Stamp {
            now_ns: 0,
            event_ns: 0,
        };
        sender
            .send(Flags::REPLAY, stamp, &StylusSample::away())
            .expect("sent");
    }
    net.set_faults(Faults::default());
    for step in 0..300 {
        sender.serve(step * STEP_NS).expect("served");
        net.advance(STEP_NS);
        receiver.poll(&bus).expect("polled");
    }
    let got: Vec<u64> = std::iter::from_fn(|| receiver.pop())
        .map(|r| r.header.seq)
        .collect();
    assert_eq!(got, (0..40).collect::<Vec<_>>());
}

#[test]
fn a_live_gap_that_nobody_can_fill_is_given_up_and_counted() {
    let net = MemoryNet::new(
        3,
        0,
        Faults {
            loss: 1.0,
            delay_ns: 0,
        },
    );
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
    let stamp = Stamp {
        now_ns: 0,
        event_ns: 0,
    };
    let away = StylusSample::away();
    let send = |sender: &mut CreditSender<_>, loss: f64| {
        net.set_faults(Faults { loss, delay_ns: 0 });
        sender.send(Flags::NONE, stamp, &away).expect("sent");
        net.advance(STEP_NS);
    };
    send(&mut sender, 0.0);
    send(&mut sender, 1.0);
    send(&mut sender, 0.0);
    drop(sender);
    for _ in 0..3000 {
        receiver.poll(&bus).expect("polled");
        net.advance(STEP_NS);
    }
    let got: Vec<u64> = std::iter::from_fn(|| receiver.pop())
        .map(|r| r.header.seq)
        .collect();
    assert_eq!(got, vec![0, 2]);
    assert_eq!(receiver.counts().lost, 1);
}
