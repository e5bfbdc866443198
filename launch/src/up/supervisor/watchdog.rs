//! Detection of nodes without progress whose token and process live: no status comes from their main loop, or the
//! status shows no progress on waiting work. The activity of the process decides how long to wait: a stopped or
//! deadlocked one does nothing, while a vast canvas is filled by a long step.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

use maulstick_types::node::{NodeStatus, NodeWork};

use super::crew::Action;
use super::node::{Node, State};
use crate::up::plan::Role;

/// Silence after which the activity of a process is checked.
const SUSPECT: Duration = Duration::from_secs(1);
/// Time for which it is looked at.
const LOOK: Duration = Duration::from_millis(3500);
/// Time of the processor in that period that counts as work, on a machine that has many times more to do than it can.
const WORK: Duration = Duration::from_millis(70);
/// Waiting time for a node that waits for a disk, or for its other threads.
const WAITS: Duration = Duration::from_secs(20);

/// Waiting times for a silent node.
#[derive(Clone, Copy, Debug)]
struct Patience {
    /// While it is idle.
    idle: Duration,
    /// While its main thread is running, in processor time.
    working: Duration,
}

impl Patience {
    fn with(role: Role) -> Self {
        let seconds = |idle_s: f64, working_s: u64| Self {
            idle: Duration::from_secs_f64(idle_s),
            working: Duration::from_secs(working_s),
        };
        match role {
            // A turn of a brush is bounded.
            Role::Brush => seconds(4.5, 8),
            // Its longest step takes as long as a start with the same work.
            Role::Paint => seconds(4.5, 600),
            Role::Player => seconds(4.5, 20),
            // A vendor's library may search for its device, and a desktop may hold its windows up.
            Role::Device | Role::Window | Role::Recorder => seconds(20.0, 60),
        }
    }
}

/// Activity of a process so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Activity {
    /// Processor time of its first thread, which does the work of a node.
    own: Duration,
    /// Processor time of the others.
    others: Duration,
    /// True while a thread waits for a disk.
    on_disk: bool,
}

impl Activity {
    /// Activity of a process; `None` where it is gone.
    fn of(pid: u32) -> Self {
        let process = Path::new("/proc").join(pid.to_string());
        let threads = process.join("task");
        let (_, all) = stat(&process);
        let (_, own) = stat(&threads.join(pid.to_string()));
        let mut threads = std::fs::read_dir(threads).into_iter().flatten().flatten();
        Self {
            own,
            others: all.saturating_sub(own),
            on_disk: threads.any(|thread| stat(&thread.path()).0 == Some('D')),
        }
    }
}

/// State of a process or thread, and its time of the processor.
fn stat(folder: &Path) -> (Option<char>, Duration) {
    let stat = std::fs::read_to_string(folder.join("stat")).unwrap_or_default();
    // After the name, which may contain anything: state and ten numbers, then user and system ticks.
    let rest = stat.rsplit_once(')').map_or("", |(_, rest)| rest);
    let mut words = rest.split_whitespace();
    let state = words.next().and_then(|word| word.chars().next());
    let ticks = words.skip(10).take(2);
    let ticks: u64 = ticks.filter_map(|ticks| ticks.parse::<u64>().ok()).sum();
    // Linux counts them in hundredths of a second for programs (USER_HZ), whatever its own clock.
    (state, Duration::from_millis(10 * ticks))
}

/// A node that is watched.
#[derive(Debug)]
struct Watched {
    process: u32,
    /// Time of its last progress.
    since: Instant,
    work: Option<NodeWork>,
    /// Activity of its process when it became suspect, and at the newest check.
    looks: Option<[(Instant, Activity); 2]>,
}

impl Watched {
    fn new(process: u32, now: Instant) -> Self {
        Self {
            process,
            since: now,
            work: None,
            looks: None,
        }
    }

    /// Adds a time without checks.
    fn postpone(&mut self, by: Duration) {
        (self.since, self.looks) = (self.since + by, None);
    }

