//! One process of the rig: started in a group of its own, watched, stopped.
//!
//! It cannot outlive its launcher: the launcher holds its standard input open and it ends when that
//! ends; besides, the kernel signals it when the launcher dies.

use std::collections::{BTreeMap, VecDeque};
use std::os::unix::process::CommandExt as _;
use std::path::Path;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use maulstick_rig::UserError;
use maulstick_rig::config::Restart;
use maulstick_rig::program::own_program;
use nix::sys::signal::{Signal, killpg};
use nix::unistd::Pid;

use crate::up::plan::NodeSpec;

/// So many failures within [`WINDOW`] are too many.
const FAILURES: usize = 3;
/// See [`FAILURES`].
const WINDOW: Duration = Duration::from_secs(10);

/// State of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// Started, its token not yet seen.
    Starting,
    /// Its token is there.
    Running,
    /// Ended, to be started again.
    Restarting,
    /// Ended with success.
    Ended,
    /// Failed too often, or may not be started again.
    Failed,
}

impl State {
    /// As the table shows it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Starting => "starting",
            Self::Running => "running",
            Self::Restarting => "restarting",
            Self::Ended => "ended",
            Self::Failed => "failed",
        }
    }
}

/// A node and its process.
#[derive(Debug)]
pub struct Node {
    /// Its specification.
    pub spec: NodeSpec,
    /// Its state.
    pub state: State,
    /// Number of restarts.
    pub restarts: u32,
    /// Since when its token is missed.
    pub missed: Option<Instant>,
    /// Since when it is asked to end, to be started afresh.
    pub leaving_since: Option<Instant>,
    process: Option<(Child, Option<ChildStdin>)>,
}

/// When which node failed, by name: a node that is made anew is not forgiven what it did before.
#[derive(Debug, Default)]
pub struct Failures(BTreeMap<String, VecDeque<Instant>>);

impl Failures {
    /// Counts a failure of the node called `name`; true where it has failed too often.
    pub fn count(&mut self, name: &str, now: Instant) -> bool {
        let failures = self.0.entry(name.to_owned()).or_default();
        failures.push_back(now);
        failures.retain(|when| now.duration_since(*when) <= WINDOW);
        failures.len() >= FAILURES
    }
}

/// End of a process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// With success.
    Well,
    /// With an exit code of bad usage: starting it again would not help.
    Refused(i32),
    /// Otherwise.
    Badly,
}

impl Node {
    /// A node that is not started.
    #[must_use]
    pub fn new(spec: NodeSpec) -> Self {
        Self {
            spec,
            state: State::Restarting,
            restarts: 0,
            missed: None,
            leaving_since: None,
            process: None,
        }
    }

    /// Starts the process.
    ///
    /// # Errors
    /// A [`UserError`] where the system cannot.
    pub fn start(&mut self, folder: &Path) -> Result<(), UserError> {
        let program = self.spec.program;
        let failed = |error: std::io::Error| {
            let what = format!("node '{}' cannot be started: {error}", self.spec.name);
            UserError::failure(what)
                .help("the machine may be out of memory or processes: end what is not needed")
        };
        let mut child = Command::new(own_program())
            .arg0(program.process_name())
            .args(["node", program.subcommand(), "--folder"])
            .arg(folder)
            .args(["--node", &self.spec.name, "--guarded"])
            .args(&self.spec.args)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .process_group(0)
            .spawn()
            .map_err(failed)?;
        let stdin = child.stdin.take();
        self.process = Some((child, stdin));
        self.state = State::Starting;
        self.missed = None;
        self.leaving_since = None;
        Ok(())
    }

    /// Process id, while it runs.
    #[must_use]
    pub fn pid(&self) -> Option<u32> {
        self.process.as_ref().map(|(child, _)| child.id())
    }

    /// The end of the process, once it has ended.
    pub fn ended(&mut self) -> Option<Ended> {
        let (child, _) = self.process.as_mut()?;
        let status = child.try_wait().ok()??;
        self.process = None;
        Some(judge(status))
    }

    /// Counts a failure and says whether the node may be started again.
    pub fn fail(&mut self, failures: &mut Failures) -> bool {
        let too_often = failures.count(&self.spec.name, Instant::now());
        let again = self.spec.restart == Restart::OnFailure && !too_often;
        self.state = if again {
            State::Restarting
        } else {
            State::Failed
        };
        again
    }

    /// Asks the process to end, to be started afresh; false if there is none.
    pub fn renew(&mut self) -> bool {
        let runs = self.pid().is_some();
        if runs {
            self.terminate();
            self.leaving_since = Some(Instant::now());
            self.state = State::Restarting;
        }
        runs
    }

    /// Asks the process to end.
    pub fn terminate(&mut self) {
        if let Some((_, stdin)) = &mut self.process {
            stdin.take();
        }
        self.signal(Signal::SIGTERM);
        // A stopped process hears no other signal.
        self.signal(Signal::SIGCONT);
    }

    /// Ends the process; that it has ended is seen as if it had by itself.
    pub fn strike(&mut self) {
        self.signal(Signal::SIGKILL);
    }

    /// Ends the process and all that it started, and waits for it.
    pub fn kill(&mut self) {
        self.signal(Signal::SIGKILL);
        if let Some((mut child, _)) = self.process.take() {
            child.wait().ok();
        }
    }

    fn signal(&self, signal: Signal) {
        if let Some(pid) = self.pid().and_then(|pid| i32::try_from(pid).ok()) {
            killpg(Pid::from_raw(pid), signal).ok();
        }
    }
}

impl Drop for Node {
    fn drop(&mut self) {
        self.kill();
    }
}

fn judge(status: ExitStatus) -> Ended {
    match status.code() {
        Some(0) => Ended::Well,
        Some(code) if code == maulstick_rig::user_error::EXIT_USAGE => Ended::Refused(code),
        _ => Ended::Badly,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_failures_in_ten_seconds_are_too_many_whoever_else_fails() {
        let (mut failures, start) = (Failures::default(), Instant::now());
        let mut fails =
            |name: &str, second: u64| failures.count(name, start + Duration::from_secs(second));
        assert!(!fails("player", 0) && !fails("paint", 1) && !fails("player", 2));
        // The first is 11 s ago, so these are two again.
        assert!(!fails("player", 11));
        assert!(!fails("paint", 11));
        assert!(fails("player", 12));
        assert!(fails("player", 13));
        assert!(!fails("player", 30));
    }
}
