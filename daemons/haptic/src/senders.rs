//! Choice of who moves the hand at a device: its own brush, or another sender by consent. Of all of them one is followed.
//!
//! The brush is known by what it says of the device's samples (`BrushConsumed`): the session of it that consumes them is
//! the device's, and stays so for as long as it is heard. Consent is given by name in the settings of the device
//! (`driven_by`), or for a few seconds by a request ([`ForceOrder::Drive`](maulstick_types::haptics::ForceOrder)).

use std::collections::BTreeSet;

use maulstick_types::{Origin, name_hash};

/// Time without a word after which a sender is silent, ns.
const SILENCE_NS: u64 = 500_000_000;
/// Time without a word after which a brush may have been started anew, ns.
const GAP_NS: u64 = 100_000_000;
/// Duration of a consent that was asked for, ns.
const CONSENT_NS: u64 = 3_000_000_000;
/// Most consents at a time.
const MOST_CONSENTS: usize = 8;

/// Kind of message that moves the hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Means {
    /// A contact model.
    Contact,
    /// A force of the paint.
    Paint,
    /// A guide.
    Guide,
}

/// Decision about a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// Its sender is followed.
    Followed,
    /// Its sender may move the hand, but another one does just now.
    SetAside,
    /// Its sender may not move the hand.
    Refused,
}

/// The senders of a device.
#[derive(Clone, Debug)]
pub(crate) struct Senders {
    /// Source of its brush.
    brush: u32,
    /// The session of its brush.
    own: Option<Heard>,
    /// Sources that have consent by the settings.
    named: BTreeSet<u32>,
    /// Senders that have consent until a time, ns.
    consents: Vec<(Origin, u64)>,
    /// The sender with consent that is followed, for each of [`Means`].
    drivers: [Option<Heard>; 3],
}

/// A sender, and when it was heard last, ns.
#[derive(Clone, Copy, Debug)]
struct Heard {
    origin: Origin,
    heard_ns: u64,
}

impl Heard {
    fn is_silent(self, for_ns: u64, now_ns: u64) -> bool {
        now_ns >= self.heard_ns.saturating_add(for_ns)
    }
}

/// Answer to a sender that asks to move the hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Consent {
    /// It may from now on.
    Given,
    /// It might before.
    Renewed,
    /// Too many others do.
    Refused,
}

impl Senders {
    /// The senders of a device that moves `brush`; those called as in `named` have consent.
    pub(crate) fn new(brush: &str, named: &[String]) -> Self {
        Self {
            brush: name_hash(brush),
            own: None,
            named: named.iter().map(|name| name_hash(name)).collect(),
            consents: Vec::new(),
            drivers: [None; 3],
        }
    }

    /// A brush has consumed samples of the device.
    pub(crate) fn consumed_by(&mut self, origin: Origin, now_ns: u64) {
        let is_taken = |own: Heard| own.origin != origin && !own.is_silent(SILENCE_NS, now_ns);
        if origin.source == self.brush && !self.own.is_some_and(is_taken) {
            let heard_ns = now_ns;
            self.own = Some(Heard { origin, heard_ns });
        }
    }

    /// Lets a sender move the hand for a while.
    pub(crate) fn consent(&mut self, origin: Origin, now_ns: u64) -> Consent {
        let had_it = self.has_consent(origin, now_ns);
        self.consents
            .retain(|(other, until_ns)| *other != origin && *until_ns > now_ns);
        if self.consents.len() >= MOST_CONSENTS {
            return Consent::Refused;
        }
        self.consents.push((origin, now_ns + CONSENT_NS));
        if had_it {
            Consent::Renewed
        } else {
            Consent::Given
        }
    }

    fn has_consent(&self, origin: Origin, now_ns: u64) -> bool {
        let mut consents = self.consents.iter();
        self.named.contains(&origin.source)
            || consents.any(|(other, until_ns)| *other == origin && *until_ns > now_ns)
    }

    /// Judges a message that is addressed to the device.
    pub(crate) fn judge(&mut self, means: Means, origin: Origin, now_ns: u64) -> Verdict {
        if self.has_consent(origin, now_ns) {
            let driver = &mut self.drivers[means as usize];
            let is_taken =
                |other: Heard| other.origin != origin && !other.is_silent(SILENCE_NS, now_ns);
            if driver.is_some_and(is_taken) {
                return Verdict::SetAside;
            }
            let heard_ns = now_ns;
            *driver = Some(Heard { origin, heard_ns });
            return Verdict::Followed;
        }
        if origin.source != self.brush || means == Means::Guide {
            return Verdict::Refused;
        }
        match &mut self.own {
            // Its first models may come before it says that it has consumed a sample.
            None => Verdict::SetAside,
            Some(own) if own.origin == origin => {
                own.heard_ns = now_ns;
                if self.is_driven(means, now_ns) {
                    Verdict::SetAside
                } else {
                    Verdict::Followed
                }
            }
            Some(own) if own.is_silent(GAP_NS, now_ns) => Verdict::SetAside,
            Some(_) => Verdict::Refused,
        }
    }

