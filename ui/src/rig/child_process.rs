//! A `maulstick` command that runs beside the window and is read line by line.

use std::io::{BufRead as _, BufReader, Read, Write as _};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, Sender, channel};

use eframe::egui::Context;
use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;

/// A command's complaint, with advice.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Refused {
    /// The error; empty if the command said none.
    pub what: String,
    /// Advice; empty if there is none.
    pub help: String,
}

/// The end of a command.
#[derive(Debug)]
pub(crate) struct Ended {
    /// Lines that it printed since they were last taken.
    pub lines: Vec<String>,
    /// Its complaint, if it failed.
    pub result: Result<(), Refused>,
}

/// The process of a command. It is interrupted, as by Ctrl-C, and waited for when this is dropped.
#[derive(Debug)]
pub(crate) struct ChildProcess {
    child: Child,
    lines: Receiver<String>,
    errors: Receiver<String>,
}

impl ChildProcess {
    /// Starts a command; the window of `context` is drawn anew at each of its lines and at its end.
    ///
    /// # Errors
    /// The system's, where it cannot be started.
    pub(crate) fn start(context: &Context, mut command: Command) -> std::io::Result<Self> {
        let command = command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn()?;
        let (to_lines, lines) = channel();
        let (to_errors, errors) = channel();
        if let Some(stdout) = child.stdout.take() {
            read(context, stdout, to_lines);
        }
        if let Some(stderr) = child.stderr.take() {
            read(context, stderr, to_errors);
        }
        Ok(Self {
            child,
            lines,
            errors,
        })
    }

    /// Lines that it printed since the last call.
    pub(crate) fn lines(&self) -> impl Iterator<Item = String> {
        self.lines.try_iter()
    }

    /// Writes a line to its standard input, where it has one; a command that has just ended reads none.
    pub(crate) fn send(&mut self, line: &str) {
        if let Some(input) = &mut self.child.stdin {
            input.write_all(format!("{line}\n").as_bytes()).ok();
        }
    }

    /// Interrupts it.
    pub(crate) fn interrupt(&self) {
        if let Ok(pid) = i32::try_from(self.child.id()) {
            kill(Pid::from_raw(pid), Signal::SIGINT).ok();
        }
    }

    /// Its end; `None` while it runs.
    pub(crate) fn ended(&mut self) -> Option<Ended> {
        let succeeded = match self.child.try_wait() {
            Ok(None) => return None,
            Ok(Some(status)) => status.success(),
            Err(_) => false,
        };
        // Until the readers have come to the end.
        let lines = self.lines.iter().collect();
        let errors: Vec<String> = self.errors.iter().collect();
        Some(Ended {
            lines,
            result: match succeeded {
                true => Ok(()),
                false => Err(complaint(&errors.join("\n"))),
            },
        })
    }
}

impl Drop for ChildProcess {
    fn drop(&mut self) {
        if matches!(self.child.try_wait(), Ok(None)) {
            self.interrupt();
            self.child.wait().ok();
        }
    }
}

/// Reads lines on a thread, so that the command never waits for the window.
fn read(context: &Context, source: impl Read + Send + 'static, to_window: Sender<String>) {
    let context = context.clone();
    let read = move || {
        for line in BufReader::new(source).lines().map_while(Result::ok) {
            to_window.send(line).ok();
            context.request_repaint();
        }
        drop(to_window);
        context.request_repaint();
    };
    let thread = std::thread::Builder::new().name("child".into()).spawn(read);
    if let Err(error) = thread {
        tracing::error!("no thread for the lines of a command: {error}");
    }
}

/// A complaint as the command line writes it: `error: what`, where, and ` help: advice`.
pub(crate) fn complaint(text: &str) -> Refused {
    let text = text.trim();
    let (first, help) = text.split_once("\n help: ").unwrap_or((text, ""));
    let mut lines = first.lines();
    let what = lines.find_map(|line| line.strip_prefix("error: "));
    Refused {
        what: what.or(first.lines().next()).unwrap_or_default().to_owned(),
        help: help.trim().to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_complaint_is_parted_into_fault_and_advice() {
        let refused = complaint("error: no permission\n  --> /dev/hidraw0\n help: ask\n");
        assert_eq!((&*refused.what, &*refused.help), ("no permission", "ask"));
        assert_eq!(complaint("it broke").what, "it broke");
    }
}
