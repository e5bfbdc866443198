//! The program of this process, for the processes that it starts.

use std::os::unix::process::CommandExt as _;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The file that this process runs, by which the kernel keeps it even if its name has another file since, or none: all
/// programs of a rig are of one version, also after an upgrade.
const RUNNING: &str = "/proc/self/exe";

/// A name that leads to the program of this process for as long as it runs.
#[must_use]
pub fn own_program() -> PathBuf {
    let running = PathBuf::from(RUNNING);
    if running.exists() || running.is_symlink() {
        running
    } else {
        std::env::current_exe().unwrap_or_else(|_| "maulstick".into())
    }
}

/// A command of a program that is called `maulstick`, whatever its file is called.
#[must_use]
pub fn command(program: &Path) -> Command {
    let mut command = Command::new(program);
    command.arg0("maulstick");
    command
}
