//! A second sender mutes no stream for good, whatever it sends.

use maulstick_types::stylus::StylusSample;
use maulstick_types::wire::topics::Topics;
use maulstick_types::{Flags, Origin, encode};
use proptest::prelude::*;

use super::{CreditReceiver, CreditSender, Stamp};
use crate::bus::{Bus, Qos};
use crate::inbox::Wake;
use crate::memory::{Faults, MemoryBus, MemoryNet};

const STEP_NS: u64 = 5_000_000;
const SECOND: u64 = 1_000_000_000 / STEP_NS;
const DEVICE: Origin = Origin {
    source: 1,
    epoch: 7,
};
const OTHER: Origin = Origin {
    source: 1,
    epoch: 8,
};

/// A device that sends 200 samples a second, and who follows it.
struct Rig {
    net: MemoryNet,
    bus: MemoryBus,
    device: CreditSender<StylusSample>,
    receiver: CreditReceiver<StylusSample>,
    got: Vec<(u32, u64)>,
}

/// A message of somebody else.
#[derive(Clone, Copy, Debug)]
struct Stray {
    origin: Origin,
    flags: Flags,
    seq: u64,
}

impl Rig {
    fn new(seed: u64, loss: f64) -> Self {
        let faults = Faults { loss, delay_ns: 0 };
        let net = MemoryNet::new(seed, 1_000_000_000_000, faults);
        let (bus, topics, wake) = (net.bus(), Topics::new("t"), Wake::new());
        let topic = topics.sample("d");
        let device = CreditSender::new(&bus, &topics, &topic, DEVICE, &wake).expect("a device");
        let receiver =
            CreditReceiver::new(&bus, &topics, &topics.sample("*"), DEVICE, &wake).expect("one");
        Self {
            net,
            bus,
            device,
            receiver,
            got: Vec::new(),
        }
    }

    /// Lets the device send, or pause, for so many steps.
    fn run(&mut self, steps: u64, sends: bool) {
        for _ in 0..steps {
            let now_ns = self.bus.now_ns();
            let (stamp, away) = (
                Stamp {
                    now_ns,
                    event_ns: now_ns,
                },
                StylusSample::away(),
            );
            self.device.reset_credit();
            if sends {
                self.device.send(Flags::NONE, stamp, &away).expect("sent");
            }
            self.device.serve(now_ns).expect("served");
            self.net.advance(STEP_NS);
            self.receiver.poll(&self.bus).expect("polled");
            while let Some(received) = self.receiver.pop() {
                let header = received.header;
                self.got.push((header.epoch, header.seq));
            }
        }
    }

    fn stray(&self, stray: Stray) {
        let now_ns = self.bus.now_ns();
        let bytes = encode(
            &stray.origin,
            stray.flags,
            stray.seq,
            now_ns,
            now_ns,
            &StylusSample::away(),
        );
        let topic = Topics::new("t").sample("d");
        let publisher = self.bus.publisher(&topic, Qos::RealTime).expect("one");
        publisher.put(bytes.expect("encoded")).expect("sent");
    }

    /// True if the device's newest sample was handed on.
    fn hears_the_device(&self) -> bool {
        self.got.last() == Some(&(DEVICE.epoch, self.device.next_seq() - 1))
    }
}

#[test]
fn one_message_of_another_epoch_takes_nothing_from_a_device() {
    let mut rig = Rig::new(1, 0.0);
    rig.run(SECOND, true);
    rig.stray(Stray {
        origin: OTHER,
        flags: Flags::NONE,
        seq: 5,
    });
    rig.run(SECOND, true);
    let sent: Vec<(u32, u64)> = (0..2 * SECOND).map(|seq| (DEVICE.epoch, seq)).collect();
    assert_eq!(rig.got, sent);
    assert_eq!(rig.receiver.counts().refused, 1);
}

#[test]
fn a_second_copy_that_starts_later_is_followed_and_the_first_is_back_when_it_ends() {
    let mut rig = Rig::new(1, 0.0);
    rig.run(SECOND, true);
    for seq in 0..2 * SECOND {
        rig.stray(Stray {
            origin: OTHER,
            flags: Flags::NONE,
            seq,
        });
        rig.run(1, true);
    }
    assert_eq!(rig.got.last(), Some(&(OTHER.epoch, 2 * SECOND - 1)));
    rig.run(SECOND, true);
    assert!(rig.hears_the_device());
}

#[test]
fn a_leap_of_a_million_mutes_nobody() {
    for (leap, flags) in [
        (1_000_000, Flags::NONE),
        (1_000_000, Flags::REPLAY),
        (2000, Flags::NONE),
    ] {
        let mut rig = Rig::new(1, 0.0);
        rig.run(SECOND, true);
        rig.stray(Stray {
            origin: DEVICE,
            flags,
            seq: rig.device.next_seq() + leap,
        });
        // The leap is most of a danger while the device itself says nothing.
        rig.run(3 * SECOND, false);
        rig.run(SECOND, true);
        assert!(
            rig.hears_the_device(),
            "{leap} {flags:?}: {:?}",
            rig.got.last()
        );
    }
}

