//! Messages of a library, as a user may read them: its errors and panics name places in source files, by paths of the machine
//! that built this program.

use std::fmt::Display;

/// Text that zenoh puts between a message and its place.
const AT: &str = " at ";
/// End of the path of a source file, before its line.
const SOURCE: &str = ".rs:";

/// The text of an error without places in source files: of `no route at /build/a.rs:12.` it is `no route`.
#[must_use]
pub fn reason(error: impl Display) -> String {
    let text = error.to_string();
    let mut parts = text.split(AT);
    let mut kept = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        match behind_place(part) {
            Some(rest) => kept.push_str(rest),
            None => {
                kept.push_str(AT);
                kept.push_str(part);
            }
        }
    }
    kept
}

/// Rest of a text that begins with a place in a source file.
fn behind_place(text: &str) -> Option<&str> {
    let (path, behind) = text.split_once(SOURCE)?;
    let is_path = path.starts_with('/') || !path.contains(char::is_whitespace);
    let rest = behind.trim_start_matches(|sign: char| sign.is_ascii_digit() || sign == ':');
    (is_path && rest.len() < behind.len()).then(|| rest.strip_prefix('.').unwrap_or(rest))
}

/// The path of a source file from its crate on: of `/build/zenoh-1.0.0/src/lib.rs` it is `zenoh-1.0.0/src/lib.rs`.
#[must_use]
pub fn place(path: &str) -> &str {
    if !path.starts_with('/') {
        return path;
    }
    let own = path.rfind("/src/").unwrap_or(path.len());
    match path[..own].rfind('/') {
        Some(at) => &path[at + 1..],
        None => path,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_has_no_path_of_the_machine_that_built_it() {
        let built = "/root/.cargo/registry/src/index.crates.io-1949cf8c6b5b557f/zenoh-1.10.2/src";
        let cause = format!("Connection refused (os error 111) at {built}/unicast.rs:284.");
        for (said, wanted) in [
            (
                format!("Unable to connect at {built}/net/runtime/orchestrator.rs:442."),
                "Unable to connect",
            ),
            (
                format!("No link to /tmp/a at {built}/manager.rs:75. - Caused by {cause}"),
                "No link to /tmp/a - Caused by Connection refused (os error 111)",
            ),
            (
                format!("[{cause}, {cause}]"),
                "[Connection refused (os error 111), Connection refused (os error 111)]",
            ),
            (
                "looked at it at 12:30.".to_owned(),
                "looked at it at 12:30.",
            ),
            ("at sea.rs: nothing".to_owned(), "at sea.rs: nothing"),
        ] {
            assert_eq!(reason(said), wanted);
        }
    }

    #[test]
    fn a_source_file_is_named_from_its_crate_on() {
        for (path, wanted) in [
            (
                "/root/.cargo/registry/src/index/zenoh-runtime-1.10.2/src/lib.rs",
                "zenoh-runtime-1.10.2/src/lib.rs",
            ),
            (
                "/rustc/abc/library/core/src/option.rs",
                "core/src/option.rs",
            ),
            ("msgs/bus/src/reason.rs", "msgs/bus/src/reason.rs"),
            ("/build/main.rs", "main.rs"),
        ] {
            assert_eq!(place(path), wanted);
        }
    }
}
