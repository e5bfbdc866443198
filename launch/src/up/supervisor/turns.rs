//! Turns of the launcher. While it was stopped itself, by a suspended machine or together with all processes, it could
//! receive nothing, so its deadlines for others are extended.

use std::time::{Duration, Instant};

/// Time between two turns from which the launcher was late, not its nodes.
const LATE: Duration = Duration::from_secs(1);

/// Time of the newest turn.
#[derive(Debug, Default)]
pub(super) struct Turns {
    newest: Option<Instant>,
}

impl Turns {
    /// Begins a turn; the time that was lost before it, if it is late.
    pub(super) fn begin(&mut self, now: Instant) -> Option<Duration> {
        let before = self.newest.replace(now)?;
        let passed = now.saturating_duration_since(before);
        let is_late = passed > LATE;
        if is_late {
            tracing::info!(
                "the launcher stood still for {:.1} s: nodes have as much longer",
                passed.as_secs_f64()
            );
        }
        is_late.then_some(passed)
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
