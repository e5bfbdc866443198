//! Detection of a paint node that hangs: its token stands and its process lives, but no status arrives.

use std::time::{Duration, Instant};

use super::Supervisor;
use crate::up::child::State;
use crate::up::plan::Role;

/// A paint node without a status for so long, and without work, hangs.
const HANGS: Duration = Duration::from_secs(20);
/// Processor time that counts as work in that period: a vast canvas is filled by a step that takes long.
const WORK: Duration = Duration::from_secs(1);
/// One that works has as long: as a start that has the same to do.
const WORKS: Duration = Duration::from_secs(600);

/// Duration of the paint node's silence.
#[derive(Debug)]
pub(super) struct Silence {
    since: Instant,
    /// When it was looked at last, and the time of the processor that its stepper had had then.
    looked: (Instant, Duration),
}

impl Silence {
    fn new(now: Instant, work: Duration) -> Self {
        Self {
            since: now,
            looked: (now, work),
        }
    }

    /// True if it hangs: `work` is the time of the processor that its stepper has had.
    fn is_hanging(&mut self, now: Instant, work: Duration) -> bool {
        let (looked, before) = self.looked;
        if now.duration_since(looked) < HANGS {
            return false;
        }
        self.looked = (now, work);
        work.saturating_sub(before) < WORK || now.duration_since(self.since) >= WORKS
    }
}

/// Time of the processor that the first thread of a process has had; 0 where the process is gone.
fn work_of(pid: u32) -> Duration {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/task/{pid}/stat"));
    // After the name, which may hold anything: state and ten numbers, then user and system ticks.
    let ticks: u64 = stat.ok().map_or(0, |stat| {
        let numbers = stat.rsplit_once(')').map_or("", |(_, numbers)| numbers);
        let ticks = numbers.split_whitespace().skip(11).take(2);
        ticks.filter_map(|ticks| ticks.parse::<u64>().ok()).sum()
    });
    // Linux counts them in hundredths of a second for programs (USER_HZ), whatever its own clock.
    Duration::from_millis(10 * ticks)
}

impl Supervisor {
    /// Notes that the paint node has sent its status.
    pub(super) fn has_spoken(&mut self) {
        self.silence = None;
    }

    /// Ends a paint node that hangs; it is started again as one that crashed.
    pub(super) fn end_hanging(&mut self) {
        let paint = self.nodes.iter().find(|node| {
            node.spec.role == Role::Paint
                && node.state == State::Running
                && node.leaving_since.is_none()
        });
        let pid = paint.and_then(|node| node.pid());
        // A painting on its way to another file may hold it up.
        let Some(pid) = pid.filter(|_| self.switch.is_none()) else {
            self.silence = None;
            return;
        };
        let now = Instant::now();
        let silence = match &mut self.silence {
            Some(silence) => silence,
            none => none.insert(Silence::new(now, work_of(pid))),
        };
        if now.duration_since(silence.looked.0) < HANGS || !silence.is_hanging(now, work_of(pid)) {
            return;
        }
        self.silence = None;
        let paint = self
            .nodes
            .iter_mut()
            .find(|node| node.spec.role == Role::Paint);
        if let Some(node) = paint {
            tracing::warn!(
                "node '{}' has said nothing for {} s and is ended",
                node.spec.name,
                HANGS.as_secs()
            );
            node.strike();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TICK: Duration = Duration::from_millis(20);

    /// After how much silence a node hangs that works for so much of each second.
    fn hangs_after(work_share: f64) -> Option<Duration> {
        let start = Instant::now();
        let mut silence = Silence::new(start, Duration::ZERO);
        let mut ticks = (1..60_000).map(|tick| TICK * tick);
        ticks.find(|after| silence.is_hanging(start + *after, after.mul_f64(work_share)))
    }

    #[test]
    fn who_does_nothing_hangs_and_who_works_has_longer() {
        assert_eq!(hangs_after(0.0), Some(HANGS));
        assert_eq!(hangs_after(0.02), Some(HANGS));
        assert_eq!(hangs_after(0.9), Some(WORKS));
    }

    #[test]
    fn who_has_worked_and_then_hangs_is_found() {
        let start = Instant::now();
        let mut silence = Silence::new(start, Duration::ZERO);
        let worked = Duration::from_secs(30);
        let mut ticks = (1..60_000).map(|tick| TICK * tick);
        let found = ticks.find(|after| silence.is_hanging(start + *after, worked.min(*after)));
        assert_eq!(found, Some(HANGS * 3));
    }

    #[test]
    fn the_work_of_a_thread_is_read() {
        let me = std::process::id();
        let before = work_of(me);
        assert_eq!(work_of(u32::MAX), Duration::ZERO);
        assert!(work_of(me) >= before);
    }
}
