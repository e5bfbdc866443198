//! Ticks of a clock: sixtieths of a second, none lost and none twice.

use maulstick_painting::clock::TICKS_A_SECOND;

const SECOND_NS: u64 = 1_000_000_000;

/// Turns the time of a clock into ticks.
#[derive(Clone, Debug, Default)]
pub struct Ticker {
    last_ns: Option<u64>,
    /// Remainder of a tick, ns times ticks a second.
    rest: u128,
}

impl Ticker {
    /// Advances to a time of the clock: returns the ticks since the last call, at most `most`; the rest come with the
    /// next call.
    pub fn look(&mut self, now_ns: u64, most: u64) -> u64 {
        let last_ns = self.last_ns.replace(now_ns).unwrap_or(now_ns);
        self.pass(now_ns.saturating_sub(last_ns), most)
    }

    /// Advances by a duration: returns its ticks, at most `most`; the rest come later.
    pub fn pass(&mut self, time_ns: u64, most: u64) -> u64 {
        self.rest += u128::from(time_ns) * u128::from(TICKS_A_SECOND);
        let ticks = (self.rest / u128::from(SECOND_NS)).min(u128::from(most));
        self.rest -= ticks * u128::from(SECOND_NS);
        ticks as u64
    }

    /// Ignores the time until the next call.
    pub fn pause(&mut self) {
        self.last_ns = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_tick_is_lost_however_often_the_clock_is_looked_at() {
        for step_ns in [1_000_000, 7_777_777, 16_666_667, 123_456_789] {
            let mut ticker = Ticker::default();
            let looks = 2_000_000_000 / step_ns;
            let ticks: u64 = (0..=looks)
                .map(|i| ticker.look(5 + i * step_ns, u64::MAX))
                .sum();
            assert_eq!(ticks, looks * step_ns * 60 / SECOND_NS);
        }
        let mut ticker = Ticker::default();
        assert_eq!(ticker.pass(90 * SECOND_NS, u64::MAX), 5400);
        assert_eq!((ticker.look(0, 9), ticker.look(SECOND_NS, 9)), (0, 9));
        assert_eq!(
            ticker.look(SECOND_NS, 99),
            51,
            "what was too much comes later"
        );
        ticker.pause();
        assert_eq!(ticker.look(9 * SECOND_NS, 99), 0);
        assert_eq!(ticker.look(8 * SECOND_NS, 99), 0, "a clock that goes back");
    }
}