#[test]
fn a_take_that_was_interrupted_goes_on_where_it_was() {
    let mut rig = Rig::new(1, 0.0);
    let mut sent = 0;
    let mut play = |rig: &mut Rig, count: u64| {
        for _ in 0..count {
            rig.stray(Stray {
                origin: DEVICE,
                flags: if sent == 0 {
                    Flags::REPLAY.with(Flags::FIRST)
                } else {
                    Flags::REPLAY
                },
                seq: sent,
            });
            sent += 1;
            rig.run(1, false);
        }
    };
    play(&mut rig, 50);
    rig.stray(Stray {
        origin: OTHER,
        flags: Flags::FIRST,
        seq: 0,
    });
    rig.run(2 * SECOND, false);
    play(&mut rig, 50);
    let take = rig.got.iter().filter(|(epoch, _)| *epoch == DEVICE.epoch);
    let take: Vec<u64> = take.map(|(_, seq)| *seq).collect();
    assert_eq!(take, (0..100).collect::<Vec<_>>());
}

#[test]
fn senders_are_bounded_and_forgotten() {
    let mut rig = Rig::new(1, 0.0);
    rig.run(SECOND, true);
    for source in 100..1100 {
        rig.stray(Stray {
            origin: Origin { source, epoch: 1 },
            flags: Flags::NONE,
            seq: 0,
        });
        rig.run(1, true);
    }
    assert!(rig.hears_the_device());
    assert!(rig.receiver.senders() <= 64, "{}", rig.receiver.senders());
    rig.net.advance(601 * SECOND * STEP_NS);
    rig.run(1, true);
    assert_eq!(rig.receiver.senders(), 1);
    assert!(rig.hears_the_device());
}

#[test]
fn five_seconds_of_a_receiver_that_stood_still_are_made_up_for() {
    let mut rig = Rig::new(1, 0.0);
    rig.run(10, true);
    // Nothing arrives at a process that is stopped: a device of 1 kHz sends on.
    let gone = Faults {
        loss: 1.0,
        delay_ns: 0,
    };
    rig.net.set_faults(gone);
    for _ in 0..5000 {
        let now_ns = rig.bus.now_ns();
        let stamp = Stamp {
            now_ns,
            event_ns: now_ns,
        };
        rig.device.reset_credit();
        rig.device
            .send(Flags::NONE, stamp, &StylusSample::away())
            .expect("sent");
        rig.net.advance(1_000_000);
    }
    rig.net.set_faults(Faults::default());
    rig.run(SECOND, true);
    assert!(rig.hears_the_device());
    assert_eq!(rig.receiver.counts().lost, 0);
    let all = rig.device.next_seq();
    assert_eq!(rig.got.len() as u64, all);
}

/// Messages of a stranger: epochs, numbers and flags of all kinds.
fn strays() -> impl Strategy<Value = Vec<(Stray, u64, bool)>> {
    let origin = prop_oneof![
        Just(DEVICE),
        Just(OTHER),
        any::<u32>().prop_map(|epoch| Origin { source: 1, epoch })
    ];
    let seq = prop_oneof![0..2000u64, 1_000_000..1_000_100u64, any::<u64>()];
    let flags = prop_oneof![
        4 => Just(Flags::NONE),
        1 => Just(Flags::FIRST),
        1 => Just(Flags::REPLAY),
        1 => Just(Flags::REPLAY.with(Flags::FIRST)),
    ];
    let stray = (origin, flags, seq).prop_map(|(origin, flags, seq)| Stray { origin, flags, seq });
    // After each so many steps, in which the device sends or pauses.
    prop::collection::vec((stray, 0..150u64, any::<bool>()), 1..30)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    /// The device is heard within two seconds of the last message of a stranger, in order.
    #[test]
    fn whatever_a_stranger_sends_the_device_is_heard_again(
        strays in strays(), seed in any::<u64>(), lossy in any::<bool>(),
    ) {
        let mut rig = Rig::new(seed, if lossy { 0.1 } else { 0.0 });
        rig.run(SECOND / 2, true);
        for (stray, steps, sends) in strays {
            rig.stray(stray);
            rig.run(steps, sends);
        }
        rig.run(2 * SECOND, true);
        rig.net.set_faults(Faults::default());
        rig.run(2, true);
        let before = rig.got.len();
        rig.run(20, true);
        prop_assert!(rig.hears_the_device(), "{:?}", rig.got.last());
        let newest = &rig.got[before..];
        prop_assert!(newest.windows(2).all(|w| w[1].1 == w[0].1 + 1), "{newest:?}");
    }
}
