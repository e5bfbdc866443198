//! The processes of a rig: each started in a group of its own, signalled, and awaited together.
//!
//! None outlives its launcher: the launcher holds its standard input open, whose end makes it stop; the kernel also
//! signals it when the launcher's thread that started it dies. That is the main thread, on which the supervisor runs.

use std::collections::BTreeMap;
use std::os::unix::process::CommandExt as _;
use std::path::Path;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc;
use std::time::Duration;

use maulstick_rig::UserError;
use maulstick_rig::program::own_program;
use maulstick_rig::user_error::EXIT_USAGE;
use nix::sys::signal::{Signal, killpg};
use nix::sys::wait::{Id, WaitPidFlag, waitid};
use nix::unistd::Pid;
use tokio::signal::unix::{Signal as SignalStream, SignalKind, signal};

use crate::up::plan::NodeSpec;

/// Longest wait for the ends of killed processes.
const LONGEST_END: Duration = Duration::from_secs(2);

/// End of a process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ended {
    Well,
    /// With an exit code of bad usage: starting it again would not help.
    Refused(i32),
    Badly,
}

/// The processes that run, by the names of their nodes. Dropped, all are killed.
#[derive(Debug)]
pub(super) struct Processes {
    running: BTreeMap<String, Process>,
    /// SIGCHLD: some process has ended.
    ends: SignalStream,
}

#[derive(Debug)]
struct Process {
    child: Child,
    /// Held open until it is asked to end.
    stdin: Option<ChildStdin>,
}

impl Processes {
    /// None yet; to be called within a runtime.
    ///
    /// # Errors
    /// A [`UserError`] where signals cannot be watched.
    pub(super) fn new() -> Result<Self, UserError> {
        let ends = signal(SignalKind::child());
        Ok(Self {
            running: BTreeMap::new(),
            ends: ends.map_err(|error| UserError::failure(error.to_string()))?,
        })
    }

    /// Starts the process of a node; returns its id.
    ///
    /// # Errors
    /// A [`UserError`] where the system cannot.
    pub(super) fn start(&mut self, spec: &NodeSpec, folder: &Path) -> Result<u32, UserError> {
        let program = spec.program;
        let failed = |error: std::io::Error| {
            let what = format!("node '{}' cannot be started: {error}", spec.name);
            UserError::failure(what)
                .help("the machine may be out of memory or processes: end what is not needed")
        };
        let mut child = Command::new(own_program())
            .arg0(program.process_name())
            .args(["node", program.subcommand(), "--folder"])
            .arg(folder)
            .args(["--node", &spec.name, "--guarded"])
            .args(&spec.args)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .process_group(0)
            .spawn()
            .map_err(failed)?;
        let id = child.id();
        let process = Process {
            stdin: child.stdin.take(),
            child,
        };
        self.running.insert(spec.name.clone(), process);
        Ok(id)
    }

    /// Waits for the next process that ends: the name of its node, and how it ended. Dropped before that, it loses none.
    pub(super) async fn ended(&mut self) -> (String, Ended) {
        loop {
            let ended = self.running.iter_mut().find_map(|(name, process)| {
                let status = process.child.try_wait().ok()??;
                Some((name.clone(), judge(status)))
            });
            if let Some((name, ended)) = ended {
                self.running.remove(&name);
                return (name, ended);
            }
            self.ends.recv().await;
        }
    }

    /// True while the process of a node runs.
    #[must_use]
    pub(super) fn runs(&self, name: &str) -> bool {
        self.running.contains_key(name)
    }

    /// Asks the process of a node to end.
    pub(super) fn terminate(&mut self, name: &str) {
        if let Some(process) = self.running.get_mut(name) {
            process.stdin.take();
            process.signal(Signal::SIGTERM);
            // A stopped process receives no other signal.
            process.signal(Signal::SIGCONT);
        }
    }

    /// Kills the process of a node and its children; its end is handled like any other.
    pub(super) fn kill(&mut self, name: &str) {
        if let Some(process) = self.running.get(name) {
            process.signal(Signal::SIGKILL);
        }
    }
}

impl Process {
    fn signal(&self, signal: Signal) {
        if let Ok(group) = i32::try_from(self.child.id()) {
            killpg(Pid::from_raw(group), signal).ok();
        }
    }
}

impl Drop for Processes {
    /// Kills all, and waits for their ends: not longer than [`LONGEST_END`], for one that hangs in the system has none.
    fn drop(&mut self) {
        self.running
            .values()
            .for_each(|process| process.signal(Signal::SIGKILL));
        let ids = self.running.values().map(|process| process.child.id());
        let ids: Vec<_> = ids.filter_map(|id| i32::try_from(id).ok()).collect();
        let (at_end, all_ended) = mpsc::channel();
        // Their status stays to be read here.
        let how = WaitPidFlag::WEXITED | WaitPidFlag::WNOWAIT;
        let waits = move || {
            for id in ids {
                waitid(Id::Pid(Pid::from_raw(id)), how).ok();
            }
            at_end.send(()).ok();
        };
        if std::thread::Builder::new().spawn(waits).is_ok() {
            all_ended.recv_timeout(LONGEST_END).ok();
        }
        for (name, process) in &mut self.running {
            if matches!(process.child.try_wait(), Ok(None)) {
                tracing::warn!("the killed process of node '{name}' does not end");
            }
        }
    }
}

fn judge(status: ExitStatus) -> Ended {
    match status.code() {
        Some(0) => Ended::Well,
        Some(code) if code == EXIT_USAGE => Ended::Refused(code),
        _ => Ended::Badly,
    }
}
