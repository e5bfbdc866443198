//! Strokes that wait for what a painter asked for before them: another brush, a load, a way of using it, an undo. Who
//! asks is often ahead of the paint; the hand goes on, and its next stroke begins when all of that is done.

use maulstick_bus::Recent;
use maulstick_types::Header;

/// Silence after which a window holds nothing up, ns.
const SILENCE_NS: u64 = 500_000_000;
/// Longest time that a stroke waits for an order, ns.
const LONGEST_NS: u64 = 10_000_000_000;

/// Oldest pending order of each window.
#[derive(Debug, Default)]
pub(super) struct Hold {
    windows: Recent<LastWord>,
}

/// Newest message of a window.
#[derive(Debug)]
struct LastWord {
    /// Since when something is pending, ns; 0 if nothing is.
    since_ns: u64,
    heard_ns: u64,
    seq: u64,
}

impl Hold {
    /// A window says since when something is pending; 0 if nothing is. A message that was overtaken counts no more.
    pub(super) fn on_pending(&mut self, header: &Header, since_ns: u64, heard_ns: u64) {
        let window = format!("{:x}-{:x}", header.source, header.epoch);
        let seq = header.seq;
        let before = self.windows.get(&window);
        if before.is_none_or(|before| before.seq < seq) {
            let heard = LastWord {
                since_ns,
                heard_ns,
                seq,
            };
            self.windows.set(&window, heard);
        }
    }

    /// Time after which no stroke begins, ns; absent where nothing is pending.
    pub(super) fn since_ns(&self, now_ns: u64) -> Option<u64> {
        let counts = |heard: &&LastWord| {
            heard.since_ns != 0
                && now_ns < heard.heard_ns.saturating_add(SILENCE_NS)
                && now_ns < heard.since_ns.saturating_add(LONGEST_NS)
        };
        let windows = self.windows.iter().map(|(_, heard)| heard);
        windows.filter(counts).map(|heard| heard.since_ns).min()
    }
}

#[cfg(test)]
mod tests {
    use maulstick_types::window::PendingOrders;
    use maulstick_types::{Flags, Origin, decode, encode};

    use super::*;

    fn header(epoch: u32, seq: u64) -> Header {
        let window = Origin { source: 1, epoch };
        let message = PendingOrders { since_ns: 0 };
        let bytes = encode(&window, Flags::NONE, seq, 0, 0, &message).expect("encoded");
        decode::<PendingOrders>(&bytes).expect("its own").0
    }

    #[test]
    fn the_oldest_of_what_is_pending_counts_and_nobody_holds_a_brush_for_ever() {
        let mut hold = Hold::default();
        hold.on_pending(&header(1, 1), 70, 100);
        hold.on_pending(&header(2, 8), 60, 100);
        assert_eq!(hold.since_ns(110), Some(60));
        hold.on_pending(&header(2, 9), 0, 120);
        hold.on_pending(&header(2, 7), 60, 121);
        assert_eq!(hold.since_ns(130), Some(70), "it was overtaken");
        assert_eq!(hold.since_ns(100 + SILENCE_NS), None, "its window ended");
        let late = 70 + LONGEST_NS;
        hold.on_pending(&header(1, 2), 70, late);
        assert_eq!(hold.since_ns(late), None);
    }
}
