//! Turns of the launcher. While it stood still itself, with a machine that was suspended or with all that was stopped
//! together, nobody could be heard: its clocks for others stand still too.

use std::time::{Duration, Instant};

use super::Supervisor;

/// Time between two turns from which the launcher was late, not its nodes.
const LATE: Duration = Duration::from_secs(1);

/// Time of the newest turn.
#[derive(Debug, Default)]
pub(super) struct Turns {
    newest: Option<Instant>,
}

impl Turns {
    /// Begins a turn; the time that was lost before it, if it is late.
    fn begin(&mut self, now: Instant) -> Option<Duration> {
        let before = self.newest.replace(now)?;
        let passed = now.saturating_duration_since(before);
        (passed > LATE).then_some(passed)
    }
}

impl Supervisor {
    /// Begins a turn, and all clocks for nodes anew where it is late.
    pub(super) fn begin_turn(&mut self) {
        let Some(lost) = self.turns.begin(Instant::now()) else {
            return;
        };
        tracing::info!(
            "the launcher stood still for {:.1} s: nodes have as much longer",
            lost.as_secs_f64()
        );
        self.watchdog.postpone(lost);
        for node in &mut self.nodes {
            for since in [&mut node.missed, &mut node.leaving_since] {
                *since = since.map(|since| since + lost);
            }
        }
        for (_, since) in &mut self.started {
            *since += lost;
        }
        if let Some(switch) = &mut self.switch {
            switch.postpone(lost);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_late_turn_tells_how_much_was_lost() {
        let (mut turns, start) = (Turns::default(), Instant::now());
        let mut at = |ms: u64| turns.begin(start + Duration::from_millis(ms));
        assert_eq!(at(0), None);
        assert_eq!(at(20), None);
        assert_eq!(at(900), None, "a busy machine");
        assert_eq!(at(60_900), Some(Duration::from_secs(60)));
        assert_eq!(at(60_920), None);
    }
}
