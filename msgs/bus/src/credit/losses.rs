//! Losses of a stream in the log: one line a second with their number, however many there are.

/// Shortest time between two lines, ns.
const EVERY_NS: u64 = 1_000_000_000;

/// Lost messages that are not reported yet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Losses {
    untold: u64,
    told_ns: Option<u64>,
}

impl Losses {
    /// Takes in that messages are lost.
    pub(super) fn add(&mut self, messages: u64) {
        self.untold = self.untold.saturating_add(messages);
    }

    /// Losses to report now; `None` while the last report is too recent.
    pub(super) fn due(&mut self, now_ns: u64) -> Option<u64> {
        let is_early = self
            .told_ns
            .is_some_and(|told_ns| now_ns < told_ns.saturating_add(EVERY_NS));
        if self.untold == 0 || is_early {
            return None;
        }
        self.told_ns = Some(now_ns);
        Some(std::mem::take(&mut self.untold))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_minute_of_losses_is_sixty_lines_in_which_none_is_missing() {
        let mut losses = Losses::default();
        let (mut lines, mut told) = (0, 0);
        for ms in 0..60_000 {
            if ms % 62 == 0 {
                losses.add(1);
            }
            if let Some(count) = losses.due(ms * 1_000_000) {
                lines += 1;
                told += count;
            }
        }
        // The last ones wait for the end of their second.
        told += losses.due(61_000_000_000).unwrap_or(0);
        assert_eq!((lines, told), (60, 968));
        assert_eq!(losses.due(99_000_000_000), None);
    }

    #[test]
    fn the_first_loss_is_told_at_once() {
        let mut losses = Losses::default();
        losses.add(3);
        assert_eq!(losses.due(0), Some(3));
    }
}
