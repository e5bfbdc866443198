//! Thins streams to a rate: what is sent more rarely passes whole, also where some of it comes at once.

use std::collections::BTreeMap;

/// Limit on the messages a second of each topic.
#[derive(Clone, Debug)]
pub struct RateLimit {
    interval_ns: u64,
    /// The time at which each topic's allowance is full again, ns.
    full_ns: BTreeMap<String, u64>,
}

/// Time over which an allowance gathers, ns: after a second's silence a second's messages pass at once.
const ALLOWANCE_NS: u64 = 1_000_000_000;

impl RateLimit {
    /// A limit of `hz` messages a second, at least one.
    #[must_use]
    pub fn new(hz: u32) -> Self {
        Self {
            interval_ns: ALLOWANCE_NS / u64::from(hz.max(1)),
            full_ns: BTreeMap::new(),
        }
    }

    /// True if a message of a topic that came at this time passes (generic cell rate algorithm, ITU-T I.371).
    pub fn admits(&mut self, topic: &str, now_ns: u64) -> bool {
        let full_ns = self
            .full_ns
            .get(topic)
            .map_or(now_ns, |own| *own.max(&now_ns));
        let next_ns = full_ns.saturating_add(self.interval_ns);
        let passes = next_ns <= now_ns.saturating_add(ALLOWANCE_NS);
        if passes {
            self.full_ns.insert(topic.to_owned(), next_ns);
        }
        passes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Messages that pass of those `each_ns` apart over `seconds`.
    fn passing(limit: &mut RateLimit, each_ns: u64, seconds: u64) -> usize {
        let times = (0..seconds * 1_000_000_000).step_by(each_ns as usize);
        times.filter(|now_ns| limit.admits("a", *now_ns)).count()
    }

    #[test]
    fn what_is_fast_is_thinned_and_what_is_slow_passes_whole() {
        assert_eq!(
            passing(&mut RateLimit::new(20), 1_000_000, 10),
            20 + 10 * 20 - 1
        );
        assert_eq!(passing(&mut RateLimit::new(20), 100_000_000, 10), 100);
    }

    #[test]
    fn a_burst_passes_and_topics_have_a_limit_each() {
        let mut limit = RateLimit::new(20);
        let burst = (0..30).filter(|number| limit.admits("a", *number)).count();
        assert_eq!(burst, 20);
        assert!(limit.admits("b", 30));
        assert!(limit.admits("a", 2_000_000_000));
    }
}
