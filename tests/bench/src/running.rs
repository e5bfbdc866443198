//! The processes that a measurement starts, and ends with itself.

use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use maulstick_bus::{RigFolder, RigInfo};
use maulstick_rig::UserError;

/// A process that ends with this value.
pub(crate) struct Running(Child);

impl Running {
    /// Starts `command` as it is.
    pub(crate) fn begin(command: &mut Command) -> Result<Self, UserError> {
        command.spawn().map(Self).map_err(fault)
    }

    /// Starts `command` without its words.
    pub(crate) fn start(command: &mut Command) -> Result<Self, UserError> {
        let quiet = command.stdout(Stdio::null()).stderr(Stdio::null());
        quiet.spawn().map(Self).map_err(fault)
    }

    /// Its number.
    pub(crate) fn id(&self) -> u32 {
        self.0.id()
    }

    /// True if it has ended.
    pub(crate) fn has_ended(&mut self) -> Result<bool, UserError> {
        Ok(self.0.try_wait().map_err(fault)?.is_some())
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.0.kill().ok();
        self.0.wait().ok();
    }
}

pub(crate) fn fault(error: impl std::fmt::Display) -> UserError {
    UserError::failure(error.to_string())
}

/// The command beside this program.
pub(crate) fn maulstick() -> Result<PathBuf, UserError> {
    Ok(std::env::current_exe()
        .map_err(fault)?
        .with_file_name("maulstick"))
}

/// Interval of checks for a starting rig, whose folder nothing announces.
const LOOK: Duration = Duration::from_millis(5);

/// The rig of a folder, once it runs.
pub(crate) fn joined(path: &Path, give_up: Instant) -> Result<(RigFolder, RigInfo), UserError> {
    loop {
        match RigFolder::join_at(path) {
            Ok(joined) => return Ok(joined),
            Err(error) if Instant::now() > give_up => return Err(error.into()),
            Err(_) => std::thread::sleep(LOOK),
        }
    }
}

/// The existing display, or one without a screen, of `size` pixels; and its name.
pub(crate) fn display(size: [u32; 2]) -> Result<(Option<Running>, String), UserError> {
    if let Ok(name) = std::env::var("DISPLAY") {
        return Ok((None, name));
    }
    let missing = |error: std::io::Error| {
        UserError::failure(format!("there is no display, and no Xvfb: {error}"))
            .help("set DISPLAY, or install xvfb")
    };
    let mut server = Command::new("Xvfb")
        .args(["-displayfd", "1", "-nolisten", "tcp", "-screen", "0"])
        .arg(format!("{}x{}x24", size[0], size[1]))
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .map_err(missing)?;
    let mut number = String::new();
    if let Some(words) = server.stdout.take() {
        BufReader::new(words)
            .read_line(&mut number)
            .map_err(fault)?;
    }
    Ok((Some(Running(server)), format!(":{}", number.trim())))
}
