//! Messages of a sender: some are late, some are lost.

/// Uniform on [0, 1): the upper bits of a linear congruential generator (Knuth's multiplier).
pub(crate) fn random(state: &mut u64) -> f64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*state >> 40) as f64 / (1u64 << 24) as f64
}

/// A sender at a steady rate, with its messages under way.
#[derive(Clone, Debug)]
pub(crate) struct Link<T> {
    period_s: f64,
    jitter: f64,
    state: u64,
    next_s: f64,
    under_way: Vec<(f64, T)>,
}

impl<T> Link<T> {
    /// A link with a message rate, delays of up to a share of the period, and losses at that share; the first message
    /// is never lost.
    pub(crate) fn new(rate_hz: f64, jitter: f64, seed: u64) -> Self {
        Self {
            period_s: 1.0 / rate_hz,
            jitter,
            state: seed,
            next_s: 0.0,
            under_way: Vec::new(),
        }
    }

    /// The newest message that arrives up to a time, s, and was not overtaken; `make` makes the message of a time.
    pub(crate) fn newest(&mut self, s: f64, mut make: impl FnMut(f64) -> T) -> Option<T> {
        while self.next_s <= s {
            let late = self.jitter * self.period_s * random(&mut self.state);
            if random(&mut self.state) >= self.jitter || self.next_s == 0.0 {
                self.under_way.push((self.next_s + late, make(self.next_s)));
            }
            self.next_s += self.period_s;
        }
        let arrived = self.under_way.iter().filter(|(at, _)| *at <= s).count();
        let newest = self.under_way.drain(..arrived).next_back();
        newest.map(|(_, message)| message)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Messages that arrive within 100 s of a link of 60 Hz, and the largest delay, s.
    fn sent(jitter: f64) -> (usize, f64) {
        let mut link = Link::new(60.0, jitter, 1);
        let (mut count, mut latest): (usize, f64) = (0, 0.0);
        for tick in 0..100_000 {
            let s = f64::from(tick) * 1e-3;
            if let Some(sent_s) = link.newest(s, |s| s) {
                count += 1;
                latest = latest.max(s - sent_s);
            }
        }
        (count, latest)
    }

    #[test]
    fn as_many_are_lost_and_as_late_as_the_jitter_says() {
        let (all, late_s) = sent(0.0);
        assert!(all == 6000 && late_s < 1e-3 + 1e-9, "{all} {late_s}");
        let (some, late_s) = sent(0.2);
        assert!((4680..4920).contains(&some), "{some} of 6000");
        assert!((2.5e-3..4.34e-3).contains(&late_s), "{late_s} s");
    }
}
