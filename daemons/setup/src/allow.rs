//! The rule by which the user at this machine may use its devices.

use std::io::{ErrorKind, Write as _};
use std::process::{Command, Stdio};

use nix::unistd::geteuid;

use crate::attached::{Places, hid, rules};
use crate::error::{RuleError, SetupError};

/// Shell command that installs the rule and has it hold for what is attached, before it returns.
const INSTALL: &str = "umask 022 && cat > /etc/udev/rules.d/70-maulstick.rules && udevadm control --reload && \
                       udevadm trigger && udevadm settle --timeout=5";

/// Writes the rule, as root or by `pkexec`, which asks for the password.
///
/// # Errors
/// [`SetupError::Rule`].
pub fn allow() -> Result<(), SetupError> {
    let mut command = if geteuid().is_root() {
        Command::new("sh")
    } else {
        let mut asked = Command::new("pkexec");
        asked.arg("sh");
        asked
    };
    let failed = |error: std::io::Error| match error.kind() {
        ErrorKind::NotFound => RuleError::NoPkexec,
        _ => RuleError::Spawn(error.to_string()),
    };
    let mut child = command
        .args(["-c", INSTALL])
        .stdin(Stdio::piped())
        .spawn()
        .map_err(failed)?;
    let text = rules(&hid::devices(&Places::here()));
    // One that was refused reads nothing, and says so by its end.
    let written = child
        .stdin
        .take()
        .map(|mut to| to.write_all(text.as_bytes()));
    let status = child.wait().map_err(failed)?;
    match (status.code(), written) {
        (Some(0), Some(Ok(()))) => Ok(()),
        (Some(126 | 127), _) => Err(RuleError::Denied.into()),
        _ => Err(RuleError::NotInstalled.into()),
    }
}