    /// Handles a status: progress, unless waiting work was left undone.
    fn hear(&mut self, now: Instant, work: &NodeWork) {
        let stands = self.work.as_ref().is_some_and(|before| {
            let done = |work: &NodeWork| (work.consumed, work.produced);
            before.waiting > 0 && work.waiting > 0 && done(before) == done(work)
        });
        self.work = Some(work.clone());
        if !stands {
            (self.since, self.looks) = (now, None);
        }
    }

    /// True if it hangs.
    fn is_hanging(
        &mut self,
        now: Instant,
        patience: Patience,
        activity: impl FnOnce() -> Activity,
    ) -> bool {
        let silent = now.saturating_duration_since(self.since);
        if silent < SUSPECT {
            return false;
        }
        let Some([first, newest]) = self.looks else {
            self.looks = Some([(now, activity()); 2]);
            return false;
        };
        if now.saturating_duration_since(newest.0) < LOOK {
            return false;
        }
        let seen = activity();
        self.looks = Some([first, (now, seen)]);
        if seen.own.saturating_sub(newest.1.own) >= WORK {
            return seen.own.saturating_sub(first.1.own) >= patience.working;
        }
        let is_waiting = seen.on_disk || seen.others.saturating_sub(newest.1.others) >= WORK;
        silent
            >= if is_waiting {
                patience.idle.max(WAITS)
            } else {
                patience.idle
            }
    }
}

/// The nodes that are watched.
#[derive(Debug, Default)]
pub(super) struct Watchdog {
    nodes: BTreeMap<String, Watched>,
}

impl Watchdog {
    /// Extends the deadlines of all nodes.
    pub(super) fn postpone(&mut self, by: Duration) {
        for node in self.nodes.values_mut() {
            node.postpone(by);
        }
    }

    /// Handles the status of a node.
    pub(super) fn hear(&mut self, name: &str, status: &NodeStatus, now: Instant) {
        let watched = self.nodes.get_mut(name);
        if let Some(watched) = watched.filter(|own| own.process == status.process) {
            watched.hear(now, &status.work);
        }
    }

