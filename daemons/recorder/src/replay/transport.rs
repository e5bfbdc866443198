//! The transport of a replay: where it is, how fast it goes on, and the orders that change it. It reads no clock.

use std::time::Duration;

use maulstick_device::player::Rate;

/// Slowest and fastest rate.
pub const RATES: std::ops::RangeInclusive<f64> = 0.1..=100.0;

/// An order to a player.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Order {
    /// Stands still, or goes on.
    Pause,
    /// Goes so far, s; back where it is negative.
    Skip(f64),
    /// Goes to a time since the beginning, s.
    Seek(f64),
    /// Stands still after the next event.
    Step,
    /// Goes on at this rate.
    Rate(Rate),
    /// Goes on so many times as fast.
    Faster(f64),
    /// Guides with this strength, 0 to 1.
    Strength(f64),
    /// Guides with so much more strength.
    Stronger(f64),
    /// Ends.
    End,
}

/// Where a replay is.
#[derive(Clone, Debug)]
pub(super) struct Transport {
    /// Beginning and end of what is played, ns.
    range_ns: [u64; 2],
    position_ns: u64,
    /// The clock at the last look, ns.
    looked_ns: Option<u64>,
    rate: Rate,
    paused: bool,
}

impl Transport {
    /// At the beginning of a range.
    pub(super) fn new(range_ns: [u64; 2], rate: Rate, paused: bool) -> Self {
        Self {
            range_ns,
            position_ns: range_ns[0],
            looked_ns: None,
            rate,
            paused,
        }
    }

    /// The clock shows this.
    pub(super) fn look(&mut self, now_ns: u64) {
        let passed_ns = now_ns.saturating_sub(self.looked_ns.replace(now_ns).unwrap_or(now_ns));
        if self.paused {
            return;
        }
        self.position_ns = match self.rate {
            Rate::Max => self.range_ns[1],
            Rate::Times(rate) => {
                let on_ns = (passed_ns as f64 * rate) as u64;
                self.position_ns.saturating_add(on_ns).min(self.range_ns[1])
            }
        };
    }

    /// True once an event of this time is due.
    pub(super) fn is_due(&self, event_ns: u64) -> bool {
        event_ns <= self.position_ns
    }

    /// Time until an event of this time is due; `None` while it stands still.
    pub(super) fn time_to(&self, event_ns: u64) -> Option<Duration> {
        let left_ns = event_ns.saturating_sub(self.position_ns);
        match self.rate {
            _ if self.paused => None,
            Rate::Max => Some(Duration::ZERO),
            Rate::Times(rate) => Some(Duration::from_nanos((left_ns as f64 / rate) as u64)),
        }
    }

    /// Where it is, ns since the beginning of the recording.
    pub(super) fn position_ns(&self) -> u64 {
        self.position_ns
    }

    /// The end of what is played, ns since the beginning of the recording.
    pub(super) fn end_ns(&self) -> u64 {
        self.range_ns[1]
    }

    /// True while it stands still.
    pub(super) fn is_paused(&self) -> bool {
        self.paused
    }

    /// Its rate.
    pub(super) fn rate(&self) -> Rate {
        self.rate
    }

    /// Goes back to before the next event where that is due already: what plays may be slower than the rate.
    pub(super) fn wait_for(&mut self, next_ns: Option<u64>) {
        if let Some(next_ns) = next_ns.filter(|next_ns| self.is_due(*next_ns)) {
            self.go_to(next_ns.saturating_sub(1));
        }
    }

    /// True once all is played: at the end of what is played, and not paused.
    pub(super) fn is_over(&self) -> bool {
        self.position_ns >= self.range_ns[1] && !self.paused
    }

    /// Carries out an order; `next_ns` is the time of the next event.
    pub(super) fn order(&mut self, order: Order, next_ns: Option<u64>) {
        let before_ns = self.position_ns;
        match order {
            Order::Pause => self.paused = !self.paused,
            Order::Seek(s) => self.go_to((s.max(0.0) * 1e9) as u64),
            Order::Skip(s) => {
                let by_ns = (s.abs() * 1e9) as u64;
                self.go_to(if s < 0.0 {
                    before_ns.saturating_sub(by_ns)
                } else {
                    before_ns.saturating_add(by_ns)
                });
            }
            Order::Step => {
                self.paused = true;
                self.go_to(next_ns.unwrap_or(before_ns));
            }
            Order::Rate(rate) => self.rate = rate,
            Order::Faster(factor) => {
                let rate = match self.rate {
                    Rate::Times(rate) => rate * factor,
                    Rate::Max => *RATES.end(),
                };
                self.rate = Rate::Times(rate.max(*RATES.start()).min(*RATES.end()));
            }
            Order::Strength(_) | Order::Stronger(_) | Order::End => {}
        }
    }

    /// Begins anew.
    pub(super) fn rewind(&mut self) {
        self.position_ns = self.range_ns[0];
    }

    fn go_to(&mut self, position_ns: u64) {
        let [start, end] = self.range_ns;
        self.position_ns = position_ns.max(start).min(end);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const S: u64 = 1_000_000_000;

    #[test]
    fn it_goes_at_its_rate_and_stands_still_while_paused() {
        let mut transport = Transport::new([2 * S, 12 * S], Rate::Times(0.5), false);
        transport.look(100 * S);
        assert!(transport.is_due(2 * S) && !transport.is_due(2 * S + 1));
        let to_next = transport.time_to(3 * S);
        assert_eq!(to_next, Some(Duration::from_secs(2)));
        transport.look(102 * S);
        assert_eq!(transport.position_ns(), 3 * S);
        transport.order(Order::Pause, None);
        transport.look(109 * S);
        assert_eq!(transport.position_ns(), 3 * S);
        assert_eq!(transport.time_to(4 * S), None);
        transport.order(Order::Step, Some(4 * S));
        assert_eq!(
            (transport.position_ns(), transport.is_paused()),
            (4 * S, true)
        );
        transport.order(Order::Pause, None);
        transport.order(Order::Faster(8.0), None);
        transport.look(110 * S);
        assert_eq!(transport.position_ns(), 8 * S);
        transport.order(Order::Skip(-1.5), None);
        assert_eq!(transport.position_ns(), 6_500_000_000);
        transport.order(Order::Seek(0.0), None);
        assert_eq!(transport.position_ns(), 2 * S, "not before the start");
        transport.order(Order::Seek(1e9), None);
        assert_eq!(transport.position_ns(), 12 * S, "nor behind the end");
        transport.rewind();
        transport.order(Order::Rate(Rate::Max), None);
        transport.look(110 * S + 1);
        assert_eq!(transport.position_ns(), 12 * S);
        // What plays is at 5 s, and is to stand still there.
        transport.wait_for(Some(5 * S));
        transport.order(Order::Pause, Some(5 * S));
        transport.look(111 * S);
        assert!(!transport.is_due(5 * S) && !transport.is_over());
    }
}
