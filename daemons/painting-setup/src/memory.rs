//! Memory that a command allocates at once: a request for too much is refused before the work begins, for an allocation
//! that fails ends the process.

use std::path::Path;

use maulstick_rig::UserError;
use maulstick_rig::size::show_bytes;

/// Checks that there is memory for `what`.
///
/// # Errors
/// A [`UserError`] where less than `bytes` are available.
pub fn check(what: &str, bytes: u64) -> Result<(), UserError> {
    match available().filter(|available| *available < bytes) {
        None => Ok(()),
        Some(available) => Err(UserError::failure(format!(
            "{what} takes {} of memory, and {} are free",
            show_bytes(bytes),
            show_bytes(available)
        ))
        .help("end other programs, or use a machine with more memory")),
    }
}

/// Memory available to this process, bytes: of the machine, of its control group, of its address space; `None` if
/// unknown.
fn available() -> Option<u64> {
    let read = |path: &str| std::fs::read_to_string(Path::new(path)).unwrap_or_default();
    let group = || {
        let number = |name: &str| {
            let text = read(&format!("/sys/fs/cgroup/memory.{name}"));
            text.trim().parse::<u64>().ok()
        };
        Some(number("max")?.saturating_sub(number("current")?))
    };
    let space = || {
        let limit = after(&read("/proc/self/limits"), "Max address space")?;
        let taken = after(&read("/proc/self/status"), "VmSize:")? * 1024;
        Some(limit.saturating_sub(taken))
    };
    let machine = after(&read("/proc/meminfo"), "MemAvailable:").map(|kilobytes| kilobytes * 1024);
    [machine, group(), space()].into_iter().flatten().min()
}

/// The number after a name at the beginning of a line.
fn after(text: &str, name: &str) -> Option<u64> {
    let rest = text.lines().find_map(|line| line.strip_prefix(name))?;
    rest.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_takes_more_than_there_is_is_refused() {
        check("nothing", 0).expect("there is that much");
        let fault = check("a picture", u64::MAX).expect_err("no machine has that");
        assert!(fault.what.contains(&show_bytes(u64::MAX)), "{fault}");
    }

    #[test]
    fn numbers_are_read_after_their_names() {
        let limits = "Max address space         4096                 unlimited            bytes\n";
        assert_eq!(after(limits, "Max address space"), Some(4096));
        assert_eq!(
            after(&limits.replace("4096", "unlimited"), "Max address space"),
            None
        );
        assert_eq!(
            after("MemTotal: 9 kB\nMemAvailable:   7 kB\n", "MemAvailable:"),
            Some(7)
        );
    }
}
