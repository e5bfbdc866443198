//! A folder in which a command is tried.

#![allow(
    clippy::panic,
    dead_code,
    unreachable_pub,
    missing_docs,
    reason = "shared by test programs, each of which uses a part"
)]

use std::path::PathBuf;
use std::process::{Command, Output};

/// Options of a picture that is painted in a fraction of the time.
pub const COARSE: [&str; 2] = ["--cell-mm", "0.5"];

/// The program under test: that of the package that is tested.
pub const MAULSTICK: &str = match [
    option_env!("CARGO_BIN_EXE_maulstick"),
    option_env!("CARGO_BIN_EXE_maulstick-figures"),
    option_env!("CARGO_BIN_EXE_maulstick-fit"),
    option_env!("CARGO_BIN_EXE_maulstick-motions"),
] {
    [Some(program), ..]
    | [_, Some(program), ..]
    | [_, _, Some(program), _]
    | [.., Some(program)] => program,
    _ => panic!("a program of the package"),
};

/// Runs a command that must fail with `code`, and returns what it says.
pub fn fault(place: &Place, args: &[&str], code: i32) -> String {
    let output = place.run(args);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{args:?}: {said}");
    assert!(said.starts_with("error: "), "{args:?}: {said}");
    assert!(!said.contains("panicked"), "{said}");
    said
}

/// Asserts that all words are said.
pub fn has(said: &str, words: &[&str]) {
    for word in words {
        assert!(said.contains(word), "'{word}' is missing in: {said}");
    }
}

/// A folder for files and one for rigs; both go when dropped.
pub struct Place {
    pub(super) folder: tempfile::TempDir,
}

impl Place {
    pub fn new() -> Self {
        Self {
            folder: tempfile::tempdir().expect("a temporary folder"),
        }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// A command in this place.
    pub fn maulstick(&self, args: &[&str]) -> Command {
        let mut command = Command::new(MAULSTICK);
        command
            .args(args)
            .current_dir(self.folder.path())
            .env("XDG_RUNTIME_DIR", self.folder.path())
            .env("XDG_CONFIG_HOME", self.folder.path())
            .env("XDG_STATE_HOME", self.folder.path());
        command
    }

    /// Runs a command to its end.
    pub fn run(&self, args: &[&str]) -> Output {
        self.maulstick(args).output().expect("started")
    }

    /// Runs a command that must succeed.
    pub fn done(&self, args: &[&str]) -> Output {
        let output = self.run(args);
        assert!(
            output.status.success(),
            "{args:?}: {}",
            String::from_utf8_lossy(&output.stderr)
        );
        output
    }

    /// What a command that must succeed prints.
    pub fn text(&self, args: &[&str]) -> String {
        String::from_utf8(self.done(args).stdout).expect("UTF-8")
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), bytes).expect("written");
    }

    /// A demo of the first `seconds`, as `name`.
    pub fn short_demo(&self, name: &str, seconds: f64) {
        let take = maulstick_device::demo::performance(maulstick_device::demo::Subject::Flower, 3);
        let end = (seconds * 1e9) as u64;
        let samples = take
            .samples
            .into_iter()
            .filter(|sample| sample.time_ns <= end)
            .collect();
        let take = maulstick_device::Take {
            setup: None,
            device: "demo".into(),
            samples,
        };
        take.write(&self.path(name)).expect("written");
    }

    pub fn bytes(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }
}
