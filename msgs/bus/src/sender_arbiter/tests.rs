//! The sender that started last is followed, and any other is back once it is silent.

use super::*;

const MS: u64 = 1_000_000;

fn header(epoch: u32, flags: Flags, sent_ms: u64) -> Header {
    Header {
        version: 1,
        schema: 0,
        source: 1,
        epoch,
        flags,
        length: 0,
        seq: 0,
        event_ns: sent_ms * MS,
        sent_ns: sent_ms * MS,
    }
}

/// Two senders at 100 Hz; hears them in turn.
struct Two {
    arbiter: SenderArbiter,
    now_ms: u64,
}

impl Two {
    fn new() -> Self {
        Self {
            arbiter: SenderArbiter::new(&header(1, Flags::FIRST, 0), 0),
            now_ms: 0,
        }
    }

    /// The named senders send for so long; what became of the last message of each.
    fn run(&mut self, epochs: &[u32], ms: u64) -> Vec<Verdict> {
        let mut last = Vec::new();
        for _ in 0..ms / 10 {
            self.now_ms += 10;
            last = epochs
                .iter()
                .map(|epoch| self.hear(*epoch, Flags::NONE, self.now_ms))
                .collect();
        }
        last
    }

    fn hear(&mut self, epoch: u32, flags: Flags, sent_ms: u64) -> Verdict {
        let header = header(epoch, flags, sent_ms);
        self.arbiter.judge(&header, self.now_ms * MS, true, Some(7))
    }
}

#[test]
fn a_stray_message_takes_nothing_over() {
    let mut two = Two::new();
    two.run(&[1], 1000);
    assert_eq!(two.hear(2, Flags::NONE, 1000), Verdict::SetAside);
    assert_eq!(two.run(&[1], 2000), [Verdict::Followed]);
    // Nor do stray messages that come now and then.
    assert_eq!(two.hear(2, Flags::NONE, two.now_ms), Verdict::SetAside);
}

#[test]
fn the_one_that_started_last_is_followed_and_the_other_is_back_when_it_is_silent() {
    let mut two = Two::new();
    two.run(&[1], 1000);
    let both = two.run(&[1, 2], 1000);
    assert_eq!(both, [Verdict::SetAside, Verdict::Followed]);
    assert_eq!(two.run(&[1], 490), [Verdict::SetAside]);
    assert_eq!(two.run(&[1], 10), [Verdict::TakesOver(Some(7))]);
    assert_eq!(two.run(&[1], 10), [Verdict::Followed]);
}

#[test]
fn a_first_message_is_followed_at_once_and_a_late_one_never() {
    let mut two = Two::new();
    two.run(&[1], 1000);
    assert_eq!(two.hear(2, Flags::FIRST, 1000), Verdict::TakesOver(None));
    two.now_ms = 5000;
    let late = two.hear(1, Flags::NONE, 990);
    assert_eq!(late, Verdict::SetAside);
    assert!(
        !two.arbiter
            .is_rival(&header(1, Flags::NONE, 990), 5000 * MS)
    );
    assert!(
        two.arbiter
            .is_rival(&header(1, Flags::NONE, 4990), 5000 * MS)
    );
}

#[test]
fn a_clock_that_is_ahead_wins_nothing() {
    let mut two = Two::new();
    let ahead = header(2, Flags::FIRST, u64::MAX / MS);
    two.run(&[1], 1000);
    let verdict = two.arbiter.judge(&ahead, 1000 * MS, true, None);
    assert_eq!(verdict, Verdict::TakesOver(None));
    assert_eq!(two.run(&[1], 600), [Verdict::Followed]);
}

#[test]
fn what_is_remembered_is_bounded() {
    let mut two = Two::new();
    for epoch in 2..1000 {
        two.run(&[1], 10);
        two.hear(epoch, Flags::NONE, two.now_ms);
    }
    assert_eq!(two.arbiter.others.len(), REMEMBERED);
    assert_eq!(two.run(&[1], 10), [Verdict::Followed]);
    let mut once = Once::default();
    assert!(once.say("a") && !once.say("a"));
    let said = (0..1000).filter(|n| once.say(&format!("{n}"))).count();
    assert_eq!(said, 255);
}
