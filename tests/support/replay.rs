//! A replay that takes orders and says in JSON how far it is.

use std::io::{BufRead as _, BufReader, Lines, Write as _};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use serde_json::Value;

/// A replay, from its start on.
pub struct Replay {
    child: Child,
    input: ChildStdin,
    lines: Lines<BufReader<ChildStdout>>,
}

impl Replay {
    /// Starts a command that prints JSON lines.
    pub fn start(mut command: Command) -> Self {
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().expect("started");
        let input = child.stdin.take().expect("piped");
        let output = child.stdout.take().expect("piped");
        Self {
            child,
            input,
            lines: BufReader::new(output).lines(),
        }
    }

    pub fn order(&mut self, order: &str) {
        writeln!(self.input, "{order}").expect("written");
    }

    /// Reads on to a line that is `wanted`.
    pub fn until(&mut self, mut wanted: impl FnMut(&Value) -> bool) {
        let mut lines = self.lines.by_ref().map_while(Result::ok);
        let found = lines.any(|line| wanted(&serde_json::from_str(&line).expect("JSON")));
        assert!(found, "it ended");
    }

    /// Waits for its end, which is a good one.
    pub fn finish(mut self) {
        self.lines.by_ref().for_each(drop);
        assert!(self.child.wait().expect("ended").success());
    }
}
