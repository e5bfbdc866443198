//! Length of the steps of a stroke whose paint is late: doubled once its samples have waited for a tenth of a second,
//! twice for a fifth, to its end. A brush that is too large for the machine so stays near its hand. Its solves carry
//! the doublings, so the journal paints them again as they were.

use maulstick_types::brush::{Solve, solve_flags};

use crate::path_simplifier::Place;

/// Wait of a sample from which steps are doubled, ns.
const LATE_NS: u64 = 100_000_000;
/// Wait of a sample from which steps are doubled twice, ns.
const VERY_LATE_NS: u64 = 200_000_000;

/// The pace of a stroke.
#[derive(Debug, Default)]
pub(super) struct Pace {
    /// When the oldest waiting sample on the surface arrived, rig clock, ns.
    since_ns: Option<u64>,
    /// Flag of the solves of `stroke`.
    flag: u32,
    stroke: u64,
}

impl Pace {
    /// Notes a sample that waits to be solved.
    pub(super) fn note(&mut self, now_ns: u64, place: Place) {
        if place == Place::Surface {
            self.since_ns.get_or_insert(now_ns);
        }
    }

    /// Nothing waits any more, or what waits does so for no fault of the paint.
    pub(super) fn forget_wait(&mut self) {
        self.since_ns = None;
    }

    /// Flags the solves of what waited.
    pub(super) fn flag(&mut self, now_ns: u64, solves: &mut [Solve]) {
        let since_ns = self.since_ns.unwrap_or(now_ns);
        let late = match now_ns.saturating_sub(since_ns) {
            VERY_LATE_NS.. => solve_flags::FOUR_TIMES,
            LATE_NS.. => solve_flags::TWICE,
            _ => 0,
        };
        for solve in solves {
            if solve.stroke != self.stroke {
                (self.stroke, self.flag) = (solve.stroke, 0);
            }
            if solve.stroke != 0 {
                self.flag = self.flag.max(late);
                solve.flags |= self.flag;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use maulstick_types::Pose;

    use super::*;

    const MS: u64 = 1_000_000;

    fn solve(stroke: u64) -> Solve {
        Solve {
            event_ns: 0,
            stroke,
            surface: 0,
            flags: 0,
            pose: Pose::IDENTITY,
            zoom: 1.0,
            angles_rad: Vec::new(),
            contacts: Vec::new(),
        }
    }

    #[test]
    fn steps_grow_with_the_wait_to_the_end_of_the_stroke() {
        let mut pace = Pace::default();
        let mut now_ns = 0;
        let mut wait = |ms: u64, place: Place, strokes: &[u64]| -> Vec<u32> {
            pace.note(now_ns, place);
            now_ns += ms * MS;
            pace.note(now_ns, Place::Surface);
            let mut solves: Vec<_> = strokes.iter().map(|stroke| solve(*stroke)).collect();
            pace.flag(now_ns, &mut solves);
            pace.forget_wait();
            solves.iter().map(|solve| solve.flags).collect()
        };
        const TWICE: u32 = solve_flags::TWICE;
        const FOUR_TIMES: u32 = solve_flags::FOUR_TIMES;
        assert_eq!(wait(99, Place::Surface, &[1]), [0]);
        assert_eq!(wait(100, Place::Surface, &[1]), [TWICE]);
        assert_eq!(wait(5, Place::Surface, &[1]), [TWICE], "the same stroke");
        assert_eq!(wait(250, Place::Surface, &[1, 0]), [FOUR_TIMES, 0]);
        assert_eq!(wait(5, Place::Surface, &[2]), [0], "another stroke");
        assert_eq!(wait(250, Place::Air, &[3]), [0], "a hover is no wait");
        assert_eq!(wait(150, Place::Surface, &[3, 0, 4]), [TWICE, 0, TWICE]);
    }
}