    /// True if another sender than the brush moves the hand by these means; who sends contact models sends all of the paint,
    /// too.
    fn is_driven(&self, means: Means, now_ns: u64) -> bool {
        let is_driven = |means: Means| {
            let driver = self.drivers[means as usize];
            driver.is_some_and(|driver| !driver.is_silent(SILENCE_NS, now_ns))
        };
        is_driven(means) || is_driven(Means::Contact)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: u64 = 1_000_000;

    fn session(name: &str, epoch: u32) -> Origin {
        Origin {
            source: name_hash(name),
            epoch,
        }
    }

    /// The senders of a device whose brush has consumed a sample at 0.
    fn senders(named: &[&str]) -> Senders {
        let named: Vec<String> = named.iter().map(|name| (*name).to_owned()).collect();
        let mut senders = Senders::new("main", &named);
        senders.consumed_by(session("main", 1), 0);
        senders
    }

    #[test]
    fn a_second_sender_is_refused_under_any_name_and_the_brush_is_followed() {
        let mut senders = senders(&[]);
        for ms in 0..2000 {
            let now_ns = ms * MS;
            for other in [session("other", 1), session("main", 2)] {
                for means in [Means::Contact, Means::Paint, Means::Guide] {
                    let verdict = senders.judge(means, other, now_ns);
                    assert_eq!(verdict, Verdict::Refused, "{other:?} {means:?}");
                }
            }
            // It says that it has consumed samples, too.
            senders.consumed_by(session("main", 2), now_ns);
            let brush = senders.judge(Means::Contact, session("main", 1), now_ns);
            assert_eq!(brush, Verdict::Followed);
        }
    }

    #[test]
    fn a_brush_whose_hand_is_away_stays_the_devices_for_as_long_as_it_consumes() {
        let mut senders = senders(&[]);
        for ms in (0..5000).step_by(50) {
            senders.consumed_by(session("main", 1), ms * MS);
            senders.consumed_by(session("main", 2), ms * MS);
            let other = senders.judge(Means::Contact, session("main", 2), ms * MS);
            assert_eq!(other, Verdict::Refused);
        }
    }

    #[test]
    fn a_brush_that_was_started_anew_is_followed_and_not_refused_meanwhile() {
        let mut senders = senders(&[]);
        let anew = session("main", 2);
        let mut verdicts = Vec::new();
        for ms in (300..1000).step_by(10) {
            verdicts.push(senders.judge(Means::Contact, anew, ms * MS));
            senders.consumed_by(anew, ms * MS);
        }
        assert!(!verdicts.contains(&Verdict::Refused), "{verdicts:?}");
        assert_eq!(verdicts.last(), Some(&Verdict::Followed));
        let before = senders.judge(Means::Contact, session("main", 1), 1000 * MS);
        assert_eq!(before, Verdict::Refused);
    }

    #[test]
    fn whoever_has_consent_takes_the_place_of_the_brush_until_it_is_silent() {
        for named in [true, false] {
            let names: &[&str] = if named { &["other"] } else { &[] };
            let mut senders = senders(names);
            let (brush, other) = (session("main", 1), session("other", 7));
            if !named {
                assert_eq!(senders.consent(other, 0), Consent::Given);
                assert_eq!(senders.consent(other, MS), Consent::Renewed);
            }
            assert_eq!(senders.judge(Means::Contact, other, MS), Verdict::Followed);
            assert_eq!(senders.judge(Means::Contact, brush, MS), Verdict::SetAside);
            assert_eq!(senders.judge(Means::Paint, brush, MS), Verdict::SetAside);
            let second = session("other", 8);
            assert_ne!(senders.judge(Means::Contact, second, MS), Verdict::Followed);
            let later_ns = MS + SILENCE_NS;
            senders.consumed_by(brush, later_ns);
            assert_eq!(
                senders.judge(Means::Contact, brush, later_ns),
                Verdict::Followed
            );
            // A consent that was asked for ends.
            let verdict = senders.judge(Means::Contact, other, MS + CONSENT_NS);
            assert_eq!(verdict == Verdict::Refused, !named);
        }
    }

    #[test]
    fn who_sends_the_drag_alone_or_guides_leaves_the_wall_to_the_brush() {
        let mut senders = senders(&["other"]);
        let (brush, other) = (session("main", 1), session("other", 7));
        assert_eq!(senders.judge(Means::Paint, other, MS), Verdict::Followed);
        assert_eq!(senders.judge(Means::Guide, other, MS), Verdict::Followed);
        assert_eq!(senders.judge(Means::Paint, brush, MS), Verdict::SetAside);
        assert_eq!(senders.judge(Means::Contact, brush, MS), Verdict::Followed);
    }
}
