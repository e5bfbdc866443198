//! Times of a window system on the rig's clock.

/// Time between two readings that is believed, ms: after a longer one another clock may have begun.
const BELIEVED_MS: u32 = 3_600_000;
/// Largest drift of the two clocks, s per s.
const DRIFT: f64 = 1e-4;

/// Finds the rig's time of events that have the window system's, in whole milliseconds from any beginning.
///
/// An event arrives after it happened: of all delays the shortest one is that of the clocks.
#[derive(Clone, Copy, Debug, Default)]
pub struct WindowClock {
    newest: Option<Heard>,
}

/// The newest event.
#[derive(Clone, Copy, Debug)]
struct Heard {
    time_ms: u32,
    /// Its time on the rig's clock, ns.
    event_ns: u64,
}

impl WindowClock {
    /// Time of an event on the rig's clock, ns, that arrives at `now_ns`; never before the one of the event before, never
    /// later than now.
    pub fn event_ns(&mut self, time_ms: u32, now_ns: u64) -> u64 {
        let passed = self.newest.and_then(|newest| {
            let passed_ms = time_ms.wrapping_sub(newest.time_ms);
            (passed_ms < BELIEVED_MS).then_some((newest.event_ns, u64::from(passed_ms)))
        });
        let event_ns = match passed {
            None => now_ns,
            Some((before_ns, passed_ms)) => {
                let passed_ns = passed_ms * 1_000_000;
                let later = (passed_ns as f64 * DRIFT) as u64;
                (before_ns + passed_ns + later).min(now_ns).max(before_ns)
            }
        };
        self.newest = Some(Heard { time_ms, event_ns });
        event_ns
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: u64 = 1_000_000;

    #[test]
    fn events_that_are_read_together_keep_their_times() {
        let mut clock = WindowClock::default();
        assert_eq!(clock.event_ns(500, 7 * MS), 7 * MS);
        // Ten milliseconds later all of them arrive at once.
        let times: Vec<u64> = (1..=10)
            .map(|ms| clock.event_ns(500 + ms, 17 * MS))
            .collect();
        for (at, time) in times.iter().enumerate() {
            let exact = (8 + at as u64) * MS;
            assert!(time.abs_diff(exact) < MS / 100, "{at}: {time}");
        }
    }

    #[test]
    fn the_shortest_delay_counts_and_no_time_goes_back() {
        let mut clock = WindowClock::default();
        // The first one came 5 ms late.
        clock.event_ns(u32::MAX, 105 * MS);
        let second = clock.event_ns(9, 110 * MS);
        assert_eq!(
            second,
            110 * MS,
            "not later than now, over the end of the counter"
        );
        assert!(clock.event_ns(19, 125 * MS).abs_diff(120 * MS) < MS / 100);
        assert!(clock.event_ns(18, 126 * MS) >= 120 * MS);
    }
}
