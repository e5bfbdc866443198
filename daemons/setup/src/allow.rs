//! The rule by which the user at this machine may use its devices.

use std::io::{ErrorKind, Write as _};
use std::process::{Command, Stdio};

use maulstick_rig::UserError;
use maulstick_rig::user_devices::ALLOW_BY_HAND;
use nix::unistd::geteuid;

use crate::attached::{Places, hid, rules};

/// Where udev reads the rule.
pub const RULE: &str = "/etc/udev/rules.d/70-maulstick.rules";
/// Shell command that installs the rule and has it hold for what is attached, before it returns.
const INSTALL: &str = "umask 022 && cat > /etc/udev/rules.d/70-maulstick.rules && udevadm control --reload && \
                       udevadm trigger && udevadm settle --timeout=5";

/// Writes the rule, as root or by `pkexec`, which asks for the password.
///
/// # Errors
/// A [`UserError`] with the command to type where it cannot be written so.
pub fn allow() -> Result<(), UserError> {
    let by_hand = |what: String| UserError::failure(what).at(RULE).help(ALLOW_BY_HAND);
    let mut command = if geteuid().is_root() {
        Command::new("sh")
    } else {
        let mut asked = Command::new("pkexec");
        asked.arg("sh");
        asked
    };
    let failed = |error: std::io::Error| match error.kind() {
        ErrorKind::NotFound => by_hand("pkexec is not installed".to_owned()),
        _ => by_hand(error.to_string()),
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
        (Some(126 | 127), _) => Err(by_hand("it was not allowed".to_owned())),
        _ => Err(by_hand("the rule could not be installed".to_owned())),
    }
}
