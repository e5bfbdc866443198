//! Strokes that wait for what a painter asked for before them: another brush, a load, a way of using it, an undo. Who
//! asks is often ahead of the paint; the hand goes on, and its next stroke begins when all of that is done.

use maulstick_bus::Recent;
use maulstick_types::Origin;

/// A window that is silent for so long holds nothing up any more, ns.
const SILENCE_NS: u64 = 500_000_000;
/// What is not done after so long is not waited for, ns.
const LONGEST_NS: u64 = 10_000_000_000;

/// What is pending, by the windows that say so.
#[derive(Debug, Default)]
pub(super) struct Hold {
    windows: Recent<Pending>,
}

#[derive(Debug)]
struct Pending {
    since_ns: u64,
    heard_ns: u64,
}

impl Hold {
    /// A window says since when something is pending; 0 if nothing is.
    pub(super) fn hear(&mut self, window: Origin, since_ns: u64, now_ns: u64) {
        let name = format!("{:x}-{:x}", window.source, window.epoch);
        match since_ns {
            0 => self.windows.remove(&name),
            _ => self.windows.set(
                &name,
                Pending {
                    since_ns,
                    heard_ns: now_ns,
                },
            ),
        }
    }

    /// Time after which no stroke begins, ns; absent where nothing is pending.
    pub(super) fn since_ns(&self, now_ns: u64) -> Option<u64> {
        let counts = |pending: &&Pending| {
            now_ns < pending.heard_ns.saturating_add(SILENCE_NS)
                && now_ns < pending.since_ns.saturating_add(LONGEST_NS)
        };
        let pending = self.windows.iter().map(|(_, pending)| pending);
        pending.filter(counts).map(|pending| pending.since_ns).min()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_of_what_is_pending_counts_and_nobody_holds_a_brush_for_ever() {
        let window = |epoch: u32| Origin { source: 1, epoch };
        let mut hold = Hold::default();
        hold.hear(window(1), 70, 100);
        hold.hear(window(2), 60, 100);
        assert_eq!(hold.since_ns(110), Some(60));
        hold.hear(window(2), 0, 120);
        assert_eq!(hold.since_ns(130), Some(70));
        assert_eq!(hold.since_ns(100 + SILENCE_NS), None, "its window ended");
        let late = 70 + LONGEST_NS;
        hold.hear(window(1), 70, late);
        assert_eq!(hold.since_ns(late), None);
    }
}