    /// Nodes that make no progress, to be killed; they are started again as those that crash. Of roles that are `spared`
    /// none is watched.
    pub(super) fn look(
        &mut self,
        nodes: &[Node],
        spared: Option<Role>,
        now: Instant,
    ) -> Vec<Action> {
        let mut before = std::mem::take(&mut self.nodes);
        let mut actions = Vec::new();
        let watched = nodes.iter().filter(|node| {
            let is_free = node.leaving_since.is_none() && spared != Some(node.spec.role);
            node.state == State::Running && is_free
        });
        for node in watched {
            let (name, Some(pid)) = (&node.spec.name, node.pid) else {
                continue;
            };
            let known = before.remove(name).filter(|known| known.process == pid);
            let mut watched = known.unwrap_or_else(|| Watched::new(pid, now));
            let patience = Patience::with(node.spec.role);
            if watched.is_hanging(now, patience, || Activity::of(pid)) {
                let silent = now.saturating_duration_since(watched.since).as_secs_f64();
                tracing::warn!("node '{name}' has made no progress for {silent:.1} s and is ended");
                actions.push(Action::Kill(name.clone()));
                continue;
            }
            self.nodes.insert(name.clone(), watched);
        }
        actions
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TICK: Duration = Duration::from_millis(20);

    fn work(consumed: u64, waiting: u64) -> NodeWork {
        NodeWork {
            consumed,
            waiting,
            ..NodeWork::default()
        }
    }

    /// Time after which a silent node of a role is ended, given the activity of its process over time.
    fn ended_after(role: Role, activity: impl Fn(Duration) -> Activity) -> Option<Duration> {
        let start = Instant::now();
        let mut watched = Watched::new(1, start);
        let mut ticks = (1..60_000).map(|tick| TICK * tick);
        ticks.find(|after| {
            watched.is_hanging(start + *after, Patience::with(role), || activity(*after))
        })
    }

    fn busy(share: f64) -> impl Fn(Duration) -> Activity {
        move |after: Duration| Activity {
            own: after.mul_f64(share),
            ..Activity::default()
        }
    }

    #[test]
    fn a_frozen_brush_or_paint_is_found_within_five_seconds() {
        for role in [Role::Brush, Role::Paint, Role::Player] {
            let after = ended_after(role, busy(0.0)).expect("ended");
            // Up to half a second passes between its last status and its end.
            let within = Duration::from_secs(4)..Duration::from_secs(5);
            assert!(within.contains(&after), "{role:?}: {after:?}");
            assert_eq!(ended_after(role, busy(0.01)), Some(after), "{role:?}");
        }
        let device = ended_after(Role::Device, busy(0.0)).expect("ended");
        assert!(device >= WAITS, "a library searches for its device");
    }

    #[test]
    fn one_that_works_has_longer_and_an_endless_loop_of_a_brush_is_found() {
        let brush = ended_after(Role::Brush, busy(1.0)).expect("ended");
        assert!(brush < Duration::from_secs(15), "{brush:?}");
        let starved = ended_after(Role::Brush, busy(0.1)).expect("ended");
        assert!(starved > Duration::from_secs(60), "{starved:?}");
        let paint = ended_after(Role::Paint, busy(0.9)).expect("ended");
        assert!(paint > Duration::from_secs(600), "{paint:?}");
    }

    #[test]
    fn one_that_waits_for_a_disk_or_for_its_threads_has_longer() {
        let on_disk = |_| Activity {
            on_disk: true,
            ..Activity::default()
        };
        let threads = |after: Duration| Activity {
            others: after,
            ..Activity::default()
        };
        let limits = [
            ended_after(Role::Paint, on_disk),
            ended_after(Role::Paint, threads),
        ];
        for after in limits {
            let within = WAITS..WAITS + 2 * LOOK;
            assert!(
                after.is_some_and(|after| within.contains(&after)),
                "{after:?}"
            );
        }
    }

    #[test]
    fn who_has_worked_and_then_hangs_is_found() {
        let worked = Duration::from_secs(30);
        let activity = |after: Duration| busy(1.0)(after.min(worked));
        let after = ended_after(Role::Paint, activity).expect("ended");
        assert!(after > worked && after < worked + 3 * LOOK, "{after:?}");
    }

    #[test]
    fn a_status_is_progress_unless_nothing_is_done_of_what_waits() {
        let start = Instant::now();
        let hangs = |works: &dyn Fn(u64) -> NodeWork| {
            let mut watched = Watched::new(1, start);
            (1..100_u32).any(|half| {
                let now = start + Duration::from_millis(500) * half;
                watched.hear(now, &works(u64::from(half)));
                watched.is_hanging(now, Patience::with(Role::Brush), Activity::default)
            })
        };
        assert!(!hangs(&|_| work(7, 0)), "it rests");
        assert!(!hangs(&|half| work(half, 9)), "it is late, and goes on");
        assert!(hangs(&|_| work(7, 9)), "its loop turns, and does nothing");
        assert!(
            !hangs(&|half| work(7, half % 2)),
            "what came was done otherwise"
        );
    }

    #[test]
    fn a_launcher_that_stood_still_begins_its_clocks_anew() {
        let start = Instant::now();
        let mut watched = Watched::new(1, start);
        let is_hanging = |watched: &mut Watched, now: Instant| {
            watched.is_hanging(now, Patience::with(Role::Paint), Activity::default)
        };
        let resumed = start + Duration::from_secs(60);
        watched.postpone(Duration::from_secs(60));
        assert!(!is_hanging(&mut watched, resumed));
        watched.hear(resumed + Duration::from_millis(400), &work(1, 0));
        assert!(!is_hanging(&mut watched, resumed + Duration::from_secs(1)));
    }

    #[test]
    fn what_a_process_does_is_read() {
        let me = std::process::id();
        let before = Activity::of(me);
        assert_eq!(Activity::of(u32::MAX), Activity::default());
        let after = Activity::of(me);
        assert!(after.own >= before.own && after.own + after.others >= before.own + before.others);
    }
}
