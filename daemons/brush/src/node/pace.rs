//! How long the steps of a stroke are that is painted late: twice as long where its samples have waited for a tenth
//! of a second, four times where for a fifth, until the brush lifts. So a brush that is too large for the machine
//! stays near its hand. The solves say it, so the journal paints them again as they were.

use maulstick_types::brush::solve_flags;

use crate::path_simplifier::Place;

/// Samples that have waited so long are painted in steps twice as long, ns.
const LATE_NS: u64 = 100_000_000;
/// See [`LATE_NS`]: four times.
const VERY_LATE_NS: u64 = 200_000_000;

/// The pace of a stroke.
#[derive(Debug, Default)]
pub(super) struct Pace {
    /// When the oldest sample that waits was heard, rig clock, ns.
    since_ns: Option<u64>,
    /// The flag of the stroke's solves.
    flag: u32,
    /// Whether the brush has lifted among what waits.
    lifts: bool,
}

impl Pace {
    /// Notes a sample that is to be solved.
    pub(super) fn hear(&mut self, now_ns: u64, place: Place) {
        self.since_ns.get_or_insert(now_ns);
        self.lifts |= place == Place::Air;
    }

    /// The flag of what waited and is solved now.
    pub(super) fn solve(&mut self, now_ns: u64) -> u32 {
        let since_ns = self.since_ns.take().unwrap_or(now_ns);
        let flag = match now_ns.saturating_sub(since_ns) {
            VERY_LATE_NS.. => solve_flags::FOUR_TIMES,
            LATE_NS.. => solve_flags::TWICE,
            _ => 0,
        };
        let flag = flag.max(self.flag);
        self.flag = if self.lifts { 0 } else { flag };
        self.lifts = false;
        flag
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: u64 = 1_000_000;

    #[test]
    fn steps_grow_with_the_wait_until_the_brush_lifts() {
        let mut pace = Pace::default();
        let mut now_ns = 0;
        let mut wait = |ms: u64, place: Place| {
            pace.hear(now_ns, place);
            now_ns += ms * MS;
            pace.hear(now_ns, Place::Surface);
            pace.solve(now_ns)
        };
        assert_eq!(wait(99, Place::Surface), 0);
        assert_eq!(wait(100, Place::Surface), solve_flags::TWICE);
        assert_eq!(
            wait(5, Place::Surface),
            solve_flags::TWICE,
            "for the whole stroke"
        );
        assert_eq!(wait(250, Place::Surface), solve_flags::FOUR_TIMES);
        assert_eq!(wait(150, Place::Air), solve_flags::FOUR_TIMES);
        assert_eq!(wait(5, Place::Surface), 0, "another stroke");
    }
}
