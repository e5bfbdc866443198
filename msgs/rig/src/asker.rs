//! Name of the asker of a command, for the log of the node that carries it out.

use std::os::fd::AsFd as _;

use nix::unistd::{User, getpid, getuid, ttyname};

/// This process as one that asks: what it is, whose, at which terminal.
#[must_use]
pub fn asker(program: &str) -> String {
    let user = getuid();
    let user = match User::from_uid(user) {
        Ok(Some(user)) => user.name,
        _ => format!("user {user}"),
    };
    let terminal = match ttyname(std::io::stdin().as_fd()) {
        Ok(path) => format!(", {}", path.display()),
        Err(_) => String::new(),
    };
    format!("{program} ({user}{terminal}, process {})", getpid())
}
